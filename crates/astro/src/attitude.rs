//! Turning of bodies: constant spin, and the shortest way from one attitude to another.

use nalgebra::{Matrix3, Rotation3, Vector3};
use numerics::rotation;

/// Attitude of a body that turns at a constant rate about an axis fixed in it (and so in space).
///
/// * `rate_b`: angular rate against inertial axes, body axes, rad/s; zero for one that stands still.
/// * `t`: time since the body axes lay along B0, s.
/// * returns: `dcm_b_b0`, maps B0 to body axes; `dcm_b_b0 * dcm_b0_n` maps N.
pub fn spin(rate_b: &Vector3<f64>, t: f64) -> Matrix3<f64> {
    exp(&(rate_b * t))
}

/// Rotation vector of the shortest turn from one attitude to another, rad; divided by the time that it takes, the mean rate.
///
/// * `dcm_a_n`, `dcm_b_n`: both attitudes.
/// * returns: axes A or B (the same components in both), length in [0, pi]. For half a turn, one of the two directions.
pub fn turn(dcm_a_n: &Matrix3<f64>, dcm_b_n: &Matrix3<f64>) -> Vector3<f64> {
    let dcm_a_b = dcm_a_n * dcm_b_n.transpose();
    rotation::vector(&Rotation3::from_matrix_unchecked(dcm_a_b))
}

/// Attitude at a share of the shortest turn from one attitude to another: at a constant rate, on SO(3).
///
/// * `share`: 0 for `dcm_a_n`, 1 for `dcm_b_n`.
pub fn between(dcm_a_n: &Matrix3<f64>, dcm_b_n: &Matrix3<f64>, share: f64) -> Matrix3<f64> {
    exp(&(turn(dcm_a_n, dcm_b_n) * share)) * dcm_a_n
}

/// Attitude half way between two.
pub fn halfway(dcm_a_n: &Matrix3<f64>, dcm_b_n: &Matrix3<f64>) -> Matrix3<f64> {
    between(dcm_a_n, dcm_b_n, 0.5)
}

/// Components in axes that have turned by this rotation vector, rad.
fn exp(turn: &Vector3<f64>) -> Matrix3<f64> {
    rotation::by(&-turn).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use numerics::expm::expm;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
        [-size..size, -size..size, -size..size].prop_map(Vector3::from)
    }

    #[test]
    fn spin_by_hand() {
        // A quarter turn about z: what lay along x of B0 lies along -y of the body.
        let dcm = spin(&Vector3::new(0.0, 0.0, 0.1), 5.0 * PI);
        assert!((dcm * Vector3::x() + Vector3::y()).amax() < 1e-15, "{dcm}");
        assert_eq!(spin(&Vector3::zeros(), 100.0), Matrix3::identity());
    }

    #[test]
    fn half_a_turn_has_a_middle() {
        for axis in [Vector3::x(), Vector3::new(1.0, -2.0, 0.5).normalize(), -Vector3::z()] {
            let (a, b) = (spin(&Vector3::new(0.3, 0.2, -0.9), 1.0), spin(&axis, PI));
            let middle = halfway(&a, &(b * a));
            let angle = turn(&a, &middle).norm();
            assert!((angle - PI / 2.0).abs() < 1e-7, "{angle}");
            assert!(
                (middle * a.transpose() * axis - axis).amax() < 1e-7,
                "about the same axis"
            );
        }
    }

    proptest! {
        /// Poisson's equation: the derivative of the DCM is -[w]x times it.
        #[test]
        fn spin_solves_poissons_equation(rate in vector(2.0), t in -3.0..3.0_f64) {
            let by_series = expm(&(rate.cross_matrix() * -t));
            prop_assert!((spin(&rate, t) - by_series).amax() < 1e-13);
        }

        #[test]
        fn turn_undoes_spin(start in vector(3.0), turned in vector(1.8)) {
            // Below half a turn, 1.8 sqrt 3 = 3.12.
            let a = spin(&start, 1.0);
            let b = spin(&turned, 1.0) * a;
            // The logarithm loses digits near half a turn.
            prop_assert!((turn(&a, &b) - turned).amax() < 1e-12 / (PI - turned.norm()));
        }

        #[test]
        fn halfway_is_half_the_turn(start in vector(3.0), turned in vector(1.8)) {
            let a = spin(&start, 1.0);
            let b = spin(&turned, 1.0) * a;
            let middle = halfway(&a, &b);
            prop_assert!((middle - spin(&turned, 0.5) * a).amax() < 1e-12 / (PI - turned.norm()));
            prop_assert!((middle * middle.transpose() - Matrix3::identity()).amax() < 1e-14);
            prop_assert!((between(&a, &b, 0.0) - a).amax() < 1e-15);
            prop_assert!((between(&a, &b, 1.0) - b).amax() < 1e-12);
        }
    }
}
