//! Helpers for symmetric positive definite matrices.

use nalgebra::{SMatrix, SVector};

/// (m + m^T) / 2, to keep rounding from making a covariance lopsided.
pub fn symmetrised<const N: usize>(m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (m + m.transpose()) * 0.5
}

/// Lower Cholesky factor of a symmetric matrix, or `None` when it is not positive definite.
///
/// Works on the stack for any size (nalgebra's own factor allocates nothing either, but asks for dimension traits).
pub fn cholesky<const N: usize>(m: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>> {
    let mut l = SMatrix::<f64, N, N>::zeros();
    for j in 0..N {
        let mut d = m[(j, j)];
        for k in 0..j {
            d -= l[(j, k)] * l[(j, k)];
        }
        // Also refuses NaN.
        if !(d > 0.0 && d.is_finite()) {
            return None;
        }
        let d = d.sqrt();
        l[(j, j)] = d;
        for i in j + 1..N {
            let mut s = m[(i, j)];
            for k in 0..j {
                s -= l[(i, k)] * l[(j, k)];
            }
            l[(i, j)] = s / d;
        }
    }
    Some(l)
}

/// Solution y of L y = b for a lower triangular L with non-zero diagonal.
pub fn forward_substitution<const N: usize>(l: &SMatrix<f64, N, N>, b: &SVector<f64, N>) -> SVector<f64, N> {
    let mut y = *b;
    for i in 0..N {
        for k in 0..i {
            y[i] -= l[(i, k)] * y[k];
        }
        y[i] /= l[(i, i)];
    }
    y
}

/// Solution x of L L^T x = b, given the Cholesky factor L.
pub fn cholesky_solve<const N: usize>(l: &SMatrix<f64, N, N>, b: &SVector<f64, N>) -> SVector<f64, N> {
    let mut x = forward_substitution(l, b);
    for i in (0..N).rev() {
        for k in i + 1..N {
            x[i] -= l[(k, i)] * x[k];
        }
        x[i] /= l[(i, i)];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn factor_and_solution_reproduce_the_system() {
        let m = Matrix3::new(4.0, 1.0, -2.0, 1.0, 9.0, 0.5, -2.0, 0.5, 6.0);
        let l = cholesky(&m).unwrap();
        assert!((l * l.transpose() - m).amax() < 1e-14);
        let b = Vector3::new(1.0, -2.0, 3.0);
        assert!((m * cholesky_solve(&l, &b) - b).amax() < 1e-14);
    }

    #[test]
    fn indefinite_and_nan_are_refused() {
        assert!(cholesky(&Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0)).is_none());
        assert!(cholesky(&Matrix3::repeat(f64::NAN)).is_none());
    }
}
