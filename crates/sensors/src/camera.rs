//! Camera: two angles to the target, in the axes L of the LiDAR ([`crate::lidar`]).

use numerics::math;

use crate::of_target::{ByState, OfTarget, Rows, Scene};
use nalgebra::{Matrix2x3, Matrix3, Vector2, Vector3};

/// The camera among the sensors of the target.
pub struct Camera;

impl OfTarget for Camera {
    fn measure(&self, scene: &Scene) -> Rows {
        measure(&(scene.dcm_l_n * scene.r_tc_n)).fixed_resize(0.0)
    }

    fn jacobian(&self, scene: &Scene) -> ByState {
        jacobian(&scene.r_tc_n, &scene.dcm_l_n).fixed_resize(0.0)
    }
}

/// Azimuth and elevation of a target.
///
/// * `rho_l`: target relative to the sensor, axes L, m.
/// * returns: azimuth and elevation, rad. An angle is NaN when both its components are zero.
///
/// Source: Mamich and Zanetti, Eq. (9).
pub fn measure(rho_l: &Vector3<f64>) -> Vector2<f64> {
    Vector2::new(math::atan(rho_l.x / rho_l.z), math::atan(rho_l.y / rho_l.z))
}

/// Derivative of [`measure`] by the relative position in axes N.
///
/// * `r_tc_n`: target relative to chaser, N, m, with a component along the boresight.
/// * `dcm_l_n`: maps N to L.
/// * returns: rows azimuth, elevation; columns `r_tc_n`; rad/m.
///
/// Source: Mamich and Zanetti, the angles' rows of H_1 in Eq. (11).
pub fn jacobian(r_tc_n: &Vector3<f64>, dcm_l_n: &Matrix3<f64>) -> Matrix2x3<f64> {
    let rho = dcm_l_n * r_tc_n;
    let (x, y, z) = (rho.x, rho.y, rho.z);
    let azimuth = Vector3::new(z, 0.0, -x).transpose() / (x * x + z * z);
    let elevation = Vector3::new(0.0, z, -y).transpose() / (y * y + z * z);
    Matrix2x3::from_rows(&[azimuth * dcm_l_n, elevation * dcm_l_n])
}

#[cfg(test)]
mod tests {
    use super::*;
    use astro::frames;
    use proptest::prelude::*;

    #[test]
    fn angles_by_hand() {
        // Boresight along z: 45 degrees towards x, half a slope towards -y; the range does not matter.
        for range in [1e-3, 1.0, 1e6] {
            let z = measure(&(Vector3::new(2.0, -1.0, 2.0) * range));
            let expected = Vector2::new(std::f64::consts::FRAC_PI_4, -0.463_647_609_000_806_1);
            assert!((z - expected).amax() < 1e-15, "{z}");
        }
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
                // Truncation (h/r)^4 = 1e-12 with factors up to (1/0.3)^5, relative to the angles' scale 1/r.
                let error = jacobian.column(i) - slope;
                prop_assert!(error.amax() * r.norm() < 1e-6, "{} and {}", jacobian, slope);
            }
        }
    }
}
