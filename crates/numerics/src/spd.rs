//! Helpers for symmetric matrices.

use nalgebra::SMatrix;

/// (m + m^T) / 2, to keep rounding from making a covariance lopsided.
pub fn symmetrised<const N: usize>(m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (m + m.transpose()) * 0.5
}
