//! Classical orbital elements of a closed orbit.

use nalgebra::{Rotation3, Vector3};

use crate::AstroError;

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
        let (sin, cos) = true_anomaly.sin_cos();
        let beta = e / (1.0 + (1.0 - e * e).sqrt());
        let eccentric = true_anomaly - 2.0 * (beta * sin).atan2(1.0 + beta * cos);
        eccentric - e * eccentric.sin()
    }

    /// Inertial position and velocity, m and m/s, of these osculating elements.
    ///
    /// * `mu`: gravitational parameter, m3/s2, positive.
    ///
    /// # Errors
    /// When the elements are not those of a closed orbit or not finite.
    pub fn to_state(&self, mu: f64) -> Result<(Vector3<f64>, Vector3<f64>), AstroError> {
        self.check()?;
        let (a, e) = (self.a, self.e);
        let anomaly = eccentric_anomaly(self.mean_anomaly, e);
        let (sin, cos) = anomaly.sin_cos();
        let minor = (1.0 - e * e).sqrt();
        let rate = (mu / a).sqrt() / (1.0 - e * cos);
        let to_inertial = Rotation3::from_axis_angle(&Vector3::z_axis(), self.node)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), self.inclination)
            * Rotation3::from_axis_angle(&Vector3::z_axis(), self.argument_of_periapsis);
        let r = Vector3::new(a * (cos - e), a * minor * sin, 0.0);
        let v = Vector3::new(-rate * sin, rate * minor * cos, 0.0);
        Ok((to_inertial * r, to_inertial * v))
    }

    fn check(&self) -> Result<(), AstroError> {
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
        let step = (big_e - e * big_e.sin() - m) / (1.0 - e * big_e.cos());
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
}
