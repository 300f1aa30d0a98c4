//! Drag.

use astro::Atmosphere;
use astro::atmosphere::Layer;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Given, Model, Place, Sky};
use crate::TruthError;

/// Air, which turns with the central body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Drag {
    atmosphere: Atmosphere,
}

impl Model for Drag {
    fn of(given: &Given<'_>) -> Result<Option<Self>, TruthError> {
        let Some(drag) = given.mission.environment.drag else {
            return Ok(None);
        };
        let layer = drag
            .density_kg_m3
            .zip(drag.reference_altitude_m)
            .zip(drag.scale_height_m);
        let atmosphere = match layer {
            Some(((density, altitude), scale_height)) => Atmosphere::layer(Layer {
                density,
                altitude,
                scale_height,
                radius: given.gravity.radius(),
                rate: given.almanac.rate(),
            })?,
            None => Atmosphere::Earth,
        };
        Ok(Some(Self { atmosphere }))
    }

    fn push(&self, _sky: &Sky, place: &Place<'_>, sum: &mut Vector3<f64>) {
        let coefficient = place.surface.cd * place.surface.area_per_mass;
        *sum += self.atmosphere.drag(place.r, place.v, coefficient);
    }
}
