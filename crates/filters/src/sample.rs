//! One sensor sample as it reaches a filter, SI.

use astro::{LvlhAxes, TargetOrbit};
use interface::signals::Seen;
use interface::{Sensor, Signals};
use nalgebra::{Matrix3, Vector3, Vector6};
use numerics::rotation;
use sensors::Rows;
use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// How far the rows of an attitude may be from orthonormal: what single precision leaves.
pub(crate) const NOT_A_ROTATION: f64 = 1e-6;

/// What a sensor of the target reports at one epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Reading {
    /// It does not sample at this epoch.
    #[default]
    NotDue,
    /// It samples and sees nothing.
    Lost,
    /// It measures this, SI and radians.
    Seen(Rows),
}

impl Reading {
    /// A measurement of these rows.
    pub fn of(z: &[f64]) -> Self {
        Self::Seen(Rows::from_fn(|row, _| z.get(row).copied().unwrap_or_default()))
    }

    /// The measurement, where there is one.
    pub fn seen(self) -> Option<Rows> {
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
    /// The specific force just after the epoch; what is commanded in it as it stood just before.
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

/// What no filter but a bound is told of, summed up since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Untold {
    /// Integral of the target's unannounced acceleration, axes N, m/s.
    pub dv_t_n: Vector3<f64>,
    /// Time in which something unannounced that begins and ends pushed it, s.
    pub event_time: f64,
}

/// What the sensors report at one epoch. A sensor that the mission does not list is not read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Ordinal, from 1.
    pub count: i32,
    /// Epoch, s.
    pub time: f64,
    /// What each sensor of the target reports, in the order of [`Sensor::ALL`].
    pub sensors: [Reading; Sensor::COUNT],
    /// Orbit of the target as an absolute navigation on board has it; all zero where nobody provides it. Its node is not read.
    pub target_orbit: TargetOrbit,
    /// Its LVLH axes at the epoch; `None` where nobody provides them.
    pub target_axes: Option<LvlhAxes>,
    /// Accelerometer reading; `None` at an epoch at which it does not sample.
    pub accelerometer: Option<SpecificForce>,
    /// Attitude at the epoch: axes N to chaser body.
    pub dcm_bc_n: Matrix3<f64>,
    /// For a filter that is a bound; `None` where nobody says it.
    pub untold: Option<Untold>,
}

impl Sample {
    /// An epoch at which nothing samples, in an attitude along axes N.
    pub fn blank(count: i32, time: f64) -> Self {
        Self {
            count,
            time,
            sensors: [Reading::NotDue; Sensor::COUNT],
            target_orbit: TargetOrbit::from_vector(&Vector6::zeros()),
            target_axes: None,
            accelerometer: None,
            dcm_bc_n: Matrix3::identity(),
            untold: None,
        }
    }
}

impl Sample {
    /// What does not end with the epoch, at another: attitude and orbit as they were.
    pub(crate) fn without_readings(&self, time: f64) -> Self {
        Self {
            target_orbit: self.target_orbit,
            target_axes: self.target_axes,
            dcm_bc_n: self.dcm_bc_n,
            ..Self::blank(self.count, time)
        }
    }
}

impl Index<Sensor> for Sample {
    type Output = Reading;

    fn index(&self, sensor: Sensor) -> &Reading {
        &self.sensors[sensor as usize]
    }
}

impl IndexMut<Sensor> for Sample {
    fn index_mut(&mut self, sensor: Sensor) -> &mut Reading {
        &mut self.sensors[sensor as usize]
    }
}

impl From<&Signals> for Sample {
    fn from(s: &Signals) -> Self {
        let reading = |seen: Seen| match (seen.due, seen.valid) {
            (false, _) => Reading::NotDue,
            (true, false) => Reading::Lost,
            (true, true) => Reading::Seen(Rows::from(seen.z)),
        };
        let alpha = Vector3::from(s.alpha_c_bc);
        let [r, r_dot, h, inclination, argument_of_latitude, node] = s.target_orbit;
        let dcm_lvlh_n = Matrix3::from_row_slice(&s.dcm_lvlh_n);
        let mut omega = Vector3::from(s.omega_lvlh);
        if omega == Vector3::zeros() && r > 0.0 {
            // Whoever says how they stand and not how they turn: but for the turn of the orbit's plane.
            omega.z = h / (r * r);
        }
        Self {
            count: s.sample_count,
            time: s.sample_time,
            sensors: s.sensors.map(reading),
            target_orbit: TargetOrbit {
                r,
                r_dot,
                h,
                inclination,
                argument_of_latitude,
                node,
            },
            target_axes: (rotation::defect(&dcm_lvlh_n) < NOT_A_ROTATION).then_some(LvlhAxes { dcm_lvlh_n, omega }),
            accelerometer: s.accelerometer_valid.then_some(if s.accelerometer_mean {
                SpecificForce::Mean(alpha)
            } else {
                SpecificForce::Instant(alpha)
            }),
            dcm_bc_n: Matrix3::from_row_slice(&s.dcm_bc_n),
            untold: (s.event_time >= 0.0).then(|| Untold {
                dv_t_n: s.dv_t_n.into(),
                event_time: s.event_time,
            }),
        }
    }
}
