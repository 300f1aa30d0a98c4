//! Messages to the host through its callback.
#![allow(unsafe_code, reason = "calls the logger of the host")]

use std::ffi::{CStr, CString};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use fmi_model::{Category, Listener, Wanted};
use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2ComponentEnvironment, Fmi2Status};

/// The category of messages that explain `status`.
fn category_of(status: Fmi2Status) -> Category {
    match status {
        Fmi2Status::Ok | Fmi2Status::Pending => Category::Events,
        Fmi2Status::Warning => Category::StatusWarning,
        Fmi2Status::Discard => Category::StatusDiscard,
        Fmi2Status::Error => Category::StatusError,
        Fmi2Status::Fatal => Category::StatusFatal,
    }
}

/// The host's end of the log: its callback, and the name under which the instance speaks.
#[derive(Debug, Clone)]
pub(crate) struct Sink {
    callback: Option<CallbackLogger>,
    environment: Fmi2ComponentEnvironment,
    instance_name: CString,
    /// [`Wanted`], as last set; all clones share it.
    wanted: Arc<AtomicU8>,
}

impl Sink {
    /// A sink for messages of `instance_name`; keeps a copy of what it needs from `callbacks`. Without callbacks nobody hears
    /// anything.
    pub(crate) fn new(callbacks: Option<&Fmi2CallbackFunctions>, instance_name: &CStr, wanted: Wanted) -> Self {
        Self {
            callback: callbacks.and_then(|callbacks| callbacks.logger),
            environment: callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.component_environment),
            instance_name: instance_name.to_owned(),
            wanted: Arc::new(AtomicU8::new(wanted.to_bits())),
        }
    }

    /// Sets what the host wants to hear.
    pub(crate) fn set_wanted(&self, wanted: Wanted) {
        self.wanted.store(wanted.to_bits(), Ordering::Relaxed);
    }

    /// Sends a message that explains `status`, if the host wants to hear such.
    pub(crate) fn explain(&self, status: Fmi2Status, message: &dyn fmt::Display) {
        let category = category_of(status);
        if self.wants(category) {
            self.send(status, category, message);
        }
    }

    fn send(&self, status: Fmi2Status, category: Category, message: &dyn fmt::Display) {
        let Some(callback) = self.callback else {
            return;
        };
        let message = for_printf(&message.to_string());
        let category = CString::new(category.name()).unwrap_or_default();
        // SAFETY: `callback` came from the host as its logger, with `environment` to go with it. The three strings are
        // NUL-terminated and outlive the call. `message` holds no conversion specification, so no further argument is read.
        unsafe {
            callback(
                self.environment,
                self.instance_name.as_ptr(),
                status.raw(),
                category.as_ptr(),
                message.as_ptr(),
            );
        }
    }
}

/// A finished message as a `printf` format that prints itself: `%` is doubled, and so is `#`, which begins the
/// name of a variable; a NUL becomes U+FFFD.
fn for_printf(message: &str) -> CString {
    CString::new(message.replace('%', "%%").replace('#', "##").replace('\0', "\u{fffd}")).unwrap_or_default()
}

impl Listener for Sink {
    fn wants(&self, category: Category) -> bool {
        self.callback.is_some() && Wanted::from_bits(self.wanted.load(Ordering::Relaxed)).wants(category)
    }

    fn hear(&self, category: Category, message: &dyn fmt::Display) {
        let status = match category {
            Category::StatusWarning => Fmi2Status::Warning,
            Category::StatusDiscard => Fmi2Status::Discard,
            Category::StatusError => Fmi2Status::Error,
            Category::StatusFatal => Fmi2Status::Fatal,
            Category::Events | Category::All => Fmi2Status::Ok,
        };
        self.send(status, category, message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finished_message_prints_itself() {
        assert_eq!(&*for_printf("50 % of #3\0"), c"50 %% of ##3\u{fffd}");
    }
}
