//! Messages to the host through its callback.
#![allow(unsafe_code, reason = "calls the logger of the host")]

use std::ffi::CString;
use std::fmt;

use fmi_export::Status;
use fmi_model::Category;
use fmi3_abi::{Fmi3InstanceEnvironment, LogMessageCallback};

/// The host's end of the log: its callback and what goes with it.
#[derive(Debug, Clone)]
pub struct Sink {
    callback: Option<LogMessageCallback>,
    environment: Fmi3InstanceEnvironment,
}

impl Sink {
    pub(crate) fn new(callback: Option<LogMessageCallback>, environment: Fmi3InstanceEnvironment) -> Self {
        Self { callback, environment }
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
        let message = CString::new(message.to_string().replace('\0', "\u{fffd}")).unwrap_or_default();
        let category = CString::new(category.name()).unwrap_or_default();
        // SAFETY: `callback` came from the host as its logger, with `environment` to go with it. Both strings are NUL-terminated
        // and outlive the call.
        unsafe { callback(self.environment, status.raw(), category.as_ptr(), message.as_ptr()) };
    }
}
