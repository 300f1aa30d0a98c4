//! A change that has been decided upon, watched until its direction is known.
//!
//! That there was a change is clear long before it is clear where it pointed, and the filter that goes on with it cannot tell any more
//! what the data alone say. So the filter without it goes on beside, for as long as a hypothesis would.

use super::super::centre::{Shared, white};
use super::super::member::Member;
use super::directions::Found;
use super::hypothesis::{Hypothesis, SIZES};
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// The filter without the change, and the change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Watched {
    /// The filter that knows of no change.
    pub without: Member<6>,
    /// The change.
    pub hypothesis: Hypothesis,
    /// Probability that there was one, by size.
    pub weights: [f64; SIZES],
}

impl Watched {
    /// Takes a sample in.
    ///
    /// * `density`: white acceleration density of the quiet filter.
    pub(super) fn take(&mut self, shared: &Shared, dt_s: f64, density: f64) {
        self.hypothesis.predict(dt_s, &shared.f);
        shared.predict(&mut self.without, &shared.f, &white(density, shared.dt), 0.0);
        for row in shared.seen.iter() {
            let taken = self.without.take(row);
            self.hypothesis.take(row, &taken);
        }
        shared.follow(&mut self.without);
    }

    /// Deviations are from another mean now.
    pub(super) fn shift(&mut self, shift: &Vector6<f64>) {
        self.without.dx -= shift;
    }

    /// What the data say of it.
    pub(super) fn found(&self) -> Found {
        found(&self.hypothesis, &self.weights)
    }
}

/// What the data say of a change, whatever was known of its direction before.
///
/// * `weights`: probability that there was one, by size.
pub(super) fn found(hypothesis: &Hypothesis, weights: &[f64; SIZES]) -> Found {
    let all: f64 = weights.iter().sum();
    let (mut d, mut second) = (Vector3::zeros(), Matrix3::zeros());
    for prior in hypothesis.priors.iter().filter(|prior| prior.anywhere) {
        let share = weights[prior.size] / all;
        if share > 1e-9 {
            let posterior = hypothesis.given(prior);
            d += posterior.mean * share;
            second += posterior.v * share;
            second.ger(share, &posterior.mean, &posterior.mean, 1.0);
        }
    }
    Found {
        d,
        v: second - d * d.transpose(),
        weights: *weights,
        axes: hypothesis.axes,
    }
}
