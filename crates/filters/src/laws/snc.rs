//! State noise compensation: no acceleration state, white acceleration of constant density.

use super::adaptation::{Adaptation, Setup};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Scales, Start, Tunable};
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "snc",
    about: "state noise compensation: constant white-acceleration density, no acceleration state",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[Tunable {
        name: "q",
        about: "square root of the acceleration density, one number for all axes",
        kind: Kind::Real {
            start: Start::Derived(Scales::root_acceleration_density),
            unit: "m/s^1.5",
            bound: Bound::Positive,
        },
    }],
    presets: &[Preset {
        name: "paper",
        about: "the mission's own q",
        other_reading: false,
        sets: &[],
    }],
    search: &[
        // A vent is worth about 5e-5, a disturbance of 1e-5 m/s2 that varies over 1000 s about 4e-4.
        Search {
            tunable: "q",
            low: 1e-7,
            high: 1e-2,
            only_with: None,
        },
    ],
};

/// Constant white-acceleration density.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snc {
    /// Square root of the density, internal units.
    q: f64,
}

impl Snc {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            q: setup.root_acceleration_density("q")?,
        })
    }
}

impl Adaptation for Snc {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::white_acceleration(self.q * self.q, dt)
    }
}
