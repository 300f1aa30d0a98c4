//! The update of an observer: a gain that nobody computes from a covariance.

use nalgebra::Vector6;
use numerics::math;
use serde::{Deserialize, Serialize};

/// A constant gain on position and velocity, where both are measured in full; internal units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConstantGain {
    /// On position, inverse time.
    pub position: f64,
    /// On velocity, inverse time.
    pub velocity: f64,
}

impl ConstantGain {
    /// Diagonal of the gain over `dt`: 1 - exp(-k dt), which is what an observer in continuous time does to a measurement held
    /// over the interval; Euler's k dt diverges when large.
    ///
    /// Source: Pesce, Silvestrini and Lavagna, Eq. (33).
    pub fn over(&self, dt: f64) -> Vector6<f64> {
        let (position, velocity) = (-math::exp_m1(-self.position * dt), -math::exp_m1(-self.velocity * dt));
        Vector6::from_fn(|i, _| if i < 3 { position } else { velocity })
    }
}
