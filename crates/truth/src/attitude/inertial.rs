//! Body axes along the inertial ones.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::{Law, Sight};

/// Fixed in space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Inertial;

impl Law for Inertial {
    fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64> {
        sight.dcm_n_i().transpose()
    }
}
