//! Why a call was not answered, and the text that tells the host.

use std::error::Error;
use std::fmt::Write;

use fmi2_abi::Fmi2Status;

use crate::model::ModelError;
use crate::order::Phase;
use crate::table::{Causality, DefinitionError};

/// Why a call ends in something other than `fmi2OK`. All but [`Model`](Self::Model) leave the instance as it was.
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

    #[error("no variable has value reference {reference}; there are {count}, counted from 0")]
    UnknownReference { reference: u32, count: usize },
    #[error("'{name}' (value reference {reference}) is of type {declared}")]
    WrongType {
        name: String,
        reference: u32,
        declared: &'static str,
    },
    #[error(
        "'{name}' cannot be set in phase '{phase}': it has causality {}", .causality.name()
    )]
    NotSettable {
        name: String,
        causality: Causality,
        phase: Phase,
    },
    #[error("{what} = {value} is not finite")]
    NotFinite { what: String, value: f64 },
    #[error("'{name}' = {value} must be {bounds}")]
    OutOfBounds {
        name: String,
        value: String,
        bounds: String,
    },
    #[error("'{name}' = {value} is not an item of its enumeration: {items}")]
    NoSuchItem { name: String, value: i32, items: String },
    #[error("the value of '{name}' holds a NUL character, which an fmi2String cannot")]
    NulInText { name: String },

    #[error("stop time {stop} s is before start time {start} s")]
    StopBeforeStart { start: f64, stop: f64 },
    #[error("tolerance {tolerance} must be greater than 0")]
    BadTolerance { tolerance: f64 },
    #[error("communication step size {h} s must be greater than 0")]
    BadStep { h: f64 },
    #[error("communication point {t} s does not follow on the end of the last step, {expected} s")]
    TimeMismatch { t: f64, expected: f64 },
    #[error("unknown fmi2StatusKind {raw}: 0 to 3 exist")]
    UnknownStatusKind { raw: i32 },
    #[error("no such information: {why}")]
    StatusNotAvailable { why: &'static str },

    #[error("argument {argument} is no state of this FMU")]
    ForeignState { argument: &'static str },
    #[error("the state needs {needed} bytes, the buffer has {given}")]
    BufferTooSmall { needed: usize, given: usize },
    #[error("the bytes are no serialized state of an FMU made with {}", env!("CARGO_PKG_NAME"))]
    NotAState,
    #[error("the bytes are a state of format {found}, this FMU reads format {known}")]
    StateFormat { found: u32, known: u32 },
    #[error("the bytes are a state of the FMU with GUID '{found}', this one has '{own}'")]
    StateOfOtherFmu { found: String, own: String },
    #[error("the serialized state should have {expected} bytes and has {given}")]
    StateLength { expected: u64, given: usize },
    #[error("the serialized state is damaged: its checksum does not match")]
    StateChecksum,
    #[error("the state could not be put into or read from bytes")]
    StateCoding(#[from] postcard::Error),
    #[error("the bytes hold {count} bytes more than a state of this FMU")]
    StateSpare { count: usize },

    #[error("the model failed, and only a reset or an earlier state helps")]
    Model(#[source] ModelError),
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
