//! Messages to the host through its callback.
#![allow(unsafe_code, reason = "calls the logger of the host")]

use std::ffi::{CStr, CString};
use std::fmt;

use fmi_export::Status;
use fmi_model::Category;
use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2ComponentEnvironment};

/// The host's end of the log: its callback, and the name under which the instance speaks.
#[derive(Debug, Clone)]
pub struct Sink {
    callback: Option<CallbackLogger>,
    environment: Fmi2ComponentEnvironment,
    instance_name: CString,
}

impl Sink {
    /// A sink for messages of `instance_name`; keeps a copy of what it needs from `callbacks`. Without callbacks nobody hears
    /// anything.
    pub(crate) fn new(callbacks: Option<&Fmi2CallbackFunctions>, instance_name: &CStr) -> Self {
        Self {
            callback: callbacks.and_then(|callbacks| callbacks.logger),
            environment: callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.component_environment),
            instance_name: instance_name.to_owned(),
        }
    }
}

impl fmi_export::Sink for Sink {
    fn has_listener(&self) -> bool {
        self.callback.is_some()
    }

    fn send(&self, status: Status, category: Category, message: &dyn fmt::Display) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finished_message_prints_itself() {
        assert_eq!(&*for_printf("50 % of #3\0"), c"50 %% of ##3\u{fffd}");
    }
}
