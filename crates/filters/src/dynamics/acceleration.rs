//! The target's unmodelled acceleration as a state, or none.

use serde::{Deserialize, Serialize};

/// What a filter makes of the target's unmodelled acceleration between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AccelerationModel {
    /// A state that stays where it is but for the process noise.
    RandomWalk,
    /// A state that decays at this rate, internal units.
    GaussMarkov(f64),
    /// No state: six states with a covariance, a_t stays zero.
    Absent,
}

impl AccelerationModel {
    /// Rate at which the state decays by itself, internal units.
    pub fn decay(self) -> f64 {
        match self {
            Self::GaussMarkov(rate) => rate,
            Self::RandomWalk | Self::Absent => 0.0,
        }
    }

    /// Number of the target's states that have a covariance: nine, or six without an acceleration state.
    pub fn states(self) -> usize {
        match self {
            Self::Absent => 6,
            Self::RandomWalk | Self::GaussMarkov(_) => 9,
        }
    }
}
