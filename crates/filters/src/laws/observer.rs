//! A full-state observer of constant gain with the learning network (Pesce, Silvestrini and Lavagna, Sec. III.B.1).

use super::adaptation::{Adaptation, Setup, Step};
use super::entry::{FilterEntry, Motion, Search, Update};
use super::learner::Learner;
use super::network;
use crate::disturbance::Disturbance;
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Start, Tunable};
use crate::update::ConstantGain;
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "observer",
    about: "constant-gain observer with a learning radial-basis network, no covariance (Pesce, Silvestrini and Lavagna)",
    motion: Motion::OfFrame,
    update: Update::ConstantGain(gain),
    ours: false,
    bound: false,
    tunables: &network::with::<2, 11>([
        Tunable {
            name: "k_position",
            about: "gain on position, K_h of Eq. (33)",
            kind: Kind::Real {
                start: Start::Fixed(0.42),
                unit: "1/s",
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "k_velocity",
            about: "gain on velocity, K_h of Eq. (33)",
            kind: Kind::Real {
                start: Start::Fixed(0.025),
                unit: "1/s",
                bound: Bound::NonNegative,
            },
        },
    ]),
    presets: &[Preset {
        name: "paper",
        about: "gains that fit the paper's Table 3",
        other_reading: false,
        sets: &[],
    }],
    search: &[
        network::SEARCH_LEARNING_RATE,
        network::SEARCH_SHAPE,
        Search {
            tunable: "k_position",
            low: 1e-4,
            high: 10.0,
            only_with: None,
        },
        Search {
            tunable: "k_velocity",
            low: 1e-4,
            high: 10.0,
            only_with: None,
        },
    ],
};

/// The gain that the tunables say, detuned if the study says so; internal units.
fn gain(setup: &Setup<'_>) -> Result<ConstantGain, FilterError> {
    let gain = |name: &str| Ok::<f64, FilterError>(setup.tunables.real(name)? * setup.off_nominal * setup.units.time);
    Ok(ConstantGain {
        position: gain("k_position")?,
        velocity: gain("k_velocity")?,
    })
}

/// The network; an observer has no process noise to adapt.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Observer {
    learner: Learner,
}

impl Observer {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            learner: Learner::new(setup)?,
        })
    }
}

impl Adaptation for Observer {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, _dt: f64) -> TargetMatrix {
        TargetMatrix::zeros()
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        self.learner.observe(step);
        Ok(())
    }

    fn look_ahead(&mut self, x: &Vector6<f64>) {
        self.learner.look_ahead(x);
    }

    fn disturbance(&self) -> Option<&Disturbance> {
        Some(self.learner.disturbance())
    }
}
