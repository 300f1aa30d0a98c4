//! Messages to the host: categories, the host's callback, and the [`Log`] that a model writes to.
#![allow(unsafe_code, reason = "calls the logger of the host")]

use std::ffi::{CStr, CString};
use std::fmt;

use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2ComponentEnvironment, Fmi2Status};

/// The log categories that the FMU declares, after the standard's names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// A call that ended in `fmi2Warning`.
    StatusWarning,
    /// A call that ended in `fmi2Discard`.
    StatusDiscard,
    /// A call that ended in `fmi2Error`.
    StatusError,
    /// A call that ended in `fmi2Fatal`.
    StatusFatal,
    /// Something noteworthy in the life of the model.
    Events,
    /// Every message there is.
    All,
}

impl Category {
    /// Every category, in the order of the XML.
    pub const ALL: [Self; 6] = [
        Self::StatusWarning,
        Self::StatusDiscard,
        Self::StatusError,
        Self::StatusFatal,
        Self::Events,
        Self::All,
    ];

    /// The name under which hosts know it.
    pub fn name(self) -> &'static str {
        match self {
            Self::StatusWarning => "logStatusWarning",
            Self::StatusDiscard => "logStatusDiscard",
            Self::StatusError => "logStatusError",
            Self::StatusFatal => "logStatusFatal",
            Self::Events => "logEvents",
            Self::All => "logAll",
        }
    }

    /// One sentence for the XML.
    pub fn about(self) -> &'static str {
        match self {
            Self::StatusWarning => "messages of calls that end in fmi2Warning; always sent",
            Self::StatusDiscard => "messages of calls that end in fmi2Discard; always sent",
            Self::StatusError => "messages of calls that end in fmi2Error; always sent",
            Self::StatusFatal => "messages of calls that end in fmi2Fatal; always sent",
            Self::Events => "noteworthy events of the model, sent while logging is on",
            Self::All => "every message, details included",
        }
    }

    /// The category with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|category| category.name() == name)
    }

    /// The category of messages that explain `status`.
    fn of_status(status: Fmi2Status) -> Self {
        match status {
            Fmi2Status::Ok | Fmi2Status::Pending => Self::Events,
            Fmi2Status::Warning => Self::StatusWarning,
            Fmi2Status::Discard => Self::StatusDiscard,
            Fmi2Status::Error => Self::StatusError,
            Fmi2Status::Fatal => Self::StatusFatal,
        }
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
        self.send(status, Category::of_status(status), message);
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
    events: bool,
    details: bool,
}

impl Logger {
    pub(crate) fn new(sink: Sink, logging_on: bool) -> Self {
        Self {
            sink,
            events: logging_on,
            details: logging_on,
        }
    }

    /// Debug messages on or off; with categories, only those named. Status messages are sent in any case.
    pub(crate) fn configure(&mut self, logging_on: bool, categories: &[Category]) {
        let wants = |category| {
            logging_on
                && (categories.is_empty() || categories.contains(&category) || categories.contains(&Category::All))
        };
        self.events = wants(Category::Events);
        self.details = wants(Category::All);
    }
}

/// What a model says while it works. Errors are not logged here but returned.
///
/// Messages are built only if the host listens; pass `format_args!(...)`.
#[derive(Debug)]
pub struct Log<'a> {
    logger: Option<&'a Logger>,
    warned: bool,
}

impl Log<'static> {
    /// A log that nobody listens to, for tests of a model without a host.
    pub fn silent() -> Self {
        Self {
            logger: None,
            warned: false,
        }
    }
}

impl<'a> Log<'a> {
    pub(crate) fn new(logger: &'a Logger) -> Self {
        Self {
            logger: Some(logger),
            warned: false,
        }
    }

    /// Something is not quite right, but the computation goes on: always sent, and the call ends in `fmi2Warning`.
    pub fn warning(&mut self, message: impl fmt::Display) {
        self.warned = true;
        if let Some(logger) = self.logger {
            logger.sink.explain(Fmi2Status::Warning, &message);
        }
    }

    /// Something noteworthy: sent under `logEvents` while logging is on.
    pub fn event(&mut self, message: impl fmt::Display) {
        if let Some(logger) = self.logger.filter(|logger| logger.events) {
            logger.sink.send(Fmi2Status::Ok, Category::Events, &message);
        }
    }

    /// Something for whoever searches a mistake: sent under `logAll` while logging is on.
    pub fn detail(&mut self, message: impl fmt::Display) {
        if let Some(logger) = self.logger.filter(|logger| logger.details) {
            logger.sink.send(Fmi2Status::Ok, Category::All, &message);
        }
    }

    /// Whether there was a warning.
    pub fn warned(&self) -> bool {
        self.warned
    }

    /// The status of a call that went well but for its warnings.
    pub(crate) fn status(&self) -> Fmi2Status {
        if self.warned {
            Fmi2Status::Warning
        } else {
            Fmi2Status::Ok
        }
    }
}
