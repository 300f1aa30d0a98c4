//! Body y to the other vehicle.

use astro::frames;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::{Law, Sight};

/// Looks at the other vehicle (Mamich and Zanetti, Sec. IV).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct LineOfSight;

impl Law for LineOfSight {
    fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64> {
        let (r, v) = sight.orbit();
        frames::los_body_axes(&sight.r_other, &sight.v_other, &r.cross(&v))
    }
}
