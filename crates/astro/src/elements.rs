//! Classical orbital elements of a closed orbit.

use nalgebra::Vector3;
use numerics::{math, rotation};

use crate::AstroError;
use crate::error::positive;

/// Eccentricity below which an orbit is a circle, and sine of the inclination below which it is over the equator.
const SINGULAR: f64 = 1e-12;

/// Classical orbital elements; angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elements {
    /// Semi-major axis, m, positive.
    pub a: f64,
    /// Eccentricity, in [0, 1).
    pub e: f64,
    /// Inclination.
    pub inclination: f64,
    /// Right ascension of the ascending node.
    pub node: f64,
    /// Argument of periapsis.
    pub argument_of_periapsis: f64,
    /// Mean anomaly.
    pub mean_anomaly: f64,
}

impl Elements {
    /// Mean anomaly of a place on the orbit, rad, continuous over all turns.
    ///
    /// * `true_anomaly`: angle from the periapsis, rad.
    /// * `e`: eccentricity, in [0, 1).
    ///
    /// Source: Kepler's equation after the eccentric anomaly by Broucke and Cefola, Celestial Mechanics 7 (1973), 388.
    pub fn mean_from_true_anomaly(true_anomaly: f64, e: f64) -> f64 {
        let (sin, cos) = math::sin_cos(true_anomaly);
        let beta = e / (1.0 + (1.0 - e * e).sqrt());
        let eccentric = true_anomaly - 2.0 * math::atan2(beta * sin, 1.0 + beta * cos);
        eccentric - e * math::sin(eccentric)
    }

    /// Osculating elements of an inertial state; the inverse of [`Elements::to_state`].
    ///
    /// Where an angle has no meaning it is zero, and the ones that follow it are counted from where it would be: over the
    /// equator the node lies on x, and on a circle the periapsis at the node. An orbit counts as such when the sine of its
    /// inclination, or its eccentricity, is below 1e-12, a few times the rounding of the state; that moves nothing by more
    /// than some 1e-12 of the distance.
    ///
    /// * `r`, `v`: position and velocity, m and m/s.
    /// * `mu`: gravitational parameter, m3/s2, positive.
    /// * returns: inclination in [0, pi], the other angles in [0, 2 pi).
    ///
    /// # Errors
    /// When the state is on no closed orbit, or `mu` is not positive.
    ///
    /// Source: Vallado, Fundamentals of Astrodynamics and Applications, algorithm 9 (RV2COE), with angles by two-argument
    /// arctangents.
    pub fn from_state(r: &Vector3<f64>, v: &Vector3<f64>, mu: f64) -> Result<Self, AstroError> {
        positive("gravitational parameter", mu, "m3/s2")?;
        let no_orbit = AstroError::NoClosedOrbit {
            r: (*r).into(),
            v: (*v).into(),
        };
        let (distance, momentum) = (r.norm(), r.cross(v));
        let h = momentum.norm();
        let a = 1.0 / (2.0 / distance - v.norm_squared() / mu);
        let towards_periapsis = v.cross(&momentum) / mu - r / distance;
        let e = towards_periapsis.norm();
        // Not-a-number fails every comparison.
        if !(h > 0.0 && a > 0.0 && a.is_finite() && e < 1.0) {
            return Err(no_orbit);
        }
        let normal = momentum / h;
        let tilt = math::hypot(normal.x, normal.y);
        let node = if tilt > SINGULAR {
            math::atan2(normal.x, -normal.y)
        } else {
            0.0
        };
        let to_node = Vector3::new(math::cos(node), math::sin(node), 0.0);
        let ahead = normal.cross(&to_node);
        let from_node = |place: &Vector3<f64>| math::atan2(place.dot(&ahead), place.dot(&to_node));
        let argument_of_periapsis = if e > SINGULAR {
            from_node(&towards_periapsis)
        } else {
            0.0
        };
        let true_anomaly = from_node(r) - argument_of_periapsis;
        Ok(Self {
            a,
            e,
            inclination: math::atan2(tilt, normal.z),
            node: turn(node),
            argument_of_periapsis: turn(argument_of_periapsis),
            mean_anomaly: turn(Self::mean_from_true_anomaly(true_anomaly, e)),
        })
    }

    /// True anomaly, rad: the angle from the periapsis, in the same turn as the mean anomaly.
    ///
    /// Source: Broucke and Cefola, Celestial Mechanics 7 (1973), 388.
    pub fn true_anomaly(&self) -> f64 {
        let eccentric = eccentric_anomaly(self.mean_anomaly, self.e);
        let (sin, cos) = math::sin_cos(eccentric);
        let beta = self.e / (1.0 + (1.0 - self.e * self.e).sqrt());
        eccentric + 2.0 * math::atan2(beta * sin, 1.0 - beta * cos)
    }

    /// Distance of the periapsis from the centre, m; an orbit for which this is less than the body's radius hits it.
    pub fn periapsis_radius(&self) -> f64 {
        self.a * (1.0 - self.e)
    }

    /// Distance of the apoapsis from the centre, m.
    pub fn apoapsis_radius(&self) -> f64 {
        self.a * (1.0 + self.e)
    }

    /// Period, s.
    ///
    /// * `mu`: gravitational parameter, m3/s2, positive.
    pub fn period(&self, mu: f64) -> f64 {
        std::f64::consts::TAU * self.a * (self.a / mu).sqrt()
    }

    /// Inertial position and velocity, m and m/s, of these osculating elements.
    ///
    /// * `mu`: gravitational parameter, m3/s2, positive.
    ///
    /// # Errors
    /// When the elements are not those of a closed orbit or not finite, or `mu` is not positive.
    pub fn to_state(&self, mu: f64) -> Result<(Vector3<f64>, Vector3<f64>), AstroError> {
        self.check()?;
        positive("gravitational parameter", mu, "m3/s2")?;
        let (a, e) = (self.a, self.e);
        let anomaly = eccentric_anomaly(self.mean_anomaly, e);
        let (sin, cos) = math::sin_cos(anomaly);
        let minor = (1.0 - e * e).sqrt();
        let rate = (mu / a).sqrt() / (1.0 - e * cos);
        let to_inertial = rotation::about(&Vector3::z_axis(), self.node)
            * rotation::about(&Vector3::x_axis(), self.inclination)
            * rotation::about(&Vector3::z_axis(), self.argument_of_periapsis);
        let r = Vector3::new(a * (cos - e), a * minor * sin, 0.0);
        let v = Vector3::new(-rate * sin, rate * minor * cos, 0.0);
        Ok((to_inertial * r, to_inertial * v))
    }

    /// Whether these are the elements of a closed orbit: a > 0, 0 <= e < 1, all finite.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn check(&self) -> Result<(), AstroError> {
        if !(self.a > 0.0 && self.a.is_finite()) {
            return Err(AstroError::SemiMajorAxis { a: self.a });
        }
        if !(0.0..1.0).contains(&self.e) {
            return Err(AstroError::Eccentricity { e: self.e });
        }
        for (name, value) in [
            ("inclination", self.inclination),
            ("right ascension of the node", self.node),
            ("argument of periapsis", self.argument_of_periapsis),
            ("mean anomaly", self.mean_anomaly),
        ] {
            if !value.is_finite() {
                return Err(AstroError::Angle { name, value });
            }
        }
        Ok(())
    }
}

/// The same angle in [0, 2 pi).
fn turn(angle: f64) -> f64 {
    let angle = angle.rem_euclid(std::f64::consts::TAU);
    // A negative angle of rounding size is rounded up to the whole turn.
    if angle < std::f64::consts::TAU { angle } else { 0.0 }
}

/// Root of Kepler's equation E - e sin E = M.
///
/// Over half a turn the left side is increasing and convex, so Newton's method from a point right of the root closes in
/// from that side and cannot miss; E <= M + e is such a point. The count only ends the last rounding-size steps.
fn eccentric_anomaly(mean: f64, e: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let turns = (mean / TAU).round() * TAU;
    let (sign, m) = ((mean - turns).signum(), (mean - turns).abs());
    let mut big_e = (m + e).min(PI);
    for _ in 0..100 {
        let step = (big_e - e * math::sin(big_e) - m) / (1.0 - e * math::cos(big_e));
        big_e -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    turns + sign * big_e
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    const MU: f64 = 3.986e14;

    fn elements() -> Elements {
        Elements {
            a: 8.0e6,
            e: 0.12,
            inclination: 0.9,
            node: -2.1,
            argument_of_periapsis: 1.3,
            mean_anomaly: 0.0,
        }
    }

    #[test]
    fn periapsis_of_a_tilted_orbit_by_hand() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let e = Elements {
            inclination: quarter,
            node: quarter,
            argument_of_periapsis: quarter,
            ..elements()
        };
        let (r, v) = e.to_state(MU).unwrap();
        // The node points to y, the orbit plane is y-z, so periapsis is over the pole and the motion goes to -y.
        let distance = e.a * (1.0 - e.e);
        let speed = (MU * (2.0 / distance - 1.0 / e.a)).sqrt();
        assert!((r - Vector3::new(0.0, 0.0, distance)).amax() < 1e-8, "{r}");
        assert!((v - Vector3::new(0.0, -speed, 0.0)).amax() < 1e-10, "{v}");
    }

    #[test]
    fn true_anomaly_is_the_angle_from_periapsis() {
        let e = Elements { e: 0.6, ..elements() };
        let (periapsis, v) = e.to_state(MU).unwrap();
        for k in -40..=40 {
            let angle = 0.3 * f64::from(k);
            let mean_anomaly = Elements::mean_from_true_anomaly(angle, e.e);
            let (r, _) = Elements { mean_anomaly, ..e }.to_state(MU).unwrap();
            let seen = r.dot(&v.normalize()).atan2(r.dot(&periapsis.normalize()));
            // Either angle is good to a few roundings, slower near the apoapsis by (1 + e) / (1 - e).
            assert!((seen - angle).sin().abs() < 1e-13, "{angle}: {seen}");
            // Both anomalies are in the same half turn.
            let half_turns = |angle: f64| (angle / std::f64::consts::PI).floor();
            assert!(
                (half_turns(mean_anomaly) - half_turns(angle)).abs() < 0.5,
                "{angle}: {mean_anomaly}"
            );
        }
    }

    #[test]
    fn mean_anomaly_is_time_since_periapsis() {
        // Kepler's equation against plain integration of the two-body motion.
        let start = elements();
        let period = std::f64::consts::TAU * (start.a.powi(3) / MU).sqrt();
        let (r, v) = start.to_state(MU).unwrap();
        let mut x = Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
        let (parts, steps) = (8, 400);
        let h = period / f64::from(parts * steps);
        for part in 1..=parts {
            for _ in 0..steps {
                x = numerics::rk4::step(0.0, &x, h, |_, x| {
                    let r = Vector3::new(x[0], x[1], x[2]);
                    let g = r * (-MU / r.norm().powi(3));
                    Vector6::new(x[3], x[4], x[5], g.x, g.y, g.z)
                });
            }
            for turns in [0, -3] {
                let mean_anomaly = std::f64::consts::TAU * (f64::from(part) / f64::from(parts) + f64::from(turns));
                let (r, v) = Elements { mean_anomaly, ..start }.to_state(MU).unwrap();
                // Error of the integration over one orbit at this step.
                assert!((r - Vector3::new(x[0], x[1], x[2])).norm() < 1e-2, "part {part}");
                assert!((v - Vector3::new(x[3], x[4], x[5])).norm() < 1e-5, "part {part}");
            }
        }
    }

    #[test]
    fn strongly_eccentric_orbits_have_their_energy_and_angular_momentum() {
        for k in 0..200 {
            let e = Elements {
                e: 0.999,
                mean_anomaly: f64::from(k) * 0.0314,
                ..elements()
            };
            let (r, v) = e.to_state(MU).unwrap();
            let energy = v.norm_squared() / 2.0 - MU / r.norm();
            // The two parts cancel to a two-thousandth, and 1 - e has lost three digits.
            assert!(
                (energy / (-MU / (2.0 * e.a)) - 1.0).abs() < 1e-9,
                "energy at {}",
                e.mean_anomaly
            );
            let h = (MU * e.a * (1.0 - e.e * e.e)).sqrt();
            assert!(
                (r.cross(&v).norm() / h - 1.0).abs() < 1e-12,
                "angular momentum at {}",
                e.mean_anomaly
            );
        }
    }

    #[test]
    fn open_and_undefined_orbits_are_refused() {
        let refused = |e: Elements| e.to_state(MU).unwrap_err();
        assert!(matches!(refused(Elements { a: -1.0, ..elements() }), AstroError::SemiMajorAxis { a } if a < 0.0));
        assert!(matches!(
            refused(Elements { e: 1.0, ..elements() }),
            AstroError::Eccentricity { .. }
        ));
        assert!(matches!(
            refused(Elements {
                e: f64::NAN,
                ..elements()
            }),
            AstroError::Eccentricity { .. }
        ));
        let error = refused(Elements {
            node: f64::NAN,
            ..elements()
        });
        assert!(error.to_string().contains("right ascension"), "{error}");
    }

    #[test]
    fn val_elements_of_printed_examples() {
        let degrees = |e: &Elements| {
            [e.inclination, e.node, e.argument_of_periapsis, e.true_anomaly()].map(|angle| angle.to_degrees())
        };
        // Vallado, example 2-5.
        let (r, v) = (
            Vector3::new(6524.834e3, 6862.875e3, 6448.296e3),
            Vector3::new(4901.327, 5533.756, -1976.341),
        );
        let e = Elements::from_state(&r, &v, 3.986_004_418e14).unwrap();
        assert!((e.a - 36_127.343e3).abs() < 20.0, "{e:?}");
        assert!((e.e - 0.832_853).abs() < 1e-6, "{e:?}");
        for (seen, printed) in degrees(&e).into_iter().zip([87.870, 227.898, 53.38, 92.335]) {
            assert!((seen - printed).abs() < 6e-3, "{seen} and {printed}");
        }
        // Curtis, Orbital Mechanics for Engineering Students, example 4.3: a retrograde orbit.
        let (r, v) = (
            Vector3::new(-6045e3, -3490e3, 2500e3),
            Vector3::new(-3457.0, 6618.0, 2533.0),
        );
        let e = Elements::from_state(&r, &v, 3.986e14).unwrap();
        assert!((e.a - 8788e3).abs() < 500.0 && (e.e - 0.1712).abs() < 5e-5, "{e:?}");
        for (seen, printed) in degrees(&e).into_iter().zip([153.2, 255.3, 20.07, 28.45]) {
            assert!((seen - printed).abs() < 0.05, "{seen} and {printed}");
        }
        assert!(
            (e.periapsis_radius() - 7284e3).abs() < 1e3 && (e.apoapsis_radius() - 10_293e3).abs() < 2e3,
            "{e:?}"
        );
    }

    #[test]
    fn val_period_of_a_geostationary_orbit_is_a_sidereal_day() {
        let stationary = Elements {
            a: 42_164.17e3,
            ..elements()
        };
        // Printed to 5 m, which is worth 15 ms.
        assert!((stationary.period(3.986_004_418e14) - 86_164.1).abs() < 0.05);
    }

    #[test]
    fn angles_without_a_meaning_are_zero() {
        let speed = (MU / 7e6_f64).sqrt();
        let of = |r: [f64; 3], v: [f64; 3]| Elements::from_state(&Vector3::from(r), &Vector3::from(v), MU).unwrap();
        let quarter = std::f64::consts::FRAC_PI_2;
        for (e, inclination, node, periapsis, anomaly) in [
            // Circle over the equator, a quarter turn from x, either way round.
            (of([0.0, 7e6, 0.0], [-speed, 0.0, 0.0]), 0.0, 0.0, 0.0, quarter),
            (
                of([0.0, 7e6, 0.0], [speed, 0.0, 0.0]),
                2.0 * quarter,
                0.0,
                0.0,
                3.0 * quarter,
            ),
            // Circle over the poles that rises through y, seen over the pole.
            (of([0.0, 0.0, 7e6], [0.0, -speed, 0.0]), quarter, quarter, 0.0, quarter),
            // Ellipse over the equator, at its periapsis on -y.
            (
                of([0.0, -7e6, 0.0], [1.1 * speed, 0.0, 0.0]),
                0.0,
                0.0,
                3.0 * quarter,
                0.0,
            ),
        ] {
            let seen = [e.inclination, e.node, e.argument_of_periapsis, e.mean_anomaly];
            for (seen, expected) in seen.into_iter().zip([inclination, node, periapsis, anomaly]) {
                assert!((seen - expected).abs() < 1e-12, "{e:?}");
            }
        }
    }

    #[test]
    fn states_of_no_closed_orbit_are_refused() {
        let r = Vector3::new(7e6, 0.0, 0.0);
        let escape = (2.0 * MU / 7e6_f64).sqrt();
        for (r, v) in [
            (r, Vector3::new(0.0, escape * 1.000_001, 0.0)),
            (r, Vector3::new(100.0, 0.0, 0.0)),
            (r, Vector3::zeros()),
            (Vector3::zeros(), Vector3::new(1.0, 2.0, 3.0)),
            (r, Vector3::new(0.0, f64::NAN, 0.0)),
            (r * f64::INFINITY, Vector3::new(0.0, 7e3, 0.0)),
        ] {
            let error = Elements::from_state(&r, &v, MU).unwrap_err();
            assert!(matches!(error, AstroError::NoClosedOrbit { .. }), "{error}");
        }
        for mu in [0.0, -MU, f64::NAN] {
            assert!(matches!(elements().to_state(mu), Err(AstroError::NotPositive { .. })));
            assert!(Elements::from_state(&r, &Vector3::y(), mu).is_err());
        }
    }

    proptest! {
        #[test]
        fn elements_undo_states(
            a in 1e6..1e9_f64,
            e in prop_oneof![Just(0.0), 0.0..1e-6_f64, 0.0..0.95_f64],
            inclination in prop_oneof![Just(0.0), 0.0..PI, Just(PI)],
            node in -TAU..TAU,
            argument_of_periapsis in -TAU..TAU,
            mean_anomaly in -TAU..TAU,
        ) {
            let given = Elements { a, e, inclination, node, argument_of_periapsis, mean_anomaly };
            let (r, v) = given.to_state(MU).unwrap();
            let found = Elements::from_state(&r, &v, MU).unwrap();
            let (r_back, v_back) = found.to_state(MU).unwrap();
            // Rounding of 1 - e and of angles; the circle costs SINGULAR.
            let bound = 1e-11 / (1.0 - e);
            prop_assert!((r_back - r).norm() < bound * a, "{found:?}");
            prop_assert!((v_back - v).norm() < bound * v.norm() / (1.0 - e), "{found:?}");
            prop_assert!((found.a / a - 1.0).abs() < bound && (found.e - e).abs() < 1e-13 / (1.0 - e), "{found:?}");
            prop_assert!((found.inclination - inclination).abs() < 1e-7, "{found:?}");
            for angle in [found.node, found.argument_of_periapsis, found.mean_anomaly] {
                prop_assert!((0.0..TAU).contains(&angle), "{found:?}");
            }
        }

        #[test]
        fn true_and_mean_anomaly_undo_each_other(true_anomaly in -20.0..20.0_f64, e in 0.0..0.99_f64) {
            let mean_anomaly = Elements::mean_from_true_anomaly(true_anomaly, e);
            let back = Elements { e, mean_anomaly, ..elements() }.true_anomaly();
            // Near the periapsis the true anomaly goes faster by up to sqrt((1 + e) / (1 - e)^3).
            prop_assert!((back - true_anomaly).abs() < 1e-14 * ((1.0 + e) / (1.0 - e).powi(3)).sqrt() * 20.0);
        }
    }
}
