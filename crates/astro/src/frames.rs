//! Direction cosine matrices. `dcm_b_n` maps axes N to axes B: its rows are the unit vectors of B in N.

use nalgebra::{Matrix3, Vector3};

/// Perpendicular relative speed below which the relative motion no longer defines the body z axis, m/s.
pub const BLEND_SPEED: f64 = 1e-5;

/// Radial, transverse, normal axes of an orbit: R along the position, N along the angular momentum, T completes.
///
/// * `r`, `v`: inertial position and velocity, m and m/s, not parallel.
/// * returns: `dcm_rtn_n`, maps N to RTN (rows R, T, N). Orthonormal for any finite input: a missing direction is replaced
///   by an arbitrary one.
pub fn rtn(r: &Vector3<f64>, v: &Vector3<f64>) -> Matrix3<f64> {
    let radial = unit(r).unwrap_or_else(Vector3::x);
    let normal = unit(v)
        .and_then(|t| across(&t, &radial))
        .map_or_else(|| any_perpendicular(&radial), |t| radial.cross(&t));
    from_rows(&radial, &normal.cross(&radial), &normal)
}

/// The same axes where the orbit defines them.
///
/// Where it nearly does not, [`rtn`] keeps orthogonality to the last digit and this does not; elsewhere the two agree to
/// rounding.
///
/// * `r`, `v`: inertial position and velocity, m and m/s.
/// * returns: `dcm_rtn_n`, or `None` where position and velocity are parallel, one of them is zero, or not finite.
pub fn try_rtn(r: &Vector3<f64>, v: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let radial = r.try_normalize(0.0)?;
    let normal = r.cross(v).try_normalize(0.0)?;
    let dcm = from_rows(&radial, &normal.cross(&radial), &normal);
    dcm.iter().all(|x| x.is_finite()).then_some(dcm)
}

/// Body axes of a vehicle that looks at another: y along the line of sight, z along the normal of the relative motion,
/// x completes.
///
/// Where the relative motion has no normal (perpendicular speed below [`BLEND_SPEED`]) z turns smoothly to the orbit
/// normal, so the axes stay defined at rest; above it nothing is changed.
///
/// * `r_other_rel`, `v_other_rel`: position and velocity of the other vehicle relative to this one, N, m and m/s.
/// * `orbit_normal`: normal of this vehicle's orbit, N, any length.
/// * returns: `dcm_b_n`, maps N to body. Orthonormal for any finite input, zero vectors included.
///
/// Source: Mamich and Zanetti, Sec. IV (frames). Deviation: the blend, since the paper's z axis is undefined at rest, which
/// its own final state is.
pub fn los_body_axes(
    r_other_rel: &Vector3<f64>,
    v_other_rel: &Vector3<f64>,
    orbit_normal: &Vector3<f64>,
) -> Matrix3<f64> {
    let up = unit(orbit_normal).unwrap_or_else(Vector3::z);
    let y = unit(r_other_rel).unwrap_or_else(|| any_perpendicular(&up));
    let motion = y.cross(v_other_rel);
    let share = (motion.norm() / BLEND_SPEED).min(1.0);
    let blended = match unit(&motion) {
        Some(normal) if share >= 1.0 => Some(normal),
        Some(normal) => {
            let weight = share * share * (3.0 - 2.0 * share);
            across(&up, &y).map_or(Some(normal), |rest| unit(&(normal * weight + rest * (1.0 - weight))))
        }
        None => None,
    };
    let z = blended
        .and_then(|z| across(&z, &y))
        .or_else(|| across(&up, &y))
        .unwrap_or_else(|| any_perpendicular(&y));
    from_rows(&y.cross(&z), &y, &z)
}

/// Axes of the LiDAR in those of the body that carries it: x_L = z_B, y_L = x_B, z_L = y_B (the boresight).
///
/// * returns: `dcm_l_b`, maps body to LiDAR.
pub fn lidar_from_body() -> Matrix3<f64> {
    Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
}

fn from_rows(x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()])
}

/// Unit vector, or `None` for a vector too short to have a direction. Scaled first, so that no square over- or underflows.
fn unit(v: &Vector3<f64>) -> Option<Vector3<f64>> {
    let largest = v.amax();
    (largest > f64::MIN_POSITIVE).then(|| (v / largest).normalize())
}

/// Unit vector of the part of `v` (a unit vector) across the unit vector `axis`, or `None` when they are parallel to within
/// rounding.
fn across(v: &Vector3<f64>, axis: &Vector3<f64>) -> Option<Vector3<f64>> {
    let part = v - axis * v.dot(axis);
    // A second projection removes what rounding left of the first.
    (part.norm() > 1e-8).then(|| {
        let part = part.normalize();
        (part - axis * part.dot(axis)).normalize()
    })
}

/// Some unit vector perpendicular to the unit vector `v`.
fn any_perpendicular(v: &Vector3<f64>) -> Vector3<f64> {
    let smallest = v.iamin();
    let mut axis = Vector3::zeros();
    axis[smallest] = 1.0;
    v.cross(&axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Finite numbers of any size, with exact zeros and equal values common enough to line vectors up.
    fn component() -> impl Strategy<Value = f64> {
        prop_oneof![
            3 => Just(0.0),
            1 => Just(1.0),
            1 => Just(-1.0),
            3 => -1e4..1e4_f64,
            1 => -1e-5..1e-5_f64,
            1 => prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL,
        ]
    }

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        [component(), component(), component()].prop_map(Vector3::from)
    }

    fn assert_rotation(m: &Matrix3<f64>) {
        assert!((m * m.transpose() - Matrix3::identity()).amax() < 1e-14, "{m}");
        assert!((m.determinant() - 1.0).abs() < 1e-14, "{m}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn axes_are_a_rotation_whatever_the_input(r in vector(), v in vector(), n in vector()) {
            assert_rotation(&los_body_axes(&r, &v, &n));
            assert_rotation(&los_body_axes(&r, &r, &r));
            assert_rotation(&los_body_axes(&r, &v, &(r * -1.0)));
            assert_rotation(&rtn(&r, &v));
            assert_rotation(&rtn(&r, &r));
        }
    }

    #[test]
    fn rtn_of_a_circular_orbit_by_hand() {
        // Over the pole, moving towards -x: R is z, T is -x, N is z cross -x = -y.
        let dcm = rtn(&Vector3::new(0.0, 0.0, 7e6), &Vector3::new(-7.5e3, 0.0, 0.0));
        let expected = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        assert!((dcm - expected).amax() < 1e-15, "{dcm}");
    }

    #[test]
    fn axes_that_no_orbit_defines_are_none() {
        let (r, v) = (Vector3::new(7e6, 1e6, -2e6), Vector3::new(1e3, 7e3, 2e2));
        assert!((try_rtn(&r, &v).unwrap() - rtn(&r, &v)).amax() < 1e-15);
        let zero = Vector3::zeros();
        let nan = Vector3::new(f64::NAN, 0.0, 0.0);
        for (r, v) in [
            (zero, v),
            (r, zero),
            (Vector3::x(), Vector3::x() * -2.0),
            (nan, v),
            (r, nan),
        ] {
            assert_eq!(try_rtn(&r, &v), None, "{r} {v}");
        }
    }

    #[test]
    fn body_axes_follow_line_of_sight_and_relative_motion() {
        let (r, v) = (Vector3::new(-3.0, 4.0, 0.0), Vector3::new(0.0, 0.0, 2.0));
        let dcm = los_body_axes(&r, &v, &Vector3::z());
        // r x v = (8, 6, 0), and x = y cross z.
        let expected = Matrix3::new(0.0, 0.0, -1.0, -0.6, 0.8, 0.0, 0.8, 0.6, 0.0);
        assert!((dcm - expected).amax() < 1e-15, "{dcm}");
        let seen = lidar_from_body() * dcm * r;
        assert!(
            (seen - Vector3::new(0.0, 0.0, 5.0)).amax() < 1e-14,
            "the target is on the boresight: {seen}"
        );
    }

    #[test]
    fn z_turns_from_orbit_normal_to_relative_motion_without_a_jump() {
        let r = Vector3::new(1.0, 0.0, 0.0);
        let up = Vector3::new(0.0, 0.0, 3.0);
        // Motion along y: its normal is r x v = +z; motion along -z: its normal is +y.
        let z_at = |speed: f64| {
            los_body_axes(&r, &(Vector3::new(0.0, 0.0, -1.0) * speed), &up)
                .row(2)
                .transpose()
        };
        assert!((z_at(0.0) - Vector3::z()).amax() < 1e-15);
        assert!((z_at(BLEND_SPEED) - Vector3::y()).amax() < 1e-15);
        let steps: u32 = 1000;
        let mut last = z_at(0.0);
        for k in 1..=steps {
            let next = z_at(BLEND_SPEED * f64::from(k) / f64::from(steps));
            // A quarter turn in 1000 steps, nowhere more than six times the mean rate.
            assert!((next - last).norm() < 6.0 * std::f64::consts::FRAC_PI_2 / f64::from(steps));
            last = next;
        }
    }
}
