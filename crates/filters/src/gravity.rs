//! The gravity models that filters propagate with.

use crate::tunable::Bound;
use crate::{Beliefs, FilterError};
use astro::{Cr3bp, ZonalGravity};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A gravity model: acceleration of a vehicle and its partials, in internal units and axes N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Gravity {
    /// Two-body attraction and zonal harmonics, inertial axes.
    Zonal(ZonalGravity),
    /// Circular restricted three-body problem, rotating axes, nondimensional.
    Cr3bp(Cr3bp),
}

/// Two-body attraction and zonal harmonics of the beliefs, SI.
///
/// # Errors
/// When a constant is out of range.
pub(crate) fn zonal(beliefs: &Beliefs) -> Result<ZonalGravity, FilterError> {
    let [j2, j3, j4] = beliefs.gravity_j;
    Ok(ZonalGravity {
        mu: Bound::Positive.check("gravity.mu", beliefs.gravity_mu, "m3/s2")?,
        r_ref: Bound::Positive.check("gravity.radius", beliefs.gravity_radius, "m")?,
        j: [j2, j3, j4, 0.0, 0.0],
    })
}

impl Gravity {
    /// The zonal field of the beliefs.
    pub(crate) fn zonal(beliefs: &Beliefs) -> Result<Self, FilterError> {
        zonal(beliefs).map(Self::Zonal)
    }

    /// Acceleration at position `r` and velocity `v`; the velocity matters in rotating axes only.
    pub fn acceleration(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Zonal(zonal) => zonal.acceleration(r),
            Self::Cr3bp(cr3bp) => cr3bp.acceleration(r, v),
        }
    }

    /// Partials of the acceleration by position and by velocity, 3x3 each.
    pub fn partials(&self, r: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        match self {
            Self::Zonal(zonal) => (zonal.gradient(r), Matrix3::zeros()),
            Self::Cr3bp(cr3bp) => cr3bp.partials(r),
        }
    }
}
