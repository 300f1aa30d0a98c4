//! What a law is: it receives what every sample told and answers with the process noise of the steps to come.

use super::bank::Replacement;
use crate::disturbance::Disturbance;
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::layout::{Layout, Measured};
use crate::state::{RowMatrix, RowVector, Rows, Target, TargetMatrix};
use crate::tunable::Tunables;
use crate::units::Units;
use nalgebra::{Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// What a law sees of one processed sample; internal units. Rows stand in the places of [`Setup::layout`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Time since the previous sample.
    pub dt: f64,
    /// Transition of the target's nine states from the previous sample to this one, 9x9.
    pub f: TargetMatrix,
    /// Which rows were measured.
    pub measured: Measured,
    /// Rows of H at the predicted state; zero where nothing was measured.
    pub h: Rows,
    /// Innovation of those rows; zero likewise.
    pub innovation: RowVector,
    /// Their covariance S; zero likewise, and without a covariance.
    pub s: RowMatrix,
    /// Log-likelihood of the innovation under S; zero when nothing was measured, and without a covariance.
    pub log_likelihood: f64,
    /// What the update, accelerometer rows included, added to the target's nine states.
    pub correction: Target,
    /// The part of it that the first pass of the update of this epoch made: the gain at the predicted state times the innovation.
    pub linear: Target,
    /// Covariance of the target's nine states before the update, 9x9; zero without a covariance.
    pub p_prior: TargetMatrix,
    /// The same after it.
    pub p_post: TargetMatrix,
}

impl Step {
    /// A sample at which nothing was measured, `dt` after the last.
    pub fn blank(dt: f64, f: TargetMatrix) -> Self {
        Self {
            dt,
            f,
            measured: Measured::default(),
            h: Rows::zeros(),
            innovation: RowVector::zeros(),
            s: RowMatrix::zeros(),
            log_likelihood: 0.0,
            correction: Target::zeros(),
            linear: Target::zeros(),
            p_prior: TargetMatrix::zeros(),
            p_post: TargetMatrix::zeros(),
        }
    }
}

/// What a bound is told of the interval up to a sample, before it is propagated over; internal units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hindsight {
    /// Mean of the target's unannounced acceleration, axes N.
    pub a_t_n: Vector3<f64>,
    /// Share of the interval in which an unannounced event pushed the target, 0 to 1.
    pub active: f64,
}

/// A law plugged into the filter.
pub trait Adaptation {
    /// How the acceleration state behaves.
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::RandomWalk
    }

    /// Discrete process noise of the target's nine states over `dt`, 9x9, internal units.
    fn process_noise(&self, dt: f64) -> TargetMatrix;

    /// Takes note of the newest estimate: the initial one, then that after each sample.
    ///
    /// * `x`: relative position and velocity, internal units.
    fn look_ahead(&mut self, _x: &Vector6<f64>) {}

    /// Acceleration that acts on the relative state until the next sample, with its partials; internal units.
    fn disturbance(&self) -> Option<&Disturbance> {
        None
    }

    /// Takes note of what no filter knows; of filters that are bounds alone.
    fn hear(&mut self, _truth: &Hindsight) {}

    /// Acceleration of the target up to the next sample as if it had been announced, axes N, internal units.
    fn announced(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// Learns from a processed sample.
    ///
    /// # Errors
    /// When the law cannot go on; the filter stops with it.
    fn observe(&mut self, _step: &Step) -> Result<(), FilterError> {
        Ok(())
    }

    /// What stands in place of the update's mean and covariance after the sample last observed, for a law that keeps filters of
    /// its own.
    fn replacement(&self) -> Option<&Replacement> {
        None
    }

    /// By how much the covariance of position and velocity that the law stands for is larger than the estimator's own, some time
    /// after the sample last observed.
    ///
    /// * `f`: transition from then, 6x6.
    fn excess(&self, _f: &Matrix6<f64>) -> Option<Matrix6<f64>> {
        None
    }

    /// Square root of the jerk density per axis of the estimate now in use, internal units; zero for a law without one.
    fn s(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// Whether nothing keeps the process noise from growing until rounding leaves no covariance: the filter then looks at its own.
    fn learns_without_bound(&self) -> bool {
        false
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

    /// Whether its tunables make it a law that is kept for what it once gave: then nothing acts that the entry has on of itself.
    fn reproduces(&self) -> bool {
        false
    }
}

/// Makes an enumeration of boxed laws a law: everything is asked of the one that it holds.
///
/// * the enumeration's name, and its variants.
macro_rules! one_of_laws {
    ($name:ident: $($variant:ident),+) => {
        impl $name {
            fn inner(&self) -> &dyn $crate::laws::Adaptation {
                match self { $(Self::$variant(law) => law.as_ref()),+ }
            }
            fn inner_mut(&mut self) -> &mut dyn $crate::laws::Adaptation {
                match self { $(Self::$variant(law) => law.as_mut()),+ }
            }
        }

        impl $crate::laws::Adaptation for $name {
            fn acceleration(&self) -> $crate::dynamics::AccelerationModel {
                self.inner().acceleration()
            }
            fn process_noise(&self, dt: f64) -> $crate::state::TargetMatrix {
                self.inner().process_noise(dt)
            }
            fn look_ahead(&mut self, x: &::nalgebra::Vector6<f64>) {
                self.inner_mut().look_ahead(x);
            }
            fn disturbance(&self) -> Option<&$crate::disturbance::Disturbance> {
                self.inner().disturbance()
            }
            fn hear(&mut self, truth: &$crate::laws::Hindsight) {
                self.inner_mut().hear(truth);
            }
            fn announced(&self) -> ::nalgebra::Vector3<f64> {
                self.inner().announced()
            }
            fn observe(&mut self, step: &$crate::laws::Step) -> Result<(), $crate::error::FilterError> {
                self.inner_mut().observe(step)
            }
            fn replacement(&self) -> Option<&$crate::laws::Replacement> {
                self.inner().replacement()
            }
            fn excess(&self, f: &::nalgebra::Matrix6<f64>) -> Option<::nalgebra::Matrix6<f64>> {
                self.inner().excess(f)
            }
            fn s(&self) -> ::nalgebra::Vector3<f64> {
                self.inner().s()
            }
            fn learns_without_bound(&self) -> bool {
                self.inner().learns_without_bound()
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
            fn reproduces(&self) -> bool {
                self.inner().reproduces()
            }
        }
    };
}
pub(super) use one_of_laws;

/// What a law may know when it is built.
pub struct Setup<'a> {
    /// Its tunables.
    pub tunables: Tunables<'a>,
    /// Places of the rows of the mission's sensors.
    pub layout: Layout,
    /// Their noise variances, the diagonal of R, internal units; zero beyond the rows there are.
    pub r: RowVector,
    /// Whether the first six rows are the relative position and velocity themselves.
    pub state_measured: bool,
    /// Internal units.
    pub units: Units,
    /// Factor on the process noise that the tunables say, or on an observer's gain, to study mistuning.
    pub off_nominal: f64,
    /// Seed of the study.
    pub study_seed: u64,
    /// Run within the study.
    pub run: u64,
}

impl Setup<'_> {
    /// Square root of the white acceleration density that a tunable says, with the factor of a study of mistuning; internal units.
    ///
    /// # Errors
    /// When the tunable is out of range.
    pub(super) fn root_acceleration_density(&self, tunable: &str) -> Result<f64, FilterError> {
        Ok(self.tunables.real(tunable)? / self.units.root_acceleration_density() * self.off_nominal.sqrt())
    }
}
