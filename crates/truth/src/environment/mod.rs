//! What surrounds the vehicles and pulls or pushes them: gravity, and beside it one file for each model and one line in the
//! registry.
//!
//! What depends on time alone (the turn of the central body, the places of Sun and Moon) is in the [`Sky`] of an instant, which
//! is computed once for both vehicles.

mod drag;
mod gravity;
mod radiation;
mod sky;
mod third_bodies;

use interface::mission::{self, Mission};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::TruthError;
use drag::Drag;
use gravity::Gravity;
use radiation::Radiation;
use sky::Almanac;
use third_bodies::ThirdBodies;

pub(crate) use sky::Sky;

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

/// From what a model is made.
pub(crate) struct Given<'a> {
    mission: &'a Mission,
    gravity: &'a Gravity,
    almanac: &'a Almanac,
}

/// A model of something in the surroundings.
pub(crate) trait Model: Sized {
    /// The model that the mission asks for, if it asks for one.
    ///
    /// # Errors
    /// When its numbers make no sense.
    fn of(given: &Given<'_>) -> Result<Option<Self>, TruthError>;

    /// Adds its acceleration, axes N, m/s2, if it is a field that pulls on every part alike; an accelerometer does not feel it.
    fn pull(&self, _sky: &Sky, _place: &Place<'_>, _sum: &mut Vector3<f64>) {}

    /// Adds its acceleration, axes N, m/s2, if it meets the surface; an accelerometer feels it.
    fn push(&self, _sky: &Sky, _place: &Place<'_>, _sum: &mut Vector3<f64>) {}
}

macro_rules! registry {
    ($($name:ident: $model:ty),* $(,)?) => {
        /// Everything that surrounds the vehicles of a mission.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub(crate) struct Environment {
            almanac: Almanac,
            gravity: Gravity,
            $($name: Option<$model>,)*
        }

        impl Environment {
            /// The environment of a mission.
            ///
            /// # Errors
            /// When a field of gravity cannot be read or a date makes no sense.
            pub(crate) fn of(mission: &Mission) -> Result<Self, TruthError> {
                let (almanac, gravity) = (Almanac::of(mission)?, Gravity::of(mission)?);
                let given = Given { mission, gravity: &gravity, almanac: &almanac };
                Ok(Self {
                    $($name: <$model>::of(&given)?,)*
                    almanac,
                    gravity,
                })
            }

            /// What pulls on every part of a vehicle alike, axes N, m/s2.
            #[inline]
            pub(crate) fn pull(&self, sky: &Sky, place: &Place<'_>) -> Vector3<f64> {
                let mut sum = self.gravity.acceleration(sky, place);
                self.pull_beside_gravity(sky, place, &mut sum);
                sum
            }

            #[inline]
            fn pull_beside_gravity(&self, sky: &Sky, place: &Place<'_>, sum: &mut Vector3<f64>) {
                $(if let Some(model) = &self.$name {
                    model.pull(sky, place, sum);
                })*
            }

            /// What meets the surface of a vehicle, axes N, m/s2; its accelerometer feels it.
            #[inline]
            pub(crate) fn push(&self, sky: &Sky, place: &Place<'_>) -> Vector3<f64> {
                let mut sum = Vector3::zeros();
                $(if let Some(model) = &self.$name {
                    model.push(sky, place, &mut sum);
                })*
                sum
            }
        }
    };
}

registry! {
    third_bodies: ThirdBodies,
    radiation: Radiation,
    drag: Drag,
}

impl Environment {
    /// Gravitational parameter of the central body, m3/s2; `None` in the three-body problem.
    pub(crate) fn mu(&self) -> Option<f64> {
        self.gravity.mu()
    }

    /// What it looks like at `t`, s since the start of the run.
    #[inline]
    pub(crate) fn sky(&self, t: f64) -> Sky {
        self.almanac.at(t)
    }

    /// The same with the places of bodies from their series each time, as the reference.
    #[cfg(test)]
    pub(crate) fn without_pages(&self) -> Self {
        Self {
            almanac: self.almanac.without_pages(),
            ..self.clone()
        }
    }

    /// Acceleration of a vehicle by all of it, axes N, m/s2.
    #[inline]
    pub(crate) fn acceleration(&self, sky: &Sky, place: &Place<'_>) -> Vector3<f64> {
        self.pull(sky, place) + self.push(sky, place)
    }

    /// The same of two vehicles, to the bit.
    #[inline]
    pub(crate) fn accelerations(&self, sky: &Sky, places: &[Place<'_>; 2]) -> [Vector3<f64>; 2] {
        let mut pulls = self.gravity.accelerations(sky, places);
        for (pull, place) in pulls.iter_mut().zip(places) {
            self.pull_beside_gravity(sky, place, pull);
            *pull += self.push(sky, place);
        }
        pulls
    }
}
