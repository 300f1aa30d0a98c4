//! The adapter: parameters and inputs as a master sets them on one side, a running [`Navigator`] on the other.

use crate::variables;
use astro::TargetOrbit;
use filters::laws::FILTERS;
use filters::scenarios::{Measures, SCENARIOS};
use filters::state::State;
use filters::{FilterError, Navigator, Sample, Settings};
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table, VendorAnnotation};
use interface::annotation::{self, Filters, Only, Preset, Search, Set};
use interface::mission::{Choice, Embedded, packed_guid};
use interface::{Signals, Status};
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::OnceLock;

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
fn sample(signals: &Signals) -> Sample {
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

impl Model for NavModel {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "fmu-nav",
            model_identifier: "fmu_nav",
            description: "Relative navigation filters of a chaser that does not know everything that acts on it and its target",
            version: env!("CARGO_PKG_VERSION"),
            license: "MIT",
            default_stop: Embedded::scenarios()
                .next()
                .and_then(|entry| entry.mission().ok())
                .map_or(1.0, |mission| mission.time.duration_s),
            default_step: 1.0,
            vendor_annotations: vec![VendorAnnotation::of(annotation::TOOL, &annotated())],
            ..ModelInfo::default()
        })
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<NavModel>> = OnceLock::new();
        TABLE.get_or_init(variables::table)
    }

    fn blank() -> Self {
        Self {
            choice: Choice::default(),
            settings: Settings::default(),
            inputs: Signals::default(),
            navigator: None,
        }
    }

    fn set_resources(&mut self, folder: &Path) {
        self.choice.resources = Some(folder.to_owned());
    }

    fn identifier_with(own: &str, resources: &Path) -> Option<String> {
        packed_guid(own, resources)
    }

    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        let navigation = self.choice.mission()?.navigation();
        let scenario = SCENARIOS.iter().position(|s| s.name == navigation.mission);
        self.settings.scenario = scenario.ok_or_else(|| FilterError::UnknownScenario {
            name: navigation.mission.clone(),
            known: SCENARIOS.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
        })?;
        self.navigator = Some(Navigator::new(&self.settings, experiment.start_time)?);
        log.event(format_args!(
            "filter {} in mission {} starts at t = {} s",
            self.settings.filter()?.name,
            navigation.mission,
            experiment.start_time
        ));
        Ok(())
    }

    fn do_step(&mut self, _t: f64, _h: f64, log: &mut Log<'_>) -> Result<(), ModelError> {
        let Some(navigator) = &mut self.navigator else {
            return Ok(());
        };
        let (before, inputs) = (navigator.status(), &self.inputs);
        // Count 0 is "no sample yet"; anything at or below the last count has been used.
        if inputs.sample_count <= navigator.estimate().count {
            return Ok(());
        }
        navigator.process(&sample(inputs), &State::from(inputs.nav_init))?;
        let now = navigator.status();
        if now != before {
            log.event(format_args!("at t = {} s: {}", inputs.sample_time, now.name()));
            let other = match navigator.measures() {
                Measures::RangeAndBearing => inputs.metrology.valid,
                Measures::RelativeState => inputs.lidar.valid,
            };
            if now == Status::Coasting && other {
                log.event(format_args!(
                    "the sample holds a measurement that mission {} does not use: is the world in the same mission?",
                    self.settings.scenario()?.name
                ));
            }
        }
        Ok(())
    }
}

/// What the harness is told: presets, search ranges, and the filters that have a meaning in some scenarios only.
fn annotated() -> Filters {
    let mut all = Filters::default();
    for filter in FILTERS {
        let variable = |tunable: &str| format!("{}.{tunable}", filter.name);
        all.presets.extend(filter.presets.iter().map(|preset| {
            Preset {
                filter: filter.name.to_owned(),
                name: preset.name.to_owned(),
                about: preset.about.to_owned(),
                sets: preset
                    .sets
                    .iter()
                    .map(|(tunable, value)| Set {
                        variable: variable(tunable),
                        value: (*value).to_owned(),
                    })
                    .collect(),
            }
        }));
        all.searches.extend(filter.search.iter().map(|search| Search {
            variable: variable(search.tunable),
            low: search.low,
            high: search.high,
        }));
        all.meanings.extend(filter.only.iter().map(|only| {
            Only {
                filter: filter.name.to_owned(),
                scenarios: SCENARIOS
                    .iter()
                    .filter(|scenario| filter.no_meaning_in(scenario).is_none())
                    .map(|scenario| scenario.name.to_owned())
                    .collect(),
                why: only.why.to_owned(),
            }
        }));
    }
    all
}
