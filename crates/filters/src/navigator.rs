//! A running filter: takes samples, bridges gaps, and holds the estimate.

use crate::beliefs::Beliefs;
use crate::error::FilterError;
use crate::laws::{AccelerationModel, Adaptation, FILTERS, FilterEntry, Law, RelativeModel, Setup, Step};
use crate::plants::{Plant, Reported};
use crate::sample::Sample;
use crate::scenarios::{Measures, SCENARIOS, ScenarioEntry};
use crate::state::{N_TARGET, State, TargetMatrix};
use crate::tunable::{Bound, Tunables, Value};
use crate::units::Units;
use interface::Status;
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// Longest step of one propagation, s; a gap between samples is crossed in equal parts no longer than this.
const LONGEST_STEP: f64 = 1.0;
/// Longest gap between samples, s. A tag further ahead is a mistake of the caller, not a gap.
const LONGEST_GAP: f64 = 1e5;

/// Everything that chooses a filter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Index into [`SCENARIOS`].
    pub scenario: usize,
    /// Index into [`FILTERS`].
    pub filter: usize,
    /// Seed of the study.
    pub study_seed: u64,
    /// Run within the study.
    pub run: u64,
    /// What the filter believes of the world.
    pub beliefs: Beliefs,
    /// Values of every tunable of every filter, in the order of [`FILTERS`] and of their declarations.
    pub tunables: Vec<Vec<Value>>,
}

impl Default for Settings {
    /// The first scenario and filter, everything at its start value.
    fn default() -> Self {
        let tunables = FILTERS
            .iter()
            .map(|f| f.tunables.iter().map(|t| t.kind.start()).collect())
            .collect();
        Self {
            scenario: 0,
            filter: 0,
            study_seed: 1,
            run: 0,
            beliefs: Beliefs::default(),
            tunables,
        }
    }
}

impl Settings {
    /// The scenario chosen.
    ///
    /// # Errors
    /// When the index is not registered.
    pub fn scenario(&self) -> Result<&'static ScenarioEntry, FilterError> {
        SCENARIOS
            .get(self.scenario)
            .ok_or_else(|| FilterError::UnknownScenario {
                name: format!("number {}", self.scenario + 1),
                known: SCENARIOS.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
            })
    }

    /// The filter chosen.
    ///
    /// # Errors
    /// When the index is not registered.
    pub fn filter(&self) -> Result<&'static FilterEntry, FilterError> {
        FILTERS.get(self.filter).ok_or_else(|| FilterError::UnknownFilter {
            name: format!("number {}", self.filter + 1),
            known: FILTERS.iter().map(|f| f.name).collect::<Vec<_>>().join(", "),
        })
    }

    /// The value of one tunable, to be changed.
    pub fn tunable_mut(&mut self, filter: &str, tunable: &str) -> Option<&mut Value> {
        let f = FILTERS.iter().position(|entry| entry.name == filter)?;
        let t = FILTERS[f].tunables.iter().position(|entry| entry.name == tunable)?;
        self.tunables.get_mut(f)?.get_mut(t)
    }
}

/// The estimate after the newest sample, SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Epoch of the sample last used, s.
    pub time: f64,
    /// Its ordinal; 0 before the first.
    pub count: i32,
    /// The 18 states; in a world that measures the relative state in full: rho, rho_dot and d (LVLH), then nothing.
    pub x: State,
    /// Covariance of the first nine.
    pub p_target: TargetMatrix,
    /// Standard deviations of the 18 states.
    pub sigma: State,
}

/// The newest innovation, SI: range (m), azimuth and elevation (rad), or relative position (m) and velocity (m/s) in LVLH.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Innovation {
    /// Measured minus predicted; zero beyond the rows of the world's measurement.
    pub residual: Vector6<f64>,
    /// Their predicted variances; zero without a covariance.
    pub variance: Vector6<f64>,
    /// Normalised innovation squared of all rows; zero without a covariance.
    pub nis: f64,
}

/// A filter at work; all of its state is here and can be saved.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Navigator {
    units: Units,
    measures: Measures,
    plant: Plant,
    law: Law,
    divergence: Divergence,
    estimate: Estimate,
    innovation: Innovation,
    status: Status,
}

/// Exponential mean of the normalised innovations.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Divergence {
    limit: f64,
    samples: f64,
    mean: f64,
}

impl Navigator {
    /// A filter that waits for its first sample.
    ///
    /// * `start_time`: epoch at which the initial estimate will hold, s.
    ///
    /// # Errors
    /// When the scenario or filter is unknown, the one has no meaning in the other, or a parameter is out of range.
    pub fn new(settings: &Settings, start_time: f64) -> Result<Self, FilterError> {
        let (scenario, filter, b) = (settings.scenario()?, settings.filter()?, &settings.beliefs);
        if let Some(why) = filter.no_meaning_in(scenario) {
            return Err(FilterError::NoMeaning {
                filter: filter.name,
                scenario: scenario.name,
                why,
            });
        }
        let law = (filter.build)(&Setup {
            tunables: Tunables {
                law: filter.name,
                declared: filter.tunables,
                values: settings.tunables.get(settings.filter).map_or(&[], Vec::as_slice),
                scenario: scenario.name,
                defaults: scenario.defaults,
            },
            rows: scenario.measures.rows(),
            r: Plant::noise(scenario, b)?,
            measures: scenario.measures,
            units: scenario.units,
            off_nominal: Bound::Positive.check("off_nominal", b.off_nominal, "")?,
            study_seed: settings.study_seed,
            run: settings.run,
        })?;
        Ok(Self {
            units: scenario.units,
            measures: scenario.measures,
            plant: Plant::new(scenario, b, &law)?,
            law,
            divergence: Divergence {
                limit: Bound::Positive.check("divergence.nis", b.divergence_nis, "")?,
                samples: Bound::Positive.check("divergence.samples", f64::from(b.divergence_samples), "")?,
                mean: 1.0,
            },
            estimate: Estimate {
                time: start_time,
                count: 0,
                x: State::zeros(),
                p_target: TargetMatrix::zeros(),
                sigma: State::zeros(),
            },
            innovation: Innovation::default(),
            status: Status::Initialising,
        })
    }

    /// Processes a sample; one whose ordinal is not above the last one used is passed by.
    ///
    /// * `nav_init`: the initial estimate at the start time, 18 states, SI; read with the first sample only.
    ///
    /// # Errors
    /// When the sample makes no sense or the filter breaks down; the filter should then not be used further.
    pub fn process(&mut self, sample: &Sample, nav_init: &State) -> Result<(), FilterError> {
        if sample.count <= self.estimate.count {
            return Ok(());
        }
        let (t_s, last_s) = (sample.time, self.estimate.time);
        let gap_s = t_s - last_s;
        if gap_s.is_nan() || gap_s <= 0.0 {
            return Err(FilterError::TimeNotAdvancing {
                count: sample.count,
                t_s,
                last_s,
            });
        }
        if gap_s > LONGEST_GAP {
            return Err(FilterError::GapTooLong {
                count: sample.count,
                t_s,
                gap_s,
                limit_s: LONGEST_GAP,
            });
        }
        let plant = self.plant.get_mut();
        plant.check(sample)?;
        if !plant.started() {
            if nav_init.iter().all(|v| *v == 0.0) {
                return Err(FilterError::NoInitialEstimate { t_s });
            }
            plant.start(nav_init, &self.law, t_s)?;
            self.law.look_ahead(&plant.relative());
        }

        let dt = gap_s / self.units.time;
        let parts = (gap_s / LONGEST_STEP - 1e-9).ceil().max(1.0) as u32;
        let f = plant.propagate(gap_s, parts, sample, &self.law);
        let updated = plant.update(sample, dt, &self.law)?;
        if let Some(defect) = plant.defect(t_s) {
            return Err(defect);
        }
        self.law.observe(Step {
            dt,
            f,
            h: updated.h,
            innovation: updated.innovation,
            correction: updated.correction,
        })?;
        self.law.look_ahead(&plant.relative());
        let Reported { x, p_target, sigma } = plant.report(sample, &self.law);
        self.estimate = Estimate {
            time: sample.time,
            count: sample.count,
            x,
            p_target,
            sigma,
        };
        self.judge(updated.seen);
        Ok(())
    }

    /// Keeps the innovation and says what the filter is doing.
    fn judge(&mut self, seen: Option<Innovation>) {
        let Some(seen) = seen else {
            self.status = Status::Coasting;
            return;
        };
        self.innovation = seen;
        if self.dimension() > 0 {
            let normalised = seen.nis / self.measures.rows() as f64;
            self.divergence.mean += (normalised - self.divergence.mean) / self.divergence.samples;
        }
        self.status = if self.dimension() > 0 && self.divergence.mean > self.divergence.limit {
            Status::Diverged
        } else {
            Status::Tracking
        };
    }

    /// The estimate after the newest sample.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The newest innovation.
    pub fn innovation(&self) -> &Innovation {
        &self.innovation
    }

    /// What the filter is doing.
    pub fn status(&self) -> Status {
        self.status
    }

    /// What the world measures of the target, and so which frame the first nine states are in.
    pub fn measures(&self) -> Measures {
        self.measures
    }

    /// Number of the first nine states that have a covariance: nine, six without an acceleration state, none under a
    /// constant gain.
    pub fn dimension(&self) -> usize {
        match self.law.acceleration() {
            _ if self.law.gain(1.0).is_some() => 0,
            AccelerationModel::Absent => 6,
            AccelerationModel::RandomWalk | AccelerationModel::GaussMarkov(_) => N_TARGET,
        }
    }

    /// Whether the unmodelled acceleration is estimated, as a state, by a network or by a better model.
    pub fn estimates_acceleration(&self) -> bool {
        self.law.acceleration() != AccelerationModel::Absent
            || self.law.disturbance().is_some()
            || self.law.relative_model() != RelativeModel::ClohessyWiltshire
    }

    /// Square root of the jerk density in use, axes of the estimate, m/s^2.5; zero for a law without one.
    pub fn s(&self) -> Vector3<f64> {
        self.law.s().map(|s| s.abs() * self.units.root_jerk_density())
    }

    /// How often the law has changed its process noise.
    pub fn updates(&self) -> i32 {
        self.law.updates()
    }

    /// How often the law's solver found no solution.
    pub fn unsolved(&self) -> i32 {
        self.law.unsolved()
    }

    /// How often the law passed an update by because its window was singular.
    pub fn skipped(&self) -> i32 {
        self.law.skipped()
    }
}
