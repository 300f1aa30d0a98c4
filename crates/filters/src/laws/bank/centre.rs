//! The estimator's own mean and covariance, as the members see them.

use super::member::Member;
use super::mixture::Replacement;
use super::rows::Seen;
use crate::jerk;
use crate::laws::Step;
use crate::state::RowVector;
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use serde::{Deserialize, Serialize};

/// What the law said last, from which follows what of the centre's covariance is not of the law's making.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(in crate::laws) struct Centre {
    /// Noise variances of the rows, internal units.
    r: RowVector,
    /// What stands in place of the estimator's own; `None` before the first sample.
    said: Option<Replacement>,
    /// White acceleration density of the mixture.
    density: f64,
}

/// What all members share of a step.
pub(in crate::laws) struct Shared {
    /// Time since the last step.
    pub dt: f64,
    /// Transition of position and velocity, 6x6.
    pub f: Matrix6<f64>,
    /// What everything but the law's process noise has added to their covariance, 6x6: errors of the chaser, an unsure thrust.
    pub common: Matrix6<f64>,
    /// What was measured.
    pub seen: Seen,
    /// By how much the linear update of the centre has moved it.
    correction: Vector6<f64>,
    /// Covariance of the centre before the update where there is no earlier step.
    first: Option<Matrix6<f64>>,
}

impl Centre {
    /// * `r`: noise variances of the rows in the places of the layout, internal units.
    pub(in crate::laws) fn new(r: RowVector) -> Self {
        Self {
            r,
            ..Self::default()
        }
    }

    /// What the members need of a step.
    pub(in crate::laws) fn shared(&self, step: &Step) -> Shared {
        let f = step.f.fixed_view::<6, 6>(0, 0).into_owned();
        let prior = step.p_prior.fixed_view::<6, 6>(0, 0).into_owned();
        let common = self.said.as_ref().map_or_else(Matrix6::zeros, |said| {
            prior - f * said.p * f.transpose() - white(self.density, step.dt)
        });
        let seen = Seen::new(step, &self.r);
        let mut centre = Member::<6> {
            dx: Vector6::zeros(),
            p: prior,
        };
        centre.update(&seen);
        Shared {
            dt: step.dt,
            f,
            common,
            seen,
            correction: centre.dx,
            first: self.said.is_none().then_some(prior),
        }
    }

    /// The mixture stands from now on, and walks with this white acceleration density.
    pub(in crate::laws) fn say(&mut self, mixture: Replacement, density: f64) {
        self.said = Some(mixture);
        self.density = density;
    }

    /// What stands in place of the estimator's own.
    pub(in crate::laws) fn said(&self) -> Option<&Replacement> {
        self.said.as_ref()
    }

    /// White acceleration density of the mixture.
    pub(in crate::laws) fn density(&self) -> f64 {
        self.density
    }
}

impl Shared {
    /// A member through the step; its deviation is then from the centre's mean after the update.
    ///
    /// * `f`: transition of its states, D x D; `noise`: its own process noise, D x D.
    /// * `acceleration`: variance of the acceleration that it starts with, where it has one.
    /// * returns: log-likelihood of the sample.
    pub(in crate::laws) fn take<const D: usize>(
        &self,
        member: &mut Member<D>,
        f: &SMatrix<f64, D, D>,
        noise: &SMatrix<f64, D, D>,
        acceleration: f64,
    ) -> f64 {
        self.predict(member, f, noise, acceleration);
        let log_likelihood = member.update(&self.seen);
        self.follow(member);
        log_likelihood
    }

    /// The time update of a member; at the first sample it takes over the centre's covariance.
    pub(in crate::laws) fn predict<const D: usize>(
        &self,
        member: &mut Member<D>,
        f: &SMatrix<f64, D, D>,
        noise: &SMatrix<f64, D, D>,
        acceleration: f64,
    ) {
        match &self.first {
            Some(prior) => {
                member.dx = SVector::zeros();
                member.p = SMatrix::zeros();
                member.p.fixed_view_mut::<6, 6>(0, 0).copy_from(prior);
                (6..D).for_each(|i| member.p[(i, i)] = acceleration);
            }
            None => member.predict(f, noise, &self.common),
        }
    }

    /// Makes the deviation of a member, from the centre's mean before the update, one from that after it.
    pub(in crate::laws) fn follow<const D: usize>(&self, member: &mut Member<D>) {
        let mut deviation = member.dx.fixed_rows_mut::<6>(0);
        deviation -= self.correction;
    }

    /// Transition of nine states, the acceleration held: its effect on position and velocity by the trapezoidal rule over the
    /// interval, exact but for the gravity gradient's share of it.
    pub(in crate::laws) fn with_acceleration(&self) -> SMatrix<f64, 9, 9> {
        let mut f = SMatrix::<f64, 9, 9>::identity();
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
    jerk::white_acceleration(density, dt).fixed_view::<6, 6>(0, 0).into_owned()
}
