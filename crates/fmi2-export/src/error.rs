//! Why a call was not answered, and the text that tells the host.

use std::error::Error;
use std::fmt::Write;

use fmi_model::{DefinitionError, InstanceError, Phase};
use fmi2_abi::Fmi2Status;

/// Why a call ends in something other than `fmi2OK`. All but a failure of the model leave the instance as it was.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CallError {
    #[error("not allowed in phase '{phase}', only in: {allowed}")]
    CallOrder { phase: Phase, allowed: String },
    #[error("this FMU is co-simulation only")]
    CoSimulationOnly,
    #[error("not supported: {why}")]
    NotSupported { why: &'static str },

    #[error("argument {argument} is a null or misaligned pointer")]
    BadPointer { argument: &'static str },
    #[error("argument {argument} would have {length} elements, more than fit into memory")]
    TooLong { argument: &'static str, length: usize },
    #[error("argument {argument} is not UTF-8")]
    NotUtf8 { argument: &'static str },

    #[error("the FMU could not be set up")]
    Definition(#[from] DefinitionError),
    #[error(
        "the GUID given is '{given}', that of this FMU is '{own}': modelDescription.xml and library are of different versions"
    )]
    WrongGuid { given: String, own: String },
    #[error("the instance name is empty")]
    EmptyName,
    #[error("unknown fmi2Type {raw}: give 1 for co-simulation")]
    UnknownType { raw: i32 },
    #[error("unknown log category '{given}', known are: {known}")]
    UnknownCategory { given: String, known: String },

    #[error("the value of '{name}' holds a NUL character, which an fmi2String cannot")]
    NulInText { name: String },

    #[error("unknown fmi2StatusKind {raw}: 0 to 3 exist")]
    UnknownStatusKind { raw: i32 },
    #[error("no such information: {why}")]
    StatusNotAvailable { why: &'static str },

    #[error("argument {argument} is no state of this FMU")]
    ForeignState { argument: &'static str },
    #[error("the state needs {needed} bytes, the buffer has {given}")]
    BufferTooSmall { needed: usize, given: usize },
    #[error(transparent)]
    Instance(#[from] InstanceError),
}

impl CallError {
    /// The status that the host gets.
    pub(crate) fn status(&self) -> Fmi2Status {
        match self {
            Self::StatusNotAvailable { .. } => Fmi2Status::Discard,
            _ => Fmi2Status::Error,
        }
    }

    /// The message with that of each source after it.
    pub(crate) fn chain(&self) -> String {
        let mut text = self.to_string();
        let mut source = self.source();
        while let Some(error) = source {
            // writing into a String cannot fail
            let _ = write!(text, ": {error}");
            source = error.source();
        }
        text
    }
}
