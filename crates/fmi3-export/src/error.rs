//! Reasons of FMI 3.0's own why a call was not answered.

use fmi_export::{CallError, Status};

/// What no other version of the standard can be asked for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Fmi3Error {
    #[error("no variable has value reference {reference}; there are {count}, counted from 0")]
    UnknownReference { reference: u32, count: usize },
    #[error("'{name}' (value reference {reference}) is of type {declared}")]
    WrongType {
        name: String,
        reference: u32,
        declared: &'static str,
    },
    #[error("the variables have {needed} values together, nValues is {given}")]
    WrongCount { needed: usize, given: usize },
    #[error("'{name}' (value reference {reference}) is the independent variable, which steps alone change")]
    Independent { name: &'static str, reference: u32 },
    #[error("event mode is asked for, and there is none (hasEventMode = false): give eventModeUsed = false")]
    NoEventMode,
    #[error(
        "{count} intermediate variables are required, and there are no intermediate updates \
         (providesIntermediateUpdate = false): require none"
    )]
    NoIntermediateUpdate { count: usize },
}

impl From<Fmi3Error> for CallError {
    fn from(error: Fmi3Error) -> Self {
        Self::OfVersion {
            status: Status::Error,
            reason: error.into(),
        }
    }
}
