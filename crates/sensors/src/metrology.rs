//! Relative metrology: the whole state of a chaser relative to its target, position and velocity at once.
//!
//! The measured state is `rho`, `rho_dot` in the turning axes of the target's orbit (`astro::relative`), so that h(x) = x
//! and the Jacobian is the identity.

use nalgebra::{Matrix6, Vector3, Vector6};

/// What metrology measures.
///
/// * `rho`, `rho_dot`: chaser minus target, LVLH, m and m/s.
/// * returns: both, in this order.
///
/// Source: Pesce, Silvestrini and Lavagna, Eq. (20) with h(x) = x and the noise outside of h.
pub fn measure(rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(rho.x, rho.y, rho.z, rho_dot.x, rho_dot.y, rho_dot.z)
}

/// Standard deviations of the measurement noise.
///
/// * `sigma_position`: m; `sigma_velocity`: m/s; each for all three axes.
/// * returns: rows as in [`measure`].
pub fn deviations(sigma_position: f64, sigma_velocity: f64) -> Vector6<f64> {
    measure(&Vector3::repeat(sigma_position), &Vector3::repeat(sigma_velocity))
}

/// Covariance of the measurement noise.
///
/// * `sigma_position`, `sigma_velocity`: as for [`deviations`].
/// * returns: diagonal 6x6, m2 and m2/s2, rows as in [`measure`].
pub fn covariance(sigma_position: f64, sigma_velocity: f64) -> Matrix6<f64> {
    Matrix6::from_diagonal(&deviations(sigma_position, sigma_velocity).map(|sigma| sigma * sigma))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_position_then_velocity() {
        let z = measure(&Vector3::new(1.0, 2.0, 3.0), &Vector3::new(4.0, 5.0, 6.0));
        assert!((z - Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)).amax() < f64::MIN_POSITIVE);
        let r = covariance(0.5, 0.25);
        let squares = Vector6::new(0.25, 0.25, 0.25, 0.0625, 0.0625, 0.0625);
        assert!((r - Matrix6::from_diagonal(&squares)).amax() < 1e-16, "{r}");
    }
}
