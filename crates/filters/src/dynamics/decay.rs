//! An acceleration that dies away as exp(-k t), in closed form.
//!
//! A Runge-Kutta step explodes where it is much longer than the time constant; with the answer to such an acceleration taken out of
//! position and velocity, what is left to integrate is smooth.

use nalgebra::{SVector, Vector3};
use numerics::{math, rk4};

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

/// An acceleration that dies away, and what it acts on.
pub(super) struct Dying {
    /// First of three rows of a position; those of its velocity follow.
    pub row: usize,
    /// At the begin of the step.
    pub start: Vector3<f64>,
    /// Rate of decay.
    pub rate: f64,
}

/// One Runge-Kutta step of `dt` in which what dying accelerations do to positions and velocities goes by their answers, and the rest,
/// which is smooth, by the step.
///
/// * `rate`: of all rows without those accelerations, at a state that holds what they have done.
pub(super) fn step<const D: usize>(
    start: &SVector<f64, D>,
    dt: f64,
    dying: &[Dying],
    rate: impl Fn(&SVector<f64, D>) -> SVector<f64, D>,
) -> SVector<f64, D> {
    let done_after = |t: f64| {
        let mut done = SVector::<f64, D>::zeros();
        for Dying { row, start, rate } in dying {
            let answer = Answer::after(t, *rate);
            done.fixed_rows_mut::<3>(*row).copy_from(&(start * answer.position));
            done.fixed_rows_mut::<3>(row + 3).copy_from(&(start * answer.velocity));
        }
        done
    };
    let rest = rk4::step(0.0, start, dt, |t, y| {
        let mut dy = rate(&(y + done_after(t)));
        // Of the rest, positions follow the velocities of the rest.
        for Dying { row, .. } in dying {
            dy.fixed_rows_mut::<3>(*row).copy_from(&y.fixed_rows::<3>(row + 3));
        }
        dy
    });
    rest + done_after(dt)
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
