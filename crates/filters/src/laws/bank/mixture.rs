//! Mean and covariance of a mixture.

use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};

/// Relative position and velocity as a law wants them in place of those of the update; internal units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Replacement {
    /// To be added to the mean, 6.
    pub shift: Vector6<f64>,
    /// The covariance, 6x6.
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
    /// Adds a part with this weight, mean and covariance.
    pub(in crate::laws) fn add(&mut self, weight: f64, mean: &Vector6<f64>, covariance: &Matrix6<f64>) {
        self.add_second(weight, mean, covariance);
        self.second.ger(weight, mean, mean, 1.0);
    }

    /// Adds parts of this weight together, with this mean and this second moment about zero.
    pub(in crate::laws) fn add_second(&mut self, weight: f64, mean: &Vector6<f64>, second: &Matrix6<f64>) {
        self.weight += weight;
        self.first.axpy(weight, mean, 1.0);
        self.second += second * weight;
    }

    /// Mean and covariance of all of it.
    pub(in crate::laws) fn moments(&self) -> Replacement {
        let shift = self.first / self.weight;
        let mut p = self.second / self.weight;
        p.ger(-1.0, &shift, &shift, 1.0);
        Replacement {
            shift,
            p: (p + p.transpose()) * 0.5,
        }
    }
}
