//! One filter of a bank.

use super::rows::{Row, Seen};
use nalgebra::{Matrix6, SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// A filter by its deviation from the centre: relative position and velocity, and in nine states an acceleration of which the
/// centre knows nothing. Internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::laws) struct Member<const D: usize> {
    /// Its mean minus the centre, D.
    pub dx: SVector<f64, D>,
    /// Its covariance, D x D.
    pub p: SMatrix<f64, D, D>,
}

/// What one row did to a member.
pub(super) struct Taken<const D: usize> {
    /// Gain, D.
    pub gain: SVector<f64, D>,
    /// Innovation of the member itself.
    pub innovation: f64,
    /// Its variance.
    pub s: f64,
}

impl<const D: usize> Member<D> {
    /// Time update: F dx, F P F' + noise.
    ///
    /// * `f`: transition, D x D.
    /// * `noise`: process noise of the member's own, D x D.
    /// * `common`: what everything else adds to position and velocity, 6x6.
    pub(in crate::laws) fn predict(
        &mut self,
        f: &SMatrix<f64, D, D>,
        noise: &SMatrix<f64, D, D>,
        common: &Matrix6<f64>,
    ) {
        self.dx = f * self.dx;
        self.p = f * self.p * f.transpose() + noise;
        let mut own = self.p.fixed_view_mut::<6, 6>(0, 0);
        own += common;
        self.p = (self.p + self.p.transpose()) * 0.5;
    }

    /// Takes one row in.
    pub(super) fn take(&mut self, row: &Row) -> Taken<D> {
        let ph: SVector<f64, D> = self.p.fixed_columns::<6>(0) * row.h.transpose();
        let s = (row.h * ph.fixed_rows::<6>(0))[0] + row.r;
        let innovation = row.innovation - (row.h * self.dx.fixed_rows::<6>(0))[0];
        let gain = ph / s;
        self.dx += gain * innovation;
        self.p.ger(-1.0, &gain, &ph, 1.0);
        Taken { gain, innovation, s }
    }

    /// Measurement update with every row.
    ///
    /// * returns: log-likelihood of the sample, without the part that all members share.
    pub(in crate::laws) fn update(&mut self, seen: &Seen) -> f64 {
        seen.iter().map(|row| self.take(row).log_likelihood()).sum()
    }
}

impl<const D: usize> Taken<D> {
    /// -1/2 (v^2 / s + ln s).
    pub(super) fn log_likelihood(&self) -> f64 {
        -0.5 * (self.innovation * self.innovation / self.s + self.s.ln())
    }
}
