//! What one slave holds: parameters and inputs as a master sets them on one side, a running [`Simulation`] on the other.

use astro::TargetOrbit;
use interface::signals::Seen;
use interface::{Sensor, Signals};
use serde::{Deserialize, Serialize};
use truth::{Inputs, Params, SensorSample, Simulation};

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TruthModel {
    /// Parameters.
    pub params: Params,
    /// Inputs as set; they act from the communication point at which the next step begins.
    pub inputs: Inputs,
    /// The run, from initialization on.
    pub simulation: Option<Simulation>,
    /// What the sensor outputs show.
    pub signals: Signals,
}

impl TruthModel {
    /// A value of the run, or the default of its type before initialization.
    pub fn read<T: Default>(&self, value: impl FnOnce(&Simulation) -> T) -> T {
        self.simulation.as_ref().map(value).unwrap_or_default()
    }
}

/// What the outputs show of no sensor.
pub fn nothing() -> Signals {
    Signals {
        sensors: [Seen::default(); Sensor::COUNT],
        accelerometer_valid: false,
        dcm_bc_n: [0.0; 9],
        event_time: 0.0,
        ..Signals::default()
    }
}

/// Makes the outputs show a sample.
pub fn show(signals: &mut Signals, sample: &SensorSample) {
    signals.sample_time = sample.time;
    signals.sample_count = i32::try_from(sample.count).unwrap_or(i32::MAX);
    signals.sensors = sample.sensors;
    let orbit = |o: &TargetOrbit| [o.r, o.r_dot, o.h, o.inclination, o.argument_of_latitude, o.node];
    signals.target_orbit = sample.target_orbit.as_ref().map_or([0.0; 6], orbit);
    let axes = sample.target_axes.as_ref();
    signals.dcm_lvlh_n = axes.map_or([0.0; 9], |axes| {
        std::array::from_fn(|i| axes.dcm_lvlh_n[(i / 3, i % 3)])
    });
    signals.omega_lvlh = axes.map_or([0.0; 3], |axes| axes.omega.into());
    signals.accelerometer_valid = sample.accelerometer.valid;
    signals.accelerometer_mean = sample.accelerometer.mean;
    signals.alpha_c_bc = sample.accelerometer.alpha_c_bc.into();
    (signals.dv_t_n, signals.event_time) = (sample.untold.dv_t_n.into(), sample.untold.event_time);
    signals.dcm_bc_n = std::array::from_fn(|i| sample.dcm_bc_n[(i / 3, i % 3)]);
}
