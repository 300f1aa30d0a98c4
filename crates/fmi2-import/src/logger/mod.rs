//! The callbacks an FMU is given: a logger that collects messages, and memory functions.
#![allow(unsafe_code, reason = "a C library calls in with pointers")]

mod references;
mod sink;

use std::borrow::Cow;
use std::ffi::{CStr, c_char, c_void};

use encoding_rs::WINDOWS_1252;
#[cfg(not(formatted_log))]
use fmi2_abi::callbacks::variadic;
use fmi2_abi::callbacks::{calloc, free};
use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2String, RawStatus};

pub use sink::LogMessage;
pub(crate) use sink::Sink;

use crate::status::Status;

/// What a callback environment begins with; `format.c` knows it, too.
type Keep =
    unsafe extern "C" fn(environment: *mut c_void, status: RawStatus, category: Fmi2String, message: Fmi2String);

/// Behind `fmi2ComponentEnvironment`.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Environment {
    keep: Keep,
    sink: Sink,
}

impl Environment {
    pub(crate) fn new(sink: Sink) -> Self {
        Self { keep, sink }
    }

    pub(crate) fn sink(&self) -> &Sink {
        &self.sink
    }

    /// The callback struct for an instance that logs here; the environment must outlive that instance.
    pub(crate) fn callbacks(&self) -> Fmi2CallbackFunctions {
        Fmi2CallbackFunctions {
            logger: Some(logger()),
            allocate_memory: Some(calloc),
            free_memory: Some(free),
            step_finished: None,
            component_environment: std::ptr::from_ref(self).cast_mut().cast::<c_void>(),
        }
    }
}

/// The logger with its arguments formatted, from `format.c`.
#[cfg(formatted_log)]
fn logger() -> CallbackLogger {
    // SAFETY: the declaration is that of `format.c`, which the build script has compiled.
    unsafe extern "C" {
        fn fmi2_import_log(
            environment: *mut c_void,
            instance_name: Fmi2String,
            status: RawStatus,
            category: Fmi2String,
            message: Fmi2String,
            ...
        );
    }
    fmi2_import_log
}

/// [`plain`] under the variadic type that the standard asks for, where no C compiler was found.
#[cfg(not(formatted_log))]
fn logger() -> CallbackLogger {
    /// Keeps one message as it came, but for its doubled percent signs.
    ///
    /// # Safety
    /// As for [`keep`].
    unsafe extern "C" fn plain(
        environment: *mut c_void,
        _instance_name: Fmi2String,
        status: RawStatus,
        category: Fmi2String,
        message: Fmi2String,
    ) {
        // SAFETY: passed on.
        let (category, message) = unsafe { (text(category), text(message)) };
        if !environment.is_null() {
            // SAFETY: the environment is ours, as for `keep`.
            let environment = unsafe { &*environment.cast::<Environment>() };
            environment.hear(status, category, &message.replace("%%", "%"));
        }
    }

    variadic(plain)
}

impl Environment {
    fn hear(&self, status: RawStatus, category: String, message: &str) {
        self.sink.push(Status::from_raw(status), category, message.trim_end());
    }
}

/// Keeps one finished message.
///
/// # Safety
/// `environment` must be null or point to a live [`Environment`]; the strings must be null or NUL-terminated.
unsafe extern "C" fn keep(environment: *mut c_void, status: RawStatus, category: Fmi2String, message: Fmi2String) {
    if environment.is_null() {
        return;
    }
    // SAFETY: the pointer is the one that `Environment::callbacks` handed out, and its instance is still alive.
    let environment = unsafe { &*environment.cast::<Environment>() };
    // SAFETY: the FMU hands over C strings or null.
    let (category, message) = unsafe { (text(category), text(message)) };
    environment.hear(status, category, &message);
}

/// A C string as owned text; null is empty. What is not UTF-8, as the standard asks for, is taken for Windows-1252, which
/// Western tools write.
///
/// # Safety
/// `pointer` must be null or NUL-terminated.
pub(crate) unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: NUL-terminated by the contract above.
    let bytes = unsafe { CStr::from_ptr(pointer) }.to_bytes();
    let text = std::str::from_utf8(bytes).map(Cow::Borrowed);
    text.unwrap_or_else(|_| WINDOWS_1252.decode_without_bom_handling(bytes).0)
        .into_owned()
}
