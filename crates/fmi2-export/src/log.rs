//! Messages to the host through its callback.
#![allow(unsafe_code, reason = "calls the logger of the host")]

use std::ffi::{CStr, CString};
use std::fmt;

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
}

impl Sink {
    /// A sink for messages of `instance_name`; keeps a copy of what it needs from `callbacks`.
    pub(crate) fn new(callbacks: &Fmi2CallbackFunctions, instance_name: &CStr) -> Self {
        Self {
            callback: callbacks.logger,
            environment: callbacks.component_environment,
            instance_name: instance_name.to_owned(),
        }
    }

    /// Sends a message that explains `status`.
    pub(crate) fn explain(&self, status: Fmi2Status, message: &dyn fmt::Display) {
        self.send(status, category_of(status), message);
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

/// A finished message as a `printf` format that prints itself: `%` is doubled, a NUL becomes U+FFFD.
fn for_printf(message: &str) -> CString {
    CString::new(message.replace('%', "%%").replace('\0', "\u{fffd}")).unwrap_or_default()
}

/// The log of one instance: where messages go, and which debug messages the host wants.
#[derive(Debug, Clone)]
pub(crate) struct Logger {
    pub(crate) sink: Sink,
    pub(crate) wanted: Wanted,
}

impl Listener for Logger {
    fn wants(&self, category: Category) -> bool {
        self.wanted.wants(category)
    }

    fn hear(&self, category: Category, message: &dyn fmt::Display) {
        let status = match category {
            Category::StatusWarning => Fmi2Status::Warning,
            Category::StatusDiscard => Fmi2Status::Discard,
            Category::StatusError => Fmi2Status::Error,
            Category::StatusFatal => Fmi2Status::Fatal,
            Category::Events | Category::All => Fmi2Status::Ok,
        };
        self.sink.send(status, category, message);
    }
}
