//! Body axes along radial, transverse and normal of the vehicle's own orbit.

use astro::frames;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::{Law, Sight};

/// Fixed in the orbit's axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rtn;

impl Law for Rtn {
    fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64> {
        let (r, v) = sight.orbit();
        frames::rtn(&r, &v)
    }
}
