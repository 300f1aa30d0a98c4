//! The adapter: what FMI asks of a slave, answered by its [`Navigator`].

use crate::slave::NavModel;
use crate::variables;
use filters::laws::FILTERS;
use filters::{Command, Navigator, Settings};
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table, VendorAnnotation};
use interface::annotation::{self, Bound, Filters, Only, Preset, Search, Set};
use interface::mission::{Choice, Embedded, packed_guid};
use interface::{Sensor, Signals, Status};
use std::path::Path;
use std::sync::OnceLock;
use uuid::Uuid;

/// Longest step, s: what a world on a grid of 1 s takes in one.
const LONGEST_STEP: f64 = 1e7;

impl Model for NavModel {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "fmu-nav",
            model_identifier: "fmu_nav",
            description: "Relative navigation filters of a chaser that does not know everything that acts on it and its target",
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
            filter: 1,
            filter_index: 0,
            burn_enabled: true,
            settings: Settings::default(),
            resolved: Vec::new(),
            inputs: Signals::default(),
            command: Command::default(),
            mission: String::new(),
            navigator: None,
            prediction: OnceLock::new(),
        }
    }

    fn set_resources(&mut self, folder: Option<&Path>) {
        self.choice.resources = folder.map(Path::to_owned);
    }

    fn identifier_with(own: &str, resources: &Path) -> Option<String> {
        packed_guid(own, resources)
    }

    fn initialise(&mut self, experiment: &Experiment, _log: &mut Log<'_>) -> Result<(), ModelError> {
        let mut navigation = self.choice.mission()?.navigation();
        if !self.burn_enabled {
            navigation.forget_burns_of_chaser();
        }
        self.settings.filter = self.chosen()?;
        let mut navigator = Navigator::new(&navigation, &self.settings, experiment.start_time)?;
        let (sample, nav_init) = self.arrived();
        navigator.begin(&sample, &nav_init, &self.command);
        self.navigator = Some(navigator);
        self.prediction = OnceLock::new();
        self.resolved = self.settings.resolved(&navigation)?;
        self.mission = navigation.mission;
        Ok(())
    }

    fn initialised(&self, experiment: &Experiment, log: &mut Log<'_>) {
        let filter = self.settings.filter().map_or("", |filter| filter.name);
        log.event(format_args!(
            "filter {filter} in mission {} starts at t = {} s",
            self.mission, experiment.start_time
        ));
    }

    fn check_step(&self, _t: f64, h: f64) -> Result<(), ModelError> {
        if h > LONGEST_STEP {
            return Err(format!("a step of {h} s is too long: at most {LONGEST_STEP} s are taken in one").into());
        }
        let (sample, nav_init) = self.arrived();
        if let Some(navigator) = &self.navigator {
            navigator.check(&sample, &nav_init)?;
        }
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), ModelError> {
        let (sample, nav_init) = self.arrived();
        self.prediction = OnceLock::new();
        let Some(navigator) = &mut self.navigator else {
            return Ok(());
        };
        let (before, inputs) = (navigator.status(), &self.inputs);
        let left_out = navigator.leaves_commands_out();
        navigator.step(t, h, &self.command);
        navigator.expect(&sample, &nav_init);
        let new = navigator.process(&sample, &nav_init)?;
        if !new {
            navigator.wait(h);
        }
        if navigator.leaves_commands_out() && !left_out {
            log.event(format_args!(
                "at t = {} s: a command is left out, since dcm_lvlh_n does not say how the LVLH axes stand: is it connected?",
                inputs.sample_time
            ));
        }
        let now = navigator.status();
        if now != before {
            let at = if new { inputs.sample_time } else { t + h };
            log.event(format_args!("at t = {at} s: {}", now.name()));
            let other = Sensor::ALL
                .into_iter()
                .any(|sensor| inputs[sensor].valid && !navigator.uses(sensor));
            if now == Status::Coasting && other {
                log.event(format_args!(
                    "the sample holds a measurement that this mission does not use: does the world fly the same mission?"
                ));
            }
        }
        Ok(())
    }
}

/// What the harness is told: presets, search ranges, bounds, and the filters that have a meaning in some scenarios only.
fn annotated() -> Filters {
    let mut all = Filters::default();
    for filter in FILTERS {
        let variable = |tunable: &str| format!("{}.{tunable}", filter.name);
        all.presets.extend(filter.presets.iter().map(|preset| {
            Preset {
                filter: filter.name.to_owned(),
                name: preset.name.to_owned(),
                about: preset.about.to_owned(),
                other_reading: preset.other_reading,
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
            only_with: search.only_with.map(|(tunable, item)| Set {
                variable: variable(tunable),
                value: item.to_owned(),
            }),
        }));
        all.bounds.extend(filter.bound.then(|| Bound {
            filter: filter.name.to_owned(),
        }));
        all.meanings.extend(filter.alone_in().map(|(frame, why)| {
            let has_meaning = |entry: &&Embedded| {
                let mission = entry.mission();
                mission.is_ok_and(|mission| filter.no_meaning_in(&mission.navigation()).is_none())
            };
            Only {
                filter: filter.name.to_owned(),
                scenarios: Embedded::scenarios()
                    .filter(has_meaning)
                    .map(|entry| entry.name.to_owned())
                    .collect(),
                frame: Some(frame.name().to_owned()),
                why: why.to_owned(),
            }
        }));
    }
    all
}
