//! The adapter: parameters and inputs as a master sets them on one side, a running [`Simulation`] on the other.

use crate::variables;
use astro::TargetOrbit;
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table};
use interface::Signals;
use interface::mission::{Embedded, packed_guid};
use interface::signals::Seen;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::OnceLock;
use truth::{Inputs, Params, SensorSample, Simulation};

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TruthModel {
    /// Parameters.
    pub params: Params,
    /// Inputs as set; they act from the next grid point.
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

impl Model for TruthModel {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "fmu-truth",
            model_identifier: "fmu_truth",
            description: "Simulated worlds of a chaser and its target, with the chaser's sensors",
            version: env!("CARGO_PKG_VERSION"),
            license: "MIT",
            default_stop: Embedded::scenarios()
                .next()
                .and_then(|entry| entry.mission().ok())
                .map_or(1.0, |mission| mission.time.duration_s),
            default_step: 1.0,
            ..ModelInfo::default()
        })
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<TruthModel>> = OnceLock::new();
        TABLE.get_or_init(variables::table)
    }

    fn blank() -> Self {
        Self {
            params: Params::default(),
            inputs: Inputs::default(),
            simulation: None,
            signals: nothing(),
        }
    }

    fn set_resources(&mut self, folder: &Path) {
        self.params.choice.resources = Some(folder.to_owned());
    }

    fn identifier_with(own: &str, resources: &Path) -> Option<String> {
        packed_guid(own, resources)
    }

    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        let simulation = Simulation::new(&self.params, experiment.start_time, &self.inputs)?;
        log.event(format_args!(
            "mission {}, seed {}, run {} starts at t = {} s with {} scheduled events",
            simulation.mission(),
            self.params.study_seed,
            self.params.run,
            experiment.start_time,
            simulation.timeline().events().len()
        ));
        for note in simulation.notes() {
            log.event(format_args!("note: {note}"));
        }
        self.signals.nav_init = std::array::from_fn(|i| simulation.initial_estimate()[i]);
        show(&mut self.signals, simulation.sample());
        self.simulation = Some(simulation);
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, _log: &mut Log<'_>) -> Result<(), ModelError> {
        if let Some(simulation) = &mut self.simulation {
            let shown = simulation.sample().count;
            simulation.advance_to(t + h, &self.inputs)?;
            let sample = simulation.sample();
            if sample.count != shown {
                show(&mut self.signals, sample);
            }
        }
        Ok(())
    }
}

/// What the outputs show of no sensor.
fn nothing() -> Signals {
    Signals {
        lidar: Seen::default(),
        camera: Seen::default(),
        radio: Seen::default(),
        metrology: Seen::default(),
        accelerometer_valid: false,
        dcm_bc_n: [0.0; 9],
        ..Signals::default()
    }
}

/// Makes the outputs show a sample.
fn show(signals: &mut Signals, sample: &SensorSample) {
    let seen = |due, valid| Seen { due, valid };
    let (lidar, camera, radio, metrology) = (&sample.lidar, &sample.camera, &sample.radio, &sample.metrology);
    signals.sample_time = sample.time;
    signals.sample_count = i32::try_from(sample.count).unwrap_or(i32::MAX);
    signals.lidar = seen(lidar.due, lidar.valid);
    signals.lidar_z = [lidar.range, lidar.azimuth, lidar.elevation];
    signals.camera = seen(camera.due, camera.valid);
    signals.camera_z = [camera.azimuth, camera.elevation];
    signals.radio = seen(radio.due, radio.valid);
    signals.radio_z = [radio.range, radio.range_rate];
    signals.metrology = seen(metrology.due, metrology.valid);
    signals.metrology_z[..3].copy_from_slice(metrology.rho_lvlh.as_slice());
    signals.metrology_z[3..].copy_from_slice(metrology.rho_dot_lvlh.as_slice());
    let orbit = |o: &TargetOrbit| [o.r, o.r_dot, o.h, o.inclination, o.argument_of_latitude];
    signals.target_orbit = sample.target_orbit.as_ref().map_or([0.0; 5], orbit);
    signals.accelerometer_valid = sample.accelerometer.valid;
    signals.accelerometer_mean = sample.accelerometer.mean;
    signals.alpha_c_bc = sample.accelerometer.alpha_c_bc.into();
    signals.dcm_bc_n = std::array::from_fn(|i| sample.dcm_bc_n[(i / 3, i % 3)]);
}
