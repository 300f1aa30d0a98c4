//! A bound: the filter that is told when something unannounced pushes the target, not how hard or in which direction.
//!
//! It has one density for all pushes, so a law that learns how hard each of them is may pass it where they are unlike.

use super::adaptation::{Adaptation, Hindsight, Setup};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Scales, Start, Tunable};
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "times_known",
    about: "bound, told by the truth: knows when the target is pushed; white acceleration then and at other times, no state",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: true,
    tunables: &[
        Tunable {
            name: "q_active",
            about: "square root of the acceleration density while something unannounced pushes the target",
            kind: Kind::Real {
                start: Start::Derived(Scales::root_acceleration_density),
                unit: "m/s^1.5",
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "q_quiet",
            about: "the same at all other times",
            kind: Kind::Real {
                start: Start::Fixed(1e-8),
                unit: "m/s^1.5",
                bound: Bound::NonNegative,
            },
        },
    ],
    presets: &[Preset {
        name: "paper",
        about: "the density of the mission's own disturbance, one that comes after the other, while it acts",
        other_reading: false,
        sets: &[],
    }],
    // What suits it is known in hindsight: from a vent of the missions, 1e-5 m/s2, to a burn.
    search: &[
        Search {
            tunable: "q_active",
            low: 1e-6,
            high: 1.0,
            only_with: None,
        },
        Search {
            tunable: "q_quiet",
            low: 1e-9,
            high: 1e-3,
            only_with: None,
        },
    ],
};

/// Two densities of white acceleration, and which of them holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TimesKnown {
    /// Square roots of the densities, internal units.
    q_active: f64,
    q_quiet: f64,
    /// Density up to the next sample.
    density: f64,
}

impl TimesKnown {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let of = |name| setup.root_acceleration_density(name);
        let (q_active, q_quiet) = (of("q_active")?, of("q_quiet")?);
        Ok(Self {
            q_active,
            q_quiet,
            density: q_quiet * q_quiet,
        })
    }
}

impl Adaptation for TimesKnown {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::white_acceleration(self.density, dt)
    }

    fn hear(&mut self, truth: &Hindsight) {
        let (active, quiet) = (self.q_active * self.q_active, self.q_quiet * self.q_quiet);
        self.density = quiet + (active - quiet) * truth.active;
    }
}
