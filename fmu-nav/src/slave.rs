//! What one slave holds: parameters and inputs as a master sets them on one side, a running [`Navigator`] on the other.

use astro::TargetOrbit;
use filters::{Navigator, Sample, Settings};
use interface::mission::Choice;
use interface::{Signals, Status};
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NavModel {
    /// Which mission.
    pub choice: Choice,
    /// The other parameters.
    pub settings: Settings,
    /// Inputs as set; they take effect in a step only.
    pub inputs: Signals,
    /// The filter, from initialization on.
    pub navigator: Option<Navigator>,
}

impl NavModel {
    /// A value of the running filter, or the default of its type before initialization.
    pub fn read<T: Default>(&self, value: impl Fn(&Navigator) -> T) -> T {
        self.navigator.as_ref().map(value).unwrap_or_default()
    }

    /// What the filter is doing.
    pub fn status(&self) -> Status {
        self.navigator.as_ref().map_or(Status::Initialising, Navigator::status)
    }
}

/// The newest sample as a filter takes it; what was due and not received is absent.
pub fn sample(signals: &Signals) -> Sample {
    let [r, r_dot, h, inclination, argument_of_latitude] = signals.target_orbit;
    Sample {
        count: signals.sample_count,
        time: signals.sample_time,
        lidar: signals.lidar.valid.then(|| Vector3::from(signals.lidar_z)),
        metrology: signals.metrology.valid.then(|| Vector6::from(signals.metrology_z)),
        target_orbit: TargetOrbit {
            r,
            r_dot,
            h,
            inclination,
            argument_of_latitude,
            // Not handed over; relative motion does not depend on it.
            node: 0.0,
        },
        alpha_c_bc: signals.alpha_c_bc.into(),
        dcm_bc_n: Matrix3::from_row_slice(&signals.dcm_bc_n),
    }
}
