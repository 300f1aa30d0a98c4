//! The measurement update of the Kalman filter for any states, some of which may be consider states.
//!
//! Pure functions of mean and covariance, written once, so that a difference in results is a difference in the law.

use crate::error::FilterError;
use crate::state::N;
use nalgebra::{Cholesky, Const, SMatrix, SVector};
use numerics::{math, spd};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Mean and covariance of D states, internal units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gaussian<const D: usize = N> {
    /// The states, D.
    pub x: SVector<f64, D>,
    /// Their covariance, D x D.
    pub p: SMatrix<f64, D, D>,
}

/// Measurement rows: H, the innovation and the noise variances of M measurements.
#[derive(Clone, Debug)]
pub struct Measurement<const M: usize, const D: usize = N> {
    /// Partials by the D states, M x D.
    pub h: SMatrix<f64, M, D>,
    /// Measured minus predicted, M.
    pub innovation: SVector<f64, M>,
    /// Diagonal of R, M.
    pub r: SVector<f64, M>,
}

/// The update failed: S has no Cholesky factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSpd {
    /// Smallest diagonal entry of S.
    pub min_diagonal: f64,
}

impl NotSpd {
    /// As the error of the sample at this epoch.
    pub(crate) fn at(self, t_s: f64) -> FilterError {
        FilterError::InnovationNotSpd {
            t_s,
            min_diagonal: self.min_diagonal,
        }
    }
}

/// The innovation covariance of an update.
#[derive(Clone, Debug)]
pub struct Innovated<const M: usize> {
    /// S, M x M.
    pub s: SMatrix<f64, M, M>,
    factor: Cholesky<f64, Const<M>>,
}

impl<const M: usize> Innovated<M> {
    /// Normalised innovation squared and log-likelihood of the first `rows` rows, with their block of S.
    ///
    /// * returns: v^T S^-1 v, and -1/2 (v^T S^-1 v + ln det S + rows ln 2 pi), in internal units.
    pub fn of_leading(&self, innovation: &SVector<f64, M>, rows: usize) -> (f64, f64) {
        // The leading block of a Cholesky factor is the factor of the leading block, and so are the first entries of the
        // solution those of its solution.
        let l = self.factor.l_dirty();
        let mut whitened = *innovation;
        l.solve_lower_triangular_unchecked_mut(&mut whitened);
        let nis = whitened.iter().take(rows).map(|w| w * w).sum::<f64>();
        // One logarithm for all rows; a determinant of thirteen rows is far from overflow in any units.
        let root_det: f64 = l.diagonal().iter().take(rows).product();
        let log_likelihood = -0.5 * (nis + rows as f64 * math::ln(2.0 * std::f64::consts::PI)) - math::ln(root_det);
        (nis, log_likelihood)
    }
}

/// Measurement update, Eqs. (6) and (12): gain with the rows of the consider states zeroed, covariance in Joseph form,
/// which stays valid for that gain.
///
/// * `consider`: slots of the consider states.
/// * returns: the innovation covariance S and its factor.
///
/// # Errors
/// [`NotSpd`] when S cannot be factored; `est` is then unchanged.
pub fn update<const M: usize, const D: usize>(
    est: &mut Gaussian<D>,
    m: &Measurement<M, D>,
    consider: Range<usize>,
) -> Result<Innovated<M>, NotSpd> {
    let u = by_rows(&m.h, &est.p);
    let mut s = SMatrix::<f64, M, M>::zeros();
    for i in 0..M {
        for k in (0..D).filter(|k| m.h[(i, *k)] != 0.0) {
            for j in 0..=i {
                s[(i, j)] += m.h[(i, k)] * u.data.0[j][k];
            }
        }
        s[(i, i)] += m.r[i];
    }
    spd::mirror(&mut s);
    let factor = s.cholesky().ok_or(NotSpd {
        min_diagonal: s.diagonal().min(),
    })?;
    let mut k = spd::over(&u, factor.l_dirty());
    k.rows_range_mut(consider).fill(0.0);
    est.x += k * m.innovation;
    let rounding = spread_of_rounding(&est.p, (0..M).map(|i| (m.r[i], s[(i, i)])));
    // (I - K H) P (I - K H)^T + K R K^T as P - K U^T - (U - K S) K^T, with U = P H^T: no product of D^3. What stands in brackets
    // is zero but for rounding, and but for the consider states.
    let rest = u - k * s;
    take(&mut est.p, &k, &u);
    take(&mut est.p, &rest, &k);
    spd::mirror(&mut est.p);
    if let Some(rounding) = rounding {
        add_variances(&mut est.p, &rounding);
    }
    Ok(Innovated { s, factor })
}

/// Variances by which rounding may be off in an update of P, D x D, where that is no longer small beside what is left: a measurement
/// that is worth so much more than what was known takes the digits of a variance with it, and leaves a matrix that is the covariance of
/// nothing.
///
/// * `rows`: variances of the noise and of the innovation of each row.
pub(crate) fn spread_of_rounding<const D: usize>(
    p: &SMatrix<f64, D, D>,
    mut rows: impl Iterator<Item = (f64, f64)>,
) -> Option<SVector<f64, D>> {
    /// A unit of the last place for each measurement, of which few filters take more than these.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;
    // Rounding is then a millionth of what is left.
    let lost = rows.any(|(noise, innovation)| noise < 1e6 * ROUNDING * innovation);
    lost.then(|| p.diagonal() * ROUNDING)
}

/// Adds to the variances of P, D x D.
pub(crate) fn add_variances<const D: usize>(p: &mut SMatrix<f64, D, D>, variances: &SVector<f64, D>) {
    for (i, variance) in variances.iter().enumerate() {
        p[(i, i)] += variance;
    }
}

/// P H^T, D x M, from the entries of H that are not zero: three of a range, eighteen at most.
fn by_rows<const M: usize, const D: usize>(h: &SMatrix<f64, M, D>, p: &SMatrix<f64, D, D>) -> SMatrix<f64, D, M> {
    let mut u = SMatrix::<f64, D, M>::zeros();
    for (row, column) in u.data.0.iter_mut().enumerate() {
        for (state, from) in p.data.0.iter().enumerate() {
            let by = h[(row, state)];
            if by != 0.0 {
                for (sum, value) in column.iter_mut().zip(from) {
                    *sum += by * value;
                }
            }
        }
    }
    u
}

/// Takes A B^T away from P, D x D, on and below the diagonal; what is above it comes by mirroring.
///
/// By parts of columns whose length is known, each held while it gathers what every measurement takes.
fn take<const M: usize, const D: usize>(p: &mut SMatrix<f64, D, D>, a: &SMatrix<f64, D, M>, b: &SMatrix<f64, D, M>) {
    const PART: usize = 6;
    for (j, column) in p.data.0.iter_mut().enumerate() {
        let (parts, rest) = column.as_chunks_mut::<PART>();
        let first = parts.len().min(j / PART);
        for (k, part) in parts.iter_mut().enumerate().skip(first) {
            let mut sum = *part;
            for m in 0..M {
                let (from, by) = (&a.data.0[m].as_chunks::<PART>().0[k], b.data.0[m][j]);
                for (value, from) in sum.iter_mut().zip(from) {
                    *value -= from * by;
                }
            }
            *part = sum;
        }
        let done = D - rest.len();
        for (i, value) in rest.iter_mut().enumerate() {
            for m in 0..M {
                *value -= a.data.0[m][done + i] * b.data.0[m][j];
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::state::{State, StateMatrix, idx};
    use nalgebra::Vector3;
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    fn random_spd(g: &mut Generator) -> StateMatrix {
        let a = StateMatrix::from_fn(|_, _| normal(g));
        a * a.transpose() + StateMatrix::identity()
    }

    /// Schmidt's filter by the general formulas, the inverse formed, on a covariance with every cross term.
    #[test]
    fn consider_update_agrees_with_the_general_formulas() {
        let g = &mut stream(1, 0, Source::Lidar);
        let mut est = Gaussian {
            x: State::from_fn(|_, _| normal(g)),
            p: random_spd(g),
        };
        let before = est.clone();
        let m = Measurement {
            h: SMatrix::<f64, 6, N>::from_fn(|_, _| normal(g)),
            innovation: SVector::<f64, 6>::from_fn(|_, _| normal(g)),
            r: SVector::<f64, 6>::from_fn(|i, _| 0.5 + i as f64),
        };
        let s = update(&mut est, &m, idx::CONSIDER).unwrap().s;
        let r = SMatrix::<f64, 6, 6>::from_diagonal(&m.r);
        let expected_s = m.h * before.p * m.h.transpose() + r;
        assert!((s - expected_s).amax() < 1e-10);
        let mut k = before.p * m.h.transpose() * expected_s.try_inverse().unwrap();
        k.fixed_rows_mut::<6>(idx::CONSIDER.start).fill(0.0);
        let i_kh = StateMatrix::identity() - k * m.h;
        let p = i_kh * before.p * i_kh.transpose() + k * r * k.transpose();
        assert!((est.p - p).amax() < 1e-10);
        assert!((est.x - before.x - k * m.innovation).amax() < 1e-11);
        assert_eq!(est.x.fixed_rows::<6>(9), before.x.fixed_rows::<6>(9));
        assert!(
            (est.p - before.p).fixed_view::<6, 6>(9, 9).amax() < 1e-11,
            "consider states keep their covariance"
        );
        assert!(est.p.cholesky().is_some());
    }

    #[test]
    fn a_covariance_that_is_not_positive_is_refused_and_kept() {
        let mut est = Gaussian {
            x: State::zeros(),
            p: -StateMatrix::identity(),
        };
        let before = est.clone();
        let mut h = SMatrix::<f64, 3, N>::zeros();
        h.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        let m = Measurement {
            h,
            innovation: Vector3::zeros(),
            r: Vector3::repeat(0.5),
        };
        assert_eq!(
            update(&mut est, &m, idx::CONSIDER).unwrap_err(),
            NotSpd { min_diagonal: -0.5 }
        );
        assert_eq!(est, before);
    }

    /// By the density of a normal vector written out, its determinant and inverse from elsewhere.
    #[test]
    fn likelihood_is_that_of_the_leading_rows() {
        let g = &mut stream(2, 0, Source::Lidar);
        let mut est = Gaussian {
            x: State::zeros(),
            p: random_spd(g),
        };
        let m = Measurement {
            h: SMatrix::<f64, 5, N>::from_fn(|_, _| normal(g)),
            innovation: SVector::<f64, 5>::from_fn(|_, _| normal(g)),
            r: SVector::<f64, 5>::repeat(0.3),
        };
        let found = update(&mut est, &m, idx::CONSIDER).unwrap();
        let block = found.s.fixed_view::<3, 3>(0, 0).into_owned();
        let v = m.innovation.fixed_rows::<3>(0).into_owned();
        let nis = (v.transpose() * block.try_inverse().unwrap() * v)[0];
        let density = (-0.5 * nis).exp() / ((2.0 * std::f64::consts::PI).powi(3) * block.determinant()).sqrt();
        let (ours, log_likelihood) = found.of_leading(&m.innovation, 3);
        assert!((ours / nis - 1.0).abs() < 1e-10 && (log_likelihood - density.ln()).abs() < 1e-10);
    }
}
