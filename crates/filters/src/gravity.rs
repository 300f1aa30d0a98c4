//! The gravity models that filters propagate with.

use crate::error::FilterError;
use crate::units::Units;
use astro::harmonics::{Coefficients, EGM96, Extent};
use astro::{CentralBody, Cr3bp, Cr3bpSystem, SphericalHarmonics, UniformRotation, ZonalGravity, epoch};
use interface::{Navigation, mission};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A gravity model: acceleration of a vehicle and its partials, in internal units and axes N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Gravity {
    /// Two-body attraction and zonal harmonics, inertial axes, SI.
    Zonal(ZonalGravity),
    /// Spherical harmonics of a body that turns, inertial axes, SI.
    Harmonics(Box<Turning>),
    /// Circular restricted three-body problem, rotating axes, nondimensional.
    Cr3bp(Cr3bp),
    /// The same, SI.
    Cr3bpSi(Cr3bpSystem),
}

/// A field in body-fixed axes, with how they stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turning {
    field: SphericalHarmonics,
    turn: Turn,
    /// Maps N to body-fixed axes at the epoch for which the field was last asked.
    dcm_f_n: Matrix3<f64>,
}

/// How body-fixed axes turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Turn {
    /// Evenly about z.
    Uniform(UniformRotation),
    /// As a known body does, from the Julian date of the start.
    Body(String, f64),
}

impl Turn {
    fn dcm_f_n(&self, t_s: f64) -> Result<Matrix3<f64>, FilterError> {
        Ok(match self {
            Self::Uniform(rotation) => rotation.dcm_f_n(t_s),
            Self::Body(name, epoch_jd) => CentralBody::new(name, *epoch_jd)?.dcm_f_n(t_s),
        })
    }
}

/// The field of harmonics that a mission names, and how it turns.
fn turning(navigation: &Navigation, harmonics: &mission::Harmonics) -> Result<Turning, FilterError> {
    let extent = Extent {
        degree: harmonics.degree.map(usize::from),
        order: harmonics.order.map(usize::from),
    };
    let coefficients = match &harmonics.file {
        Some(file) => Coefficients::read(file, extent)?,
        None => {
            let field = EGM96.coefficients();
            let degree = extent.degree.unwrap_or(field.degree());
            field.truncated(degree, extent.order.unwrap_or(degree).min(field.order()))?
        }
    };
    let unusable = |what: &str| FilterError::Unusable {
        mission: navigation.mission.clone(),
        what: what.into(),
    };
    let turn = match (navigation.rotation, navigation.body, &navigation.epoch_utc) {
        (Some(rotation), ..) => Turn::Uniform(UniformRotation {
            rate: rotation.rate_deg_s.to_radians(),
            angle: rotation.angle_deg.to_radians(),
        }),
        (None, mission::Body::Other, _) => {
            return Err(unusable(
                "environment.rotation is missing: nothing is known of how this body turns with its harmonics",
            ));
        }
        (None, body, Some(date)) => {
            let name = if body == mission::Body::Earth { "earth" } else { "moon" };
            Turn::Body(name.into(), epoch::julian_date(date)?)
        }
        (None, _, None) => {
            return Err(unusable(
                "time.epoch_utc is missing: the harmonics turn with the body, as \"2020-01-01T00:00:00\"",
            ));
        }
    };
    Ok(Turning {
        dcm_f_n: turn.dcm_f_n(0.0)?,
        field: SphericalHarmonics::new(coefficients),
        turn,
    })
}

impl Gravity {
    /// The gravity that a mission's filter believes in.
    ///
    /// # Errors
    /// When a field cannot be read, its turning is not known, or a constant is out of range.
    pub fn of(navigation: &Navigation) -> Result<Self, FilterError> {
        Ok(match &navigation.gravity {
            mission::Gravity::TwoBody(body) => Self::Zonal(ZonalGravity::new(body.mu_m3_s2, body.radius_m, &[])?),
            mission::Gravity::Zonal(body) => Self::Zonal(ZonalGravity::new(body.mu_m3_s2, body.radius_m, &body.j)?),
            mission::Gravity::Harmonics(field) => Self::Harmonics(Box::new(turning(navigation, field)?)),
            mission::Gravity::Cr3bp(problem) if Units::of(&navigation.units) != Units::SI => Self::Cr3bp(Cr3bp {
                mass_ratio: problem.mass_ratio,
            }),
            mission::Gravity::Cr3bp(problem) => {
                Self::Cr3bpSi(Cr3bpSystem::new(problem.mass_ratio, problem.length_m, problem.time_s)?)
            }
        })
    }

    /// The point mass and zonal part of a central body, SI; `None` in the three-body problem.
    pub(crate) fn zonal(&self) -> Option<ZonalGravity> {
        match self {
            Self::Zonal(zonal) => Some(*zonal),
            Self::Harmonics(turning) => {
                let field = turning.field.coefficients();
                let mut j = [0.0; 5];
                j[0] = field.j2();
                Some(ZonalGravity {
                    mu: field.mu(),
                    r_ref: field.r_ref(),
                    j,
                })
            }
            Self::Cr3bp(_) | Self::Cr3bpSi(_) => None,
        }
    }

    /// Turns a body-fixed field to an epoch, `t_s` after the start; the Earth turns by 7e-5 rad in a step of 1 s, so once a
    /// step is enough.
    ///
    /// # Errors
    /// None for what [`Gravity::of`] returned.
    pub fn turn_to(&mut self, t_s: f64) -> Result<(), FilterError> {
        if let Self::Harmonics(turning) = self {
            turning.dcm_f_n = turning.turn.dcm_f_n(t_s)?;
        }
        Ok(())
    }

    /// Acceleration at position `r` and velocity `v`; the velocity matters in rotating axes only.
    pub fn acceleration(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Zonal(zonal) => zonal.acceleration(r),
            Self::Harmonics(turning) => {
                let dcm_f_n = &turning.dcm_f_n;
                dcm_f_n.tr_mul(&turning.field.acceleration(&(dcm_f_n * r)))
            }
            Self::Cr3bp(problem) => problem.acceleration(r, v),
            Self::Cr3bpSi(system) => system.acceleration(r, v),
        }
    }

    /// Partials of the acceleration by position and by velocity, 3x3 each.
    pub fn partials(&self, r: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        match self {
            Self::Zonal(zonal) => (zonal.gradient(r), Matrix3::zeros()),
            Self::Harmonics(turning) => {
                let dcm_f_n = &turning.dcm_f_n;
                let by_r = dcm_f_n.tr_mul(&turning.field.gradient(&(dcm_f_n * r))) * dcm_f_n;
                (by_r, Matrix3::zeros())
            }
            Self::Cr3bp(problem) => problem.partials(r),
            Self::Cr3bpSi(system) => system.partials(r),
        }
    }
}
