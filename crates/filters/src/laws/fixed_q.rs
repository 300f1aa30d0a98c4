//! No adaptation: an acceleration state driven by jerk of constant density. The yardstick for every other law.

use super::adaptation::{Adaptation, Setup};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Scales, Start, Tunable};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "fixed_q",
    about: "constant jerk density, acceleration as a state",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: false,
    bound: false,
    tunables: &[Tunable {
        name: "s",
        about: "square root of the jerk density, one number for all axes",
        kind: Kind::Real {
            start: Start::Derived(Scales::root_jerk_density),
            unit: "m/s^2.5",
            bound: Bound::Positive,
        },
    }],
    presets: &[
        Preset {
            name: "paper",
            about: "the mission's own s; 1e-5 m/s^2.5 in those of the papers",
            other_reading: false,
            sets: &[],
        },
        Preset {
            name: "small",
            about: "s = 1e-6 m/s^2.5, about the size of the vents",
            other_reading: false,
            sets: &[("s", "1e-6")],
        },
        Preset {
            name: "slow",
            about: "s = 1e-8 m/s^2.5, for a disturbance that swings by 1e-6 m/s2 within a thousand seconds",
            other_reading: false,
            sets: &[("s", "1e-8")],
        },
    ],
    search: &[
        // Vents are worth 1e-7 to 1e-6, a disturbance of 1e-5 m/s2 that varies over 1000 s about 5e-7.
        Search {
            tunable: "s",
            low: 1e-9,
            high: 1e-3,
            only_with: None,
        },
    ],
};

/// Constant jerk density.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FixedQ {
    /// Square root of the density, internal units.
    s: f64,
}

impl FixedQ {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            s: setup.tunables.real("s")? / setup.units.root_jerk_density() * setup.off_nominal.sqrt(),
        })
    }
}

impl Adaptation for FixedQ {
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::process_noise(&Vector3::repeat(self.s * self.s), dt)
    }

    fn s(&self) -> Vector3<f64> {
        Vector3::repeat(self.s)
    }
}
