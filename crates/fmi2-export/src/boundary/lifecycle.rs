//! Inquiry, logging, creation, initialization, end.

use std::ffi::{CStr, c_char, c_int};
use std::path::PathBuf;
use std::ptr;

use fmi_model::{Experiment, Wanted, braced, guarded};
use fmi2_abi::{
    FMI_VERSION, Fmi2Boolean, Fmi2CallbackFunctions, Fmi2Component, Fmi2Real, Fmi2Status, Fmi2String, Fmi2Type,
    RawStatus, TYPES_PLATFORM, truth,
};
use percent_encoding::percent_decode_str;

use super::call::call;
use super::handle::Handle;
use super::memory;
use crate::error::CallError;
use crate::identity::{Exported, own_guid};
use crate::instance::Instance;
use crate::log::Sink;
use crate::order;

pub fn get_types_platform() -> *const c_char {
    TYPES_PLATFORM.as_ptr()
}

pub fn get_version() -> *const c_char {
    FMI_VERSION.as_ptr()
}

pub unsafe fn set_debug_logging<M: Exported>(
    component: Fmi2Component,
    logging_on: Fmi2Boolean,
    count: usize,
    categories: *const Fmi2String,
) -> RawStatus {
    // SAFETY: `categories` has `count` strings; see the module.
    unsafe {
        call::<M>(component, &order::SET_DEBUG_LOGGING, |instance| {
            let categories = memory::array("categories", categories, count)?
                .iter()
                .map(|category| memory::text("categories", *category))
                .collect::<Result<Vec<_>, _>>()?;
            instance.set_debug_logging(truth(logging_on), &categories)
        })
    }
}

/// Answers null for a wrong GUID, an interface other than co-simulation, an empty name, or a faulty definition, and says which to
/// the logger if logging is on. Visibility is not used, a resource location that is no folder of this machine is taken as none, and
/// any callback may be missing: messages then reach nobody, memory is the library's own, and steps are never asynchronous.
pub unsafe fn instantiate<M: Exported>(
    name: Fmi2String,
    fmu_type: c_int,
    guid: Fmi2String,
    resource_location: Fmi2String,
    functions: *const Fmi2CallbackFunctions,
    _visible: Fmi2Boolean,
    logging_on: Fmi2Boolean,
) -> Fmi2Component {
    if !functions.is_aligned() {
        return ptr::null_mut(); // nobody to tell
    }
    // SAFETY: null or aligned, and the host vouches for what it points to.
    let functions = unsafe { functions.as_ref() };
    let spoken_name = if name.is_null() {
        c""
    } else {
        // SAFETY: not null, and the host vouches for the terminating NUL.
        unsafe { CStr::from_ptr(name) }
    };
    let sink = Sink::new(functions, spoken_name, Wanted::new(truth(logging_on), &[]));
    let created = guarded(|| {
        // SAFETY: `name` and `guid` are strings; see the module.
        let (name, guid) = unsafe { (memory::text("instanceName", name), memory::text("fmuGUID", guid)) };
        // SAFETY: null or a string; see the module.
        let location =
            (!resource_location.is_null()).then(|| unsafe { memory::text("fmuResourceLocation", resource_location) });
        let resources = location.and_then(Result::ok).and_then(folder_of);
        let created = create::<M>(name, fmu_type, guid, resources, &sink);
        created.map_err(|error| error.chain())
    });
    let (status, reason) = match created {
        Ok(Ok(handle)) => return Box::into_raw(handle).cast(),
        Ok(Err(reason)) => (Fmi2Status::Error, reason),
        Err(panic) => (Fmi2Status::Fatal, panic),
    };
    let message = format!("{}: {reason}", order::INSTANTIATE.name);
    sink.explain(status, &message);
    ptr::null_mut()
}

fn create<M: Exported>(
    name: Result<&str, CallError>,
    fmu_type: c_int,
    given: Result<&str, CallError>,
    resources: Option<PathBuf>,
    sink: &Sink,
) -> Result<Box<Handle<M>>, CallError> {
    if name?.is_empty() {
        return Err(CallError::EmptyName);
    }
    match Fmi2Type::from_raw(fmu_type) {
        Some(Fmi2Type::CoSimulation) => {}
        Some(Fmi2Type::ModelExchange) => return Err(CallError::CoSimulationOnly),
        None => return Err(CallError::UnknownType { raw: fmu_type }),
    }
    let guid = own_guid::<M>()?;
    let (given, own) = (given?, braced(guid));
    // What an FMU was packed with may make it another.
    let own = resources
        .as_deref()
        .and_then(|folder| M::identifier_with(&own, folder))
        .unwrap_or(own);
    if given != own {
        return Err(CallError::WrongGuid {
            given: given.to_owned(),
            own,
        });
    }
    let instance = Instance::new(sink.clone(), resources);
    Ok(Box::new(Handle::new(guid, sink.clone(), instance)))
}

/// The folder that a resource location names: a `file:` URI as the standard asks for, or a plain path as some hosts give.
fn folder_of(location: &str) -> Option<PathBuf> {
    let path = match location.strip_prefix("file:") {
        None => location.to_owned(),
        Some(rest) => {
            let rest = rest
                .strip_prefix("//")
                .map_or(rest, |rest| rest.strip_prefix("localhost").unwrap_or(rest));
            // A drive of Windows stands behind a slash of its own.
            let rest = match rest.as_bytes() {
                [b'/', drive, b':', ..] if drive.is_ascii_alphabetic() => &rest[1..],
                _ => rest,
            };
            percent_decode_str(rest).decode_utf8().ok()?.into_owned()
        }
    };
    Some(PathBuf::from(path)).filter(|path| path.is_dir())
}

/// Frees the instance in whatever phase it is. Null is fine.
pub unsafe fn free_instance<M: Exported>(component: Fmi2Component) {
    // SAFETY: `component` is null or an instance; see the module.
    let Ok(Some(handle)) = guarded(|| unsafe { Handle::<M>::recognise(component) }) else {
        return;
    };
    let Some(claim) = handle.claim(&order::FREE_INSTANCE) else {
        return;
    };
    handle.retire();
    let sink = handle.sink.clone();
    drop(claim);
    // SAFETY: the box was made by `instantiate` and is given up here: `handle` and `claim` are not used any more.
    let freed = guarded(|| drop(unsafe { Box::from_raw(component.cast::<Handle<M>>()) }));
    if let Err(panic) = freed {
        let message = format!("{}: {panic}", order::FREE_INSTANCE.name);
        sink.explain(Fmi2Status::Fatal, &message);
    }
}

pub unsafe fn setup_experiment<M: Exported>(
    component: Fmi2Component,
    tolerance_defined: Fmi2Boolean,
    tolerance: Fmi2Real,
    start_time: Fmi2Real,
    stop_time_defined: Fmi2Boolean,
    stop_time: Fmi2Real,
) -> RawStatus {
    let experiment = Experiment {
        start_time,
        stop_time: truth(stop_time_defined).then_some(stop_time),
        tolerance: truth(tolerance_defined).then_some(tolerance),
    };
    // SAFETY: see the module.
    unsafe {
        call::<M>(component, &order::SETUP_EXPERIMENT, |instance| {
            instance.setup_experiment(experiment)
        })
    }
}

pub unsafe fn enter_initialization_mode<M: Exported>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        call::<M>(
            component,
            &order::ENTER_INITIALIZATION_MODE,
            Instance::enter_initialization_mode,
        )
    }
}

pub unsafe fn exit_initialization_mode<M: Exported>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        call::<M>(
            component,
            &order::EXIT_INITIALIZATION_MODE,
            Instance::exit_initialization_mode,
        )
    }
}

pub unsafe fn terminate<M: Exported>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<M>(component, &order::TERMINATE, Instance::terminate) }
}

pub unsafe fn reset<M: Exported>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<M>(component, &order::RESET, Instance::reset) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resource_locations_of_every_host_lead_to_the_folder() {
        let base = tempfile::tempdir().unwrap();
        let folder = base.path().join("with space");
        std::fs::create_dir(&folder).unwrap();
        let plain = folder.to_str().unwrap();
        let coded = plain.replace(' ', "%20");
        for location in [
            plain.to_owned(),
            format!("file:{coded}"),
            format!("file://{coded}"),
            format!("file://localhost{coded}"),
        ] {
            assert_eq!(folder_of(&location).as_deref(), Some(folder.as_path()), "{location}");
        }
        for location in ["", "file:///no/such/folder", "http://example.org/resources"] {
            assert_eq!(folder_of(location), None, "{location}");
        }
    }
}
