//! A change that has been decided upon, watched until its direction is known.
//!
//! That there was a change is clear long before it is clear where it pointed, and the filter that goes on with it cannot tell any more
//! what the data alone say. So the filter without it goes on beside, for as long as a hypothesis would, or until the next change: what
//! the data said before that one is kept.

use super::super::centre::Shared;
use super::super::member::Member;
use super::directions::Found;
use super::hypothesis::{self, Hypothesis};
use super::prior::SIZES;
use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// Time between what is kept of what the data have said, s.
const KEPT: f64 = 20.0;

/// The filter without the change, and the change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Watched {
    /// The filter that knows of no change.
    pub without: Member<6>,
    /// The change.
    pub hypothesis: Hypothesis,
    /// Probability that there was one, by size.
    pub weights: [f64; SIZES],
    /// What the data had said of it, the oldest first.
    said: Vec<Said>,
}

/// What the data had said when the change was this old.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Said {
    /// s.
    age: f64,
    /// C, 3x3, and d.
    c: Matrix3<f64>,
    /// 3.
    d: Vector3<f64>,
}

impl Watched {
    /// * `room`: for what the data say, as [`room`] makes it or [`Watched::into_room`] leaves it.
    pub(super) fn new(without: Member<6>, hypothesis: Hypothesis, weights: [f64; SIZES], mut room: Vec<Said>) -> Self {
        room.clear();
        room.push(Said::of(&hypothesis));
        Self {
            without,
            hypothesis,
            weights,
            said: room,
        }
    }

    /// Takes a sample in.
    ///
    /// * `density`: white acceleration density of the quiet filter.
    pub(super) fn take(&mut self, shared: &Shared, dt_s: f64, density: f64) {
        let change = std::slice::from_mut(&mut self.hypothesis);
        hypothesis::predict(&mut self.without, change, shared, density, dt_s);
        hypothesis::update(&mut self.without, change, shared);
        if self
            .said
            .last()
            .is_none_or(|said| self.hypothesis.age >= said.age + KEPT)
        {
            self.said.push(Said::of(&self.hypothesis));
        }
    }

    /// Deviations are from another mean now.
    pub(super) fn shift(&mut self, shift: &Vector6<f64>) {
        self.without.dx -= shift;
    }

    /// What the data say of it; `None` where all of it is spoilt.
    ///
    /// * `spoilt_s`: for how long they have spoken of something else, too.
    pub(super) fn found(&self, spoilt_s: f64) -> Option<Found> {
        let mut hypothesis = self.hypothesis.clone();
        if spoilt_s > 0.0 {
            let mut newest_first = self.said.iter().rev();
            let Said { c, d, .. } = newest_first.find(|said| hypothesis.age - said.age >= spoilt_s)?;
            (hypothesis.c, hypothesis.d) = (*c, *d);
        }
        Some(found(&hypothesis, &self.weights))
    }

    /// The memory that it leaves to the next one.
    pub(super) fn into_room(self) -> Vec<Said> {
        self.said
    }
}

/// Room for what the data say of a change that is watched until it is this old, s.
pub(super) fn room(window: f64) -> Vec<Said> {
    Vec::with_capacity((window / KEPT) as usize + 2)
}

impl Said {
    fn of(hypothesis: &Hypothesis) -> Self {
        let Hypothesis { age, c, d, .. } = *hypothesis;
        Self { age, c, d }
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
