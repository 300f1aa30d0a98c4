//! Gravity of the central body, or of the two bodies of the three-body problem.

use astro::Coefficients;
use astro::harmonics::{EGM96, Extent};
use astro::{Cr3bp, SphericalHarmonics, ZonalGravity};
use interface::mission::{self, Mission};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Ambient, Model, Needs, Place, Sky};
use crate::TruthError;

/// The field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Gravity {
    /// A point mass with zonal harmonics, all zero for two bodies alone.
    Zonal(ZonalGravity),
    /// In turning axes.
    Harmonics(SphericalHarmonics),
    /// Rotating axes N, scaled to SI.
    Cr3bp { problem: Cr3bp, length: f64, time: f64 },
}

impl Gravity {
    /// Gravitational parameter of the central body, m3/s2.
    pub(super) fn mu(&self) -> Option<f64> {
        match self {
            Self::Zonal(field) => Some(field.mu),
            Self::Harmonics(field) => Some(field.coefficients().mu()),
            Self::Cr3bp { .. } => None,
        }
    }
}

/// Coefficients of a field by name or from its file.
fn coefficients(mission: &Mission, harmonics: &mission::Harmonics) -> Result<Coefficients, TruthError> {
    let extent = Extent {
        degree: harmonics.degree.map(usize::from),
        order: harmonics.order.map(usize::from),
    };
    Ok(match &harmonics.file {
        Some(file) => Coefficients::read(&mission.locate(file), extent)?,
        None => {
            let field = EGM96.coefficients();
            let degree = extent.degree.unwrap_or(field.degree());
            field.truncated(degree, extent.order.unwrap_or(degree))?
        }
    })
}

impl Model for Gravity {
    fn of(mission: &Mission) -> Result<Option<Self>, TruthError> {
        Ok(Some(match &mission.environment.gravity {
            mission::Gravity::TwoBody(body) => Self::Zonal(ZonalGravity {
                mu: body.mu_m3_s2,
                r_ref: body.radius_m,
                j: [0.0; 5],
            }),
            mission::Gravity::Zonal(body) => Self::Zonal(ZonalGravity {
                mu: body.mu_m3_s2,
                r_ref: body.radius_m,
                j: std::array::from_fn(|n| body.j.get(n).copied().unwrap_or(0.0)),
            }),
            mission::Gravity::Harmonics(harmonics) => {
                Self::Harmonics(SphericalHarmonics::new(coefficients(mission, harmonics)?))
            }
            mission::Gravity::Cr3bp(problem) => Self::Cr3bp {
                problem: Cr3bp {
                    mass_ratio: problem.mass_ratio,
                },
                length: problem.length_m,
                time: problem.time_s,
            },
        }))
    }

    fn needs(&self) -> Needs {
        Needs {
            turn: matches!(self, Self::Harmonics(_)),
            ..Needs::default()
        }
    }

    fn act(&self, sky: &Sky, place: &Place<'_>, sum: &mut Ambient) {
        sum.gravity += match self {
            Self::Zonal(field) => field.acceleration(place.r),
            Self::Harmonics(field) => sky.dcm_f_n.tr_mul(&field.acceleration(&(sky.dcm_f_n * place.r))),
            Self::Cr3bp { problem, length, time } => {
                let nd: Vector3<f64> = problem.acceleration(&(place.r / *length), &(place.v * (time / length)));
                nd * (length / (time * time))
            }
        };
    }
}

/// Radius of the central body, m; that of the field's coefficients where it comes with harmonics.
pub(super) fn radius(mission: &Mission) -> Result<f64, TruthError> {
    Ok(match &mission.environment.gravity {
        mission::Gravity::Harmonics(harmonics) => coefficients(mission, harmonics)?.r_ref(),
        other => other.radius_m().unwrap_or(0.0),
    })
}
