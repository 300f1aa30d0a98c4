//! Helpers for symmetric positive definite matrices; their factors are nalgebra's.

use nalgebra::SMatrix;

/// (m + m^T) / 2, to keep rounding from making a covariance lopsided.
pub fn symmetrised<const N: usize>(m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (m + m.transpose()) * 0.5
}

/// Copies what is below the diagonal above it.
pub fn mirror<const N: usize>(m: &mut SMatrix<f64, N, N>) {
    for j in 1..N {
        let (before, from) = m.data.0.split_at_mut(j);
        for (above, column) in from[0].iter_mut().zip(before) {
            *above = column[j];
        }
    }
}

/// Whether a symmetric matrix is a covariance but for rounding: every variance positive, and no eigenvalue of its correlations below
/// -1e-9.
pub fn is_covariance<const N: usize>(p: &SMatrix<f64, N, N>) -> bool {
    /// Correlations lose digits where one state is known much better than what it hangs on.
    const ROUNDING: f64 = 1e-9;
    let mut lifted = *p;
    (0..N).for_each(|i| lifted[(i, i)] *= 1.0 + ROUNDING);
    p.diagonal().iter().all(|variance| *variance > 0.0) && lifted.cholesky().is_some()
}

/// B S^-1 from the lower Cholesky factor L of S: a Kalman gain from P H^T.
///
/// Whole columns of B are worked on, which for a tall B is several times as fast as nalgebra's solutions for the columns of B^T.
///
/// * `b`: R x N; `l`: N x N, its upper triangle is not read.
pub fn over<const R: usize, const N: usize>(b: &SMatrix<f64, R, N>, l: &SMatrix<f64, N, N>) -> SMatrix<f64, R, N> {
    let mut x = *b;
    let eliminate = |x: &mut SMatrix<f64, R, N>, i: usize, k: usize, factor: f64| {
        let known = x.column(k) * factor;
        let mut column = x.column_mut(i);
        column -= known;
    };
    for i in 0..N {
        (0..i).for_each(|k| eliminate(&mut x, i, k, l[(i, k)]));
        x.column_mut(i).unscale_mut(l[(i, i)]);
    }
    for i in (0..N).rev() {
        (i + 1..N).for_each(|k| eliminate(&mut x, i, k, l[(k, i)]));
        x.column_mut(i).unscale_mut(l[(i, i)]);
    }
    x
}

/// F P and F P F^T, a covariance P taken through a linear map F.
///
/// Whole columns are worked on, in loops whose lengths are known. The lower triangle of the second product is mirrored, which is
/// therefore symmetric to the bit.
///
/// * `f`: R x N; `p`: N x N, symmetric.
pub fn carried<const R: usize, const N: usize>(
    f: &SMatrix<f64, R, N>,
    p: &SMatrix<f64, N, N>,
) -> (SMatrix<f64, R, N>, SMatrix<f64, R, R>) {
    let (mut fp, mut fpf) = (SMatrix::<f64, R, N>::zeros(), SMatrix::<f64, R, R>::zeros());
    for j in 0..N {
        fp.data.0[j] = gathered(&f.data.0, |k| p.data.0[j][k]);
    }
    for j in 0..R {
        fpf.data.0[j] = gathered(&fp.data.0, |k| f.data.0[k][j]);
    }
    mirror(&mut fpf);
    (fp, fpf)
}

/// Sum of columns, each by its factor; held while it gathers. What a matrix by its columns makes of a vector.
#[inline(always)]
pub fn gathered<const R: usize, const N: usize>(columns: &[[f64; R]; N], factor: impl Fn(usize) -> f64) -> [f64; R] {
    let mut sum = [0.0; R];
    for (k, from) in columns.iter().enumerate() {
        let factor = factor(k);
        for (sum, from) in sum.iter_mut().zip(from) {
            *sum += from * factor;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3, SMatrix};

    #[test]
    fn over_divides_by_the_matrix() {
        let s = Matrix3::new(4.0, 1.0, -2.0, 1.0, 9.0, 0.5, -2.0, 0.5, 6.0);
        let b = SMatrix::<f64, 5, 3>::from_fn(|i, j| (i as f64 - 1.5) * (j as f64 + 0.3) + 0.1 * i as f64);
        let x = over(&b, &s.cholesky().unwrap().unpack_dirty());
        assert!((x * s - b).amax() < 1e-14, "{x}");
    }

    /// By nalgebra's products.
    #[test]
    fn carried_is_both_products() {
        let p = Matrix3::new(4.0, 1.0, -2.0, 1.0, 9.0, 0.5, -2.0, 0.5, 6.0);
        let f = SMatrix::<f64, 5, 3>::from_fn(|i, j| (i as f64 - 1.5) * (j as f64 + 0.3) + 0.1 * i as f64);
        let (fp, fpf) = carried(&f, &p);
        assert!((fp - f * p).amax() < 1e-13, "{fp}");
        assert!((fpf - f * p * f.transpose()).amax() < 1e-12, "{fpf}");
        assert_eq!(fpf, fpf.transpose());
        let wide = f.fixed_rows::<2>(1).into_owned();
        let (fp, fpf) = carried(&wide, &p);
        assert!((fp - wide * p).amax() < 1e-13 && (fpf - wide * p * wide.transpose()).amax() < 1e-12);
    }

    /// A correlation beyond one is none, in whatever units; one that is one but for rounding is.
    #[test]
    fn a_covariance_has_correlations_up_to_one() {
        for (correlation, expected) in [
            (0.9, true),
            (1.0, true),
            (-1.0 - 1e-12, true),
            (1.0 + 1e-6, false),
            (-2.0, false),
        ] {
            for (a, b) in [(1.0, 1.0), (1e6, 1e-9)] {
                let p = Matrix2::new(a * a, correlation * a * b, correlation * a * b, b * b);
                assert_eq!(is_covariance(&p), expected, "{correlation} {a} {b}");
            }
        }
        assert!(
            !is_covariance(&Matrix2::new(1.0, 0.0, 0.0, 0.0)) && !is_covariance(&Matrix2::new(1.0, 0.0, 0.0, -1.0))
        );
        assert!(!is_covariance(&Matrix2::new(1.0, f64::NAN, f64::NAN, 1.0)));
    }

    #[test]
    fn the_symmetric_part_has_the_mean_of_both_sides() {
        let m = symmetrised(&Matrix2::new(1.0, 3.0, 5.0, 2.0));
        assert!((m - Matrix2::new(1.0, 4.0, 4.0, 2.0)).amax() < f64::MIN_POSITIVE);
    }
}
