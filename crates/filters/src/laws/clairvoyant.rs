//! A bound: the filter that is told everything that pushes the target.

use super::adaptation::{Adaptation, Hindsight, Setup};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Start, Tunable};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "clairvoyant",
    about: "bound, told by the truth: knows all that pushes the target, no acceleration state",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: true,
    tunables: &[Tunable {
        name: "q",
        about: "square root of the acceleration density of what is left, one number for all axes",
        kind: Kind::Real {
            // In an hour less than 1e-6 m/s.
            start: Start::Fixed(1e-8),
            unit: "m/s^1.5",
            bound: Bound::NonNegative,
        },
    }],
    presets: &[Preset {
        name: "paper",
        about: "next to no process noise",
        other_reading: false,
        sets: &[],
    }],
    // Differences of gravity, drag and light between the vehicles are left, where a mission has them.
    search: &[Search {
        tunable: "q",
        low: 1e-9,
        high: 1e-5,
        only_with: None,
    }],
};

/// What pushes the target, as if it had been announced.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Clairvoyant {
    /// Square root of the density, internal units.
    q: f64,
    /// Mean acceleration up to the next sample, axes N, internal units.
    a_t_n: Vector3<f64>,
}

impl Clairvoyant {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            q: setup.root_acceleration_density("q")?,
            a_t_n: Vector3::zeros(),
        })
    }
}

impl Adaptation for Clairvoyant {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::white_acceleration(self.q * self.q, dt)
    }

    fn hear(&mut self, truth: &Hindsight) {
        self.a_t_n = truth.a_t_n;
    }

    fn announced(&self) -> Vector3<f64> {
        self.a_t_n
    }
}
