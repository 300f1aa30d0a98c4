//! The callbacks that an instance is given, and what it logs through them.

use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, PoisonError};

use fmi2_abi::callbacks::{calloc, free, variadic};
use fmi2_abi::{Fmi2CallbackFunctions, Fmi2ComponentEnvironment, Fmi2String, RawStatus};

/// Messages kept; what comes after them says no more.
const KEPT: usize = 1000;

/// One message.
#[derive(Debug, Clone)]
pub(super) struct Message {
    pub(super) status: RawStatus,
    pub(super) category: String,
    /// As it comes, its conversions unfilled.
    pub(super) text: String,
}

/// Which callbacks are there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Offered {
    pub(super) logger: bool,
    pub(super) memory: bool,
}

/// Where messages of one instance go; it outlives the instance.
#[derive(Debug, Default)]
pub(super) struct Sink(Mutex<Vec<Message>>);

impl Sink {
    /// All messages so far.
    pub(super) fn messages(&self) -> Vec<Message> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The last message, as the tail of a sentence.
    pub(super) fn said(&self) -> String {
        let last = self.messages().pop();
        last.map_or_else(String::new, |m| format!("; it logged: {}", m.text.trim_end()))
    }

    pub(super) fn callbacks(&self, offered: Offered) -> Fmi2CallbackFunctions {
        Fmi2CallbackFunctions {
            logger: offered.logger.then(|| variadic(log)),
            allocate_memory: offered.memory.then_some(calloc),
            free_memory: offered.memory.then_some(free),
            step_finished: None,
            component_environment: std::ptr::from_ref(self).cast_mut().cast::<c_void>(),
        }
    }
}

/// # Safety
/// `environment` is null or a live [`Sink`]; the strings are null or end in NUL.
unsafe extern "C" fn log(
    environment: Fmi2ComponentEnvironment,
    _instance: Fmi2String,
    status: RawStatus,
    category: Fmi2String,
    message: Fmi2String,
) {
    if environment.is_null() {
        return;
    }
    // SAFETY: it is what `callbacks` handed out, and the sink outlives the instance.
    let sink = unsafe { &*environment.cast::<Sink>() };
    let mut messages = sink.0.lock().unwrap_or_else(PoisonError::into_inner);
    if messages.len() < KEPT {
        // SAFETY: by the contract above.
        let (category, text) = unsafe { (text(category), text(message)) };
        messages.push(Message { status, category, text });
    }
}

/// A string of C; nothing said is empty.
///
/// # Safety
/// The pointer is null or ends in NUL.
pub(super) unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: by the contract above.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}
