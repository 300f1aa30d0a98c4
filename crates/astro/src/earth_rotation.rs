//! The turning Earth: from inertial to Earth-fixed axes.
//!
//! Inertial axes are the mean equator and equinox of date, which nutation (17 arcseconds), polar motion (0.3 arcseconds)
//! and, over a day, precession (0.14 arcseconds) leave where they are.

use nalgebra::{Matrix3, Vector3};
use numerics::rotation;

use crate::epoch::centuries;

/// Rotation of the Earth against the mean equinox, deg/d: rate of the IAU 1982 sidereal time.
const TURN_PER_DAY_DEG: f64 = 360.985_647_366_29;

/// Angular rate of the Earth, rad/s, z axis.
pub const RATE: f64 = TURN_PER_DAY_DEG * (std::f64::consts::PI / 180.0) / 86_400.0;

/// Greenwich mean sidereal time: the angle from the equinox to the Greenwich meridian.
///
/// * `days`: days since J2000.0, from [`crate::epoch::days_since_j2000`].
/// * returns: rad, in [0, 2 pi).
///
/// Source: IAU 1982 (Aoki et al.), as one polynomial in time; Meeus, Astronomical Algorithms, Eq. (12.4).
pub fn gmst(days: f64) -> f64 {
    let t = centuries(days);
    // Whole turns are dropped before they cost digits.
    let turn = days.fract() * 360.0 + days * (TURN_PER_DAY_DEG - 360.0);
    let degrees = 280.460_618_37 + turn + t * t * (0.000_387_933 - t / 38_710_000.0);
    degrees.rem_euclid(360.0).to_radians()
}

/// Direction cosine matrix `dcm_f_n` from inertial axes N to Earth-fixed axes F (x through Greenwich, z north).
///
/// * `days`: days since J2000.0.
pub fn dcm_f_n(days: f64) -> Matrix3<f64> {
    rotation::about(&Vector3::z_axis(), -gmst(days)).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epoch::J2000;
    use crate::sun_moon;

    #[test]
    fn val_sidereal_time_of_printed_examples() {
        // Meeus, examples 12.a and 12.b; Vallado, example 3-5. Digits as printed; 1e-5 s of time is 4e-8 deg.
        for (jd, degrees) in [
            (2_446_895.5, 197.693_195),
            (2_446_896.306_25, 128.737_873_4),
            (2_448_855.0 + (14.0 / 60.0) / 24.0, 152.578_787_810),
        ] {
            let angle = gmst(jd - J2000).to_degrees();
            assert!((angle - degrees).abs() < 5e-7, "{jd}: {angle} and {degrees}");
        }
    }

    /// At noon of universal time the Sun has passed Greenwich by the equation of time, whose extremes are in every almanac.
    #[test]
    fn val_the_sun_at_noon_stands_over_greenwich_but_for_the_equation_of_time() {
        for (jd, minutes, seconds) in [(2_458_891.0, -14.0, -14.0), (2_459_157.0, 16.0, 26.0)] {
            let days = jd - J2000;
            let fixed = dcm_f_n(days) * sun_moon::sun(days);
            let west = -fixed.y.atan2(fixed.x).to_degrees();
            let expected = (minutes + seconds / 60.0) / 4.0;
            // The almanac's 2 s, and 6 s of aberration, nutation and of the series.
            assert!((west - expected).abs() < 8.0 / 240.0, "{west} and {expected}");
        }
    }

    #[test]
    fn axes_turn_at_the_rate() {
        let (h, day) = (1.0, 86_400.0);
        let days = 7304.5;
        let change = (dcm_f_n(days + h / day) - dcm_f_n(days - h / day)) / (2.0 * h);
        let expected = -Vector3::new(0.0, 0.0, RATE).cross_matrix() * dcm_f_n(days);
        // Steps of 0.1 microseconds in the days, over 2 s.
        assert!((change - expected).amax() < 1e-7 * RATE, "{change} and {expected}");
        assert!((RATE / 7.292_115e-5 - 1.0).abs() < 2e-7);
    }
}
