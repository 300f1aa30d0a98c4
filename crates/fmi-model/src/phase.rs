//! Where an instance is in its life.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Where an instance is in its life. Which calls a phase allows is for a standard to say.
// Saved states hold the number of the variant, so the order is fixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Created or reset.
    Instantiated,
    /// Initialization has begun and not ended.
    Initialization,
    /// Initialised, and every step so far went well.
    StepComplete,
    /// The model could not initialise or step.
    Failed,
    /// The simulation is over.
    Terminated,
    /// After a panic; the model must not be touched again.
    Fatal,
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::StepComplete => "step complete",
            Self::Failed => "failed",
            Self::Terminated => "terminated",
            Self::Fatal => "fatal",
        })
    }
}
