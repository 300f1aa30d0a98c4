//! The adapter: parameters and inputs as a master sets them on one side, a running [`Navigator`] on the other.

use crate::variables;
use astro::TargetOrbit;
use filters::laws::FILTERS;
use filters::scenarios::{Measures, SCENARIOS};
use filters::state::State;
use filters::{Navigator, Sample, Settings, Status};
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table, VendorAnnotation};
use interface::annotation::{self, Filters, Only, Preset, Search, Set};
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// The inputs as set; they take effect in a step only.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Inputs {
    /// `sample_time`, s.
    pub sample_time: f64,
    /// `sample_count`.
    pub sample_count: i32,
    /// `lidar.valid`.
    pub lidar_valid: bool,
    /// `lidar.range` (m), `lidar.azimuth` and `lidar.elevation` (rad).
    pub lidar: Vector3<f64>,
    /// `metrology.valid`.
    pub metrology_valid: bool,
    /// `metrology.rho_lvlh` (m), then `metrology.rho_dot_lvlh` (m/s).
    pub metrology: Vector6<f64>,
    /// `target_orbit.*`; without a node, which relative motion does not depend on.
    pub target_orbit: TargetOrbit,
    /// `accelerometer.alpha_c_bc`, m/s2.
    pub alpha_c_bc: Vector3<f64>,
    /// `dcm_bc_n`.
    pub dcm_bc_n: Matrix3<f64>,
    /// `nav_init.x`, SI.
    pub nav_init: State,
}

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NavModel {
    /// Parameters.
    pub settings: Settings,
    /// Inputs.
    pub inputs: Inputs,
    /// The filter, from initialization on.
    pub navigator: Option<Navigator>,
}

impl NavModel {
    /// A value of the running filter, or the default of its type before initialization.
    pub fn read<T: Default>(&self, value: impl Fn(&Navigator) -> T) -> T {
        self.navigator.as_ref().map(value).unwrap_or_default()
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
            default_stop: SCENARIOS.first().map_or(1.0, |s| s.duration),
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
            settings: Settings::default(),
            inputs: Inputs {
                sample_time: 0.0,
                sample_count: 0,
                lidar_valid: false,
                lidar: Vector3::zeros(),
                metrology_valid: false,
                metrology: Vector6::zeros(),
                target_orbit: TargetOrbit::from_vector(&Vector6::zeros()),
                alpha_c_bc: Vector3::zeros(),
                dcm_bc_n: Matrix3::identity(),
                nav_init: State::zeros(),
            },
            navigator: None,
        }
    }

    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        self.navigator = Some(Navigator::new(&self.settings, experiment.start_time)?);
        log.event(format_args!(
            "filter {} in scenario {} starts at t = {} s",
            self.settings.filter()?.name,
            self.settings.scenario()?.name,
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
        let sample = Sample {
            count: inputs.sample_count,
            time: inputs.sample_time,
            lidar: inputs.lidar_valid.then_some(inputs.lidar),
            metrology: inputs.metrology_valid.then_some(inputs.metrology),
            target_orbit: inputs.target_orbit,
            alpha_c_bc: inputs.alpha_c_bc,
            dcm_bc_n: inputs.dcm_bc_n,
        };
        navigator.process(&sample, &inputs.nav_init)?;
        let now = navigator.status();
        if now != before {
            log.event(format_args!("at t = {} s: {}", sample.time, status_name(now)));
            let other = match navigator.measures() {
                Measures::RangeAndBearing => inputs.metrology_valid,
                Measures::RelativeState => inputs.lidar_valid,
            };
            if now == Status::Coasting && other {
                log.event(format_args!(
                    "the sample holds a measurement that scenario {} does not use: is the world in the same scenario?",
                    self.settings.scenario()?.name
                ));
            }
        }
        Ok(())
    }
}

fn status_name(status: Status) -> &'static str {
    Status::ALL
        .iter()
        .find(|(s, _)| *s == status)
        .map_or("", |(_, name)| name)
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
