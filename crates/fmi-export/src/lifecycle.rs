//! Creation, logging and end of an instance.
#![allow(unsafe_code, reason = "raw pointers come in, references and boxes go on")]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr;

use fmi_model::{braced, guarded};
use uuid::Uuid;

use crate::call::call;
use crate::error::CallError;
use crate::handle::Handle;
use crate::identity::{Exported, own_guid};
use crate::instance::Instance;
use crate::log::Logger;
use crate::memory;
use crate::order::Function;
use crate::status::Status;
use crate::version::Version;

/// What every host says when it asks for an instance.
#[derive(Debug, Clone, Copy)]
pub struct Wish {
    /// Name of the instance.
    pub name: *const c_char,
    /// The identifier in the description, and the name of the argument that it came in.
    pub identifier: (&'static str, *const c_char),
    /// Whether messages are wanted.
    pub logging_on: bool,
}

/// Where the FMU's resources are, as the host says.
#[derive(Debug)]
pub struct Resources {
    argument: &'static str,
    /// `None` for a null pointer.
    given: Option<String>,
    /// `None` where no folder of this machine is meant.
    folder: Option<PathBuf>,
}

impl Resources {
    /// What the host says in `argument`. Whatever is no folder of this machine counts as none.
    ///
    /// * `path`: the path that the text means.
    ///
    /// # Safety
    /// `location` is null or a NUL-terminated text that nobody writes to during the call.
    pub unsafe fn read(
        argument: &'static str,
        location: *const c_char,
        path: impl FnOnce(&str) -> Option<PathBuf>,
    ) -> Self {
        if location.is_null() {
            return Self {
                argument,
                given: None,
                folder: None,
            };
        }
        // SAFETY: not null, and the caller vouches for the terminating NUL.
        let given = unsafe { CStr::from_ptr(location) };
        let meant = given.to_str().ok().and_then(path);
        Self {
            argument,
            given: Some(given.to_string_lossy().into_owned()),
            folder: meant.filter(|path| path.is_dir()),
        }
    }

    /// Why a description and a library may not fit.
    fn suspicion(self) -> String {
        const VERSIONS: &str = "modelDescription.xml and library are of different versions";
        if self.folder.is_some() {
            return VERSIONS.to_owned();
        }
        let what = match self.given {
            None => format!("{} is null", self.argument),
            Some(given) => format!("{} '{given}' is no folder here", self.argument),
        };
        format!("{what}; an FMU packed with a mission needs it; of any other, {VERSIONS}")
    }
}

/// Makes an instance; null, and the reason to `sink` if logging is on, for an empty name, a wrong identifier, a faulty definition, or
/// what `resources` finds.
///
/// * `resources`: looks at what else the standard's function was given, and answers where the FMU's resources are.
///
/// # Safety
/// The texts of the wish are null or NUL-terminated, and nobody writes to them during the call.
pub unsafe fn create<V: Version, M: Exported<V>>(
    function: &Function,
    sink: &V::Sink,
    wish: Wish,
    resources: impl FnOnce() -> Result<Resources, CallError>,
) -> *mut c_void {
    let logger = Logger::new(sink.clone(), wish.logging_on);
    let created = guarded(|| {
        let (argument, identifier) = wish.identifier;
        // SAFETY: both are texts, as the caller vouches.
        let (name, given) = unsafe {
            (
                memory::text("instanceName", wish.name),
                memory::text(argument, identifier),
            )
        };
        let made = name
            .and_then(|name| {
                if name.is_empty() {
                    Err(CallError::EmptyName)
                } else {
                    Ok(())
                }
            })
            .and_then(|()| resources())
            .and_then(|resources| handle::<V, M>(given?, resources, &logger));
        made.map_err(|error| error.chain())
    });
    let (status, reason) = match created {
        Ok(Ok(handle)) => return Box::into_raw(handle).cast(),
        Ok(Err(reason)) => (Status::Error, reason),
        Err(panic) => (Status::Fatal, panic),
    };
    let message = format!("{}: {reason}", function.name);
    logger.explain(status, &message);
    ptr::null_mut()
}

fn handle<V: Version, M: Exported<V>>(
    given: &str,
    resources: Resources,
    logger: &Logger<V::Sink>,
) -> Result<Box<Handle<V, M>>, CallError> {
    let guid = own_guid::<V, M>()?;
    let own = braced(guid);
    // What an FMU was packed with may make it another.
    let own = resources
        .folder
        .as_deref()
        .and_then(|folder| M::identifier_with(&own, folder))
        .unwrap_or(own);
    if given != own {
        return Err(CallError::WrongIdentifier {
            kind: V::IDENTIFIER_NAME,
            given: given.to_owned(),
            own,
            suspicion: resources.suspicion(),
        });
    }
    // Its states are not those of the library packed with something else.
    let identity = Uuid::parse_str(&own).unwrap_or_else(|_| Uuid::new_v5(&guid, own.as_bytes()));
    let instance = Instance::new(identity, logger.clone(), resources.folder);
    Ok(Box::new(Handle::new(guid, logger.clone(), instance)))
}

/// Frees the instance in whatever phase it is. Null is fine.
///
/// # Safety
/// As for [`call`]; the instance is not used afterwards.
pub unsafe fn free_instance<V: Version, M: Exported<V>>(component: *mut c_void, function: &Function) {
    // SAFETY: `component` is null or an instance, as the caller vouches.
    let Ok(Some(handle)) = guarded(|| unsafe { Handle::<V, M>::recognise(component) }) else {
        return;
    };
    let Some(claim) = handle.claim(function) else {
        return;
    };
    handle.retire();
    let logger = handle.logger.clone();
    // Never given back: a call that overlaps this one is refused until the end.
    std::mem::forget(claim);
    // SAFETY: the box was made by `create` and is given up here: `handle` and `claim` are not used any more.
    let freed = guarded(|| drop(unsafe { Box::from_raw(component.cast::<Handle<V, M>>()) }));
    if let Err(panic) = freed {
        let message = format!("{}: {panic}", function.name);
        logger.explain(Status::Fatal, &message);
    }
}

/// Logging on or off, with the categories that are wanted.
///
/// # Safety
/// As for [`call`]; `categories` has `count` NUL-terminated texts.
pub unsafe fn set_debug_logging<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    logging_on: bool,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    // SAFETY: the caller vouches for the same.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let categories = memory::array("categories", categories, count)?
                .iter()
                .map(|category| memory::text("categories", *category))
                .collect::<Result<Vec<_>, _>>()?;
            instance.set_debug_logging(function, logging_on, &categories)
        })
    }
}
