//! A status of a foreign library.

use std::fmt;

use fmi2_abi::{Fmi2Status, RawStatus};

/// A status as it arrived from the FMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// One of the six of the standard.
    Known(Fmi2Status),
    /// A number that the standard does not know; treated as an error.
    Unknown(i32),
}

impl Status {
    pub(crate) fn from_raw(raw: RawStatus) -> Self {
        Fmi2Status::from_raw(raw).map_or(Self::Unknown(raw), Self::Known)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Known(status) => status.fmt(f),
            Self::Unknown(raw) => write!(f, "{raw}, which is no fmi2Status,"),
        }
    }
}
