//! A tank that empties: full size at the begin, falling exponentially.

use numerics::math;
use serde::{Deserialize, Serialize};

use super::Shape;

/// Exponential decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Decay {
    /// Time constant, s.
    pub time: f64,
}

impl Shape for Decay {
    fn impulse(&self, t: f64, _duration: f64) -> f64 {
        -self.time * math::exp_m1(-t / self.time)
    }
}
