//! A valve that opens and closes slowly.

use serde::{Deserialize, Serialize};

use super::Shape;

/// Linear rise, plateau, linear fall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ramp {
    /// Length of rise and of fall, s.
    pub time: f64,
}

impl Shape for Ramp {
    fn impulse(&self, t: f64, duration: f64) -> f64 {
        let rise = t.min(self.time);
        let fall = (t - (duration - self.time)).max(0.0);
        t - (t.min(self.time)) + rise * rise / (2.0 * self.time) - fall * fall / (2.0 * self.time)
    }
}
