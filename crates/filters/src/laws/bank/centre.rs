//! The estimator's own mean and covariance, as the members see them.

use super::covariance::as_covariance;
use super::member::Member;
use super::mixture::{Moments, Replacement};
use super::rows::Seen;
use crate::jerk;
use crate::laws::Step;
use crate::state::{RowVector, TargetMatrix};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use numerics::spd;
use serde::{Deserialize, Serialize};

/// The centre between two samples.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::laws) struct Centre {
    /// Noise variances of the rows, internal units.
    r: RowVector,
    /// The estimator's own covariance after the last sample, 6x6, and what was said in its place; `None` before the first sample.
    last: Option<(Matrix6<f64>, Replacement)>,
    /// White acceleration density with which the estimator walks: that of the mixture.
    density: f64,
    /// Relative position and velocity of the newest estimate, 6.
    relative: Vector6<f64>,
}

/// What all members share of a step.
pub(in crate::laws) struct Shared {
    /// Time since the last step.
    pub dt: f64,
    /// Relative position and velocity of the estimate before it, 6.
    pub relative: Vector6<f64>,
    /// Transition of position and velocity, 6x6.
    pub f: Matrix6<f64>,
    /// What everything but the law's process noise has added to their covariance, 6x6: errors of the chaser, an unsure thrust.
    pub common: Matrix6<f64>,
    /// What was measured.
    pub seen: Seen,
    /// By how much the first pass of the update has moved the centre; what later passes make of nonlinear rows, members share.
    correction: Vector6<f64>,
    /// Where there is no earlier step: covariance of the centre before the update, without its own process noise. What is known of
    /// the start must not be lost to the noise of the largest member.
    first: Option<Matrix6<f64>>,
    /// The estimator's own after the update.
    post: Matrix6<f64>,
    /// What the mixture makes of the sample: normalised innovation squared, and variances of the rows.
    predicted: (f64, RowVector),
}

impl Centre {
    /// * `r`: noise variances of the rows in the places of the layout, internal units.
    /// * `density`: of white acceleration, up to the first sample.
    pub(in crate::laws) fn new(r: RowVector, density: f64) -> Self {
        Self {
            r,
            last: None,
            density,
            relative: Vector6::zeros(),
        }
    }

    /// What the members need of a step.
    pub(in crate::laws) fn shared(&self, step: &Step) -> Shared {
        let six = |m: &TargetMatrix| m.fixed_view::<6, 6>(0, 0).into_owned();
        let (f, prior) = (six(&step.f), six(&step.p_prior));
        let walk = white(self.density, step.dt);
        let carried = |p: &Matrix6<f64>| spd::carried(&f, p).1;
        let (common, mixture_prior) = match &self.last {
            None => (Matrix6::zeros(), prior),
            Some((before, said)) => {
                let common = as_covariance(prior - carried(before) - walk, &prior);
                (common, carried(&said.p) + common + walk)
            }
        };
        let seen = Seen::new(step, &self.r);
        Shared {
            dt: step.dt,
            relative: self.relative,
            f,
            common,
            seen,
            correction: step.linear.fixed_rows::<6>(0).into_owned(),
            first: self.last.is_none().then(|| as_covariance(prior - walk, &prior)),
            post: six(&step.p_post),
            predicted: predicted(mixture_prior, &seen),
        }
    }

    /// Takes note of the newest estimate: relative position and velocity, 6.
    pub(in crate::laws) fn look(&mut self, relative: &Vector6<f64>) {
        self.relative = *relative;
    }

    /// The mixture stands from now on, and walks with this white acceleration density.
    pub(in crate::laws) fn say(&mut self, shared: &Shared, Moments { mean, p }: Moments, density: f64) {
        let said = Replacement {
            shift: mean,
            p,
            nis: shared.predicted.0,
            variance: shared.predicted.1,
        };
        self.last = Some((shared.post, said));
        self.density = density;
    }

    /// What stands in place of the estimator's own.
    pub(in crate::laws) fn said(&self) -> Option<&Replacement> {
        self.last.as_ref().map(|(_, said)| said)
    }

    /// As [`crate::laws::Adaptation::excess`].
    pub(in crate::laws) fn excess(&self, f: &Matrix6<f64>) -> Option<Matrix6<f64>> {
        self.last.as_ref().map(|(own, said)| spd::carried(f, &(said.p - own)).1)
    }

    /// White acceleration density of the mixture.
    pub(in crate::laws) fn density(&self) -> f64 {
        self.density
    }
}

/// Normalised innovation squared of a sample, and variances of its rows, under a covariance before it.
fn predicted(prior: Matrix6<f64>, seen: &Seen) -> (f64, RowVector) {
    let mut member = Member::<6> {
        dx: Vector6::zeros(),
        p: prior,
    };
    let (mut nis, mut variance) = (0.0, RowVector::zeros());
    for row in seen.iter() {
        variance[row.place] = (row.h * prior * row.h.transpose())[0] + row.r;
        let taken = member.take(row);
        nis += taken.innovation * taken.innovation / taken.s;
    }
    (nis, variance)
}

impl Shared {
    /// A step in which the centre stays where it is.
    #[cfg(test)]
    pub(super) fn of(dt: f64, f: Matrix6<f64>, seen: Seen) -> Self {
        Self {
            dt,
            relative: Vector6::new(0.0, 100.0, 0.0, 1.0, 0.0, 0.0),
            f,
            common: Matrix6::zeros(),
            seen,
            correction: Vector6::zeros(),
            first: None,
            post: Matrix6::zeros(),
            predicted: (0.0, RowVector::zeros()),
        }
    }

    /// A member through the step; its deviation is then from the centre's mean after the update.
    ///
    /// * `f`: transition into position and velocity, 6 x D; `noise`: its own process noise, D x D.
    /// * `acceleration`: variance of the acceleration that it starts with, where it has one.
    /// * returns: log-likelihood of the sample.
    pub(in crate::laws) fn take<const D: usize>(
        &self,
        member: &mut Member<D>,
        f: &SMatrix<f64, 6, D>,
        noise: &SMatrix<f64, D, D>,
        acceleration: f64,
    ) -> f64 {
        self.predict(member, f, noise, acceleration);
        let log_likelihood = member.update(&self.seen);
        self.follow(member);
        log_likelihood
    }

    /// The time update of a member; at the first sample it begins with what the centre began with.
    pub(in crate::laws) fn predict<const D: usize>(
        &self,
        member: &mut Member<D>,
        f: &SMatrix<f64, 6, D>,
        noise: &SMatrix<f64, D, D>,
        acceleration: f64,
    ) {
        match &self.first {
            Some(first) => {
                member.dx = SVector::zeros();
                member.p = SMatrix::zeros();
                (6..D).for_each(|i| member.p[(i, i)] = acceleration);
                member.predict(f, noise, first);
            }
            None => member.predict(f, noise, &self.common),
        }
    }

    /// Makes the deviation of a member, from the centre's mean before the update, one from that after it.
    pub(in crate::laws) fn follow<const D: usize>(&self, member: &mut Member<D>) {
        let mut deviation = member.dx.fixed_rows_mut::<6>(0);
        deviation -= self.correction;
    }

    /// Transition from nine states into position and velocity, 6x9, the acceleration held: its effect by the trapezoidal rule over
    /// the interval, exact but for the gravity gradient's share of it.
    pub(in crate::laws) fn with_acceleration(&self) -> SMatrix<f64, 6, 9> {
        let mut f = SMatrix::<f64, 6, 9>::zeros();
        f.fixed_view_mut::<6, 6>(0, 0).copy_from(&self.f);
        let half = self.dt / 2.0;
        for axis in 0..3 {
            for state in 0..6 {
                let at_start = f64::from(u8::from(state == 3 + axis));
                f[(state, 6 + axis)] = half * (at_start + self.f[(state, 3 + axis)]);
            }
        }
        f
    }
}

/// Process noise of white acceleration over `dt` in position and velocity, 6x6.
pub(in crate::laws) fn white(density: f64, dt: f64) -> Matrix6<f64> {
    jerk::white_acceleration(density, dt)
        .fixed_view::<6, 6>(0, 0)
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, Vector3};

    /// A start whose velocity is known to 1e-8, and a bank whose loudest member walks by 0.1: the quiet member must still know it.
    #[test]
    fn a_member_begins_with_what_is_known_of_the_start_and_its_own_noise() {
        let (dt, quiet, loud) = (1.0, 4e-12, 1e-2);
        let start = Matrix6::from_diagonal(&Vector6::new(9.0, 9.0, 9.0, 1e-16, 1e-16, 1e-16));
        let mut f = Matrix6::identity();
        f.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(dt);
        let mut nine = TargetMatrix::identity();
        nine.fixed_view_mut::<6, 6>(0, 0).copy_from(&f);
        let mut step = Step::blank(dt, nine);
        let prior = f * start * f.transpose() + white(loud, dt);
        step.p_prior.fixed_view_mut::<6, 6>(0, 0).copy_from(&prior);
        let shared = Centre::new(RowVector::zeros(), loud).shared(&step);
        let mut member = Member::<6> {
            dx: Vector6::zeros(),
            p: Matrix6::zeros(),
        };
        shared.predict(&mut member, &f, &white(quiet, dt), 0.0);
        let velocity = |p: Matrix6<f64>| p.diagonal().fixed_rows::<3>(3).into_owned();
        let expected = Vector3::repeat(1e-16 + quiet * dt);
        // Of 1e-2 the last digit is 2e-18.
        assert!((velocity(member.p) - expected).amax() < 1e-17, "{}", velocity(member.p));
        let mut walking = Member::<9> {
            dx: SVector::zeros(),
            p: SMatrix::zeros(),
        };
        let with = shared.with_acceleration();
        shared.predict(&mut walking, &with, &SMatrix::zeros(), 1e-6);
        // The acceleration of the start has acted since then.
        assert!((walking.p[(3, 3)] - (1e-6 * dt * dt)).abs() < 1e-12, "{}", walking.p);
    }
}
