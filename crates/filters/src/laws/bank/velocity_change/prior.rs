//! What is expected of a change before the data.

use arrayvec::ArrayVec;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Number of sizes.
pub(super) const SIZES: usize = 5;
/// Directions that are known in one set of axes at most.
pub(super) const MOST_LOBES: usize = 3;
/// Priors of one hypothesis at most: of each size in any direction, and along each that is known.
const MOST: usize = SIZES * (MOST_LOBES + 1);

/// The priors of one hypothesis, in place: hypotheses come and go, and a step asks for no memory.
pub(super) type Priors = ArrayVec<Prior, MOST>;

/// What is expected of a change before the data: a rate, and D ~ N(0, P_D).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Prior {
    /// Place of its size.
    pub size: usize,
    /// Whether it may point anywhere.
    pub anywhere: bool,
    /// Its rate, 1/s.
    pub rate: f64,
    /// P_D^-1, 3x3, internal units.
    pub precision: Matrix3<f64>,
    /// det P_D.
    pub det: f64,
}

impl Prior {
    /// A change of a size in any direction, P_D = c^2 I.
    pub(super) fn anywhere(size: usize, c: f64, rate: f64) -> Self {
        Self {
            size,
            anywhere: true,
            rate,
            precision: Matrix3::from_diagonal_element(1.0 / (c * c)),
            det: c.powi(6),
        }
    }

    /// A change along a direction that is known to within `spread`, P_D = c^2 (u u' + spread^2 (I - u u')).
    pub(super) fn along(size: usize, c: f64, rate: f64, along: &Vector3<f64>, spread: f64) -> Self {
        let axis = along * along.transpose();
        let across = (Matrix3::identity() - axis) / (spread * spread);
        Self {
            size,
            anywhere: false,
            rate,
            precision: (axis + across) / (c * c),
            det: c.powi(6) * spread.powi(4),
        }
    }
}
