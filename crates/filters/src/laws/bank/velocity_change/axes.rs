//! Axes in which the direction of a vent may be fixed.

use astro::frames;
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// From axes of the estimate to those in which a direction may be fixed, each 3x3.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Axes(pub(super) [Matrix3<f64>; 2]);

impl Axes {
    /// Those of a body that is held along the line of sight, then those of the estimate itself.
    ///
    /// * `relative`: position and velocity, axes of the estimate, 6, internal units; `speed`: the unit of velocity, m/s.
    pub(super) fn of(relative: &Vector6<f64>, speed: f64) -> Self {
        let (r, v) = (relative.fixed_rows::<3>(0), relative.fixed_rows::<3>(3));
        // Where the relative motion leaves the axes open the orbit's normal would close them, which no law is told.
        let sight = frames::los_body_axes(&r.into_owned(), &(v * speed), &Vector3::z());
        Self([sight, Matrix3::identity()])
    }
}
