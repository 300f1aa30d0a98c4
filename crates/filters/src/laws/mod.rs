//! Adaptation laws: how a filter chooses its process noise.
//!
//! A law is one file that exports an `ENTRY` and implements [`Adaptation`], and one line in the registry below. That line
//! makes it appear in the FMU's `filter` enumeration, its tunables in the model description, and itself in
//! `trade-harness list` and in every test that loops over [`FILTERS`].

mod constrained_q;
pub mod correlation;
mod dmc;
mod ekf_j2;
mod fixed_q;
mod learner;
mod milton;
pub mod network;
mod observer;
mod rbfnn_aekf;
mod rbfnn_ekf;
mod snc;
mod step_noise;
mod window;

use self::network::Disturbance;
use crate::FilterError;
use crate::scenarios::{Measures, ScenarioEntry};
use crate::state::{Rows, Target, TargetMatrix};
use crate::tunable::{Preset, Tunable, Tunables};
use crate::units::Units;
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// What a law sees of one processed sample; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Step {
    /// Time since the previous sample.
    pub dt: f64,
    /// Transition of the target's nine states from the previous sample to this one, 9x9.
    pub f: TargetMatrix,
    /// Rows of H at the predicted state, the first [`Setup::rows`] of 6x9; zero when the sample had no measurement.
    pub h: Rows,
    /// Innovation of those rows; zero without a measurement.
    pub innovation: Vector6<f64>,
    /// What the update, accelerometer rows included, added to the target's nine states.
    pub correction: Target,
}

/// What a filter makes of the target's unmodelled acceleration between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AccelerationModel {
    /// A state that stays where it is but for the process noise.
    RandomWalk,
    /// A state that decays at this rate, internal units.
    GaussMarkov(f64),
    /// No state: six states with a covariance, a_t stays zero.
    Absent,
}

impl AccelerationModel {
    /// Rate at which the state decays by itself, internal units.
    pub fn decay(self) -> f64 {
        match self {
            Self::GaussMarkov(rate) => rate,
            Self::RandomWalk | Self::Absent => 0.0,
        }
    }
}

/// Dynamics of the relative state in the target's LVLH frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelativeModel {
    /// Linear, about a circular orbit: Clohessy and Wiltshire.
    ClohessyWiltshire,
    /// Nonlinear, with J2, about the target's orbit as it is handed over with each sample.
    J2,
}

/// A law plugged into the filter.
pub trait Adaptation {
    /// How the acceleration state behaves.
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::RandomWalk
    }

    /// Discrete process noise of the target's nine states over `dt`, 9x9, internal units.
    fn process_noise(&self, dt: f64) -> TargetMatrix;

    /// Dynamics of the relative state, where it is measured in full.
    fn relative_model(&self) -> RelativeModel {
        RelativeModel::ClohessyWiltshire
    }

    /// Diagonal of a gain over `dt` that takes the place of the Kalman gain on position and velocity, where they are
    /// measured in full; the filter then has no covariance.
    fn gain(&self, _dt: f64) -> Option<Vector6<f64>> {
        None
    }

    /// Takes note of the newest estimate: the initial one, then that after each sample.
    ///
    /// * `x`: relative position and velocity, internal units.
    fn look_ahead(&mut self, _x: &Vector6<f64>) {}

    /// Acceleration that acts on the relative state until the next sample, with its partials; internal units.
    fn disturbance(&self) -> Option<&Disturbance> {
        None
    }

    /// Learns from a processed sample.
    ///
    /// # Errors
    /// When the law cannot go on; the filter stops with it.
    fn observe(&mut self, _step: Step) -> Result<(), FilterError> {
        Ok(())
    }

    /// Square root of the jerk density per axis of the estimate now in use, internal units; zero for a law without one.
    fn s(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// How often the law has changed its mind.
    fn updates(&self) -> i32 {
        0
    }

    /// How often it had to pass an update by, its window being singular.
    fn skipped(&self) -> i32 {
        0
    }

    /// How often its solver found no solution, so that the last process noise stayed.
    fn unsolved(&self) -> i32 {
        0
    }
}

/// What a law may know when it is built.
pub struct Setup<'a> {
    /// Its tunables.
    pub tunables: Tunables<'a>,
    /// Rows of the main measurement: three of a LiDAR (range, azimuth, elevation), six of a metrology (rho, rho_dot).
    pub rows: usize,
    /// Their noise variances, the diagonal of R, internal units; zero beyond [`Setup::rows`].
    pub r: Vector6<f64>,
    /// What kind of measurement that is.
    pub measures: Measures,
    /// Internal units.
    pub units: Units,
    /// Factor on the process noise that the tunables say, or on an observer's gain, to study mistuning.
    pub off_nominal: f64,
    /// Seed of the study.
    pub study_seed: u64,
    /// Run within the study.
    pub run: u64,
}

/// A tunable to be searched, on a logarithmic scale.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Name without the law's prefix.
    pub tunable: &'static str,
    /// Smallest value, SI or as the tunable says.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

/// Where a filter has a meaning.
#[derive(Clone, Copy, Debug)]
pub struct Only {
    /// The main measurement that it needs.
    pub measures: Measures,
    /// Why it has no meaning elsewhere.
    pub why: &'static str,
}

/// A registered filter.
pub struct FilterEntry {
    /// Name, as in the FMU's `filter` enumeration, and prefix of its tunables.
    pub name: &'static str,
    /// One line for `list` and the enumeration's description.
    pub about: &'static str,
    /// Parameters it offers.
    pub tunables: &'static [Tunable],
    /// Named sets; the first is always `paper`.
    pub presets: &'static [Preset],
    /// Real tunables that a search for the best tuning varies.
    pub search: &'static [Search],
    /// Set when the filter has a meaning only where the main measurement is of one kind.
    pub only: Option<Only>,
    /// Builds the law.
    pub build: fn(&Setup<'_>) -> Result<Law, FilterError>,
}

impl FilterEntry {
    /// Why the filter has no meaning in a scenario; `None` where it has one.
    pub fn no_meaning_in(&self, scenario: &ScenarioEntry) -> Option<&'static str> {
        let only = self.only.as_ref()?;
        (only.measures != scenario.measures).then_some(only.why)
    }
}

/// Makes the registry: the list of entries and the closed set of laws that a saved FMU state can hold.
macro_rules! registry {
    ($($variant:ident => $law:ty, $entry:expr;)*) => {
        /// Every filter, in the order reports list them.
        pub const FILTERS: &[FilterEntry] = &[$($entry),*];

        /// The law of a running filter.
        #[allow(missing_docs)]
        #[derive(Clone, Debug, Serialize, Deserialize)]
        pub enum Law { $($variant(Box<$law>)),* }

        $(impl From<$law> for Law {
            fn from(law: $law) -> Self {
                Self::$variant(Box::new(law))
            }
        })*

        impl Law {
            fn inner(&self) -> &dyn Adaptation {
                match self { $(Self::$variant(law) => law.as_ref()),* }
            }
            fn inner_mut(&mut self) -> &mut dyn Adaptation {
                match self { $(Self::$variant(law) => law.as_mut()),* }
            }
        }
    };
}

registry! {
    FixedQ => fixed_q::FixedQ, fixed_q::ENTRY;
    Snc => snc::Snc, snc::ENTRY;
    Dmc => dmc::Dmc, dmc::ENTRY;
    Milton => milton::Milton, milton::ENTRY;
    ConstrainedQ => constrained_q::ConstrainedQ, constrained_q::ENTRY;
    RbfnnAekf => rbfnn_aekf::RbfnnAekf, rbfnn_aekf::ENTRY;
    RbfnnEkf => rbfnn_ekf::RbfnnEkf, rbfnn_ekf::ENTRY;
    Observer => observer::Observer, observer::ENTRY;
    EkfJ2 => ekf_j2::EkfJ2, ekf_j2::ENTRY;
}

impl Adaptation for Law {
    fn acceleration(&self) -> AccelerationModel {
        self.inner().acceleration()
    }
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        self.inner().process_noise(dt)
    }
    fn relative_model(&self) -> RelativeModel {
        self.inner().relative_model()
    }
    fn gain(&self, dt: f64) -> Option<Vector6<f64>> {
        self.inner().gain(dt)
    }
    fn look_ahead(&mut self, x: &Vector6<f64>) {
        self.inner_mut().look_ahead(x);
    }
    fn disturbance(&self) -> Option<&Disturbance> {
        self.inner().disturbance()
    }
    fn observe(&mut self, step: Step) -> Result<(), FilterError> {
        self.inner_mut().observe(step)
    }
    fn s(&self) -> Vector3<f64> {
        self.inner().s()
    }
    fn updates(&self) -> i32 {
        self.inner().updates()
    }
    fn skipped(&self) -> i32 {
        self.inner().skipped()
    }
    fn unsolved(&self) -> i32 {
        self.inner().unsolved()
    }
}
