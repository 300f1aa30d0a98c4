//! Bodies that pull beside the central one.

use astro::sun_moon;
use interface::mission::Mission;
use serde::{Deserialize, Serialize};

use super::{Ambient, Model, Needs, Place, Sky};
use crate::TruthError;

/// Which bodies pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ThirdBodies {
    sun: bool,
    moon: bool,
}

impl Model for ThirdBodies {
    fn of(mission: &Mission) -> Result<Option<Self>, TruthError> {
        let asked = |name: &str| mission.environment.third_bodies.iter().any(|b| b == name);
        let bodies = Self {
            sun: asked("sun"),
            moon: asked("moon"),
        };
        Ok((bodies.sun || bodies.moon).then_some(bodies))
    }

    fn needs(&self) -> Needs {
        Needs {
            bodies: true,
            ..Needs::default()
        }
    }

    fn act(&self, sky: &Sky, place: &Place<'_>, sum: &mut Ambient) {
        if self.sun {
            sum.gravity += sun_moon::third_body(sun_moon::SUN_MU, &sky.sun, place.r);
        }
        if self.moon {
            sum.gravity += sun_moon::third_body(sun_moon::MOON_MU, &sky.moon, place.r);
        }
    }
}
