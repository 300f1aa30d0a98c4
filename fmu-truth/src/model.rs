//! The adapter: parameters and inputs as a master sets them on one side, a running [`Simulation`] on the other.

use crate::variables;
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use truth::{Inputs, Params, Simulation, WORLDS};

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TruthModel {
    /// Parameters.
    pub params: Params,
    /// Inputs as set; they act from the next grid point.
    pub inputs: Inputs,
    /// The run, from initialization on.
    pub simulation: Option<Simulation>,
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
            default_stop: WORLDS[0].duration,
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
        }
    }

    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        let simulation = Simulation::new(&self.params, experiment.start_time, &self.inputs)?;
        log.event(format_args!(
            "world {}, seed {}, run {} starts at t = {} s with {} scheduled events",
            self.params.scenario.entry().name,
            self.params.study_seed,
            self.params.run,
            experiment.start_time,
            simulation.timeline().events.len()
        ));
        self.simulation = Some(simulation);
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, _log: &mut Log<'_>) -> Result<(), ModelError> {
        if let Some(simulation) = &mut self.simulation {
            simulation.advance_to(t + h, &self.inputs)?;
        }
        Ok(())
    }
}
