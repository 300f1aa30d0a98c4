//! Rotations from an angle and back, by [`crate::math`]; those of nalgebra ask the C library.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, UnitVector3, Vector3};

use crate::math;

/// How far the rows of a matrix are from orthonormal: the largest element of D D' - 1.
pub fn defect(dcm: &Matrix3<f64>) -> f64 {
    (dcm * dcm.transpose() - Matrix3::identity()).amax()
}

/// Rotation by an angle about an axis.
///
/// * `angle`: rad, right-handed.
pub fn about(axis: &UnitVector3<f64>, angle: f64) -> Rotation3<f64> {
    let (sin, cos) = math::sin_cos(angle);
    let cross = axis.cross_matrix();
    Rotation3::from_matrix_unchecked(Matrix3::from_fn(|i, j| {
        let both = axis[i] * axis[j];
        if i == j {
            both + (1.0 - both) * cos
        } else {
            both * (1.0 - cos) + cross[(i, j)] * sin
        }
    }))
}

/// Rotation by the length of a vector, rad, about its direction.
pub fn by(vector: &Vector3<f64>) -> Rotation3<f64> {
    UnitVector3::try_new_and_get(*vector, 0.0).map_or_else(Rotation3::identity, |(axis, angle)| about(&axis, angle))
}

/// The vector, rad, by which [`by`] gives this rotation; its length is in [0, pi]. For half a turn, one of the two directions.
pub fn vector(rotation: &Rotation3<f64>) -> Vector3<f64> {
    let q = UnitQuaternion::from_rotation_matrix(rotation);
    // Of the two quaternions of a rotation, the one of the shorter turn.
    let imaginary = q.imag() * 1.0_f64.copysign(q.w);
    let sin = imaginary.norm();
    if sin > 0.0 {
        imaginary * (2.0 * math::atan2(sin, q.w.abs()) / sin)
    } else {
        Vector3::zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_nalgebras_to_rounding() {
        for k in 0..200_u32 {
            let k = f64::from(k);
            let turn = Vector3::new((0.7 * k).sin(), (1.3 * k).cos(), (2.1 * k).sin())
                * (0.02 * k * 1e-3_f64.powf((0.9 * k).sin().abs()));
            let theirs = Rotation3::new(turn);
            assert!((by(&turn).matrix() - theirs.matrix()).amax() < 1e-15, "{turn}");
            assert!(
                (vector(&theirs) - UnitQuaternion::from(theirs).scaled_axis()).norm() < 1e-14,
                "{turn}"
            );
            let axis = UnitVector3::new_normalize(turn + Vector3::x());
            let off = about(&axis, -k).matrix() - Rotation3::from_axis_angle(&axis, -k).matrix();
            assert!(off.amax() < 1e-15, "{k} {off}");
        }
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "exact")]
    fn no_turn_is_none_and_axes_of_coordinates_stay() {
        assert_eq!(by(&Vector3::zeros()).into_inner(), Matrix3::identity());
        assert_eq!(vector(&Rotation3::identity()), Vector3::zeros());
        let z = about(&Vector3::z_axis(), 0.3).into_inner();
        assert_eq!(z.column(2), Vector3::z());
        assert_eq!(z[(0, 0)], math::cos(0.3));
        assert_eq!(z[(1, 0)], math::sin(0.3));
    }
}
