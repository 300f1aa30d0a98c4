//! What the models of the surroundings need to know of the body at the centre: where Sun, Earth and Moon stand about it,
//! how it turns, its radius and its air.
//!
//! Axes N of a central body are inertial, with z along its pole and x towards the ascending node of its equator:
//! * of the Earth: the mean equator and equinox of date, see [`crate::earth_rotation`];
//! * of the Moon: its equator at the epoch of the run, x towards its node on the equator of the ICRF, so that inclinations
//!   are counted from the Moon's equator and zonal gravity has its axis along z. They keep still; the Moon's pole moves
//!   away from them by about 0.01 deg in a day.

use nalgebra::{Matrix3, Vector3};
use numerics::rotation;
use serde::{Deserialize, Serialize};

use crate::harmonics::EGM96;
use crate::{AstroError, Atmosphere, earth_rotation, epoch, moon_rotation, precession, sun_moon};

/// A body whose place is known.
struct Body {
    name: &'static str,
    /// Gravitational parameter, m3/s2.
    mu: f64,
    /// Position from days since J2000.0: geocentric, mean equator and equinox of date, m.
    geocentric: fn(f64) -> Vector3<f64>,
    /// What is known of it as a central body.
    centre: Option<Centre>,
}

/// What is known of a central body.
struct Centre {
    /// Radius, m: of the equator, or the mean one.
    radius: f64,
    /// Axes N of a run that begins at these days since J2000.0, from the mean equator and equinox of date.
    dcm_n_date: fn(f64) -> Matrix3<f64>,
    /// Body-fixed axes from the mean equator and equinox of date, from days since J2000.0.
    dcm_f_date: fn(f64) -> Matrix3<f64>,
    atmosphere: Option<Atmosphere>,
}

/// Every body whose place is known. To add one: a line here.
const BODIES: &[Body] = &[
    Body {
        name: "sun",
        mu: sun_moon::SUN_MU,
        geocentric: sun_moon::sun,
        centre: None,
    },
    Body {
        name: "earth",
        mu: EGM96.mu,
        geocentric: |_| Vector3::zeros(),
        centre: Some(Centre {
            radius: EGM96.r_ref,
            dcm_n_date: |_| Matrix3::identity(),
            dcm_f_date: earth_rotation::dcm_f_n,
            atmosphere: Some(Atmosphere::Earth),
        }),
    },
    Body {
        name: "moon",
        mu: sun_moon::MOON_MU,
        geocentric: sun_moon::moon,
        centre: Some(Centre {
            // IAU mean radius.
            radius: 1.7374e6,
            dcm_n_date: |days| moon_rotation::dcm_equator_icrf(days) * precession::dcm_date_j2000(days).transpose(),
            dcm_f_date: |days| moon_rotation::dcm_f_icrf(days) * precession::dcm_date_j2000(days).transpose(),
            atmosphere: None,
        }),
    },
];

/// Names of the bodies that `suits`.
fn names(suits: impl Fn(&Body) -> bool) -> String {
    let names: Vec<_> = BODIES.iter().filter(|body| suits(body)).map(|body| body.name).collect();
    names.join(", ")
}

/// The body at the centre of a run, with the axes N that begin with it.
#[derive(Clone, Copy)]
pub struct CentralBody {
    body: &'static Body,
    centre: &'static Centre,
    epoch_jd: f64,
    dcm_n_date: Matrix3<f64>,
}

/// A body that disturbs the motion about another.
#[derive(Clone, Copy)]
pub struct ThirdBody {
    body: &'static Body,
}

impl CentralBody {
    /// The body of this name at the centre of a run.
    ///
    /// * `epoch_jd`: Julian date of the start of the run, from [`epoch::julian_date`].
    ///
    /// # Errors
    /// When nothing is known of the surroundings of this body; the message says of which it is.
    pub fn new(name: &str, epoch_jd: f64) -> Result<Self, AstroError> {
        let found = BODIES.iter().find(|body| body.name == name);
        let (body, centre) = found
            .and_then(|body| Some((body, body.centre.as_ref()?)))
            .ok_or_else(|| AstroError::UnknownCentre {
                name: name.to_owned(),
                known: names(|body| body.centre.is_some()),
            })?;
        Ok(Self {
            body,
            centre,
            epoch_jd,
            dcm_n_date: (centre.dcm_n_date)(epoch::days_since_j2000(epoch_jd, 0.0)),
        })
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.body.name
    }

    /// Gravitational parameter, m3/s2; a mission may well use another.
    pub fn mu(&self) -> f64 {
        self.body.mu
    }

    /// Radius of the body and of its shadow, m.
    pub fn radius(&self) -> f64 {
        self.centre.radius
    }

    /// A body that disturbs the motion about this one.
    ///
    /// # Errors
    /// When its place is not known, or when it is this body itself.
    pub fn third_body(&self, name: &str) -> Result<ThirdBody, AstroError> {
        if name == self.body.name {
            return Err(AstroError::ThirdIsCentre {
                name: self.body.name,
                others: names(|body| body.name != name),
            });
        }
        let body = BODIES.iter().find(|body| body.name == name);
        body.map(|body| ThirdBody { body })
            .ok_or_else(|| AstroError::UnknownBody {
                name: name.to_owned(),
                known: names(|body| body.name != self.body.name),
            })
    }

    /// Position of another body relative to this one.
    ///
    /// From the Moon, the Earth is minus the Moon's geocentric place, and the Sun the difference of both.
    ///
    /// * `t`: s since the start of the run.
    /// * returns: axes N, m.
    pub fn position(&self, of: &ThirdBody, t: f64) -> Vector3<f64> {
        let days = epoch::days_since_j2000(self.epoch_jd, t);
        self.dcm_n_date * ((of.body.geocentric)(days) - (self.body.geocentric)(days))
    }

    /// Direction cosine matrix `dcm_f_n` from axes N to body-fixed axes F.
    ///
    /// * `t`: s since the start of the run.
    pub fn dcm_f_n(&self, t: f64) -> Matrix3<f64> {
        (self.centre.dcm_f_date)(epoch::days_since_j2000(self.epoch_jd, t)) * self.dcm_n_date.transpose()
    }

    /// Its atmosphere.
    ///
    /// # Errors
    /// When none is known.
    pub fn atmosphere(&self) -> Result<Atmosphere, AstroError> {
        let name = self.body.name;
        self.centre.atmosphere.ok_or(AstroError::NoAtmosphere { name })
    }
}

impl ThirdBody {
    /// Its name.
    pub fn name(&self) -> &'static str {
        self.body.name
    }

    /// Gravitational parameter, m3/s2.
    pub fn mu(&self) -> f64 {
        self.body.mu
    }

    /// Acceleration of a satellite of a central body, relative to that body's centre.
    ///
    /// * `position`: of this body, from [`CentralBody::position`].
    /// * `r`: of the satellite, axes N, m.
    /// * returns: axes N, m/s2.
    pub fn acceleration(&self, position: &Vector3<f64>, r: &Vector3<f64>) -> Vector3<f64> {
        sun_moon::third_body(self.body.mu, position, r)
    }
}

impl std::fmt::Debug for CentralBody {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "CentralBody({}, JD {})", self.body.name, self.epoch_jd)
    }
}

impl std::fmt::Debug for ThirdBody {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ThirdBody({})", self.body.name)
    }
}

/// Body-fixed axes F that turn evenly about the z axis of N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UniformRotation {
    /// Rate, rad/s.
    pub rate: f64,
    /// Angle from the x axis of N to that of F at the start of the run, rad.
    pub angle: f64,
}

impl UniformRotation {
    /// Direction cosine matrix `dcm_f_n`.
    ///
    /// * `t`: s since the start of the run.
    pub fn dcm_f_n(&self, t: f64) -> Matrix3<f64> {
        rotation::about(&Vector3::z_axis(), -(self.angle + self.rate * t)).into_inner()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPOCH: f64 = 2_458_849.5;

    fn centre(name: &str) -> CentralBody {
        CentralBody::new(name, EPOCH).unwrap()
    }

    #[test]
    fn about_the_earth_everything_is_as_in_its_own_modules() {
        let earth = centre("earth");
        for t in [0.0, 21_939.0, 1e6] {
            let days = epoch::days_since_j2000(EPOCH, t);
            let position = |name| earth.position(&earth.third_body(name).unwrap(), t);
            assert_eq!(position("sun"), sun_moon::sun(days));
            assert_eq!(position("moon"), sun_moon::moon(days));
            assert_eq!(earth.dcm_f_n(t), earth_rotation::dcm_f_n(days));
        }
        assert_eq!(earth.atmosphere(), Ok(Atmosphere::Earth));
        let sun = earth.third_body("sun").unwrap();
        let (place, r) = (earth.position(&sun, 0.0), Vector3::new(7e6, 0.0, 1e6));
        assert_eq!(
            sun.acceleration(&place, &r),
            sun_moon::third_body(sun_moon::SUN_MU, &place, &r)
        );
    }

    #[test]
    fn from_the_moon_the_triangle_is_the_same() {
        let (earth, moon) = (centre("earth"), centre("moon"));
        for t in [0.0, 3e5] {
            let from = |centre: &CentralBody, name| centre.position(&centre.third_body(name).unwrap(), t);
            let (e_sun, e_moon) = (from(&earth, "sun"), from(&earth, "moon"));
            let (m_sun, m_earth) = (from(&moon, "sun"), from(&moon, "earth"));
            // Lengths and angles are those of the triangle, whatever the axes.
            assert!((m_earth.norm() - e_moon.norm()).abs() < 1e-6);
            assert!((m_sun.norm() - (e_sun - e_moon).norm()).abs() < 1e-4);
            let (one, other) = (m_sun.angle(&m_earth), (e_sun - e_moon).angle(&-e_moon));
            assert!((one - other).abs() < 1e-12, "{one} and {other}");
            // And right-handed: the same triple product with a third vector, the pole of the Earth, carried over.
            let x = m_sun.cross(&m_earth).dot(&(moon.dcm_n_date * Vector3::z()));
            let y = (e_sun - e_moon).cross(&-e_moon).z;
            assert!((x / y - 1.0).abs() < 1e-12, "{x} and {y}");
        }
    }

    /// Axes N of the Moon are those of its equator at the epoch: the prime meridian alone turns, once in a sidereal month.
    #[test]
    fn the_moon_turns_about_z_once_in_a_month() {
        let moon = centre("moon");
        let start = moon.dcm_f_n(0.0);
        assert!((start.row(2) - Vector3::z().transpose()).amax() < 1e-14, "{start}");
        let month = 27.321_661 * 86_400.0;
        let later = moon.dcm_f_n(month);
        // The pole moves by a twelfth of 0.5 deg, forced librations move the meridian by 0.04 deg.
        assert!((later - start).amax() < 0.05_f64.to_radians(), "{}", later - start);
        // The Earth stands over the near side, within the librations.
        let earth = moon.third_body("earth").unwrap();
        for t in [0.0, 5e5, 1.5e6] {
            let seen = moon.dcm_f_n(t) * moon.position(&earth, t);
            assert!(seen.x / seen.norm() > 10.8_f64.to_radians().cos(), "{seen}");
        }
        // The node's 0.053 deg a day at 1.54 deg, and 0.028 deg of libration in the pace of the month.
        let day = moon.dcm_f_n(86_400.0).row(2).transpose();
        assert!(day.angle(&Vector3::z()).to_degrees() < 0.011, "the pole in a day");
    }

    #[test]
    fn bodies_of_which_nothing_is_known_are_refused() {
        let error = CentralBody::new("mars", EPOCH).unwrap_err().to_string();
        assert!(
            error.contains("\"mars\"") && error.ends_with("one of earth, moon"),
            "{error}"
        );
        assert!(matches!(
            CentralBody::new("sun", EPOCH),
            Err(AstroError::UnknownCentre { .. })
        ));
        let error = centre("moon").third_body("mars").unwrap_err().to_string();
        assert!(
            error.contains("\"mars\"") && error.ends_with("one of sun, earth"),
            "{error}"
        );
        let error = centre("moon").third_body("moon").unwrap_err().to_string();
        assert!(
            error.contains("central body") && error.ends_with("one of sun, earth"),
            "{error}"
        );
        let error = centre("moon").atmosphere().unwrap_err().to_string();
        assert!(error.contains("\"moon\"") && error.contains("scale height"), "{error}");
    }

    #[test]
    fn even_turning_by_hand() {
        let rotation = UniformRotation {
            rate: 0.1,
            angle: std::f64::consts::FRAC_PI_2,
        };
        // After a quarter turn x of F lies on y of N.
        assert!((rotation.dcm_f_n(0.0) * Vector3::y() - Vector3::x()).amax() < 1e-15);
        let half = rotation.dcm_f_n(5.0 * std::f64::consts::PI) * Vector3::x();
        assert!((half + Vector3::x()).amax() < 1e-15, "{half}");
    }
}
