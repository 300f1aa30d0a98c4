//! An acceleration that dies away as exp(-k t), in closed form.
//!
//! A Runge-Kutta step explodes where it is much longer than the time constant; with the answer to such an acceleration taken out of
//! position and velocity, what is left to integrate is smooth.

use numerics::math;

/// Up to this k t, a Runge-Kutta step carries the decay itself, to 1e-7 of it.
const SLOW: f64 = 0.1;

/// Whether a Runge-Kutta step of `dt` may carry a decay at rate `k`.
pub(super) fn is_slow(k: f64, dt: f64) -> bool {
    (k * dt).abs() <= SLOW
}

/// What a unit acceleration that dies away at rate `k` has done after `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Answer {
    /// Of position: t^2 psi_2(k t).
    pub position: f64,
    /// Of velocity: t psi_1(k t).
    pub velocity: f64,
    /// What is left of it: exp(-k t).
    pub left: f64,
}

impl Answer {
    pub(crate) fn after(t: f64, k: f64) -> Self {
        let z = k * t;
        Self {
            position: t * t * psi(z, 2),
            velocity: t * psi(z, 1),
            left: math::exp(-z),
        }
    }
}

/// psi_1 = (1 - e^-x) / x and psi_2 = (x - 1 + e^-x) / x^2, accurate near zero.
fn psi(x: f64, order: i32) -> f64 {
    if x > 0.5 {
        return if order == 1 {
            -math::exp_m1(-x) / x
        } else {
            (x + math::exp_m1(-x)) / (x * x)
        };
    }
    // sum over k of (-x)^k / (k + order)!
    let mut term = if order == 1 { 1.0 } else { 0.5 };
    let mut sum = 0.0;
    for k in 1..20 {
        sum += term;
        term *= -x / f64::from(k + order);
    }
    sum
}
