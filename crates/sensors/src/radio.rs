//! Radio link: range to the target and its rate, whatever the attitude.
//!
//! The rate is that of a distance, so it is the same number in every set of axes. In axes that turn with `omega` the inertial
//! velocity is v = v_n + omega x rho, and its part along the line of sight is that of v_n, since rho . (omega x rho) = 0. The
//! functions therefore take the relative velocity of the state as it stands, inertial or, in the three-body problem, relative
//! to the rotating axes; the Jacobian is that by this velocity and needs no term for the turning either.

use crate::of_target::{ByState, OfTarget, Rows, Scene};
use nalgebra::{Matrix2x6, Vector2, Vector3};

/// The radio link among the sensors of the target.
pub struct Radio;

impl OfTarget for Radio {
    fn measure(&self, scene: &Scene) -> Rows {
        measure(&scene.r_tc_n, &scene.v_tc_n).fixed_resize(0.0)
    }

    fn jacobian(&self, scene: &Scene) -> ByState {
        jacobian(&scene.r_tc_n, &scene.v_tc_n).fixed_resize(0.0)
    }
}

/// Range and range rate of a target.
///
/// * `r_tc_n`, `v_tc_n`: target relative to chaser, m and m/s, any axes, turning or not, and the rate as seen in them.
/// * returns: range |rho|, m, and range rate rho . v / |rho|, m/s; positive when the vehicles part. The rate of two vehicles in
///   one place is NaN.
pub fn measure(r_tc_n: &Vector3<f64>, v_tc_n: &Vector3<f64>) -> Vector2<f64> {
    let range = r_tc_n.norm();
    Vector2::new(range, r_tc_n.dot(v_tc_n) / range)
}

/// Derivative of [`measure`] by relative position and velocity.
///
/// With the line of sight u = rho / |rho|: the range changes by u with the position; the rate by (v - u (u . v)) / |rho| with
/// the position, which is the turning of the line of sight, and by u with the velocity.
///
/// * `r_tc_n`, `v_tc_n`: as for [`measure`], the position not zero.
/// * returns: rows range, range rate; columns `r_tc_n`, `v_tc_n`; 1, 1/s and s/m as they come.
pub fn jacobian(r_tc_n: &Vector3<f64>, v_tc_n: &Vector3<f64>) -> Matrix2x6<f64> {
    let range = r_tc_n.norm();
    let sight = r_tc_n / range;
    let turning = (v_tc_n - sight * sight.dot(v_tc_n)) / range;
    let mut h = Matrix2x6::zeros();
    h.fixed_view_mut::<1, 3>(0, 0).copy_from(&sight.transpose());
    h.fixed_view_mut::<1, 3>(1, 0).copy_from(&turning.transpose());
    h.fixed_view_mut::<1, 3>(1, 3).copy_from(&sight.transpose());
    h
}

#[cfg(test)]
mod tests {
    use super::*;
    use astro::cr3bp::dcm_rotating_inertial;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    #[test]
    fn range_and_rate_by_hand() {
        // 3-4-5 with 10 m/s across and 1 m/s along the line of sight.
        let sight = Vector3::new(0.6, 0.0, 0.8);
        let z = measure(&(sight * 5.0), &(Vector3::new(-0.8, 0.0, 0.6) * 10.0 - sight));
        assert!((z - Vector2::new(5.0, -1.0)).amax() < 1e-14, "{z}");
        assert!(measure(&Vector3::zeros(), &Vector3::x())[1].is_nan());
    }

    /// The rate as a time derivative: range along a straight line in inertial axes, seen from axes that turn.
    #[test]
    fn the_rate_is_the_derivative_of_the_range_in_turning_axes_too() {
        let (r0, v_i, rate) = (Vector3::new(800.0, -300.0, 120.0), Vector3::new(-1.5, 0.7, 3.0), 0.02);
        let at = |t: f64| dcm_rotating_inertial(rate * t) * (r0 + v_i * t);
        let (t, h) = (7.0, 1e-3);
        // Velocity relative to the turning axes by differences of the position in them.
        let v_n = (at(t + h) - at(t - h)) / (2.0 * h);
        let range_rate = (at(t + h).norm() - at(t - h).norm()) / (2.0 * h);
        let z = measure(&at(t), &v_n);
        // Truncation: h^2 times the third derivatives, rate^3 r = 7e-3 m/s3; rounding: 1e-13 m over h.
        assert!((z[1] - range_rate).abs() < 1e-8, "{} and {range_rate}", z[1]);
        // The inertial velocity differs by several m/s and has the same rate.
        let inertial = v_n + Vector3::new(0.0, 0.0, rate).cross(&at(t));
        assert!((inertial - v_n).norm() > 10.0);
        assert!((inertial - dcm_rotating_inertial(rate * t) * v_i).norm() < 1e-6);
        assert!((measure(&at(t), &inertial)[1] - z[1]).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn turning_axes_change_neither_the_rate_nor_its_slope(
            r in [10.0..3e3_f64, -2e3..2e3_f64, -2e3..2e3_f64],
            v in [-10.0..10.0_f64, -10.0..10.0_f64, -10.0..10.0_f64],
            omega in [-1e-2..1e-2_f64, -1e-2..1e-2_f64, -1e-2..1e-2_f64],
        ) {
            let (r, v, omega) = (Vector3::from(r), Vector3::from(v), Vector3::from(omega));
            let turned = v + omega.cross(&r);
            // Rounding of products of size r |v|.
            let rounding = 1e-14 * turned.norm().max(v.norm()).max(1.0);
            prop_assert!((measure(&r, &v) - measure(&r, &turned))[1].abs() < rounding);
            // By v_n directly, and by the inertial velocity with d(omega x r)/dr carried through.
            let direct = jacobian(&r, &v);
            let inertial = jacobian(&r, &turned);
            let through = inertial.fixed_view::<1, 3>(1, 0) + inertial.fixed_view::<1, 3>(1, 3) * omega.cross_matrix();
            let error = (direct.fixed_view::<1, 3>(1, 0) - through).amax();
            prop_assert!(error < 1e-14, "{error}");
        }

        #[test]
        fn jacobian_is_the_derivative(
            r in [10.0..3e3_f64, -2e3..2e3_f64, -2e3..2e3_f64],
            v in [-10.0..10.0_f64, -10.0..10.0_f64, -10.0..10.0_f64],
        ) {
            let (r, v) = (Vector3::from(r), Vector3::from(v));
            let jacobian = jacobian(&r, &v);
            let steps = Vector6::from_fn(|i, _| if i < 3 { 1e-3 * r.norm() } else { 1e-3 * v.norm().max(1.0) });
            for (i, &h) in steps.iter().enumerate() {
                let along = |d: f64| {
                    let (mut r, mut v) = (r, v);
                    if i < 3 { r[i] += d } else { v[i - 3] += d }
                    measure(&r, &v)
                };
                let slope = (along(h) - along(-h)) * (2.0 / (3.0 * h)) - (along(2.0 * h) - along(-2.0 * h)) / (12.0 * h);
                // Truncation (h/r)^4 = 1e-12 and rounding 1e-16 / 1e-3, relative to the rows' scales: 1, |v| / |r| and 1.
                let scale = if i < 3 { v.norm().max(1.0) / r.norm() } else { 1.0 };
                let error = jacobian.column(i) - slope;
                prop_assert!(error[0].abs() < 1e-10 && error[1].abs() < 1e-9 * scale, "{} and {}", jacobian, slope);
            }
        }
    }
}
