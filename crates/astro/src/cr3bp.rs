//! The circular restricted three-body problem in its rotating, barycentric, nondimensional frame.
//!
//! Axes: x from the larger primary to the smaller, z along their angular momentum. Length, time and mass are scaled so that
//! the distance of the primaries, their mean motion and the sum of their gravitational parameters are one.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Mass ratio of the Earth-Moon system (Mamich and Zanetti, Table 5).
pub const EARTH_MOON_MASS_RATIO: f64 = 1.215e-2;
/// Characteristic length of the Earth-Moon system, m (Table 5).
pub const EARTH_MOON_LENGTH: f64 = 3.844e8;
/// Characteristic time of the Earth-Moon system, s (Table 5).
pub const EARTH_MOON_TIME: f64 = 3.752e5;

/// The three-body problem of one mass ratio; all quantities nondimensional, rotating axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cr3bp {
    /// Mass of the smaller primary over the sum of both.
    pub mass_ratio: f64,
}

impl Cr3bp {
    /// Position of the smaller primary.
    pub fn secondary(&self) -> Vector3<f64> {
        Vector3::new(1.0 - self.mass_ratio, 0.0, 0.0)
    }

    fn primaries(&self) -> [(f64, Vector3<f64>); 2] {
        let mu = self.mass_ratio;
        [(1.0 - mu, Vector3::new(-mu, 0.0, 0.0)), (mu, self.secondary())]
    }

    /// Acceleration at position `r` and velocity `v`: attraction of both primaries, centrifugal and Coriolis.
    ///
    /// Source: Mamich and Zanetti, Eq. (36). Deviation: its third row prints r1 and r2 without their cubes.
    pub fn acceleration(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        let mut a = Vector3::new(r.x + 2.0 * v.y, r.y - 2.0 * v.x, 0.0);
        for (mass, place) in self.primaries() {
            let d = r - place;
            a -= d * (mass / d.norm().powi(3));
        }
        a
    }

    /// Partials of the acceleration by position and by velocity, 3x3 each.
    pub fn partials(&self, r: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        let mut by_r = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
        for (mass, place) in self.primaries() {
            let d = r - place;
            let u = d.normalize();
            by_r += (u * u.transpose() * 3.0 - Matrix3::identity()) * (mass / d.norm().powi(3));
        }
        let by_v = Matrix3::new(0.0, 2.0, 0.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        (by_r, by_v)
    }

    /// Jacobi constant 2 Omega - v^2, which every free motion keeps.
    pub fn jacobi_constant(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> f64 {
        let attraction: f64 = self
            .primaries()
            .iter()
            .map(|(mass, place)| mass / (r - place).norm())
            .sum();
        r.x * r.x + r.y * r.y + 2.0 * attraction - v.norm_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH_MOON: Cr3bp = Cr3bp {
        mass_ratio: EARTH_MOON_MASS_RATIO,
    };

    fn near_the_moon() -> (Vector3<f64>, Vector3<f64>) {
        (
            Vector3::new(0.9879, 0.01432, 0.0521),
            Vector3::new(0.07173, 0.9238, -0.8528),
        )
    }

    #[test]
    fn acceleration_is_the_gradient_of_the_effective_potential_and_coriolis() {
        let (r, v) = near_the_moon();
        let at_rest = EARTH_MOON.acceleration(&r, &Vector3::zeros());
        for axis in 0..3 {
            let h = 1e-6;
            let mut step = Vector3::zeros();
            step[axis] = h;
            // Omega = (Jacobi constant at rest) / 2.
            let omega = |r: &Vector3<f64>| EARTH_MOON.jacobi_constant(r, &Vector3::zeros()) / 2.0;
            let slope = (omega(&(r + step)) - omega(&(r - step))) / (2.0 * h);
            assert!((slope - at_rest[axis]).abs() < 1e-6 * at_rest.norm(), "axis {axis}");
        }
        let coriolis = EARTH_MOON.acceleration(&r, &v) - at_rest;
        assert!((coriolis - Vector3::z().cross(&v) * -2.0).amax() < 1e-12);
    }

    #[test]
    fn partials_agree_with_differences() {
        let (r, v) = near_the_moon();
        let (by_r, by_v) = EARTH_MOON.partials(&r);
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = 1e-6;
            let a = |r: Vector3<f64>, v: Vector3<f64>| EARTH_MOON.acceleration(&r, &v);
            let column = (a(r + step, v) - a(r - step, v)) / 2e-6;
            assert!(
                (by_r.column(axis) - column).amax() < 1e-6 * by_r.amax(),
                "position {axis}"
            );
            let column = (a(r, v + step) - a(r, v - step)) / 2e-6;
            assert!((by_v.column(axis) - column).amax() < 1e-8, "velocity {axis}");
        }
    }

    /// At the triangular points everything balances; they form equilateral triangles with the primaries.
    #[test]
    fn triangular_points_are_at_rest() {
        let place = Vector3::new(0.5 - EARTH_MOON_MASS_RATIO, 3.0_f64.sqrt() / 2.0, 0.0);
        assert!(EARTH_MOON.acceleration(&place, &Vector3::zeros()).amax() < 1e-15);
    }
}
