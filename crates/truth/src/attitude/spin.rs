//! A constant turn about an axis fixed in body and space alike.

use astro::attitude;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::{Law, Sight};

/// Spins, from inertial axes at the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Spin {
    /// Angular velocity, body axes, rad/s.
    rate: Vector3<f64>,
}

impl Spin {
    /// From deg/s.
    pub(super) fn deg_s(rate: [f64; 3]) -> Self {
        Self {
            rate: Vector3::from(rate).map(f64::to_radians),
        }
    }
}

impl Law for Spin {
    fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64> {
        attitude::spin(&self.rate, sight.t) * sight.dcm_n_i().transpose()
    }
}
