//! What every sensor of the target has in common, so that world and filter handle whichever a mission has on board.

use interface::Sensor;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

/// What one sensor measures; rows beyond its own ([`Sensor::rows`]) are 0.
pub type Rows = SVector<f64, { Sensor::MOST_ROWS }>;

/// Derivative of [`Rows`] by six states: a position, then a velocity.
pub type ByState = SMatrix<f64, { Sensor::MOST_ROWS }, 6>;

/// Where the target is, in any one set of units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// Position of the target relative to the chaser, axes N.
    pub r_tc_n: Vector3<f64>,
    /// Its rate as seen in axes N.
    pub v_tc_n: Vector3<f64>,
    /// Maps N to the axes L of the LiDAR ([`crate::lidar`]).
    pub dcm_l_n: Matrix3<f64>,
    /// Position of the chaser relative to the target in LVLH axes of the target, then its rate in those turning axes; NaN where
    /// nobody asks for it ([`OfTarget::in_lvlh`]).
    pub lvlh: Vector6<f64>,
}

/// A sensor that sees the target.
pub trait OfTarget: Sync {
    /// What it measures without noise: lengths and velocities in the units of the scene, angles in rad.
    ///
    /// A row is not finite where the scene has no such measurement: the direction of a target in the sensor itself.
    fn measure(&self, scene: &Scene) -> Rows;

    /// Derivative of [`OfTarget::measure`] by `r_tc_n` and `v_tc_n`, or by `lvlh` for a sensor that measures in those axes.
    fn jacobian(&self, scene: &Scene) -> ByState;

    /// Whether it is a function of `lvlh` rather than of `r_tc_n` and `v_tc_n`.
    fn in_lvlh(&self) -> bool {
        false
    }
}
