//! A constant turn about an axis fixed in body and space alike.

use nalgebra::{Matrix3, Rotation3, Vector3};
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
    fn dcm_b_n(&self, sight: &Sight) -> Matrix3<f64> {
        let turned = Rotation3::new(self.rate * sight.t).into_inner();
        turned.transpose() * sight.dcm_n_i.transpose()
    }
}
