//! Pressure of sunlight on a sphere, and the shadow of the body that it flies about.

use nalgebra::Vector3;

/// Pressure of sunlight at one astronomical unit on a surface that absorbs it, N/m2 (Montenbruck and Gill, Sec. 3.4).
pub const PRESSURE: f64 = 4.56e-6;

/// Astronomical unit, m (IAU 2012).
pub const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;

/// Whether the Sun is seen from `r`: the shadow is a cylinder behind the central body, without penumbra.
///
/// * `r`, `sun`: positions of the satellite and of the Sun from the centre of the body, same axes, m; `sun` not zero.
/// * `radius`: radius of the body, m; below 0 there is no shadow.
pub fn is_lit(r: &Vector3<f64>, sun: &Vector3<f64>, radius: f64) -> bool {
    let to_sun = sun.normalize();
    let along = r.dot(&to_sun);
    along >= 0.0 || (r - to_sun * along).norm() > radius
}

/// Acceleration of a sphere by sunlight, away from the Sun; zero in the shadow.
///
/// * `r`, `sun`: as for [`is_lit`], m.
/// * `radius`: as for [`is_lit`].
/// * `cr_area_per_mass`: radiation pressure coefficient times cross section over mass, Cr A/m, m2/kg. Cr is 1 where light
///   is absorbed and 2 where it is thrown straight back.
/// * returns: same axes, m/s2.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Sec. 3.4.
pub fn acceleration(r: &Vector3<f64>, sun: &Vector3<f64>, radius: f64, cr_area_per_mass: f64) -> Vector3<f64> {
    if !is_lit(r, sun, radius) {
        return Vector3::zeros();
    }
    let from_sun = r - sun;
    let distance = from_sun.norm();
    from_sun * (PRESSURE * cr_area_per_mass * (ASTRONOMICAL_UNIT / distance).powi(2) / distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 6.378e6;

    #[test]
    fn push_at_one_astronomical_unit_by_hand() {
        // Half way to the Sun the push is four times as strong; 1.3 * 1.2 m2 / 100 kg at 4.56e-6 N/m2 is 7.1136e-8 m/s2.
        let sun = Vector3::new(0.0, 0.6, 0.8) * ASTRONOMICAL_UNIT;
        let push = acceleration(&Vector3::new(7e6, 0.0, 0.0), &sun, RADIUS, 0.0156);
        // The satellite's own place changes direction and distance by 5e-5.
        assert!(
            (push - Vector3::new(0.0, -0.6, -0.8) * 7.1136e-8).amax() < 1e-11 * 0.5,
            "{push}"
        );
        let near = acceleration(&(sun * 0.5), &sun, RADIUS, 0.0156);
        assert!((near.norm() / (4.0 * 7.1136e-8) - 1.0).abs() < 1e-12, "{near}");
    }

    #[test]
    fn shadow_is_a_cylinder_behind_the_earth() {
        let sun = Vector3::new(0.0, 0.0, -ASTRONOMICAL_UNIT);
        let push = |x: f64, y: f64, z: f64| acceleration(&Vector3::new(x, y, z), &sun, RADIUS, 0.01).norm();
        assert!(push(0.0, 0.0, 7e6).abs() < f64::MIN_POSITIVE);
        assert!(push(3e6, -5.6e6, 4e8).abs() < f64::MIN_POSITIVE);
        assert!(push(3e6, -5.7e6, 4e6) > 4e-8, "beside the cylinder, |(3, 5.7)| = 6.44");
        assert!(push(0.0, 0.0, -7e6) > 4e-8, "before the Earth");
    }

    /// An orbit whose plane holds the Sun is in the dark over an arc of 2 asin(R/r).
    #[test]
    fn share_of_an_orbit_in_the_dark() {
        let (r, sun) = (7.2e6, Vector3::new(ASTRONOMICAL_UNIT, 0.0, 0.0));
        let steps = 100_000;
        let dark = (0..steps).filter(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(*k) / f64::from(steps)).sin_cos();
            !is_lit(&Vector3::new(r * cos, 0.0, r * sin), &sun, RADIUS)
        });
        let share = dark.count() as f64 / f64::from(steps);
        let expected = (RADIUS / r).asin() / std::f64::consts::PI;
        assert!(
            (share - expected).abs() < 2.0 / f64::from(steps),
            "{share} and {expected}"
        );
    }
}
