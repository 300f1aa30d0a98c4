//! Density of the upper atmosphere and the drag it causes.

use nalgebra::Vector3;
use numerics::math;
use serde::{Deserialize, Serialize};

use crate::error::{finite, positive};
use crate::{AstroError, earth_rotation};

/// Equatorial radius of the ellipsoid that altitudes are counted from, m (WGS 84).
const EQUATORIAL_RADIUS: f64 = 6_378_137.0;

/// Square of the ellipsoid's second eccentricity (WGS 84).
const SECOND_ECCENTRICITY_SQUARED: f64 = 6.739_496_742_28e-3;

/// Base altitude, km; density there, kg/m3; scale height of the layer above, km.
///
/// Source: Vallado, Fundamentals of Astrodynamics and Applications, Table 8-4 (U.S. Standard Atmosphere at sea
/// level, CIRA-72 from 25 km on, with an exospheric temperature of 1000 K above 500 km).
const LAYERS: [(f64, f64, f64); 28] = [
    (0.0, 1.225, 7.249),
    (25.0, 3.899e-2, 6.349),
    (30.0, 1.774e-2, 6.682),
    (40.0, 3.972e-3, 7.554),
    (50.0, 1.057e-3, 8.382),
    (60.0, 3.206e-4, 7.714),
    (70.0, 8.770e-5, 6.549),
    (80.0, 1.905e-5, 5.799),
    (90.0, 3.396e-6, 5.382),
    (100.0, 5.297e-7, 5.877),
    (110.0, 9.661e-8, 7.263),
    (120.0, 2.438e-8, 9.473),
    (130.0, 8.484e-9, 12.636),
    (140.0, 3.845e-9, 16.149),
    (150.0, 2.070e-9, 22.523),
    (180.0, 5.464e-10, 29.740),
    (200.0, 2.789e-10, 37.105),
    (250.0, 7.248e-11, 45.546),
    (300.0, 2.418e-11, 53.628),
    (350.0, 9.518e-12, 53.298),
    (400.0, 3.725e-12, 58.515),
    (450.0, 1.585e-12, 60.828),
    (500.0, 6.967e-13, 63.822),
    (600.0, 1.454e-13, 71.835),
    (700.0, 3.614e-14, 88.667),
    (800.0, 1.170e-14, 124.64),
    (900.0, 5.245e-15, 181.05),
    (1000.0, 3.019e-15, 268.00),
];

/// Density of the exponential atmosphere.
///
/// Above 1000 km the highest layer goes on. Below 0 the density of sea level stands, so that a trajectory that has hit the
/// ground stays finite; ending it there is the caller's part.
///
/// * `altitude`: above the ellipsoid, m.
/// * returns: kg/m3; NaN for NaN.
pub fn density(altitude: f64) -> f64 {
    let km = altitude / 1e3;
    if km < 0.0 {
        return LAYERS[0].1;
    }
    let above = LAYERS.partition_point(|(base, ..)| *base <= km);
    let (base, at_base, scale) = LAYERS[above.saturating_sub(1)];
    at_base * math::exp(-(km - base) / scale)
}

/// Altitude above the ellipsoid, along the line to the Earth's centre.
///
/// This line and the vertical differ by at most 0.2 deg: 4 m at 600 km.
///
/// * `r`: position, z along the Earth's axis, m, not zero.
pub fn altitude(r: &Vector3<f64>) -> f64 {
    let dist = r.norm();
    let u = r.z / dist;
    dist - EQUATORIAL_RADIUS / (1.0 + SECOND_ECCENTRICITY_SQUARED * u * u).sqrt()
}

/// Acceleration by drag in the Earth's atmosphere, which turns with the Earth; [`Atmosphere::drag`] for
/// [`Atmosphere::Earth`].
pub fn drag(r: &Vector3<f64>, v: &Vector3<f64>, cd_area_per_mass: f64) -> Vector3<f64> {
    Atmosphere::Earth.drag(r, v, cd_area_per_mass)
}

/// The air about a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Atmosphere {
    /// The Earth's: exponential layers over the ellipsoid.
    Earth,
    /// One exponential layer over a sphere.
    Layer(Layer),
}

/// One exponential layer over a sphere.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Density at `altitude`, kg/m3, positive.
    pub density: f64,
    /// Altitude of that density, m.
    pub altitude: f64,
    /// Height over which the density falls by e, m, positive.
    pub scale_height: f64,
    /// Radius of the sphere that altitudes are counted from, m, positive.
    pub radius: f64,
    /// Rate at which the air turns about z, rad/s.
    pub rate: f64,
}

impl Atmosphere {
    /// One exponential layer.
    ///
    /// # Errors
    /// When a number is out of its range, or the density at the surface is infinite.
    pub fn layer(layer: Layer) -> Result<Self, AstroError> {
        positive("density of the atmosphere", layer.density, "kg/m3")?;
        finite("altitude of the atmosphere's density", layer.altitude, "m")?;
        positive("scale height of the atmosphere", layer.scale_height, "m")?;
        positive("radius of the body", layer.radius, "m")?;
        finite("rate of the atmosphere", layer.rate, "rad/s")?;
        if !layer.density_at(0.0).is_finite() {
            return Err(AstroError::Layer {
                scale_height: layer.scale_height,
                altitude: layer.altitude,
            });
        }
        Ok(Self::Layer(layer))
    }

    /// Density at a position.
    ///
    /// * `r`: body-centred, z along the axis of rotation, m, not zero.
    /// * returns: kg/m3; below the surface that of the surface.
    pub fn density(&self, r: &Vector3<f64>) -> f64 {
        match self {
            Self::Earth => density(altitude(r)),
            Self::Layer(layer) => layer.density_at(r.norm() - layer.radius),
        }
    }

    /// Rate at which the air turns about z, rad/s.
    pub fn rate(&self) -> f64 {
        match self {
            Self::Earth => earth_rotation::RATE,
            Self::Layer(layer) => layer.rate,
        }
    }

    /// Acceleration by drag in air that turns with the body.
    ///
    /// * `r`, `v`: inertial position and velocity, body-centred, z along the axis of rotation, m and m/s; `r` not zero.
    /// * `cd_area_per_mass`: drag coefficient times cross section over mass, Cd A/m, m2/kg.
    /// * returns: same axes, m/s2, against the velocity relative to the air.
    ///
    /// Source: Vallado, Fundamentals of Astrodynamics and Applications, Sec. 8.6.2.
    pub fn drag(&self, r: &Vector3<f64>, v: &Vector3<f64>, cd_area_per_mass: f64) -> Vector3<f64> {
        let wind = Vector3::new(-r.y, r.x, 0.0) * self.rate();
        let through_air = v - wind;
        through_air * (-0.5 * self.density(r) * cd_area_per_mass * through_air.norm())
    }
}

impl Layer {
    fn density_at(&self, altitude: f64) -> f64 {
        self.density * math::exp((self.altitude - altitude.max(0.0)) / self.scale_height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each scale height was derived so that a layer ends where the next begins: a wrong digit would show as a jump.
    #[test]
    fn layers_join() {
        for (k, pair) in LAYERS.windows(2).enumerate() {
            let (base, at_base, _) = pair[1];
            let from_below = density(base * 1e3 * (1.0 - 1e-12));
            // Four printed digits of the density, and three of a scale height that stands in the exponent.
            assert!(
                (from_below / at_base - 1.0).abs() < 2e-3,
                "layer {k}: {from_below} and {at_base}"
            );
            assert!((density(base * 1e3) / at_base - 1.0).abs() < 1e-12, "layer {k}");
        }
    }

    #[test]
    fn val_density_of_a_printed_example_and_outside_the_table() {
        // Vallado, example 8-4: 747.2119 km, 2.1219854e-14 kg/m3.
        assert!(
            (density(747_211.9) / 2.121_985_4e-14 - 1.0).abs() < 1e-7,
            "{}",
            density(747_211.9)
        );
        for low in [-1.0, -6.378e6, f64::NEG_INFINITY] {
            assert!((density(low) - 1.225).abs() < 1e-15, "{low}");
        }
        assert!((density(1.268e6) / (3.019e-15 * (-1.0_f64).exp()) - 1.0).abs() < 1e-12);
        assert!(density(f64::INFINITY).abs() < f64::MIN_POSITIVE);
        assert!(density(f64::NAN).is_nan());
    }

    #[test]
    fn altitude_is_zero_on_the_ellipsoid() {
        // Semi-axes of WGS 84, and the point at parametric latitude 45 deg.
        let (a, b) = (6_378_137.0, 6_356_752.314_2);
        let half = 0.5_f64.sqrt();
        for r in [[a, 0.0, 0.0], [0.0, 0.0, -b], [0.0, a * half, b * half]] {
            assert!(altitude(&Vector3::from(r)).abs() < 1e-3, "{r:?}");
        }
    }

    #[test]
    fn drag_acts_against_the_motion_through_the_air() {
        let r = Vector3::new(0.0, 6_378_137.0 + 600e3, 0.0);
        // At rest in the turning air there is none.
        let still = Vector3::new(-r.y * earth_rotation::RATE, 0.0, 0.0);
        assert!(drag(&r, &still, 0.02).amax() < 1e-40);
        // Due north at 7.5 km/s: the air comes from the side at 7.292e-5 * 6.978e6 = 508.8 m/s, on either component.
        let felt = drag(&r, &Vector3::new(0.0, 0.0, 7500.0), 0.02);
        let speed = (7500.0_f64.powi(2) + 508.85_f64.powi(2)).sqrt();
        let factor = 0.5 * 1.454e-13 * 0.02 * speed;
        let expected = Vector3::new(-508.85 * factor, 0.0, -7500.0 * factor);
        assert!(
            (felt - expected).amax() < 1e-4 * expected.amax(),
            "{felt} and {expected}"
        );
    }

    /// Thin air over Mars, by hand: rho at 200 km of 3e-10 kg/m3, 10 km of scale height.
    const MARS: Layer = Layer {
        density: 3e-10,
        altitude: 200e3,
        scale_height: 10e3,
        radius: 3.3895e6,
        rate: 7.088e-5,
    };

    #[test]
    fn one_layer_over_any_sphere() {
        let air = Atmosphere::layer(MARS).unwrap();
        let up = |altitude: f64| Vector3::new(0.0, 0.0, -(MARS.radius + altitude));
        assert!((air.density(&up(200e3)) / 3e-10 - 1.0).abs() < 1e-12);
        assert!((air.density(&up(220e3)) / (3e-10 * (-2.0_f64).exp()) - 1.0).abs() < 1e-12);
        // Inside the body nothing overflows.
        assert!((air.density(&up(-3e6)) / air.density(&up(0.0)) - 1.0).abs() < 1e-12);
        // Against the motion, and none in air that one moves with.
        let r = Vector3::new(3.5895e6, 0.0, 0.0);
        let with_it = Vector3::new(0.0, 3.5895e6 * 7.088e-5, 0.0);
        assert!(air.drag(&r, &with_it, 0.01).amax() < 1e-40);
        let felt = air.drag(&r, &(with_it + Vector3::new(0.0, 3000.0, 4000.0)), 0.01);
        let size = 0.5 * 3e-10 * 0.01 * 5000.0;
        assert!(
            (felt - Vector3::new(0.0, -3000.0 * size, -4000.0 * size)).amax() < 1e-10 * felt.amax(),
            "{felt}"
        );
    }

    /// Within one layer of the Earth's table, and on its equator, the two kinds are the same.
    #[test]
    fn a_layer_of_the_earth_is_a_layer() {
        let layer = Atmosphere::layer(Layer {
            density: 1.454e-13,
            altitude: 600e3,
            scale_height: 71.835e3,
            radius: EQUATORIAL_RADIUS,
            rate: earth_rotation::RATE,
        })
        .unwrap();
        let (r, v) = (
            Vector3::new(EQUATORIAL_RADIUS + 650e3, 0.0, 0.0),
            Vector3::new(10.0, 7e3, 2e3),
        );
        let (one, table) = (layer.drag(&r, &v, 0.02), drag(&r, &v, 0.02));
        assert!((one - table).amax() < 1e-12 * table.amax(), "{one} and {table}");
    }

    #[test]
    fn impossible_layers_are_refused() {
        let refused = |layer: Layer| Atmosphere::layer(layer).unwrap_err().to_string();
        assert!(refused(Layer { density: 0.0, ..MARS }).contains("density"));
        assert!(
            refused(Layer {
                scale_height: -1.0,
                ..MARS
            })
            .contains("scale height of the atmosphere is -1 m")
        );
        assert!(
            refused(Layer {
                radius: f64::NAN,
                ..MARS
            })
            .contains("radius")
        );
        assert!(
            refused(Layer {
                altitude: f64::INFINITY,
                ..MARS
            })
            .contains("altitude")
        );
        assert!(refused(Layer { rate: f64::NAN, ..MARS }).contains("rad/s"));
        assert!(
            refused(Layer {
                scale_height: 10.0,
                ..MARS
            })
            .contains("lower down")
        );
    }
}
