//! Helpers for symmetric positive definite matrices; their factors are nalgebra's.

use nalgebra::SMatrix;

/// (m + m^T) / 2, to keep rounding from making a covariance lopsided.
pub fn symmetrised<const N: usize>(m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (m + m.transpose()) * 0.5
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

    #[test]
    fn the_symmetric_part_has_the_mean_of_both_sides() {
        let m = symmetrised(&Matrix2::new(1.0, 3.0, 5.0, 2.0));
        assert!((m - Matrix2::new(1.0, 4.0, 4.0, 2.0)).amax() < f64::MIN_POSITIVE);
    }
}
