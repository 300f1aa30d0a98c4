//! What surrounds the vehicles and pulls or pushes them: one file for each model and one line in the registry.
//!
//! A model sees the [`Sky`] of an instant, in which what several models ask for (the turn of the central body, the places of
//! Sun and Moon) is computed once.

mod drag;
mod gravity;
mod radiation;
mod sky;
mod third_bodies;

use interface::mission::{self, Mission};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{TruthError, Vehicles};
use drag::Drag;
use gravity::Gravity;
use radiation::Radiation;
use sky::{Almanac, Sky};
use third_bodies::ThirdBodies;

/// What air and light meet of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Surface {
    /// Cross section over mass, m2/kg.
    pub area_per_mass: f64,
    /// Drag coefficient.
    pub cd: f64,
    /// Coefficient of radiation pressure.
    pub cr: f64,
}

impl Surface {
    pub(crate) fn of(vehicle: &mission::Vehicle) -> Self {
        Self {
            area_per_mass: vehicle.area_m2 / vehicle.mass_kg,
            cd: vehicle.cd,
            cr: vehicle.cr,
        }
    }
}

/// Where a vehicle is, axes N.
pub(crate) struct Place<'a> {
    /// Position, m.
    pub r: &'a Vector3<f64>,
    /// Velocity, m/s.
    pub v: &'a Vector3<f64>,
    /// The vehicle.
    pub surface: &'a Surface,
}

/// Accelerations of a vehicle by its surroundings, axes N, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Ambient {
    /// By fields that pull on every part alike; an accelerometer does not feel them.
    pub gravity: Vector3<f64>,
    /// By air and light on the surface; an accelerometer feels it.
    pub surface: Vector3<f64>,
}

impl Ambient {
    /// Both together.
    pub(crate) fn sum(&self) -> Vector3<f64> {
        self.gravity + self.surface
    }
}

/// Accelerations of both vehicles by their surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surroundings {
    pub target: Ambient,
    pub chaser: Ambient,
}

/// A model of something in the surroundings.
pub(crate) trait Model: Sized {
    /// The model that the mission asks for, if it asks for one.
    fn of(mission: &Mission) -> Result<Option<Self>, TruthError>;

    /// What it needs to know of the sky.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// Adds what it does to a vehicle.
    fn act(&self, sky: &Sky, place: &Place<'_>, sum: &mut Ambient);
}

/// Which parts of the sky a model asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Needs {
    /// The turn of body-fixed axes.
    pub turn: bool,
    /// The places of other bodies.
    pub bodies: bool,
}

macro_rules! registry {
    ($($name:ident),* $(,)?) => {
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[allow(clippy::large_enum_variant)]
        enum AnyModel { $($name($name)),* }

        impl AnyModel {
            /// The models that the mission asks for, in the order of the registry, in which their effects are added.
            fn all(mission: &Mission) -> Result<Vec<Self>, TruthError> {
                let mut models = Vec::new();
                $(models.extend($name::of(mission)?.map(Self::$name));)*
                Ok(models)
            }

            fn needs(&self) -> Needs {
                match self { $(Self::$name(model) => model.needs()),* }
            }

            fn act(&self, sky: &Sky, place: &Place<'_>, sum: &mut Ambient) {
                match self { $(Self::$name(model) => model.act(sky, place, sum)),* }
            }
        }
    };
}

registry!(Gravity, ThirdBodies, Radiation, Drag);

/// Everything that surrounds the vehicles of a mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Environment {
    models: Vec<AnyModel>,
    needs: Needs,
    almanac: Almanac,
}

impl Environment {
    /// The environment of a mission.
    ///
    /// # Errors
    /// When a field of gravity cannot be read or a date makes no sense.
    pub(crate) fn of(mission: &Mission) -> Result<Self, TruthError> {
        let models = AnyModel::all(mission)?;
        let needs = models.iter().map(AnyModel::needs).fold(Needs::default(), |a, b| Needs {
            turn: a.turn || b.turn,
            bodies: a.bodies || b.bodies,
        });
        Ok(Self {
            models,
            needs,
            almanac: Almanac::of(mission)?,
        })
    }

    /// Gravitational parameter of the central body, m3/s2; `None` in the three-body problem.
    pub(crate) fn mu(&self) -> Option<f64> {
        self.models.iter().find_map(|model| match model {
            AnyModel::Gravity(gravity) => gravity.mu(),
            _ => None,
        })
    }

    /// What it does to both vehicles at `t`, s since the start of the run.
    pub(crate) fn act(&self, t: f64, state: &Vehicles, target: &Surface, chaser: &Surface) -> Surroundings {
        let sky = self.almanac.at(t, self.needs);
        let on = |r, v, surface| {
            let mut sum = Ambient::default();
            for model in &self.models {
                model.act(&sky, &Place { r, v, surface }, &mut sum);
            }
            sum
        };
        Surroundings {
            target: on(&state.r_t, &state.v_t, target),
            chaser: on(&state.r_c, &state.v_c, chaser),
        }
    }
}
