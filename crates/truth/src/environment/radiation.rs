//! Radiation pressure of the Sun.

use astro::radiation;
use interface::mission::Shadow;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Given, Model, Place, Sky};
use crate::TruthError;

/// Sunlight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Radiation {
    /// Place of the Sun in the sky.
    sun: usize,
    /// Radius of the shadow's cylinder, m; below zero: no shadow.
    shadow_radius: f64,
}

impl Model for Radiation {
    fn of(given: &Given<'_>) -> Result<Option<Self>, TruthError> {
        let asked = given.mission.environment.radiation.zip(given.almanac.sun());
        Ok(asked.map(|(radiation, sun)| Self {
            sun,
            shadow_radius: match radiation.shadow {
                Shadow::None => -1.0,
                Shadow::Cylindrical => given.gravity.radius(),
            },
        }))
    }

    fn push(&self, sky: &Sky, place: &Place<'_>, sum: &mut Vector3<f64>) {
        let coefficient = place.surface.cr * place.surface.area_per_mass;
        *sum += radiation::acceleration(place.r, &sky.places[self.sun], self.shadow_radius, coefficient);
    }
}
