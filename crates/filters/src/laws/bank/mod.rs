//! Several filters behind one estimate: what laws share that weigh hypotheses instead of choosing one process noise.
//!
//! The estimator's own mean, the *centre*, is that of the mixture. A [`Member`] is a deviation from the centre with a covariance of
//! its own: all members share the propagation of the mean, its partials F, the rows H and what the chaser's errors add, and each
//! costs two small products a step. After every sample the law hands the mixture back as a [`Replacement`], so that partials are
//! always taken about the best estimate there is. The estimator's own covariance makes its own gain, and serves to tell what the
//! chaser's errors add; what is reported is that of the mixture.
//!
//! Everything is linear in the deviations; they are a few standard deviations long, over which the slopes hold.

mod centre;
mod covariance;
mod member;
mod mixture;
mod rows;
mod weights;

pub(super) mod velocity_change;

pub(crate) use covariance::positive;
pub use mixture::Replacement;

pub(super) use centre::{Centre, Shared, white};
pub(super) use member::Member;
pub(super) use mixture::Mixture;
pub(super) use weights::{LogLikelihoods, MOST_MEMBERS, Weights, reweigh};

use super::adaptation::{Adaptation, Step};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::Preset;
use nalgebra::{Matrix6, Vector6};

/// The preset of a bank, whose constants are the same in every mission.
pub(super) const CONSTANTS: Preset = Preset {
    name: "paper",
    about: "the constants of docs/laws.md, the same in every mission",
    other_reading: false,
    sets: &[],
};

/// What makes a law a bank; all else of its [`Adaptation`] follows.
pub(super) trait Bank {
    /// The estimator as the members see it.
    fn centre(&self) -> &Centre;

    /// The same, to be told what stands in its place.
    fn centre_mut(&mut self) -> &mut Centre;

    /// Every member takes a sample in.
    fn take(&mut self, shared: &Shared);

    /// All of them together, as deviations from the centre.
    fn mixture(&self) -> Mixture;

    /// White acceleration density with which they walk together.
    fn density(&self) -> f64;

    /// Deviations are from another mean now.
    fn shift(&mut self, by: &Vector6<f64>);

    /// As [`Adaptation::updates`].
    fn decisions(&self) -> i32 {
        0
    }

    /// As [`Adaptation::unsolved`].
    fn unsolved(&self) -> i32 {
        0
    }
}

impl<B: Bank> Adaptation for B {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::white_acceleration(self.centre().density(), dt)
    }

    fn look_ahead(&mut self, x: &Vector6<f64>) {
        self.centre_mut().look(x);
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        let shared = self.centre().shared(step);
        self.take(&shared);
        let mixture = self.mixture().moments();
        self.shift(&mixture.mean);
        let density = self.density();
        self.centre_mut().say(&shared, mixture, density);
        Ok(())
    }

    fn replacement(&self) -> Option<&Replacement> {
        self.centre().said()
    }

    fn excess(&self, f: &Matrix6<f64>) -> Option<Matrix6<f64>> {
        self.centre().excess(f)
    }

    fn updates(&self) -> i32 {
        self.decisions()
    }

    fn unsolved(&self) -> i32 {
        Bank::unsolved(self)
    }
}
