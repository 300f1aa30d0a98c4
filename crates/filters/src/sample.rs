//! One sensor sample as it reaches a filter, SI.

use astro::TargetOrbit;
use interface::Signals;
use interface::signals::Seen;
use nalgebra::{Matrix3, SVector, Vector2, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// What a sensor of the target reports at one epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Reading<T> {
    /// It does not sample at this epoch.
    #[default]
    NotDue,
    /// It samples and sees nothing.
    Lost,
    /// It measures this.
    Seen(T),
}

impl<T> Reading<T> {
    /// The measurement, where there is one.
    pub fn seen(self) -> Option<T> {
        match self {
            Self::Seen(z) => Some(z),
            Self::NotDue | Self::Lost => None,
        }
    }

    /// Whether the sensor samples at this epoch.
    pub fn is_due(&self) -> bool {
        !matches!(self, Self::NotDue)
    }
}

/// What an accelerometer reports, chaser body axes, m/s2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SpecificForce {
    /// The specific force just after the epoch.
    Instant(Vector3<f64>),
    /// The mean since its last sample.
    Mean(Vector3<f64>),
}

impl SpecificForce {
    /// The reading, whichever it is.
    pub fn alpha_c_bc(&self) -> &Vector3<f64> {
        match self {
            Self::Instant(alpha) | Self::Mean(alpha) => alpha,
        }
    }
}

/// What the sensors report at one epoch. A sensor that the mission does not list is not read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Ordinal, from 1.
    pub count: i32,
    /// Epoch, s.
    pub time: f64,
    /// Range (m), azimuth and elevation (rad) of the target in LiDAR axes.
    pub lidar: Reading<Vector3<f64>>,
    /// Azimuth and elevation (rad) of the target in LiDAR axes.
    pub camera: Reading<Vector2<f64>>,
    /// Range (m) and range rate (m/s) of the target.
    pub radio: Reading<Vector2<f64>>,
    /// Relative position (m) and velocity (m/s) of the chaser in the target's LVLH frame.
    pub metrology: Reading<Vector6<f64>>,
    /// Orbit of the target as an absolute navigation on board has it; all zero where nobody provides it. Its node is not read.
    pub target_orbit: TargetOrbit,
    /// Accelerometer reading; `None` at an epoch at which it does not sample.
    pub accelerometer: Option<SpecificForce>,
    /// Attitude at the epoch: axes N to chaser body.
    pub dcm_bc_n: Matrix3<f64>,
}

impl Sample {
    /// An epoch at which nothing samples, in an attitude along axes N.
    pub fn blank(count: i32, time: f64) -> Self {
        Self {
            count,
            time,
            lidar: Reading::NotDue,
            camera: Reading::NotDue,
            radio: Reading::NotDue,
            metrology: Reading::NotDue,
            target_orbit: TargetOrbit::from_vector(&Vector6::zeros()),
            accelerometer: None,
            dcm_bc_n: Matrix3::identity(),
        }
    }
}

impl From<&Signals> for Sample {
    fn from(s: &Signals) -> Self {
        fn reading<const M: usize>(of: Seen, z: &[f64; M]) -> Reading<SVector<f64, M>> {
            match (of.due, of.valid) {
                (false, _) => Reading::NotDue,
                (true, false) => Reading::Lost,
                (true, true) => Reading::Seen(SVector::from(*z)),
            }
        }
        let alpha = Vector3::from(s.alpha_c_bc);
        let [r, r_dot, h, inclination, argument_of_latitude] = s.target_orbit;
        Self {
            count: s.sample_count,
            time: s.sample_time,
            lidar: reading(s.lidar, &s.lidar_z),
            camera: reading(s.camera, &s.camera_z),
            radio: reading(s.radio, &s.radio_z),
            metrology: reading(s.metrology, &s.metrology_z),
            target_orbit: TargetOrbit {
                r,
                r_dot,
                h,
                inclination,
                argument_of_latitude,
                ..TargetOrbit::from_vector(&Vector6::zeros())
            },
            accelerometer: s.accelerometer_valid.then_some(if s.accelerometer_mean {
                SpecificForce::Mean(alpha)
            } else {
                SpecificForce::Instant(alpha)
            }),
            dcm_bc_n: Matrix3::from_row_slice(&s.dcm_bc_n),
        }
    }
}
