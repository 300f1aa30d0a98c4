//! What a filter estimates and how its sensors see it: one file for each kind of main measurement.
//!
//! A plant owns mean and covariance in internal units; [`crate::Navigator`] decides which samples reach it and tells the law.

mod range_and_bearing;
mod relative_state;

use crate::beliefs::Beliefs;
use crate::error::FilterError;
use crate::laws::{Adaptation, Law};
use crate::navigator::Innovation;
use crate::sample::Sample;
use crate::scenarios::{Measures, ScenarioEntry};
use crate::state::{Rows, State, Target, TargetMatrix};
use crate::tunable::Bound;
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

use range_and_bearing::RangeAndBearing;
use relative_state::RelativeState;

/// What the update with one sample did; internal units but for what is seen.
pub(crate) struct Updated {
    /// Rows of H; zero when the sample had no main measurement.
    pub h: Rows,
    /// Innovation of those rows; zero likewise.
    pub innovation: Vector6<f64>,
    /// What was added to the target's nine states.
    pub correction: Target,
    /// The innovation in SI with its variances; `None` without a measurement.
    pub seen: Option<Innovation>,
}

/// Mean, covariance and standard deviations, SI, as in [`crate::Estimate`].
pub(crate) struct Reported {
    pub x: State,
    pub p_target: TargetMatrix,
    pub sigma: State,
}

/// The filter's state and what it knows of motion and sensors.
pub(crate) trait Estimator {
    /// Refuses a sample that makes no sense, before anything changes.
    fn check(&self, sample: &Sample) -> Result<(), FilterError>;

    /// Takes the initial estimate, SI, when the first sample arrives at `t_s`.
    fn start(&mut self, nav_init: &State, law: &Law, t_s: f64) -> Result<(), FilterError>;

    /// Whether [`Estimator::start`] has been called.
    fn started(&self) -> bool;

    /// Time update over `gap_s` seconds in `parts` equal steps, up to the epoch of `sample`.
    ///
    /// * returns: transition of the target's nine states over the whole gap.
    fn propagate(&mut self, gap_s: f64, parts: u32, sample: &Sample, law: &Law) -> TargetMatrix;

    /// Measurement update with what the sample offers, `dt` internal units of time after the last.
    fn update(&mut self, sample: &Sample, dt: f64, law: &Law) -> Result<Updated, FilterError>;

    /// Relative position and velocity, internal units.
    fn relative(&self) -> Vector6<f64>;

    /// The estimate in SI.
    fn report(&self, sample: &Sample, law: &Law) -> Reported;

    /// The first thing wrong with mean and covariance.
    fn defect(&self, t_s: f64) -> Option<FilterError>;
}

/// The plant of a running filter.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Plant {
    RangeAndBearing(Box<RangeAndBearing>),
    RelativeState(Box<RelativeState>),
}

impl Plant {
    /// The plant of a scenario.
    ///
    /// # Errors
    /// When a belief is out of range.
    pub(crate) fn new(scenario: &ScenarioEntry, beliefs: &Beliefs, law: &Law) -> Result<Self, FilterError> {
        Ok(match scenario.measures {
            Measures::RangeAndBearing => {
                Self::RangeAndBearing(Box::new(RangeAndBearing::new(scenario, beliefs, law.acceleration())?))
            }
            Measures::RelativeState => Self::RelativeState(Box::new(RelativeState::new(scenario, beliefs, law)?)),
        })
    }

    /// Noise variances of the main measurement, internal units; zero beyond its rows.
    ///
    /// # Errors
    /// When a belief is out of range.
    pub(crate) fn noise(scenario: &ScenarioEntry, beliefs: &Beliefs) -> Result<Vector6<f64>, FilterError> {
        match scenario.measures {
            Measures::RangeAndBearing => range_and_bearing::noise(scenario, beliefs),
            Measures::RelativeState => relative_state::noise(beliefs),
        }
    }

    pub(crate) fn get_mut(&mut self) -> &mut dyn Estimator {
        match self {
            Self::RangeAndBearing(plant) => plant.as_mut(),
            Self::RelativeState(plant) => plant.as_mut(),
        }
    }
}

/// A standard deviation of the beliefs, or the scenario's own.
fn sigma(scenario: &ScenarioEntry, name: &str, value: f64, unit: &'static str) -> Result<f64, FilterError> {
    Ok(Bound::Positive.check(name, scenario.resolve(name, value)?, unit)?)
}

/// The first thing wrong with a mean and the variances of a covariance.
fn defect<'a>(
    x: impl IntoIterator<Item = &'a f64>,
    p: impl IntoIterator<Item = &'a f64>,
    variances: impl IntoIterator<Item = f64>,
    t_s: f64,
) -> Option<FilterError> {
    if !x.into_iter().chain(p).all(|v| v.is_finite()) {
        return Some(FilterError::NotFinite { t_s });
    }
    // Zero is legal: a law without an acceleration state has no variance there.
    let negative = variances.into_iter().position(|v| v < 0.0);
    negative.map(|i| FilterError::NegativeVariance { t_s, state: i + 1 })
}
