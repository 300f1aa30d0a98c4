//! One past time at which the velocity may have changed.

use numerics::math;

use super::super::centre::{Shared, white};
use super::super::member::{Likelihood, Member, Taken};
use super::super::rows::Row;
use super::axes::Axes;
use super::prior::{Prior, Priors, SIZES};
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3};
use serde::{Deserialize, Serialize};

/// Weights below this, and shares below this of what has been summed so far, count for nothing.
pub(super) const NEGLIGIBLE: f64 = 1e-9;

/// A change, given the data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Posterior {
    /// d' V d / 2.
    pub exponent: f64,
    /// det(I + P_D C): the likelihood against "no change" is exp(d' V d / 2) over the root of it.
    pub det: f64,
    /// V d.
    pub mean: Vector3<f64>,
    /// V, 3x3.
    pub v: Matrix3<f64>,
}

/// A past time with all that may have happened at it; internal units, times in s.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Hypothesis {
    /// E, 6x3.
    pub e: Matrix6x3<f64>,
    /// C, 3x3, and d.
    pub c: Matrix3<f64>,
    /// 3.
    pub d: Vector3<f64>,
    /// s.
    pub age: f64,
    /// Time to the next one, or to now: that for which it stands, s.
    pub span: f64,
    /// By how much longer it counts, since a change was due, s.
    pub due: f64,
    /// What was expected.
    pub priors: Priors,
    /// Largest exponent of a likelihood, of the newest sample.
    pub exponent: f64,
    /// Sum of rates times likelihoods over the exponential of it, 1/s.
    pub mass: f64,
    /// Logarithm of what "no change" weighs by now, for what has been folded into it since this one was opened.
    pub ln_base: f64,
    /// Axes at its time.
    pub axes: Axes,
    /// Whether it is the first of all, to which what the start has left is a change, too: nothing is learnt from it. An outlier among
    /// the first samples, which nothing tells from the others, leaves the estimate far off; were that counted, noise would pass for
    /// changes from then on. A change of the target's in the time for which it stands goes uncounted with it.
    pub first: bool,
}

/// A change whatever its prior: all of a hypothesis, by weight.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Part {
    /// Weights by size.
    pub weights: [f64; SIZES],
    /// Weighted sum of D, 3.
    pub first: Vector3<f64>,
    /// Weighted sum of V + D D', 3x3.
    pub second: Matrix3<f64>,
}

impl Part {
    /// Sum of the weights.
    pub(super) fn weight(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// Every weight times a factor.
    pub(super) fn scale(&mut self, by: f64) {
        self.weights.iter_mut().for_each(|weight| *weight *= by);
        self.first *= by;
        self.second *= by;
    }
}

impl Hypothesis {
    pub(super) fn new(due: f64, priors: Priors, axes: Axes, first: bool) -> Self {
        let mut e = Matrix6x3::zeros();
        e.fixed_view_mut::<3, 3>(3, 0).fill_with_identity();
        Self {
            e,
            c: Matrix3::zeros(),
            d: Vector3::zeros(),
            age: 0.0,
            span: 0.0,
            due,
            exponent: 0.0,
            mass: priors.iter().map(|prior| prior.rate).sum(),
            ln_base: 0.0,
            priors,
            axes,
            first,
        }
    }

    /// By what the mass is to be multiplied for its weight, where that of "no change" is exp(-`ln_scale`).
    pub(super) fn factor(&self, ln_scale: f64) -> f64 {
        (self.span + self.due) * math::exp(self.exponent - self.ln_base - ln_scale)
    }

    /// The next one goes, and its time is this one's.
    pub(super) fn stand_for(&mut self, next: &Self) {
        self.span += next.span;
        self.due += next.due;
    }

    /// A step further.
    pub(super) fn predict(&mut self, dt: f64, f: &Matrix6<f64>) {
        self.age += dt;
        self.e = f * self.e;
    }

    /// Takes a row in with what it did to the filter that knows of no change.
    pub(super) fn take(&mut self, row: &Row, taken: &Taken<6>) {
        let g = (row.h * self.e).transpose();
        self.c.ger(1.0 / taken.s, &g, &g, 1.0);
        self.d.axpy(taken.innovation / taken.s, &g, 1.0);
        self.e.ger(-1.0, &taken.gain, &g, 1.0);
    }

    /// All priors together, given the data; their mass is noted, to which the weights of the part sum.
    pub(super) fn weigh(&mut self) -> Part {
        let (mut top, mut sum, mut part) = (f64::NEG_INFINITY, 0.0, Part::default());
        // The largest of a kind comes last and has the largest exponent: begun with it, there is little to scale down.
        for prior in self.priors.iter().rev().filter(|prior| prior.rate > 0.0) {
            let posterior = self.given(prior);
            if posterior.exponent > top {
                let less = math::exp(top - posterior.exponent);
                (top, sum) = (posterior.exponent, sum * less);
                part.scale(less);
            }
            let mass = prior.rate * math::exp(posterior.exponent - top) / posterior.det.sqrt();
            sum += mass;
            if mass > NEGLIGIBLE * sum {
                part.weights[prior.size] += mass;
                part.first.axpy(mass, &posterior.mean, 1.0);
                part.second += posterior.v * mass;
                part.second.ger(mass, &posterior.mean, &posterior.mean, 1.0);
            }
        }
        (self.exponent, self.mass) = (top, sum);
        part
    }

    /// A change as this prior has it, given the data.
    pub(super) fn given(&self, prior: &Prior) -> Posterior {
        let precision = self.c + prior.precision;
        // By cofactors, which give inverse and determinant at once; the sum of a covariance and a precision is far from singular.
        let m = |i: usize, j: usize| precision[(i, j)];
        let cofactor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (others(i), others(j));
            m(a, c) * m(b, d) - m(a, d) * m(b, c)
        };
        let cofactors = Matrix3::from_fn(cofactor);
        let det = precision.row(0).dot(&cofactors.row(0));
        let v = cofactors / det;
        let mean = v * self.d;
        Posterior {
            exponent: 0.5 * self.d.dot(&mean),
            det: det * prior.det,
            mean,
            v,
        }
    }
}

/// A filter and what may have happened to it, a step further; it and every hypothesis.
///
/// * `density`: white acceleration density of the filter; `dt`: the step, s.
pub(super) fn predict(filter: &mut Member<6>, hypotheses: &mut [Hypothesis], shared: &Shared, density: f64, dt: f64) {
    hypotheses
        .iter_mut()
        .for_each(|hypothesis| hypothesis.predict(dt, &shared.f));
    shared.predict(filter, &shared.f, &white(density, shared.dt), 0.0);
}

/// Both take the sample in.
///
/// * returns: its log-likelihood under the filter, as [`Member::update`] has it.
pub(super) fn update(filter: &mut Member<6>, hypotheses: &mut [Hypothesis], shared: &Shared) -> f64 {
    let mut likelihood = Likelihood::default();
    for row in shared.seen.iter() {
        let taken = filter.take(row);
        likelihood.add(row, &taken);
        hypotheses
            .iter_mut()
            .for_each(|hypothesis| hypothesis.take(row, &taken));
    }
    shared.follow(filter);
    likelihood.log()
}

/// The other two of three places, in the order that makes cofactors of them.
fn others(place: usize) -> [usize; 2] {
    [(place + 1) % 3, (place + 2) % 3]
}
