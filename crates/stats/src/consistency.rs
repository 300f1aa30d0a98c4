//! Normalised estimation error squared, and the chi-square bounds a consistent filter stays in.

use nalgebra::{SMatrix, SVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::StatsError;

/// Largest asymmetry taken for rounding, relative to the sigmas of row and column.
const SYMMETRY_TOLERANCE: f64 = 1e-6;

/// Normalised estimation error squared e^T P^-1 e over the first `dimension` states, not divided by their number.
///
/// * `error`: estimate minus truth, ordered and in units as `covariance`.
/// * returns: chi-square of `dimension` degrees of freedom when the filter is consistent.
///
/// # Errors
/// [`StatsError::Dimension`], [`StatsError::NotSymmetric`], [`StatsError::NotPositiveDefinite`]. The matrix is never
/// repaired: a filter whose covariance has broken down is to be counted.
pub fn nees(error: &SVector<f64, 9>, covariance: &SMatrix<f64, 9, 9>, dimension: usize) -> Result<f64, StatsError> {
    if !(1..=9).contains(&dimension) {
        return Err(StatsError::Dimension { dimension });
    }
    // An identity in the unused rows keeps the matrix size fixed and leaves the leading block alone.
    let mut p = SMatrix::<f64, 9, 9>::identity();
    let mut e = SVector::<f64, 9>::zeros();
    for i in 0..dimension {
        e[i] = error[i];
        for j in 0..dimension {
            p[(i, j)] = covariance[(i, j)];
        }
    }
    // What is above the diagonal too, which no factor reads.
    if !p.iter().all(|v| v.is_finite()) {
        return Err(StatsError::NotPositiveDefinite { dimension });
    }
    for i in 0..dimension {
        for j in 0..i {
            let difference = p[(i, j)] - p[(j, i)];
            if difference.abs() > SYMMETRY_TOLERANCE * (p[(i, i)] * p[(j, j)]).abs().sqrt() {
                return Err(StatsError::NotSymmetric {
                    row: i + 1,
                    column: j + 1,
                    difference,
                });
            }
        }
    }
    let factor = p.cholesky().ok_or(StatsError::NotPositiveDefinite { dimension })?;
    factor.l_dirty().solve_lower_triangular_unchecked_mut(&mut e);
    Ok(e.norm_squared())
}

/// Two-sided bounds of a mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Bounds {
    /// Whether the value is within the bounds.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// Bounds of the mean over `runs` independent runs of a chi-square of `dimension` degrees of freedom, divided by
/// `dimension`, so that they lie about 1.
///
/// * `confidence`: two-sided probability, such as 0.95.
///
/// They hold at one epoch. The mean over time as well is no sharper by the number of epochs, since the error of a
/// filter at one epoch is much the same as at the next.
///
/// # Errors
/// [`StatsError::Bounds`] for no runs, no degrees of freedom, or a confidence not between 0 and 1.
pub fn mean_chi_square_bounds(runs: usize, dimension: usize, confidence: f64) -> Result<Bounds, StatsError> {
    let refused = StatsError::Bounds {
        runs,
        dimension,
        confidence,
    };
    let freedom = (runs * dimension) as f64;
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(refused);
    }
    let chi_square = ChiSquared::new(freedom).map_err(|_| refused)?;
    let tail = 0.5 * (1.0 - confidence);
    Ok(Bounds {
        low: chi_square.inverse_cdf(tail) / freedom,
        high: chi_square.inverse_cdf(1.0 - tail) / freedom,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use numerics::{Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn random_spd(seed: u64) -> SMatrix<f64, 9, 9> {
        let mut generator = stream(seed, 0, Source::Lidar);
        let a = SMatrix::<f64, 9, 9>::from_fn(|_, _| StandardNormal.sample(&mut generator));
        a * a.transpose() + SMatrix::identity() * 0.1
    }

    #[test]
    fn nees_equals_the_form_with_an_explicit_inverse() {
        for seed in 0..20 {
            let p = random_spd(seed);
            let e = SVector::<f64, 9>::from_fn(|i, _| (i as f64 - 3.5) * 0.3);
            let full = (e.transpose() * p.try_inverse().unwrap() * e)[0];
            assert!((nees(&e, &p, 9).unwrap() / full - 1.0).abs() < 1e-10);
            let p6 = p.fixed_view::<6, 6>(0, 0).into_owned();
            let e6 = e.fixed_rows::<6>(0).into_owned();
            let six = (e6.transpose() * p6.try_inverse().unwrap() * e6)[0];
            assert!((nees(&e, &p, 6).unwrap() / six - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn broken_covariances_are_refused() {
        let e = SVector::<f64, 9>::repeat(1.0);
        let mut p = SMatrix::<f64, 9, 9>::identity();
        p[(4, 4)] = -1e-3;
        assert_eq!(nees(&e, &p, 9), Err(StatsError::NotPositiveDefinite { dimension: 9 }));
        assert!((nees(&e, &p, 4).unwrap() - 4.0).abs() < 1e-15);
        p[(4, 4)] = 1.0;
        p[(2, 1)] = 0.1;
        assert_eq!(
            nees(&e, &p, 9),
            Err(StatsError::NotSymmetric {
                row: 3,
                column: 2,
                difference: 0.1
            })
        );
        p[(2, 1)] = 0.0;
        for (at, nothing) in [
            ((2, 1), f64::NAN),
            ((1, 2), f64::NAN),
            ((1, 2), f64::INFINITY),
            ((8, 8), f64::INFINITY),
        ] {
            let mut p = p;
            p[at] = nothing;
            assert_eq!(
                nees(&e, &p, 9),
                Err(StatsError::NotPositiveDefinite { dimension: 9 }),
                "{at:?}"
            );
        }
        for dimension in [0, 10] {
            assert_eq!(nees(&e, &p, dimension), Err(StatsError::Dimension { dimension }));
        }
    }

    #[test]
    fn bounds_match_printed_tables() {
        // Bar-Shalom, Li and Kirubarajan, Estimation with Applications (2001), Sec. 5.4.2: 50 runs of 2 states, 95 %:
        // [1.5, 2.6] for the mean NEES itself. Chi-square tables: 100 degrees, 2.5 % 74.22, 97.5 % 129.56.
        let b = mean_chi_square_bounds(50, 2, 0.95).unwrap();
        assert!((b.low * 100.0 - 74.22).abs() < 0.01 && (b.high * 100.0 - 129.56).abs() < 0.01);
        assert!((2.0 * b.low - 1.5).abs() < 0.05 && (2.0 * b.high - 2.6).abs() < 0.05);
        assert!(b.contains(1.0) && !b.contains(1.3) && !b.contains(0.7));
        // One degree of freedom: the square of the normal's 1.959964.
        let one = mean_chi_square_bounds(1, 1, 0.90).unwrap();
        assert!((one.high - 3.841459).abs() < 1e-5);
        // Many: normal approximation, mean 1 and sigma sqrt(2/n).
        let many = mean_chi_square_bounds(10_000, 9, 0.95).unwrap();
        assert!((many.high - 1.0 - 1.96 * (2.0 / 90_000.0_f64).sqrt()).abs() < 1e-4);
    }

    #[test]
    fn impossible_bounds_are_refused() {
        for (runs, dimension, confidence) in [(0, 9, 0.95), (10, 0, 0.95), (10, 9, 1.0), (10, 9, f64::NAN)] {
            assert!(matches!(
                mean_chi_square_bounds(runs, dimension, confidence),
                Err(StatsError::Bounds { .. })
            ));
        }
    }
}
