//! Gravity of the central body, or of the two bodies of the three-body problem.

use astro::harmonics::{Embedded, Extent};
use astro::{Coefficients, Cr3bpSystem, SphericalHarmonics, ZonalGravity};
use interface::mission::{self, Mission};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Place, Sky};
use crate::TruthError;

/// The field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Gravity {
    /// A point mass with zonal harmonics, all zero for two bodies alone.
    Zonal(ZonalGravity),
    /// In turning axes.
    Harmonics(Box<SphericalHarmonics>),
    /// Rotating axes N, scaled to SI.
    Cr3bp(Cr3bpSystem),
}

impl Gravity {
    /// The field that the mission asks for.
    ///
    /// # Errors
    /// When a number is out of its range or a coefficient file cannot be used.
    pub(super) fn of(mission: &Mission) -> Result<Self, TruthError> {
        Ok(match &mission.environment.gravity {
            mission::Gravity::TwoBody(body) => Self::Zonal(ZonalGravity::new(body.mu_m3_s2, body.radius_m, &[])?),
            mission::Gravity::Zonal(body) => Self::Zonal(ZonalGravity::new(body.mu_m3_s2, body.radius_m, &body.j)?),
            mission::Gravity::Harmonics(harmonics) => {
                Self::Harmonics(Box::new(SphericalHarmonics::new(coefficients(mission, harmonics)?)))
            }
            mission::Gravity::Cr3bp(p) => Self::Cr3bp(Cr3bpSystem::new(p.mass_ratio, p.length_m, p.time_s)?),
        })
    }

    /// Gravitational parameter of the central body, m3/s2.
    pub(super) fn mu(&self) -> Option<f64> {
        match self {
            Self::Zonal(field) => Some(field.mu),
            Self::Harmonics(field) => Some(field.coefficients().mu()),
            Self::Cr3bp(_) => None,
        }
    }

    /// Radius of the central body, m, as its coefficients have it; 0 in the three-body problem.
    pub(super) fn radius(&self) -> f64 {
        match self {
            Self::Zonal(field) => field.r_ref,
            Self::Harmonics(field) => field.coefficients().r_ref(),
            Self::Cr3bp(_) => 0.0,
        }
    }

    /// Acceleration by it, axes N, m/s2.
    #[inline]
    pub(super) fn acceleration(&self, sky: &Sky, place: &Place<'_>) -> Vector3<f64> {
        match self {
            Self::Zonal(field) => field.acceleration(place.r),
            Self::Harmonics(field) => sky.dcm_f_n.tr_mul(&field.acceleration(&(sky.dcm_f_n * place.r))),
            Self::Cr3bp(system) => system.acceleration(place.r, place.v),
        }
    }

    /// The same at two places, to the bit.
    #[inline]
    pub(super) fn accelerations(&self, sky: &Sky, places: &[Place<'_>; 2]) -> [Vector3<f64>; 2] {
        let [a, b] = places;
        match self {
            Self::Zonal(field) => field.accelerations([a.r, b.r]),
            Self::Harmonics(field) => {
                let dcm = &sky.dcm_f_n;
                field
                    .accelerations([&(dcm * a.r), &(dcm * b.r)])
                    .map(|f| dcm.tr_mul(&f))
            }
            Self::Cr3bp(system) => system.accelerations([a.r, b.r], [a.v, b.v]),
        }
    }
}

/// Coefficients of a field by name or from its file.
fn coefficients(mission: &Mission, harmonics: &mission::Harmonics) -> Result<Coefficients, TruthError> {
    let extent = Extent {
        degree: harmonics.degree.map(usize::from),
        order: harmonics.order.map(usize::from),
    };
    if let Some(file) = &harmonics.file {
        return Ok(Coefficients::read(&mission.locate(file), extent)?);
    }
    let field = Embedded::find(harmonics.field.as_deref().unwrap_or_default())?.coefficients();
    let degree = extent.degree.unwrap_or(field.degree());
    let order = extent.order.unwrap_or(field.order().min(degree));
    Ok(field.truncated(degree, order)?)
}
