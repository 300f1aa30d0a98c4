//! Relative metrology: the whole state of a chaser relative to its target, position and velocity at once.
//!
//! The measured state is `rho`, `rho_dot` in the turning axes of the target's orbit (`astro::relative`). For a filter whose
//! state that is, h(x) = x and the Jacobian is the identity: [`measure`]. For one whose state stands in inertial axes,
//! [`measure_inertial`] turns it there, with the axes of the target's orbit as the filter estimates it.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// What metrology measures.
///
/// * `rho`, `rho_dot`: chaser minus target, LVLH, m and m/s.
/// * returns: both, in this order.
///
/// Source: Pesce, Silvestrini and Lavagna, Eq. (20) with h(x) = x and the noise outside of h.
pub fn measure(rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(rho.x, rho.y, rho.z, rho_dot.x, rho_dot.y, rho_dot.z)
}

/// What metrology measures of a relative state in inertial axes: rho = -C r_tc and rho_dot = -C (v_tc - omega x r_tc).
///
/// * `r_tc_n`, `v_tc_n`: target relative to chaser, axes N, m, and inertial velocity, m/s.
/// * `dcm_lvlh_n`: C, maps N to the target's LVLH axes (`astro::Lvlh::dcm_lvlh_n`).
/// * `omega_lvlh`: angular rate of those axes against inertial ones, LVLH axes, rad/s (`astro::Lvlh::angular_rate`).
/// * returns: rows as in [`measure`].
pub fn measure_inertial(
    r_tc_n: &Vector3<f64>,
    v_tc_n: &Vector3<f64>,
    dcm_lvlh_n: &Matrix3<f64>,
    omega_lvlh: &Vector3<f64>,
) -> Vector6<f64> {
    let rho = -(dcm_lvlh_n * r_tc_n);
    measure(&rho, &(-(dcm_lvlh_n * v_tc_n) - omega_lvlh.cross(&rho)))
}

/// Derivative of [`measure_inertial`] by `r_tc_n` and `v_tc_n`, the axes held.
///
/// C and omega move with the estimate of the target's orbit as well, which the relative state is a part of. What that leaves out
/// is of the order of the relative distance over the target's distance from the central body, or velocity for velocity over its
/// speed: 1e-4 of what is measured for a kilometre in low Earth orbit.
///
/// * `dcm_lvlh_n`, `omega_lvlh`: as for [`measure_inertial`].
/// * returns: rows as in [`measure`], columns `r_tc_n`, `v_tc_n`; 1 and rad/s.
pub fn jacobian_inertial(dcm_lvlh_n: &Matrix3<f64>, omega_lvlh: &Vector3<f64>) -> Matrix6<f64> {
    let mut h = Matrix6::zeros();
    h.fixed_view_mut::<3, 3>(0, 0).copy_from(&-dcm_lvlh_n);
    h.fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&(omega_lvlh.cross_matrix() * dcm_lvlh_n));
    h.fixed_view_mut::<3, 3>(3, 3).copy_from(&-dcm_lvlh_n);
    h
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
    use astro::Lvlh;

    #[test]
    fn rows_are_position_then_velocity() {
        let z = measure(&Vector3::new(1.0, 2.0, 3.0), &Vector3::new(4.0, 5.0, 6.0));
        assert!((z - Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)).amax() < f64::MIN_POSITIVE);
        let r = covariance(0.5, 0.25);
        let squares = Vector6::new(0.25, 0.25, 0.25, 0.0625, 0.0625, 0.0625);
        assert!((r - Matrix6::from_diagonal(&squares)).amax() < 1e-16, "{r}");
    }

    /// Against the same relative state from absolute positions and velocities.
    #[test]
    fn inertial_and_turning_axes_tell_the_same_state() {
        let (r_t, v_t) = (Vector3::new(6.5e6, 1.9e6, -8e5), Vector3::new(-1.7e3, 6.9e3, 2.1e3));
        let a_t = astro::earth::TRUTH.acceleration(&r_t);
        let lvlh = Lvlh::new(&r_t, &v_t, &a_t);
        let (r_tc, v_tc) = (Vector3::new(-700.0, 350.0, 1200.0), Vector3::new(0.4, -1.1, 0.8));
        let (rho, rho_dot) = lvlh.relative(&(r_t - r_tc), &(v_t - v_tc));
        let z = measure_inertial(&r_tc, &v_tc, lvlh.dcm_lvlh_n(), lvlh.angular_rate());
        // Rounding of positions of 7e6 m and velocities of 7e3 m/s.
        let error = z - measure(&rho, &rho_dot);
        assert!(
            error.fixed_rows::<3>(0).amax() < 1e-8 && error.fixed_rows::<3>(3).amax() < 1e-11,
            "{error}"
        );
    }

    #[test]
    fn jacobian_is_the_derivative() {
        let (r_t, v_t) = (Vector3::new(6.5e6, 1.9e6, -8e5), Vector3::new(-1.7e3, 6.9e3, 2.1e3));
        let lvlh = |r: &Vector3<f64>, v: &Vector3<f64>| Lvlh::new(r, v, &astro::earth::TRUTH.acceleration(r));
        let held = lvlh(&r_t, &v_t);
        let x = Vector6::new(-700.0, 350.0, 1200.0, 0.4, -1.1, 0.8);
        let h = jacobian_inertial(held.dcm_lvlh_n(), held.angular_rate());
        let parts = |x: &Vector6<f64>| (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned());
        let seen = |x: &Vector6<f64>, axes: &Lvlh| {
            let (r, v) = parts(x);
            measure_inertial(&r, &v, axes.dcm_lvlh_n(), axes.angular_rate())
        };
        for i in 0..6 {
            let step = if i < 3 { 10.0 } else { 0.1 };
            let mut d = Vector6::zeros();
            d[i] = step;
            // The axes held: a linear function, so that only rounding is left.
            let slope = (seen(&(x + d), &held) - seen(&(x - d), &held)) / (2.0 * step);
            assert!((h.column(i) - slope).amax() < 1e-11, "{i}: {slope}");
            // The axes of the moved target: what the Jacobian leaves out is rho / r = 2e-4 of one; of a position's derivative
            // of the rate, of 1e-3 rad/s; of a velocity's derivative of the position, of r / v = 1e3 s times that.
            let moved = |sign: f64| {
                let (r, v) = parts(&(d * sign));
                seen(&(x + d * sign), &lvlh(&(r_t + r), &(v_t + v)))
            };
            let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
            let error = h.column(i) - slope;
            let bound = if i < 3 { [5e-4, 1e-6] } else { [0.5, 5e-4] };
            assert!(
                error.fixed_rows::<3>(0).amax() < bound[0] && error.fixed_rows::<3>(3).amax() < bound[1],
                "{i}: {error}"
            );
        }
    }
}
