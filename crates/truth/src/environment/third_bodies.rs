//! Bodies that pull beside the central one.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Given, Model, Place, Sky};
use crate::TruthError;
use astro::sun_moon;

/// Which bodies pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ThirdBodies {
    /// Place in the sky and gravitational parameter, m3/s2.
    pulls: Vec<(usize, f64)>,
}

impl Model for ThirdBodies {
    fn of(given: &Given<'_>) -> Result<Option<Self>, TruthError> {
        let asked = &given.mission.environment.third_bodies;
        let pulls = given.almanac.bodies().iter().enumerate();
        let pulls: Vec<_> = pulls
            .filter(|(_, body)| asked.iter().any(|name| name == body.name()))
            .map(|(place, body)| (place, body.mu()))
            .collect();
        Ok((!pulls.is_empty()).then_some(Self { pulls }))
    }

    fn pull(&self, sky: &Sky, place: &Place<'_>, sum: &mut Vector3<f64>) {
        for &(body, mu) in &self.pulls {
            *sum += sun_moon::third_body(mu, &sky.places[body], place.r);
        }
    }
}
