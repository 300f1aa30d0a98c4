//! Dynamic model compensation: the acceleration state is a first-order Gauss-Markov process.

use super::adaptation::{Adaptation, Setup};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Start, Tunable};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "dmc",
    about: "dynamic model compensation: first-order Gauss-Markov acceleration",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[
        Tunable {
            name: "sigma",
            about: "steady standard deviation of the acceleration, per axis",
            kind: Kind::Real {
                start: Start::Derived(|scales| scales.disturbance),
                unit: "m/s2",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "time_constant",
            about: "correlation time of the acceleration",
            kind: Kind::Real {
                start: Start::Derived(|scales| scales.time),
                unit: "s",
                bound: Bound::Positive,
            },
        },
    ],
    presets: &[Preset {
        name: "paper",
        about: "the mission's own sigma and correlation time",
        other_reading: false,
        sets: &[],
    }],
    search: &[
        Search {
            tunable: "sigma",
            low: 1e-8,
            high: 1e-3,
            only_with: None,
        },
        // From the sampling period to beyond the slowest disturbance.
        Search {
            tunable: "time_constant",
            low: 1.0,
            high: 1e4,
            only_with: None,
        },
    ],
};

/// First-order Gauss-Markov acceleration.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Dmc {
    /// Square root of the density of the white jerk that drives it, internal units.
    s: f64,
    /// Decay rate, internal units.
    beta: f64,
}

impl Dmc {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let sigma = setup.tunables.real("sigma")? / setup.units.acceleration() * setup.off_nominal.sqrt();
        let beta = setup.units.time / setup.tunables.real("time_constant")?;
        Ok(Self {
            s: sigma * (2.0 * beta).sqrt(),
            beta,
        })
    }
}

impl Adaptation for Dmc {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::GaussMarkov(self.beta)
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::gauss_markov(self.s * self.s, self.beta, dt)
    }

    fn s(&self) -> Vector3<f64> {
        Vector3::repeat(self.s)
    }
}
