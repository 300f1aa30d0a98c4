//! One sensor sample as it reaches a filter, SI.

use astro::TargetOrbit;
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// What the sensors report at one epoch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Ordinal, from 1.
    pub count: i32,
    /// Epoch, s.
    pub time: f64,
    /// Range (m), azimuth and elevation (rad) of the target in LiDAR axes; `None` on a dropout.
    pub lidar: Option<Vector3<f64>>,
    /// Relative position (m) and velocity (m/s) of the chaser in the target's LVLH frame; `None` on a dropout or without such a
    /// sensor.
    pub metrology: Option<Vector6<f64>>,
    /// Orbit of the target as an absolute navigation on board has it; all zero where nobody provides it. Its node is not read.
    pub target_orbit: TargetOrbit,
    /// Accelerometer reading just after the epoch, chaser body axes, m/s2.
    pub alpha_c_bc: Vector3<f64>,
    /// Attitude at the epoch: axes N to chaser body.
    pub dcm_bc_n: Matrix3<f64>,
}
