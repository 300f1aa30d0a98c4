//! The turning Moon: its equator and its body-fixed axes.
//!
//! Body-fixed axes are those of the mean Earth and pole: x through the mean sub-Earth point, z north. The series hold them
//! to about 150 m at the surface.

use nalgebra::{Matrix3, Rotation3, Vector3};
use numerics::{math, rotation};

use crate::epoch::centuries;

/// Arguments E1 to E13: deg at J2000.0, and deg per day.
///
/// Source of this and of the other series: Archinal et al., Report of the IAU Working Group on Cartographic Coordinates and
/// Rotational Elements: 2015, Table 2 (the Moon's as in the report of 2009).
const ARGUMENTS: [(f64, f64); 13] = [
    (125.045, -0.0529921),
    (250.089, -0.1059842),
    (260.008, 13.0120009),
    (176.625, 13.3407154),
    (357.529, 0.9856003),
    (311.589, 26.4057084),
    (134.963, 13.0649930),
    (276.617, 0.3287146),
    (34.226, 1.7484877),
    (15.134, -0.1589763),
    (119.743, 0.0036096),
    (239.961, 0.1643573),
    (25.053, 12.9590088),
];

/// What sin E adds to the right ascension of the pole, cos E to its declination, and sin E to the prime meridian, deg.
const AMPLITUDES: [[f64; 3]; 13] = [
    [-3.8787, 1.5419, 3.5610],
    [-0.1204, 0.0239, 0.1208],
    [0.0700, -0.0278, -0.0642],
    [-0.0172, 0.0068, 0.0158],
    [0.0, 0.0, 0.0252],
    [0.0072, -0.0029, -0.0066],
    [0.0, 0.0009, -0.0047],
    [0.0, 0.0, -0.0046],
    [0.0, 0.0, 0.0028],
    [-0.0052, 0.0008, 0.0052],
    [0.0, 0.0, 0.0040],
    [0.0, 0.0, 0.0019],
    [0.0043, -0.0009, -0.0044],
];

/// Right ascension and declination of the pole, ICRF, and the angle from the node of the Moon's equator on that of the ICRF
/// to the prime meridian, rad.
fn elements(days: f64) -> [f64; 3] {
    let t = centuries(days);
    let mut pole_and_meridian = [
        269.9949 + 0.0031 * t,
        66.5392 + 0.0130 * t,
        38.3213 + days * (13.176_358_15 - 1.4e-12 * days),
    ];
    for ((at_epoch, rate), [ascension, declination, meridian]) in ARGUMENTS.iter().zip(AMPLITUDES) {
        let (sin, cos) = math::sin_cos((at_epoch + rate * days).to_radians());
        pole_and_meridian[0] += ascension * sin;
        pole_and_meridian[1] += declination * cos;
        pole_and_meridian[2] += meridian * sin;
    }
    pole_and_meridian.map(f64::to_radians)
}

/// Direction cosine matrix from the axes of the ICRF to those of the Moon's equator of date: z along the pole, x towards the
/// ascending node of the Moon's equator on the equator of the ICRF.
///
/// * `days`: days since J2000.0.
pub fn dcm_equator_icrf(days: f64) -> Matrix3<f64> {
    equator(&elements(days))
}

/// Direction cosine matrix `dcm_f_icrf`, from the axes of the ICRF to body-fixed axes F.
///
/// * `days`: days since J2000.0.
pub fn dcm_f_icrf(days: f64) -> Matrix3<f64> {
    let elements = elements(days);
    turned(Vector3::z_axis(), elements[2]).into_inner() * equator(&elements)
}

fn equator([ascension, declination, _]: &[f64; 3]) -> Matrix3<f64> {
    let quarter = std::f64::consts::FRAC_PI_2;
    (turned(Vector3::x_axis(), quarter - declination) * turned(Vector3::z_axis(), quarter + ascension)).into_inner()
}

/// Components in axes that are turned by `angle` about `axis`.
fn turned(axis: nalgebra::UnitVector3<f64>, angle: f64) -> Rotation3<f64> {
    rotation::about(&axis, -angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epoch::J2000;
    use crate::{precession, sun_moon};

    /// Selenographic longitude and latitude, deg, of a geocentric place in axes of date.
    fn seen_from_the_moon(days: f64, place: &Vector3<f64>) -> (f64, f64) {
        let from_moon = precession::dcm_date_j2000(days).tr_mul(&(place - sun_moon::moon(days)));
        let fixed = dcm_f_icrf(days) * from_moon;
        (
            fixed.y.atan2(fixed.x).to_degrees(),
            (fixed.z / fixed.norm()).asin().to_degrees(),
        )
    }

    #[test]
    fn val_libration_of_meeus() {
        // Meeus, example 53.a: 1992 April 12, optical and physical libration together. His pole is that of the principal axis
        // of inertia (the terms 0.02245 sin F and 0.02244 cos F of his physical libration), which stands 0.0224 deg away from
        // the mean pole, towards the sub-Earth point.
        let (longitude, latitude) = seen_from_the_moon(2_448_724.5 - J2000, &Vector3::zeros());
        // Printed to 0.01 deg; the Moon's series is off by 0.005 deg here.
        assert!((longitude + 1.23).abs() < 0.015, "{longitude}");
        assert!((latitude - (4.20 - 0.0224)).abs() < 0.015, "{latitude}");
    }

    /// The Earth swings by known amounts about the middle of the near side, and the Sun stays over the equator.
    #[test]
    fn val_earth_and_sun_in_the_lunar_sky() {
        let (mut east, mut north, mut sun_north, mut mean) = (0.0_f64, 0.0_f64, 0.0_f64, [0.0; 2]);
        let samples = 20 * 365 * 4;
        for k in 0..samples {
            let days = f64::from(k) / 4.0;
            let (longitude, latitude) = seen_from_the_moon(days, &Vector3::zeros());
            east = east.max(longitude.abs());
            north = north.max(latitude.abs());
            mean[0] += longitude / f64::from(samples);
            mean[1] += latitude / f64::from(samples);
            sun_north = sun_north.max(seen_from_the_moon(days, &sun_moon::sun(days)).1.abs());
        }
        // Largest librations: 8 deg 9' in longitude and 6 deg 53' in latitude, reached in exceptional months alone.
        assert!((7.8..8.17).contains(&east), "{east}");
        assert!((6.7..6.9).contains(&north), "{north}");
        // The equator is tilted against the ecliptic by 1 deg 32' 33'', physical libration 0.03 deg.
        assert!((sun_north - 1.5425).abs() < 0.05, "{sun_north}");
        // x is the mean direction of the Earth; 20 years hold no whole number of swings.
        assert!(mean[0].abs() < 0.03 && mean[1].abs() < 0.03, "{mean:?}");
    }

    #[test]
    fn matrices_are_rotations() {
        for days in [-20_000.0, 0.0, 7304.5, 36_525.0] {
            for dcm in [dcm_f_icrf(days), dcm_equator_icrf(days)] {
                assert!((dcm * dcm.transpose() - Matrix3::identity()).amax() < 1e-14);
                assert!((dcm.determinant() - 1.0).abs() < 1e-14);
            }
        }
    }
}
