//! Process noise of a random jerk.

use crate::state::TargetMatrix;
use nalgebra::{Matrix3, Vector3};

/// Covariance of (r, v, a) of one axis after white jerk of unit density has acted over `dt`.
///
/// Source: Mamich and Zanetti, Eq. (27).
pub fn gamma(dt: f64) -> Matrix3<f64> {
    let (d2, d3, d4, d5) = (dt.powi(2) / 2.0, dt.powi(3), dt.powi(4) / 8.0, dt.powi(5) / 20.0);
    Matrix3::new(d5, d4, d3 / 6.0, d4, d3 / 3.0, d2, d3 / 6.0, d2, dt)
}

/// Lower Cholesky factor of [`gamma`], in closed form and therefore without loss for any `dt`.
pub fn gamma_factor(dt: f64) -> Matrix3<f64> {
    let (r5, r3) = (5.0_f64.sqrt(), 3.0_f64.sqrt());
    let unit = Matrix3::new(
        r5 / 10.0,
        0.0,
        0.0,
        r5 / 4.0,
        r3 / 12.0,
        0.0,
        r5 / 3.0,
        r3 / 3.0,
        1.0 / 3.0,
    );
    let scale = Vector3::new(dt.powf(2.5), dt.powf(1.5), dt.sqrt());
    Matrix3::from_diagonal(&scale) * unit
}

/// Discrete process noise of a random jerk acting over one step.
///
/// * `q_psd`: jerk power spectral density of the three axes N (the diagonal of Q), internal units (m2/s5 in SI).
/// * `dt`: propagation interval, positive.
/// * returns: `q_hat`, 9x9, ordered r, v, a; positive definite when every entry of `q_psd` is positive.
///
/// Source: Mamich and Zanetti, Eq. (27).
pub fn process_noise(q_psd: &Vector3<f64>, dt: f64) -> TargetMatrix {
    let g = gamma(dt);
    TargetMatrix::from_fn(|i, j| {
        if i % 3 == j % 3 {
            g[(i / 3, j / 3)] * q_psd[i % 3]
        } else {
            0.0
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

    /// Van Loan's construction: exp([[-A, L q L^T], [0, A^T]] dt) holds F^T and F^-1 Q_hat.
    #[test]
    fn process_noise_agrees_with_van_loan() {
        let q = Vector3::new(2.0, 0.5, 3e-4);
        for dt in [0.25, 1.0, 7.0] {
            let mut a = TargetMatrix::zeros();
            let mut lq = TargetMatrix::zeros();
            for i in 0..6 {
                a[(i, i + 3)] = 1.0;
            }
            for i in 0..3 {
                lq[(6 + i, 6 + i)] = q[i];
            }
            let mut m = SMatrix::<f64, 18, 18>::zeros();
            m.fixed_view_mut::<9, 9>(0, 0).copy_from(&(-a * dt));
            m.fixed_view_mut::<9, 9>(0, 9).copy_from(&(lq * dt));
            m.fixed_view_mut::<9, 9>(9, 9).copy_from(&(a.transpose() * dt));
            let e = numerics::expm(&m);
            let f = e.fixed_view::<9, 9>(9, 9).transpose();
            let expected = f * e.fixed_view::<9, 9>(0, 9);
            let ours = process_noise(&q, dt);
            assert!((ours - expected).amax() < 1e-12 * expected.amax(), "dt = {dt}");
        }
    }

    #[test]
    fn factor_reproduces_gamma() {
        for dt in [1e-3, 0.5, 1.0, 40.0] {
            let (l, g) = (gamma_factor(dt), gamma(dt));
            for (ours, expected) in (l * l.transpose()).iter().zip(g.iter()) {
                assert!((ours - expected).abs() <= 1e-14 * expected, "dt = {dt}");
            }
        }
    }
}
