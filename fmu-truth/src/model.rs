//! What FMI asks of a slave.

use crate::slave::{TruthModel, nothing, show};
use crate::variables;
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table};
use interface::mission::{Embedded, packed_guid};
use std::path::Path;
use std::sync::OnceLock;
use truth::{Inputs, Params, Simulation};
use uuid::Uuid;

impl Model for TruthModel {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "fmu-truth",
            model_identifier: "fmu_truth",
            description: "Simulated worlds of a chaser and its target, with the chaser's sensors",
            version: env!("CARGO_PKG_VERSION"),
            author: "the authors of relative-navigation-trades",
            copyright: "Copyright (c) 2026 the authors of relative-navigation-trades",
            license: "MIT",
            guid: Uuid::parse_str(env!("FMU_GUID")).ok(),
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

    fn set_resources(&mut self, folder: Option<&Path>) {
        self.params.choice.resources = folder.map(Path::to_owned);
    }

    fn identifier_with(own: &str, resources: &Path) -> Option<String> {
        packed_guid(own, resources)
    }

    fn initialise(&mut self, experiment: &Experiment, _log: &mut Log<'_>) -> Result<(), ModelError> {
        let simulation = Simulation::new(&self.params, experiment.start_time, &self.inputs)?;
        self.signals = nothing();
        self.signals.nav_init = std::array::from_fn(|i| simulation.initial_estimate()[i]);
        show(&mut self.signals, simulation.sample());
        self.simulation = Some(simulation);
        Ok(())
    }

    fn initialised(&self, experiment: &Experiment, log: &mut Log<'_>) {
        let Some(simulation) = &self.simulation else { return };
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
    }

    fn check_step(&self, t: f64, h: f64) -> Result<(), ModelError> {
        self.simulation
            .as_ref()
            .map_or(Ok(()), |s| Ok(s.check(t + h, &self.inputs)?))
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
