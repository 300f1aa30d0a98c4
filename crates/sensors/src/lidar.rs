//! Flash LiDAR: range and two angles to the target.
//!
//! Axes L of the sensor: z_L along the boresight; azimuth turns towards x_L, elevation towards y_L
//! (`astro::frames::lidar_from_body` places them in the body).

use crate::camera;
use crate::of_target::{ByState, OfTarget, Rows, Scene};
use nalgebra::{Matrix3, Vector3};

/// The LiDAR among the sensors of the target.
pub struct Lidar;

impl OfTarget for Lidar {
    fn measure(&self, scene: &Scene) -> Rows {
        measure(&(scene.dcm_l_n * scene.r_tc_n)).fixed_resize(0.0)
    }

    fn jacobian(&self, scene: &Scene) -> ByState {
        jacobian(&scene.r_tc_n, &scene.dcm_l_n).fixed_resize(0.0)
    }
}

/// Range, azimuth and elevation of a target.
///
/// * `rho_l`: target relative to the sensor, axes L, m.
/// * returns: range, m; azimuth and elevation, rad. An angle is NaN when both its components are zero.
///
/// Source: Mamich and Zanetti, Eqs. (8) and (9).
pub fn measure(rho_l: &Vector3<f64>) -> Vector3<f64> {
    let angles = camera::measure(rho_l);
    Vector3::new(rho_l.norm(), angles.x, angles.y)
}

/// Derivative of [`measure`] by the relative position in axes N.
///
/// * `r_tc_n`: target relative to chaser, N, m, with a component along the boresight.
/// * `dcm_l_n`: maps N to L.
/// * returns: rows range, azimuth, elevation; columns `r_tc_n`; 1 and rad/m.
///
/// Source: Mamich and Zanetti, the first three columns of H_1 in Eq. (11).
pub fn jacobian(r_tc_n: &Vector3<f64>, dcm_l_n: &Matrix3<f64>) -> Matrix3<f64> {
    let rho = dcm_l_n * r_tc_n;
    let angles = camera::jacobian(r_tc_n, dcm_l_n);
    Matrix3::from_rows(&[
        r_tc_n.transpose() / rho.norm(),
        angles.row(0).into_owned(),
        angles.row(1).into_owned(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use astro::frames;
    use proptest::prelude::*;

    #[test]
    fn angles_by_hand() {
        // Boresight along z: 45 degrees towards x, half a slope towards y.
        let z = measure(&Vector3::new(2.0, 1.0, 2.0));
        let expected = Vector3::new(3.0, std::f64::consts::FRAC_PI_4, 0.463_647_609_000_806_1);
        assert!((z - expected).amax() < 1e-15, "{z}");
    }

    proptest! {
        #[test]
        fn jacobian_is_the_derivative(
            r in [10.0..3e3_f64, -200.0..200.0_f64, -200.0..200.0_f64],
            look in [10.0..3e3_f64, -200.0..200.0_f64, -200.0..200.0_f64],
            v in [-1.0..1.0_f64, 0.1..1.0_f64, -1.0..1.0_f64],
        ) {
            let r = Vector3::from(r);
            // The sensor looks somewhere near the target, not at it.
            let dcm = frames::lidar_from_body() * frames::los_body_axes(&look.into(), &v.into(), &Vector3::z());
            prop_assume!((dcm * r).z > 0.3 * r.norm());
            let jacobian = jacobian(&r, &dcm);
            let h = 1e-3 * r.norm();
            for i in 0..3 {
                let along = |d: f64| {
                    let mut moved = r;
                    moved[i] += d;
                    measure(&(dcm * moved))
                };
                let slope = (along(h) - along(-h)) * (2.0 / (3.0 * h)) - (along(2.0 * h) - along(-2.0 * h)) / (12.0 * h);
                // Truncation (h/r)^4 = 1e-12 with factors up to (1/0.3)^5, relative to the row's scale.
                let error = jacobian.column(i) - slope;
                prop_assert!(error[0].abs() < 1e-8 && error.amax() * r.norm() < 1e-6, "{} and {}", jacobian, slope);
            }
        }
    }
}
