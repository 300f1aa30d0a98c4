//! Covariance matching: the density of a white acceleration grows while innovations are larger than the filter expects, and
//! shrinks while they are smaller.

use super::adaptation::{Adaptation, Setup, Step};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Scales, Start, Tunable};
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "covariance_matching",
    about: "white acceleration whose density follows the size of the innovations",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[
        Tunable {
            name: "q",
            about: "square root of the acceleration density that the filter starts from and comes back to",
            kind: Kind::Real {
                start: Start::Derived(Scales::root_acceleration_density),
                unit: "m/s^1.5",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "samples",
            about: "time constant of the mean of the innovations, samples",
            kind: Kind::Integer {
                start: 30,
                min: 1,
                max: 10_000,
            },
        },
    ],
    presets: &[Preset {
        name: "paper",
        about: "the mission's own q",
        other_reading: false,
        sets: &[],
    }],
    search: &[Search {
        tunable: "q",
        low: 1e-7,
        high: 1e-2,
        only_with: None,
    }],
};

/// The law and its memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CovarianceMatching {
    /// Square root of the density to come back to, internal units.
    q: f64,
    samples: f64,
    /// Running mean of the innovations' squares over their variances: 1 where Q is right.
    ratio: f64,
    updates: i32,
}

impl CovarianceMatching {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let unit = setup.units.velocity() / setup.units.time.sqrt();
        Ok(Self {
            q: setup.tunables.real("q")? / unit * setup.off_nominal.sqrt(),
            samples: f64::from(setup.tunables.integer("samples")?),
            ratio: 1.0,
            updates: 0,
        })
    }
}

impl Adaptation for CovarianceMatching {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        // A ratio of 2 makes the density eight times as large: innovations answer to Q late.
        jerk::white_acceleration(self.q * self.q * self.ratio.clamp(0.1, 10.0).powi(3), dt)
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        let rows = step.s.diagonal();
        let squares = rows.iter().zip(step.innovation.iter()).filter(|(s, _)| **s > 0.0);
        let (count, sum) = squares.fold((0.0, 0.0), |(n, sum), (s, v)| (n + 1.0, sum + v * v / s));
        if count > 0.0 {
            self.ratio += (sum / count - self.ratio) / self.samples;
            self.updates += 1;
        }
        Ok(())
    }

    fn updates(&self) -> i32 {
        self.updates
    }
}
