//! Drag.

use astro::atmosphere;
use interface::mission::Mission;
use serde::{Deserialize, Serialize};

use super::{Ambient, Model, Place, Sky};
use crate::TruthError;

/// Air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Drag;

impl Model for Drag {
    fn of(mission: &Mission) -> Result<Option<Self>, TruthError> {
        Ok(mission.environment.drag.map(|_| Self))
    }

    fn act(&self, _sky: &Sky, place: &Place<'_>, sum: &mut Ambient) {
        sum.surface += atmosphere::drag(place.r, place.v, place.surface.cd * place.surface.area_per_mass);
    }
}
