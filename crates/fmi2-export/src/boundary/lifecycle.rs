//! Inquiry, logging, creation, initialization, end.

use std::ffi::{CStr, c_char, c_int};
use std::path::PathBuf;
use std::ptr;

use fmi_export::lifecycle::{self, Resources, Wish};
use fmi_export::{CallError, Exported, Instance, call};
use fmi_model::Experiment;
use fmi2_abi::{
    FMI_VERSION, Fmi2Boolean, Fmi2CallbackFunctions, Fmi2Component, Fmi2Real, Fmi2String, Fmi2Type, RawStatus,
    TYPES_PLATFORM, truth,
};
use percent_encoding::percent_decode_str;

use crate::error::Fmi2Error;
use crate::log::Sink;
use crate::order;
use crate::version::Fmi2;

pub fn get_types_platform() -> *const c_char {
    TYPES_PLATFORM.as_ptr()
}

pub fn get_version() -> *const c_char {
    FMI_VERSION.as_ptr()
}

pub unsafe fn set_debug_logging<M: Exported<Fmi2>>(
    component: Fmi2Component,
    logging_on: Fmi2Boolean,
    count: usize,
    categories: *const Fmi2String,
) -> RawStatus {
    let (function, on) = (&order::SET_DEBUG_LOGGING, truth(logging_on));
    // SAFETY: `categories` has `count` strings; see the module.
    unsafe { lifecycle::set_debug_logging::<Fmi2, M>(component, function, on, count, categories) }
}

/// Answers null for a wrong GUID, an interface other than co-simulation, an empty name, or a faulty definition, and says which to
/// the logger if logging is on. Visibility is not used, a resource location that is no folder of this machine is taken as none, and
/// any callback may be missing: messages then reach nobody, memory is the library's own, and steps are never asynchronous.
pub unsafe fn instantiate<M: Exported<Fmi2>>(
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
    let sink = Sink::new(functions, spoken_name);
    let wish = Wish {
        name,
        identifier: ("fmuGUID", guid),
        logging_on: truth(logging_on),
    };
    let resources = || match Fmi2Type::from_raw(fmu_type) {
        Some(Fmi2Type::CoSimulation) => {
            // SAFETY: null or a string; see the module.
            Ok(unsafe { Resources::read("fmuResourceLocation", resource_location, path_of) })
        }
        Some(Fmi2Type::ModelExchange) => Err(CallError::CoSimulationOnly),
        None => Err(Fmi2Error::UnknownType { raw: fmu_type }.into()),
    };
    // SAFETY: `name` and `guid` are strings; see the module.
    unsafe { lifecycle::create::<Fmi2, M>(&order::INSTANTIATE, &sink, wish, resources) }
}

/// The path that a resource location names: a `file:` URI as the standard asks for, or a plain path as some hosts give. That of
/// another machine is a UNC path, `//server/share/...`.
fn path_of(location: &str) -> Option<PathBuf> {
    let path = match location.strip_prefix("file:") {
        None => location.to_owned(),
        Some(rest) => {
            let rest = match rest.strip_prefix("//") {
                None => rest,
                Some(local) => match local.strip_prefix("localhost").unwrap_or(local) {
                    local if local.starts_with('/') || local.as_bytes().get(1) == Some(&b':') => local,
                    _ => rest,
                },
            };
            // A drive of Windows stands behind a slash of its own.
            let rest = match rest.as_bytes() {
                [b'/', drive, b':', ..] if drive.is_ascii_alphabetic() => &rest[1..],
                _ => rest,
            };
            percent_decode_str(rest).decode_utf8().ok()?.into_owned()
        }
    };
    Some(PathBuf::from(path))
}

/// Frees the instance in whatever phase it is. Null is fine.
pub unsafe fn free_instance<M: Exported<Fmi2>>(component: Fmi2Component) {
    // SAFETY: see the module.
    unsafe { lifecycle::free_instance::<Fmi2, M>(component, &order::FREE_INSTANCE) }
}

pub unsafe fn setup_experiment<M: Exported<Fmi2>>(
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
        call::<Fmi2, M>(component, &order::SETUP_EXPERIMENT, |instance| {
            instance.setup_experiment(experiment)
        })
    }
}

pub unsafe fn enter_initialization_mode<M: Exported<Fmi2>>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        call::<Fmi2, M>(
            component,
            &order::ENTER_INITIALIZATION_MODE,
            Instance::enter_initialization_mode,
        )
    }
}

pub unsafe fn exit_initialization_mode<M: Exported<Fmi2>>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        call::<Fmi2, M>(
            component,
            &order::EXIT_INITIALIZATION_MODE,
            Instance::exit_initialization_mode,
        )
    }
}

pub unsafe fn terminate<M: Exported<Fmi2>>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi2, M>(component, &order::TERMINATE, Instance::terminate) }
}

pub unsafe fn reset<M: Exported<Fmi2>>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi2, M>(component, &order::RESET, Instance::reset) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resource_locations_of_every_host_lead_to_the_folder() {
        for (location, path) in [
            ("/with space", "/with space"),
            ("file:/with%20space", "/with space"),
            ("file:///with%20space", "/with space"),
            ("file://localhost/with%20space", "/with space"),
            ("C:/a", "C:/a"),
            ("file:///C:/a", "C:/a"),
            ("file://C:/a", "C:/a"),
            ("file://server/share/a", "//server/share/a"),
            ("file:////server/share/a", "//server/share/a"),
            ("file://localhosts/share/a", "//localhosts/share/a"),
        ] {
            assert_eq!(path_of(location), Some(PathBuf::from(path)), "{location}");
        }
        assert_eq!(path_of("file:///%ff"), None, "not UTF-8");
    }
}
