//! Mean and covariance of a mixture.

use super::covariance::positive;
use crate::error::FilterError;
use crate::state::RowVector;
use nalgebra::{Matrix6, Vector6};
use numerics::spd;
use serde::{Deserialize, Serialize};

/// Relative position and velocity as a law wants them in place of those of the update; internal units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Replacement {
    /// To be added to the mean, 6.
    pub shift: Vector6<f64>,
    /// The covariance, 6x6.
    pub p: Matrix6<f64>,
    /// Normalised innovation squared of the sample under the covariance before it.
    pub nis: f64,
    /// Variances of its rows then, in the places of the layout; zero where nothing was measured.
    pub variance: RowVector,
}

impl Replacement {
    /// The first thing wrong with it.
    pub(crate) fn defect(&self, t_s: f64) -> Option<FilterError> {
        if !self.p.iter().all(|v| v.is_finite()) {
            return Some(FilterError::NotFinite { t_s });
        }
        let negative = self.p.diagonal().iter().position(|v| *v < 0.0);
        negative.map(|i| FilterError::NegativeVariance { t_s, state: i + 1 })
    }
}

/// Share of a second moment that is so little that rounding counts in it.
const LITTLE: f64 = 1e-8;

/// Mean and covariance of a mixture; internal units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::laws) struct Moments {
    /// 6.
    pub mean: Vector6<f64>,
    /// 6x6.
    pub p: Matrix6<f64>,
}

/// A mixture of normal densities while it is added up; weights need not sum to one.
#[derive(Clone, Debug, Default)]
pub(in crate::laws) struct Mixture {
    weight: f64,
    first: Vector6<f64>,
    second: Matrix6<f64>,
}

impl Mixture {
    /// A mixture by its sums: of the weights, of the means times these, and of the second moments about zero times these.
    pub(in crate::laws) fn of_sums(weight: f64, first: Vector6<f64>, second: Matrix6<f64>) -> Self {
        Self { weight, first, second }
    }

    /// Adds a part with this weight, mean and covariance.
    pub(in crate::laws) fn add(&mut self, weight: f64, mean: &Vector6<f64>, covariance: &Matrix6<f64>) {
        self.weight += weight;
        self.first.axpy(weight, mean, 1.0);
        self.second += covariance * weight;
        self.second.ger(weight, mean, mean, 1.0);
    }

    /// Mean and covariance of all of it.
    pub(in crate::laws) fn moments(&self) -> Moments {
        let mean = self.first / self.weight;
        let second = self.second / self.weight;
        let mut p = second;
        p.ger(-1.0, &mean, &mean, 1.0);
        let mut p = spd::symmetrised(&p);
        // Far from zero, the means take the digits of the covariance with them.
        if (0..6).any(|i| p[(i, i)] < LITTLE * second[(i, i)]) {
            p = positive(p, &second);
        }
        Moments { mean, p }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parts, by the formula for two; weights that do not sum to one, and the first part by its sums.
    #[test]
    fn two_parts() {
        let means = [Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0), Vector6::repeat(-0.5)];
        let covariances = [Matrix6::identity() * 2.0, Matrix6::identity() * 0.3];
        let about_zero = covariances[0] + means[0] * means[0].transpose();
        let mut mixture = Mixture::of_sums(3.0, means[0] * 3.0, about_zero * 3.0);
        mixture.add(1.0, &means[1], &covariances[1]);
        let Moments { mean, p } = mixture.moments();
        let apart = means[0] - means[1];
        let expected = covariances[0] * 0.75 + covariances[1] * 0.25 + apart * apart.transpose() * (0.75 * 0.25);
        assert!((mean - means[0] * 0.75 - means[1] * 0.25).amax() < 1e-14);
        assert!((p - expected).amax() < 1e-13);
    }
}
