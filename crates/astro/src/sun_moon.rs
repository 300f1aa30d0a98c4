//! Where the Sun and the Moon stand, and what their attraction does to an Earth satellite.
//!
//! Geocentric positions in the mean equator and equinox of date, the inertial axes of [`crate::earth_rotation`]. The
//! series are good to about 0.01 deg for the Sun and to a few arcminutes and 500 km for the Moon.

use nalgebra::Vector3;
use numerics::math;

use crate::epoch::centuries;

/// Gravitational parameter of the Sun, m3/s2 (IAU 1976; Montenbruck and Gill).
pub const SUN_MU: f64 = 1.327_124_38e20;

/// Gravitational parameter of the Moon, m3/s2: that of EGM96 over the mass ratio 81.300587 (Montenbruck and Gill).
pub const MOON_MU: f64 = crate::harmonics::EGM96.mu / 81.300_587;

/// Motion of the perihelion against the equinox of date, deg per century: general precession 1.3972 (Montenbruck and Gill,
/// Sec. 3.3.2) and its own advance 0.3225.
const PERIHELION_RATE_DEG: f64 = 1.7197;

/// Longitude of the Moon beyond its mean longitude: arcseconds, and multiples of l, l', F, D in the sine.
///
/// Source of this and the following two series: Montenbruck and Gill, Satellite Orbits, Sec. 3.3.2.
const MOON_LONGITUDE: [(f64, [f64; 4]); 14] = [
    (22640.0, [1.0, 0.0, 0.0, 0.0]),
    (769.0, [2.0, 0.0, 0.0, 0.0]),
    (-4586.0, [1.0, 0.0, 0.0, -2.0]),
    (2370.0, [0.0, 0.0, 0.0, 2.0]),
    (-668.0, [0.0, 1.0, 0.0, 0.0]),
    (-412.0, [0.0, 0.0, 2.0, 0.0]),
    (-212.0, [2.0, 0.0, 0.0, -2.0]),
    (-206.0, [1.0, 1.0, 0.0, -2.0]),
    (192.0, [1.0, 0.0, 0.0, 2.0]),
    (-165.0, [0.0, 1.0, 0.0, -2.0]),
    (148.0, [1.0, -1.0, 0.0, 0.0]),
    (-125.0, [0.0, 0.0, 0.0, 1.0]),
    (-110.0, [1.0, 1.0, 0.0, 0.0]),
    (-55.0, [0.0, 0.0, 2.0, -2.0]),
];

/// Latitude of the Moon beyond its leading term: arcseconds, and multiples in the sine.
const MOON_LATITUDE: [(f64, [f64; 4]); 7] = [
    (-526.0, [0.0, 0.0, 1.0, -2.0]),
    (44.0, [1.0, 0.0, 1.0, -2.0]),
    (-31.0, [-1.0, 0.0, 1.0, -2.0]),
    (-25.0, [-2.0, 0.0, 1.0, 0.0]),
    (-23.0, [0.0, 1.0, 1.0, -2.0]),
    (21.0, [-1.0, 0.0, 1.0, 0.0]),
    (11.0, [0.0, -1.0, 1.0, -2.0]),
];

/// Distance of the Moon: km, and multiples in the cosine.
const MOON_DISTANCE: [(f64, [f64; 4]); 9] = [
    (385_000.0, [0.0, 0.0, 0.0, 0.0]),
    (-20905.0, [1.0, 0.0, 0.0, 0.0]),
    (-3699.0, [-1.0, 0.0, 0.0, 2.0]),
    (-2956.0, [0.0, 0.0, 0.0, 2.0]),
    (-570.0, [2.0, 0.0, 0.0, 0.0]),
    (246.0, [2.0, 0.0, 0.0, -2.0]),
    (-205.0, [0.0, 1.0, 0.0, -2.0]),
    (-171.0, [1.0, 0.0, 0.0, 2.0]),
    (-152.0, [1.0, 1.0, 0.0, -2.0]),
];

/// Position of the Sun.
///
/// * `days`: days since J2000.0, from [`crate::epoch::days_since_j2000`].
/// * returns: geocentric, N, m.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Sec. 3.3.2, for the equinox of date.
///
/// Deviation: they hold the perihelion still among the stars, which by 2020 puts the Sun off by 4 arcminutes; here it
/// advances.
pub fn sun(days: f64) -> Vector3<f64> {
    let t = centuries(days);
    let m = (357.5256 + 35999.049 * t).to_radians();
    let perihelion = (282.9400 + PERIHELION_RATE_DEG * t).to_radians();
    let longitude = perihelion + m + arcseconds(6892.0 * math::sin(m) + 72.0 * math::sin(2.0 * m));
    let distance = (149.619 - 2.499 * math::cos(m) - 0.021 * math::cos(2.0 * m)) * 1e9;
    equatorial(t, longitude, 0.0, distance)
}

/// Position of the Moon.
///
/// * `days`: days since J2000.0.
/// * returns: geocentric, N, m.
///
/// Source: Montenbruck and Gill, Satellite Orbits, Sec. 3.3.2, with the mean longitude left at the equinox of date.
pub fn moon(days: f64) -> Vector3<f64> {
    let t = centuries(days);
    let mean_longitude = (218.31617 + 481_267.880_88 * t).to_radians();
    let arguments = [
        (134.96292 + 477_198.867_53 * t).to_radians(),
        (357.52543 + 35_999.049_44 * t).to_radians(),
        (93.27283 + 483_202.018_73 * t).to_radians(),
        (297.85027 + 445_267.111_35 * t).to_radians(),
    ];
    let [_, sun_anomaly, f, _] = arguments;
    let inequality = arcseconds(sum(&MOON_LONGITUDE, &arguments, math::sin));
    let node_distance = f + inequality + arcseconds(412.0 * math::sin(2.0 * f) + 541.0 * math::sin(sun_anomaly));
    let latitude = arcseconds(18520.0 * math::sin(node_distance) + sum(&MOON_LATITUDE, &arguments, math::sin));
    let distance = sum(&MOON_DISTANCE, &arguments, math::cos) * 1e3;
    equatorial(t, mean_longitude + inequality, latitude, distance)
}

/// Acceleration of a satellite relative to the Earth's centre by a distant body: its pull on the satellite less its pull on
/// the Earth.
///
/// The two pulls agree in their first digits (seven of them for the Sun over a low orbit); Battin's form never takes their
/// difference.
///
/// * `mu`: gravitational parameter of the body, m3/s2.
/// * `body`: its geocentric position, m, not zero.
/// * `r`: geocentric position of the satellite, same axes, m, not at the body.
/// * returns: same axes, m/s2.
///
/// Source: Battin, An Introduction to the Mathematics and Methods of Astrodynamics, Sec. 8.4.
pub fn third_body(mu: f64, body: &Vector3<f64>, r: &Vector3<f64>) -> Vector3<f64> {
    let q = r.dot(&(r - body * 2.0)) / body.norm_squared();
    // (1 + q)^(3/2) - 1, where 1 + q = |body - r|^2 / |body|^2.
    let ratio = 1.0 + q;
    let f = q * (3.0 + q * (3.0 + q)) / (1.0 + ratio * ratio.sqrt());
    (r + body * f) * (-mu / (body - r).norm().powi(3))
}

fn arcseconds(value: f64) -> f64 {
    (value / 3600.0).to_radians()
}

fn sum(series: &[(f64, [f64; 4])], arguments: &[f64; 4], wave: fn(f64) -> f64) -> f64 {
    let angle = |multiples: &[f64; 4]| multiples.iter().zip(arguments).map(|(k, a)| k * a).sum();
    series
        .iter()
        .map(|(size, multiples)| size * wave(angle(multiples)))
        .sum()
}

/// From ecliptic longitude and latitude, rad, and distance, m, to equatorial axes. Obliquity of date, IAU 1976.
fn equatorial(t: f64, longitude: f64, latitude: f64, distance: f64) -> Vector3<f64> {
    let (sin_e, cos_e) = math::sin_cos((23.439_291_11 - 0.013_004_2 * t).to_radians());
    let (sin_l, cos_l) = math::sin_cos(longitude);
    let (sin_b, cos_b) = math::sin_cos(latitude);
    let (x, y, z) = (cos_b * cos_l, cos_b * sin_l, sin_b);
    Vector3::new(x, cos_e * y - sin_e * z, sin_e * y + cos_e * z) * distance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epoch::J2000;

    const AU: f64 = 149_597_870_700.0;

    /// Ecliptic longitude and latitude of date, deg, by turning back with the obliquity of 2000.
    fn ecliptic(r: &Vector3<f64>) -> (f64, f64) {
        let (sin, cos) = 23.439_3_f64.to_radians().sin_cos();
        let (y, z) = (cos * r.y + sin * r.z, cos * r.z - sin * r.y);
        (
            y.atan2(r.x).to_degrees().rem_euclid(360.0),
            (z / r.norm()).asin().to_degrees(),
        )
    }

    #[test]
    fn val_sun_and_moon_of_meeus() {
        // Meeus, Astronomical Algorithms, example 25.b (VSOP87): true longitude and distance, 1992 October 13.
        let r = sun(2_448_908.5 - J2000);
        let (longitude, latitude) = ecliptic(&r);
        assert!((longitude - 199.907_37).abs() < 0.01, "{longitude}");
        assert!(latitude.abs() < 0.001, "{latitude}");
        assert!((r.norm() / AU - 0.997_608).abs() < 1e-4, "{}", r.norm() / AU);
        // Example 47.a (ELP-2000/82): 1992 April 12, without nutation. Measured: 0.005 deg and 51 km off.
        let r = moon(2_448_724.5 - J2000);
        let (longitude, latitude) = ecliptic(&r);
        assert!((longitude - 133.162_66).abs() < 0.01, "{longitude}");
        assert!((latitude + 3.229_13).abs() < 0.01, "{latitude}");
        assert!((r.norm() - 368_409.7e3).abs() < 100e3, "{}", r.norm());
    }

    /// Seasons of 2020 (universal time) to the minute; the Sun moves by 0.04 deg in an hour.
    #[test]
    fn val_seasons_of_2020() {
        for (jd, hours, expected) in [
            (2_458_928.5, 3.0 + 50.0 / 60.0, 0.0),
            (2_459_020.5, 21.0 + 44.0 / 60.0, 90.0),
            (2_459_114.5, 13.0 + 31.0 / 60.0, 180.0),
            (2_459_204.5, 10.0 + 2.0 / 60.0, 270.0),
        ] {
            let (longitude, _) = ecliptic(&sun(jd - J2000 + hours / 24.0));
            let off = (longitude - expected + 180.0).rem_euclid(360.0) - 180.0;
            // Aberration of 0.006 deg lies between this and the apparent place that defines the seasons.
            assert!((off - 0.006).abs() < 0.01, "{longitude} and {expected}");
        }
        // Perihelion on 5 January, 147.091e6 km; aphelion on 4 July, 152.095e6 km.
        for (jd, distance) in [(2_458_853.8, 147.091e9), (2_459_035.0, 152.095e9)] {
            let r = sun(jd - J2000).norm();
            assert!((r - distance).abs() < 3e7, "{r} and {distance}");
        }
    }

    /// In a solar eclipse the line from the Sun through the Moon passes the Earth's centre at the distance gamma, in
    /// Earth radii, positive north. Times and gamma: NASA's Five Millennium Canon of Solar Eclipses.
    #[test]
    fn val_the_shadow_of_the_moon_falls_where_eclipses_were_seen() {
        for (jd, seconds, gamma) in [
            (2_457_986.5, 18.0 * 3600.0 + 26.0 * 60.0 + 40.0, 0.4367),
            (2_458_843.5, 5.0 * 3600.0 + 18.0 * 60.0 + 53.0, 0.4135),
            (2_459_021.5, 6.0 * 3600.0 + 41.0 * 60.0 + 15.0, 0.1209),
            (2_459_197.5, 16.0 * 3600.0 + 14.0 * 60.0 + 39.0, -0.2939),
        ] {
            let days = jd - J2000 + seconds / 86_400.0;
            let (s, m) = (sun(days), moon(days));
            let axis = (m - s).normalize();
            let passing = m - axis * m.dot(&axis);
            let distance = passing.norm().copysign(passing.z) / 6378.137e3;
            // One arcminute of the Moon is 0.018; the series happens to be good to half of it at all four.
            assert!((distance - gamma).abs() < 0.02, "{jd}: {distance} and {gamma}");
        }
    }

    #[test]
    fn val_the_moon_keeps_its_month_and_its_distances() {
        let hours = 20 * 365 * 24;
        let (mut turns, mut last) = (0.0, ecliptic(&moon(0.0)).0);
        let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
        for hour in 1..=hours {
            let r = moon(f64::from(hour) / 24.0);
            let (longitude, latitude) = ecliptic(&r);
            assert!(latitude.abs() < 5.35, "{latitude}");
            turns += (longitude - last).rem_euclid(360.0) / 360.0;
            last = longitude;
            nearest = nearest.min(r.norm());
            farthest = farthest.max(r.norm());
        }
        // Tropical month; the inequality of up to 6.3 deg at either end is 2 hours in 267 months.
        let month = f64::from(hours) / 24.0 / turns;
        assert!((month - 27.321_582).abs() < 1e-3 * 1.5, "{month}");
        // Extremes of perigee and apogee, 356 400 and 406 700 km, to the 500 km of the series.
        assert!((nearest - 356_400e3).abs() < 700e3, "{nearest}");
        assert!((farthest - 406_700e3).abs() < 700e3, "{farthest}");
    }

    #[test]
    fn third_body_is_the_difference_of_attractions() {
        // Near enough for the plain difference to keep its digits.
        let (body, r) = (Vector3::new(3.0, -1.0, 2.0), Vector3::new(0.4, 0.7, -0.5));
        let d: Vector3<f64> = body - r;
        let plain = (d / d.norm().powi(3) - body / body.norm().powi(3)) * 2.5;
        assert!((third_body(2.5, &body, &r) - plain).amax() < 1e-15);
    }

    #[test]
    fn third_body_keeps_its_digits_close_to_the_earth() {
        // One metre from the centre: the tide mu/d^3 (3 d_hat d_hat - 1) r, and the next term is smaller by r/d.
        let body = sun(7304.5);
        let e = body.normalize();
        let r = Vector3::new(0.3, -0.5, 0.8);
        let tide = (e * (3.0 * e.dot(&r)) - r) * (SUN_MU / body.norm().powi(3));
        let felt = third_body(SUN_MU, &body, &r);
        assert!((felt - tide).amax() < 1e-10 * tide.amax(), "{felt} and {tide}");
        // The plain difference has lost everything.
        let d: Vector3<f64> = body - r;
        let plain = (d / d.norm().powi(3) - body / body.norm().powi(3)) * SUN_MU;
        assert!((plain - tide).amax() > 1e-6 * tide.amax());
    }
}
