//! One filter of a bank.

use super::rows::{Row, Seen};
use crate::update::kalman::{add_variances, spread_of_rounding};
use nalgebra::{Matrix6, SMatrix, SVector};
use numerics::{math, spd};
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

/// Likelihood of a sample while its rows are taken, without the part that all members share. One logarithm for all rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Likelihood {
    /// Normalised innovation squared.
    nis: f64,
    /// Determinant of the innovation covariance over that of the noise: free of units, and no factor below one.
    det: f64,
}

impl Default for Likelihood {
    fn default() -> Self {
        Self { nis: 0.0, det: 1.0 }
    }
}

impl<const D: usize> Member<D> {
    /// Time update: F dx, F P F' + noise. What is beyond position and velocity stays as it is.
    ///
    /// * `f`: transition into position and velocity, 6 x D.
    /// * `noise`: process noise of the member's own, D x D.
    /// * `common`: what everything else adds to position and velocity, 6x6.
    pub(in crate::laws) fn predict(
        &mut self,
        f: &SMatrix<f64, 6, D>,
        noise: &SMatrix<f64, D, D>,
        common: &Matrix6<f64>,
    ) {
        let moved = f * self.dx;
        self.dx.fixed_rows_mut::<6>(0).copy_from(&moved);
        let (fp, own) = spd::carried(f, &self.p);
        self.p.fixed_view_mut::<6, 6>(0, 0).copy_from(&(own + common));
        for beyond in 6..D {
            let with_own = fp.column(beyond);
            self.p.fixed_view_mut::<6, 1>(0, beyond).copy_from(&with_own);
            self.p
                .fixed_view_mut::<1, 6>(beyond, 0)
                .copy_from(&with_own.transpose());
        }
        self.p += noise;
    }

    /// Takes one row in.
    pub(super) fn take(&mut self, row: &Row) -> Taken<D> {
        let ph: SVector<f64, D> = self.p.fixed_columns::<6>(0) * row.h.transpose();
        let s = (row.h * ph.fixed_rows::<6>(0))[0] + row.r;
        let innovation = row.innovation - (row.h * self.dx.fixed_rows::<6>(0))[0];
        let gain = ph / s;
        self.dx += gain * innovation;
        let rounding = spread_of_rounding(&self.p, std::iter::once((row.r, s)));
        self.p.ger(-1.0, &gain, &ph, 1.0);
        if let Some(rounding) = rounding {
            add_variances(&mut self.p, &rounding);
        }
        Taken { gain, innovation, s }
    }

    /// Measurement update with every row.
    ///
    /// * returns: log-likelihood of the sample, without the part that all members share.
    pub(in crate::laws) fn update(&mut self, seen: &Seen) -> f64 {
        let mut likelihood = Likelihood::default();
        seen.iter().for_each(|row| likelihood.add(row, &self.take(row)));
        likelihood.log()
    }
}

impl Likelihood {
    /// Of one row more.
    pub(super) fn add<const D: usize>(&mut self, row: &Row, taken: &Taken<D>) {
        self.nis += taken.innovation * taken.innovation / taken.s;
        // Two negative ones must not pass for a likelihood.
        self.det *= if taken.s > 0.0 { taken.s / row.r } else { f64::NAN };
    }

    /// -1/2 (v' S^-1 v + ln (det S / det R)).
    pub(super) fn log(&self) -> f64 {
        -0.5 * (self.nis + math::ln(self.det))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::update::kalman::{self, Gaussian, Measurement};
    use nalgebra::{RowVector6, SMatrix, Vector3};
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    /// Any mean, and a covariance with every cross term.
    fn of_nine_states(g: &mut Generator) -> Member<9> {
        let root = SMatrix::<f64, 9, 9>::from_fn(|_, _| normal(g));
        Member {
            dx: SVector::from_fn(|_, _| normal(g)),
            p: root * root.transpose() + SMatrix::identity(),
        }
    }

    /// Row by row against all rows at once, for a member with an acceleration of which nothing is measured.
    #[test]
    fn rows_one_after_the_other_are_the_update_of_all_at_once() {
        let g = &mut stream(3, 0, Source::Lidar);
        let mut member = of_nine_states(g);
        let mut dense = Gaussian {
            x: member.dx,
            p: member.p,
        };
        let rows: [Row; 3] = std::array::from_fn(|place| Row {
            place,
            h: RowVector6::from_fn(|_, _| normal(g)),
            innovation: normal(g),
            r: 0.1 + normal(g).abs(),
        });
        let mut h = SMatrix::<f64, 3, 9>::zeros();
        for (i, row) in rows.iter().enumerate() {
            h.fixed_view_mut::<1, 6>(i, 0).copy_from(&row.h);
        }
        let innovation = Vector3::from_fn(|i, _| rows[i].innovation) - h * dense.x;
        let measurement = Measurement {
            h,
            innovation,
            r: Vector3::from_fn(|i, _| rows[i].r),
        };
        let (_, expected) = kalman::update(&mut dense, &measurement, 0..0)
            .unwrap()
            .of_leading(&innovation, 3);
        let shared: f64 = rows.iter().map(|row| (2.0 * std::f64::consts::PI * row.r).ln()).sum();
        let log_likelihood = member.update(&Seen::of(&rows)) - 0.5 * shared;
        assert!((member.dx - dense.x).amax() < 1e-12);
        assert!((member.p - dense.p).amax() < 1e-12);
        assert!((log_likelihood - expected).abs() < 1e-12);
    }

    /// By the dense products of nine states.
    #[test]
    fn what_is_beyond_position_and_velocity_is_held() {
        let g = &mut stream(4, 0, Source::Lidar);
        let mut member = of_nine_states(g);
        let (dx, p) = (member.dx, member.p);
        let f = SMatrix::<f64, 6, 9>::from_fn(|_, _| normal(g));
        let mut dense = SMatrix::<f64, 9, 9>::identity();
        dense.fixed_view_mut::<6, 9>(0, 0).copy_from(&f);
        let (noise, common) = (SMatrix::identity() * 0.3, Matrix6::from_diagonal_element(0.2));
        let mut expected = dense * p * dense.transpose() + noise;
        let mut own = expected.fixed_view_mut::<6, 6>(0, 0);
        own += common;
        member.predict(&f, &noise, &common);
        assert!((member.dx - dense * dx).amax() < 1e-13);
        assert!(
            (member.p - expected).amax() < 1e-12 * expected.amax(),
            "{}",
            member.p - expected
        );
    }
}
