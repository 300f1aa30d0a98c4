//! Radiation pressure of the Sun.

use astro::radiation;
use interface::mission::{Mission, Shadow};
use serde::{Deserialize, Serialize};

use super::{Ambient, Model, Needs, Place, Sky};
use crate::TruthError;

/// Sunlight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Radiation {
    /// Radius of the shadow's cylinder, m; zero: no shadow.
    shadow_radius: f64,
}

impl Model for Radiation {
    fn of(mission: &Mission) -> Result<Option<Self>, TruthError> {
        let Some(radiation) = mission.environment.radiation else {
            return Ok(None);
        };
        Ok(Some(Self {
            shadow_radius: match radiation.shadow {
                Shadow::None => 0.0,
                Shadow::Cylindrical => super::gravity::radius(mission)?,
            },
        }))
    }

    fn needs(&self) -> Needs {
        Needs {
            bodies: true,
            ..Needs::default()
        }
    }

    fn act(&self, sky: &Sky, place: &Place<'_>, sum: &mut Ambient) {
        let coefficient = place.surface.cr * place.surface.area_per_mass;
        sum.surface += radiation::acceleration(place.r, &sky.sun, self.shadow_radius, coefficient);
    }
}
