//! The circular restricted three-body problem in its rotating, barycentric, nondimensional frame.
//!
//! Axes: x from the larger primary to the smaller, z along their angular momentum. Length, time and mass are scaled so that
//! the distance of the primaries, their mean motion and the sum of their gravitational parameters are one. [`Cr3bp`] works
//! in these units; [`Cr3bpSystem`] knows the scales and works in SI.

use nalgebra::{Matrix3, Vector3};
use numerics::lanes::{self, Lanes};
use numerics::rotation;
use serde::{Deserialize, Serialize};

use crate::error::positive;
use crate::{AstroError, frames};

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
        self.in_lanes([r.x, r.y, r.z], [v.x, v.y, v.z]).into()
    }

    #[inline]
    fn in_lanes<T: Lanes>(&self, r: [T; 3], v: [T; 3]) -> [T; 3] {
        let two = T::all(2.0);
        let mut a = [r[0] + two * v[1], r[1] - two * v[0], T::all(0.0)];
        for (mass, place) in self.primaries() {
            let d: [T; 3] = std::array::from_fn(|i| r[i] - T::all(place[i]));
            let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let strength = T::all(mass) / (distance * distance * distance);
            for (a, d) in a.iter_mut().zip(d) {
                *a -= d * strength;
            }
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

/// The three-body problem of two bodies, in SI; rotating axes N from the barycentre, velocities relative to them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cr3bpSystem {
    /// The problem without its scales.
    pub problem: Cr3bp,
    /// Distance of the primaries, m.
    pub length: f64,
    /// Inverse of their mean motion, s.
    pub time: f64,
}

impl Cr3bpSystem {
    /// Earth and Moon (Mamich and Zanetti, Table 5).
    pub const EARTH_MOON: Self = Self {
        problem: Cr3bp {
            mass_ratio: EARTH_MOON_MASS_RATIO,
        },
        length: EARTH_MOON_LENGTH,
        time: EARTH_MOON_TIME,
    };

    /// Any two bodies.
    ///
    /// * `mass_ratio`: mass of the smaller one over the sum of both.
    /// * `length`: their distance, m.
    /// * `time`: inverse of their mean motion, s.
    ///
    /// # Errors
    /// When the mass ratio is not above 0 and at most 0.5, or a scale not positive and finite.
    pub fn new(mass_ratio: f64, length: f64, time: f64) -> Result<Self, AstroError> {
        if !(mass_ratio > 0.0 && mass_ratio <= 0.5) {
            return Err(AstroError::MassRatio { mass_ratio });
        }
        Ok(Self {
            problem: Cr3bp { mass_ratio },
            length: positive("distance of the two bodies", length, "m")?,
            time: positive("inverse of their mean motion", time, "s")?,
        })
    }

    /// Position and velocity in SI from nondimensional ones.
    pub fn to_si(&self, r_nd: &Vector3<f64>, v_nd: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        (r_nd * self.length, v_nd * (self.length / self.time))
    }

    /// Nondimensional position and velocity from those in SI.
    pub fn to_nd(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        (r / self.length, v * (self.time / self.length))
    }

    /// Acceleration as seen in axes N, m/s2.
    ///
    /// * `r`, `v`: position and velocity, N, m and m/s.
    pub fn acceleration(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        self.in_lanes([r.x, r.y, r.z], [v.x, v.y, v.z]).into()
    }

    /// [`Cr3bpSystem::acceleration`] of two vehicles, to the bit.
    pub fn accelerations(&self, r: [&Vector3<f64>; 2], v: [&Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        lanes::apart(self.in_lanes(lanes::beside(r), lanes::beside(v)))
    }

    #[inline]
    fn in_lanes<T: Lanes>(&self, r: [T; 3], v: [T; 3]) -> [T; 3] {
        let (length, per_velocity) = (T::all(self.length), T::all(self.time / self.length));
        let unit = T::all(self.length / (self.time * self.time));
        let a = self
            .problem
            .in_lanes(r.map(|x| x / length), v.map(|x| x * per_velocity));
        a.map(|x| x * unit)
    }

    /// Partials of the acceleration by position, 1/s2, and by velocity, 1/s; 3x3 each.
    ///
    /// * `r`: position, N, m.
    pub fn partials(&self, r: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        let (by_r, by_v) = self.problem.partials(&(r / self.length));
        (by_r / (self.time * self.time), by_v / self.time)
    }

    /// Position of the smaller body, N, m.
    pub fn secondary(&self) -> Vector3<f64> {
        self.problem.secondary() * self.length
    }

    /// Angular rate of axes N against inertial ones, rad/s.
    pub fn rate(&self) -> Vector3<f64> {
        Vector3::z() / self.time
    }

    /// Motion about the smaller body: position from it and inertial velocity relative to it, components along N.
    ///
    /// The smaller body rests in N, so the inertial velocity is that in N and what the rotation adds.
    ///
    /// * `r`, `v`: position and velocity, N, m and m/s.
    pub fn about_secondary(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let r = r - self.secondary();
        let v = v + Vector3::z().cross(&r) / self.time;
        (r, v)
    }

    /// Radial, transverse, normal axes of the orbit about the smaller body.
    ///
    /// * `r`, `v`: position and velocity, N, m and m/s.
    /// * returns: `dcm_rtn_n`, or `None` where that orbit has no normal.
    pub fn rtn_about_secondary(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Option<Matrix3<f64>> {
        let (r, v) = self.about_secondary(r, v);
        frames::try_rtn(&r, &v)
    }
}

/// The inertial axes I from which axes N turn about z, over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InertialAxes {
    /// Angle by which N have turned at `end`, rad.
    pub angle_at_end: f64,
    /// That time, s since the start of the run.
    pub end: f64,
    /// Inverse of the mean motion, s.
    pub time: f64,
}

impl InertialAxes {
    /// Angle by which N have turned, rad, `t` s since the start of the run.
    pub fn angle(&self, t: f64) -> f64 {
        self.angle_at_end + (t - self.end) / self.time
    }

    /// Direction cosine matrix `dcm_n_i` from I to N, `t` s since the start of the run.
    pub fn dcm_n_i(&self, t: f64) -> Matrix3<f64> {
        dcm_rotating_inertial(self.angle(t))
    }
}

/// Direction cosine matrix from inertial axes to axes that have turned from them about z by `angle`, rad.
pub fn dcm_rotating_inertial(angle: f64) -> Matrix3<f64> {
    rotation::about(&Vector3::z_axis(), -angle).into_inner()
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
    fn two_vehicles_at_once_have_the_bits_of_either() {
        let system = Cr3bpSystem::EARTH_MOON;
        let (r_nd, v_nd) = near_the_moon();
        let (r, v) = system.to_si(&r_nd, &v_nd);
        let (r_other, v_other) = (r * -0.3, v + Vector3::new(1.0, -20.0, 300.0));
        let alone = [system.acceleration(&r, &v), system.acceleration(&r_other, &v_other)];
        let both = system.accelerations([&r, &r_other], [&v, &v_other]);
        assert_eq!(both.map(|a| a.map(f64::to_bits)), alone.map(|a| a.map(f64::to_bits)));
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

    /// Collinear points of the Earth and the Moon as JPL's catalogue of three-body periodic orbits gives them.
    #[test]
    fn val_collinear_points_of_the_earth_and_the_moon() {
        let problem = Cr3bp {
            mass_ratio: 1.215_058_560_962_404e-2,
        };
        for x in [0.836_915, 1.155_682, -1.005_063] {
            // The acceleration changes sign within one unit of the last digit.
            let [before, after] =
                [x - 1e-6, x + 1e-6].map(|x| problem.acceleration(&Vector3::new(x, 0.0, 0.0), &Vector3::zeros()).x);
            assert!(before * after < 0.0, "{x}: {before} and {after}");
        }
    }

    /// The distance g of a collinear point from the smaller body solves Euler's quintic, for any mass ratio.
    #[test]
    fn collinear_points_solve_the_quintic() {
        for mu in [3e-6, 9.54e-4, 1.215e-2, 0.3, 0.5] {
            for side in [-1.0, 1.0] {
                let quintic = |g: f64| {
                    let odd = g.powi(5) + (3.0 - 2.0 * mu) * g.powi(3) - mu * g * g - mu;
                    odd + side * ((3.0 - mu) * g.powi(4) - 2.0 * mu * g)
                };
                let (mut low, mut high) = (1e-6, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if quintic(middle) < 0.0 {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                let place = Vector3::new(1.0 - mu + side * low, 0.0, 0.0);
                let a = Cr3bp { mass_ratio: mu }.acceleration(&place, &Vector3::zeros());
                // The root is good to the rounding of 1, times the slope of the acceleration, some 10.
                assert!(a.amax() < 1e-13, "{mu}, side {side}: {a}");
            }
        }
    }

    #[test]
    fn si_is_newtons_law_in_turning_axes() {
        // A system in which the scales are consistent: mu_1 + mu_2 = length^3 / time^2.
        let system = Cr3bpSystem::new(0.2, 3e8, 4e5).unwrap();
        let total = 3e8_f64.powi(3) / 4e5_f64.powi(2);
        let (r, v) = (Vector3::new(1.3e8, 0.7e8, -0.4e8), Vector3::new(150.0, -80.0, 300.0));
        let pull = |mu: f64, x: f64| {
            let d: Vector3<f64> = r - Vector3::x() * x;
            d * (-mu / d.norm().powi(3))
        };
        let omega = Vector3::z() / 4e5;
        let expected = pull(0.8 * total, -0.2 * 3e8) + pull(0.2 * total, 0.8 * 3e8)
            - omega.cross(&v) * 2.0
            - omega.cross(&omega.cross(&r));
        let a = system.acceleration(&r, &v);
        assert!((a - expected).amax() < 1e-14 * expected.amax(), "{a} and {expected}");
        let (by_r, by_v) = system.partials(&r);
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = 1e3;
            let column = (system.acceleration(&(r + step), &v) - system.acceleration(&(r - step), &v)) / 2e3;
            assert!(
                (by_r.column(axis) - column).amax() < 1e-8 * by_r.amax(),
                "position {axis}"
            );
            let column = (system.acceleration(&r, &(v + step)) - system.acceleration(&r, &(v - step))) / 2e3;
            assert!(
                (by_v.column(axis) - column).amax() < 1e-9 * by_v.amax(),
                "velocity {axis}"
            );
        }
        let (r_nd, v_nd) = system.to_nd(&r, &v);
        let (r_back, v_back) = system.to_si(&r_nd, &v_nd);
        assert!((r_back - r).amax() < 1e-7 && (v_back - v).amax() < 1e-12);
    }

    #[test]
    fn orbit_about_the_smaller_body_by_hand() {
        let system = Cr3bpSystem::EARTH_MOON;
        // At rest in N, 1e7 m behind the Moon: the rotation alone moves it, along y.
        let r = system.secondary() + Vector3::new(1e7, 0.0, 0.0);
        let (from_moon, v) = system.about_secondary(&r, &Vector3::zeros());
        assert!((from_moon - Vector3::new(1e7, 0.0, 0.0)).amax() < 1e-7);
        assert!((v - Vector3::new(0.0, 1e7 / 3.752e5, 0.0)).amax() < 1e-12, "{v}");
        let dcm = system.rtn_about_secondary(&r, &Vector3::zeros()).unwrap();
        assert!((dcm - Matrix3::identity()).amax() < 1e-14, "{dcm}");
        assert_eq!(system.rtn_about_secondary(&system.secondary(), &Vector3::y()), None);
        // On the axis of rotation, moving along it.
        let pole = system.secondary() + Vector3::new(0.0, 0.0, 1e7);
        assert_eq!(system.rtn_about_secondary(&pole, &Vector3::z()), None);
    }

    #[test]
    fn axes_turn_once_in_a_period() {
        let axes = InertialAxes {
            angle_at_end: 0.5,
            end: 1000.0,
            time: 4e5,
        };
        assert!((axes.angle(1000.0) - 0.5).abs() < 1e-15);
        let turn = std::f64::consts::TAU * 4e5;
        assert!((axes.dcm_n_i(1000.0 - turn) - axes.dcm_n_i(1000.0)).amax() < 1e-14);
        // A direction at the angle of the axes lies on x of N.
        let along = axes.dcm_n_i(1000.0) * Vector3::new(0.5_f64.cos(), 0.5_f64.sin(), 0.0);
        assert!((along - Vector3::x()).amax() < 1e-15);
    }

    #[test]
    fn what_is_no_pair_of_bodies_is_refused() {
        for (mass_ratio, length, time, said) in [
            (0.0, 1.0, 1.0, "mass ratio 0"),
            (0.6, 1.0, 1.0, "at most 0.5"),
            (f64::NAN, 1.0, 1.0, "NaN"),
            (0.1, 0.0, 1.0, "0 m"),
            (0.1, 1.0, f64::INFINITY, "inf s"),
        ] {
            let error = Cr3bpSystem::new(mass_ratio, length, time).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
