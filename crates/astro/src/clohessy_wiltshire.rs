//! Linear relative motion about a circular orbit.

use nalgebra::{Matrix3, Matrix6, Vector3};
use numerics::math;
use serde::{Deserialize, Serialize};

/// Clohessy-Wiltshire model, LVLH axes of [`crate::relative`], state (rho, rho_dot).
///
/// Source: Pesce, Silvestrini and Lavagna, Eq. (30).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClohessyWiltshire {
    /// Mean motion n of the target, rad/s, positive.
    pub mean_motion: f64,
}

impl ClohessyWiltshire {
    /// Model for a target with this period, s: n = 2 pi / T.
    pub fn from_period(period: f64) -> Self {
        Self {
            mean_motion: std::f64::consts::TAU / period,
        }
    }

    /// Model for a target with this semi-major axis, m, about a body of this gravitational parameter, m3/s2.
    pub fn from_semi_major_axis(a: f64, mu: f64) -> Self {
        Self {
            mean_motion: (mu / a).sqrt() / a,
        }
    }

    /// Relative acceleration, m/s2.
    pub fn acceleration(&self, rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> Vector3<f64> {
        let (by_rho, by_rho_dot) = self.partials();
        by_rho * rho + by_rho_dot * rho_dot
    }

    /// Partials of the acceleration by position, 1/s2, and by velocity, 1/s; 3x3 each and constant.
    pub fn partials(&self) -> (Matrix3<f64>, Matrix3<f64>) {
        let n = self.mean_motion;
        let by_rho = Matrix3::from_diagonal(&Vector3::new(3.0 * n * n, 0.0, -n * n));
        let by_rho_dot = Matrix3::new(0.0, 2.0 * n, 0.0, -2.0 * n, 0.0, 0.0, 0.0, 0.0, 0.0);
        (by_rho, by_rho_dot)
    }

    /// Exact state transition matrix over `dt`, s (of either sign): 6x6, ordered rho, rho_dot.
    pub fn transition(&self, dt: f64) -> Matrix6<f64> {
        let n = self.mean_motion;
        let phase = n * dt;
        let (s, c) = math::sin_cos(phase);
        // 1 - cos, without the cancellation over a short step.
        let k = 2.0 * math::sin(0.5 * phase).powi(2);
        let drift = 6.0 * (s - phase);
        #[rustfmt::skip]
        let phi = Matrix6::new(
            1.0 + 3.0 * k, 0.0, 0.0, s / n, 2.0 * k / n, 0.0,
            drift, 1.0, 0.0, -2.0 * k / n, 4.0 * s / n - 3.0 * dt, 0.0,
            0.0, 0.0, c, 0.0, 0.0, s / n,
            3.0 * n * s, 0.0, 0.0, c, 2.0 * s, 0.0,
            -6.0 * n * k, 0.0, 0.0, -2.0 * s, 1.0 - 4.0 * k, 0.0,
            0.0, 0.0, -n * s, 0.0, 0.0, c,
        );
        phi
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn mean_motion_from_either_side() {
        let (a, mu) = (8143.1e3_f64, 3.986004415e14);
        let period = std::f64::consts::TAU * (a * a * a / mu).sqrt();
        let [from_period, from_axis] = [
            ClohessyWiltshire::from_period(period),
            ClohessyWiltshire::from_semi_major_axis(a, mu),
        ]
        .map(|cw| cw.mean_motion);
        // Three orbits of this axis are 21 939 s and a fraction.
        assert!((3.0 * period - 21_939.0).abs() < 1.0, "{period}");
        assert!((from_period / from_axis - 1.0).abs() < 1e-15);
    }

    #[test]
    fn transition_integrates_the_linear_equations() {
        let cw = ClohessyWiltshire { mean_motion: 8.6e-4 };
        // Written out as printed, not from the partials.
        let n = cw.mean_motion;
        let rate = |x: &Vector6<f64>| {
            Vector6::new(
                x[3],
                x[4],
                x[5],
                3.0 * n * n * x[0] + 2.0 * n * x[4],
                -2.0 * n * x[3],
                -n * n * x[2],
            )
        };
        for (dt, steps) in [(1.0, 1), (0.5, 1), (700.0, 700), (-400.0, 400), (7313.0, 7313)] {
            for column in 0..6 {
                let mut x = Vector6::zeros();
                x[column] = 1.0;
                for _ in 0..steps {
                    x = numerics::rk4::step(0.0, &x, dt / f64::from(steps), |_, x| rate(x));
                }
                // 1 m/s for an orbit is 2e4 m; the integration is good to (n h)^4 times the phase, 3e-12.
                let error = (cw.transition(dt).column(column) - x).amax();
                assert!(error < 1e-9 * x.amax().max(1.0), "{dt} s, column {column}: {error}");
            }
        }
    }

    #[test]
    fn partials_agree_with_the_printed_equations() {
        let cw = ClohessyWiltshire { mean_motion: 1e-3 };
        let a = cw.acceleration(&Vector3::new(10.0, 20.0, 30.0), &Vector3::new(0.1, 0.2, 0.3));
        // x: 3e-6 * 10 + 2e-3 * 0.2; y: -2e-3 * 0.1; z: -1e-6 * 30.
        assert!((a - Vector3::new(4.3e-4, -2e-4, -3e-5)).amax() < 1e-18, "{a}");
    }
}
