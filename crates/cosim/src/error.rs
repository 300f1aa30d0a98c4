//! What slaves report, and what the master makes of it.

use std::sync::Arc;

use fmi2_import::{BaseType, Causality, ImportError};

/// A call that a slave answered with an error.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{function} returned {status}{}", said(messages))]
pub struct SlaveError {
    /// Function that was called, e.g. `fmi2DoStep`.
    pub function: String,
    /// What it returned, e.g. `fmi2Error`.
    pub status: String,
    /// The slave's own messages, oldest first.
    pub messages: Vec<String>,
}

fn said(messages: &[String]) -> String {
    if messages.is_empty() {
        String::new()
    } else {
        format!(": {}", messages.join("; "))
    }
}

impl SlaveError {
    /// An error with one message and the status `fmi2Error`.
    #[must_use]
    pub fn new(function: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            function: function.into(),
            status: "fmi2Error".to_owned(),
            messages: vec![message.into()],
        }
    }

    /// The answer of a slave without variables of this kind.
    pub(crate) fn unsupported(function: &str) -> Self {
        Self::new(function, "this slave has no such variables")
    }
}

impl From<ImportError> for SlaveError {
    fn from(error: ImportError) -> Self {
        match error {
            ImportError::Call {
                function,
                status,
                messages,
                ..
            } => Self {
                function: function.to_owned(),
                status: status.to_string(),
                messages,
            },
            other => Self::new("the FMI call", other.to_string()),
        }
    }
}

/// Why slaves could not be coupled or stepped; one variant per cause.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum CosimError {
    /// Two slaves of one system have the same name.
    #[error("two slaves are named {name:?}: names must differ")]
    DuplicateSlave {
        /// The name.
        name: String,
    },

    /// A slave offers two variables of one name, or an alias takes a name that is in use.
    #[error("slave {slave:?} has two variables named {variable:?}")]
    DuplicateVariable {
        /// The slave.
        slave: String,
        /// The name.
        variable: String,
    },

    /// An id was made by another system.
    #[error("slave number {index} is not in this system of {count}")]
    UnknownSlave {
        /// Its position.
        index: usize,
        /// Slaves in this system.
        count: usize,
    },

    /// A slave has no variable of this name.
    #[error(
        "slave {slave:?} has no variable {variable:?}{}",
        suggestion.as_ref().map_or(String::new(), |s| format!("; did you mean {s:?}?"))
    )]
    UnknownVariable {
        /// The slave.
        slave: String,
        /// Name that was asked for.
        variable: String,
        /// Nearest name it does have.
        suggestion: Option<String>,
    },

    /// A variable is used in a role it does not have.
    #[error("{slave}.{variable} has causality {found}, but {expected} is needed")]
    WrongCausality {
        /// The slave.
        slave: String,
        /// The variable.
        variable: String,
        /// Its causality.
        found: Causality,
        /// What the use needs.
        expected: &'static str,
    },

    /// An output and an input of different types were to be connected.
    #[error("cannot connect {source_name} ({source_type}) to {input} ({input_type}): types differ")]
    TypeMismatch {
        /// Slave and name of the output.
        source_name: String,
        /// Its type.
        source_type: BaseType,
        /// Slave and name of the input.
        input: String,
        /// Its type.
        input_type: BaseType,
    },

    /// An output and an input of units that do not convert into each other were to be connected.
    #[error(
        "cannot connect {source_name} in {source_unit} to {input} in {input_unit}: these units measure different things"
    )]
    UnitMismatch {
        /// Slave and name of the output.
        source_name: String,
        /// Its unit.
        source_unit: String,
        /// Slave and name of the input.
        input: String,
        /// Its unit.
        input_unit: String,
    },

    /// A second output was to feed one input.
    #[error("input {input} is fed by both {first} and {second}: keep one of them")]
    SeveralSources {
        /// Slave and name of the input.
        input: String,
        /// The output connected first.
        first: String,
        /// The other one.
        second: String,
    },

    /// A start value is of another type than its variable.
    #[error("{slave}.{variable} is of type {expected}, but the value {value} is of type {given}")]
    WrongValueType {
        /// The slave.
        slave: String,
        /// The variable.
        variable: String,
        /// Type of the variable.
        expected: BaseType,
        /// Type of the value.
        given: BaseType,
        /// The value.
        value: String,
    },

    /// A variable is to be read as one of another type.
    #[error("{slave}.{variable} is of type {found} and cannot be read as {expected}")]
    WrongType {
        /// The slave.
        slave: String,
        /// The variable.
        variable: String,
        /// Its type.
        found: BaseType,
        /// Type of what reads it.
        expected: BaseType,
    },

    /// The step size is no positive finite number, or so small that time would stand still.
    #[error("step size {step} s: a positive, finite number is needed, with less than 2^53 steps in the run")]
    StepSize {
        /// As given, s.
        step: f64,
    },

    /// Start and stop make no interval that can be stepped through.
    #[error("cannot run from {start} s to {stop} s: both must be finite, and stop at or after start")]
    Interval {
        /// Start time, s.
        start: f64,
        /// Stop time, s.
        stop: f64,
    },

    /// A slave failed.
    #[error("slave {slave:?} failed at {time} s: {error}")]
    Slave {
        /// The slave.
        slave: String,
        /// Communication point at which the call was made, s.
        time: f64,
        /// Function, status and messages.
        error: SlaveError,
    },

    /// A slave cannot be used for another run.
    #[error("slave {slave:?} could not be reset: {error}; create it anew")]
    Reset {
        /// The slave.
        slave: String,
        /// Function, status and messages.
        error: SlaveError,
    },

    /// A slave was stopped because one that feeds it failed.
    #[error("slave {slave:?} stopped at {time} s, since it depends on a slave that failed: {cause}")]
    Upstream {
        /// The slave that was stopped.
        slave: String,
        /// Communication point, s.
        time: f64,
        /// What happened to the other one.
        cause: Arc<CosimError>,
    },

    /// A slave that has left the run was to be read.
    #[error("slave {slave:?} has left the run and cannot be read")]
    Inactive {
        /// The slave.
        slave: String,
    },
}
