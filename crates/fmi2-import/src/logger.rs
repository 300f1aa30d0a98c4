//! The callbacks an FMU is given: a logger that collects messages, and memory functions.

use std::collections::VecDeque;
use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2ComponentEnvironment, Fmi2String, RawStatus};

use crate::status::Status;

/// Messages kept for each instance; older ones make room.
const KEPT: usize = 256;

/// Messages quoted in an error.
const SHOWN: usize = 5;

/// One message of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogMessage {
    /// Status it was logged with.
    pub status: Status,
    /// Category it was logged under; may be empty.
    pub category: String,
    /// The text. Conversions such as `%d` stand as they are: their arguments cannot be read from Rust.
    pub text: String,
}

/// Where the messages of one instance go. An FMU may log from any of its threads.
#[derive(Debug, Default)]
pub(crate) struct Sink {
    messages: Mutex<VecDeque<LogMessage>>,
    /// Messages logged so far, dropped ones included.
    logged: AtomicUsize,
}

impl Sink {
    fn lock(&self) -> MutexGuard<'_, VecDeque<LogMessage>> {
        // A message list is never half-changed, so a poisoned lock is as good as another.
        self.messages.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, message: LogMessage) {
        let mut messages = self.lock();
        if messages.len() == KEPT {
            messages.pop_front();
        }
        messages.push_back(message);
        self.logged.fetch_add(1, Ordering::Relaxed);
    }

    /// Takes all messages, oldest first.
    pub(crate) fn drain(&self) -> Vec<LogMessage> {
        self.lock().drain(..).collect()
    }

    /// A mark to be given to [`Sink::since`].
    pub(crate) fn mark(&self) -> usize {
        self.logged.load(Ordering::Relaxed)
    }

    /// Texts of the last few messages logged after `mark`, oldest first, leaving them in place.
    pub(crate) fn since(&self, mark: usize) -> Vec<String> {
        let messages = self.lock();
        let wanted = self.mark().saturating_sub(mark).min(SHOWN);
        messages
            .iter()
            .skip(messages.len().saturating_sub(wanted))
            .map(|m| m.text.clone())
            .collect()
    }

    /// The callback struct for an instance that logs here; the sink must outlive that instance.
    pub(crate) fn callbacks(self: &Arc<Self>) -> Fmi2CallbackFunctions {
        Fmi2CallbackFunctions {
            logger: Some(variadic_logger()),
            allocate_memory: Some(calloc),
            free_memory: Some(free),
            step_finished: None,
            component_environment: Arc::as_ptr(self).cast_mut().cast::<c_void>(),
        }
    }
}

/// [`log`] under the variadic type that the standard asks for.
///
/// The only place where the two types meet. Stable Rust can call a C-variadic function but not define one, so the
/// function takes the five named arguments and ignores what follows.
fn variadic_logger() -> CallbackLogger {
    type FixedLogger = unsafe extern "C" fn(Fmi2ComponentEnvironment, Fmi2String, RawStatus, Fmi2String, Fmi2String);
    // SAFETY: both are C function pointers of the same size. In the C calling conventions of the platforms FMI names (x86-64
    // and AArch64, System V, Apple and Windows; cdecl on 32-bit x86) the named arguments of a variadic call travel as
    // in a fixed call and the caller removes the others, so a callee that reads the named ones only works for both.
    unsafe { std::mem::transmute::<FixedLogger, CallbackLogger>(log) }
}

/// Keeps one message.
///
/// # Safety
/// `environment` must be null or point to a live [`Sink`]; the strings must be null or NUL-terminated.
unsafe extern "C" fn log(
    environment: Fmi2ComponentEnvironment,
    _instance_name: Fmi2String,
    status: RawStatus,
    category: Fmi2String,
    message: Fmi2String,
) {
    if environment.is_null() {
        return;
    }
    // SAFETY: the pointer is the one that `Sink::callbacks` handed out, and its instance is still alive.
    let sink = unsafe { &*environment.cast::<Sink>() };
    // SAFETY: the FMU hands over C strings or null.
    let (category, message) = unsafe { (text(category), text(message)) };
    sink.push(LogMessage {
        status: Status::from_raw(status),
        category,
        text: message.trim_end().replace("%%", "%"),
    });
}

/// A C string as owned text; null is empty, bad UTF-8 is shown with replacement characters.
///
/// # Safety
/// `pointer` must be null or NUL-terminated.
pub(crate) unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: NUL-terminated by the contract above.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

// The standard asks for zeroed memory that `freeMemory` takes back: the C library's own pair.
// SAFETY: the declarations match the C standard library, which `std` links on every platform with shared libraries.
unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}
