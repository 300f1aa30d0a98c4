//! The matrix exponential of small matrices.

use nalgebra::SMatrix;

use crate::math;

/// exp(`a`) by scaling, a Taylor series summed to rounding, and squaring.
///
/// Meant for `a = A dt` of an estimator: small, so the series ends after a handful of terms and nothing is inverted, and
/// mostly zero, so each term takes only the entries that are not.
///
/// * `a`: N x N, finite.
/// * returns: N x N; every entry is NaN when `a` is not finite.
pub fn expm<const N: usize>(a: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let norm = (0..N).map(|j| a.column(j).abs().sum()).fold(0.0, f64::max);
    if !norm.is_finite() {
        return SMatrix::repeat(f64::NAN);
    }
    // A norm of 2 costs a few more terms and saves the squarings of the usual dt = 1 s.
    let squarings = if norm > 2.0 {
        math::log2(norm / 2.0).ceil() as i32
    } else {
        0
    };
    let scaled = a * 2.0_f64.powi(-squarings);
    let mut sum = SMatrix::<f64, N, N>::identity();
    let mut term = sum;
    for k in 1..40 {
        let mut next = SMatrix::<f64, N, N>::zeros();
        for j in 0..N {
            for i in (0..N).filter(|i| scaled[(*i, j)] != 0.0) {
                next.column_mut(j)
                    .axpy(scaled[(i, j)] / f64::from(k), &term.column(i), 1.0);
            }
        }
        term = next;
        sum += term;
        if term.amax() <= f64::EPSILON * 1e-3 {
            break;
        }
    }
    for _ in 0..squarings {
        sum *= sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix3};

    #[test]
    fn rotation_generator_gives_a_rotation() {
        for angle in [0.1_f64, 1.0, 7.5] {
            let r = expm(&Matrix2::new(0.0, -angle, angle, 0.0));
            let exact = Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos());
            assert!((r - exact).amax() < 1e-14, "angle {angle}: {r}");
        }
    }

    #[test]
    fn nilpotent_series_is_exact() {
        let e = expm(&Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0));
        let exact = Matrix3::new(1.0, 1.0, 0.5, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0);
        assert!((e - exact).amax() < 1e-15);
    }

    #[test]
    fn exponentials_of_a_and_minus_a_are_inverse() {
        let a = Matrix3::new(0.3, 2.0, -1.0, 0.5, -0.2, 4.0, 1.0, 0.7, -0.9);
        assert!((expm(&a) * expm(&-a) - Matrix3::identity()).amax() < 1e-11);
    }

    #[test]
    fn not_finite_in_not_finite_out() {
        assert!(expm(&Matrix2::new(f64::INFINITY, 0.0, 0.0, 0.0))[(0, 0)].is_nan());
    }
}
