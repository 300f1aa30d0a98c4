//! Reasons of FMI 2.0's own why a call was not answered.

use fmi_export::{CallError, Status};
use fmi2_abi::Fmi2StatusKind;

/// What no other version of the standard can be asked for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Fmi2Error {
    #[error("unknown fmi2Type {raw}: give 1 for co-simulation")]
    UnknownType { raw: i32 },
    #[error("unknown fmi2StatusKind {raw}: 0 to 3 exist")]
    UnknownStatusKind { raw: i32 },
    #[error("no such information: {why}")]
    StatusNotAvailable { why: &'static str },
}

impl Fmi2Error {
    /// Why a status cannot be asked for.
    pub(crate) fn not_available(kind: Fmi2StatusKind) -> Self {
        Self::StatusNotAvailable {
            why: match kind {
                Fmi2StatusKind::DoStepStatus | Fmi2StatusKind::PendingStatus => "no step is ever pending",
                Fmi2StatusKind::LastSuccessfulTime => "fmi2LastSuccessfulTime is a Real, use fmi2GetRealStatus",
                Fmi2StatusKind::Terminated => "fmi2Terminated is a Boolean, use fmi2GetBooleanStatus",
            },
        }
    }
}

impl From<Fmi2Error> for CallError {
    fn from(error: Fmi2Error) -> Self {
        Self::OfVersion {
            status: match error {
                Fmi2Error::StatusNotAvailable { .. } => Status::Discard,
                _ => Status::Error,
            },
            reason: error.into(),
        }
    }
}
