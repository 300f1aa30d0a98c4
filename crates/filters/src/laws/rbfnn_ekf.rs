//! A network learns the unmodelled acceleration, Q stays: the peer of the adaptive filter in Pesce, Silvestrini and Lavagna.

use super::adaptation::{Adaptation, Setup, Step};
use super::entry::{FilterEntry, Motion, Update};
use super::learner::Learner;
use super::network;
use super::step_noise::{self, Q_POSITION, Q_VELOCITY};
use crate::disturbance::Disturbance;
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::state::TargetMatrix;
use crate::tunable::Preset;
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "rbfnn_ekf",
    about: "a radial-basis network learns the disturbance, constant Q (Pesce, Silvestrini and Lavagna)",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: false,
    bound: false,
    tunables: &network::with::<2, 11>([Q_POSITION, Q_VELOCITY]),
    presets: &[
        Preset {
            name: "paper",
            about: "the Q that the adaptive filter starts with, as in the paper",
            other_reading: false,
            sets: &[],
        },
        Preset {
            name: "light",
            about: "a Q and a slow network as a search finds them for the formation",
            other_reading: false,
            sets: &[
                ("q_position", "5e-14"),
                ("q_velocity", "4e-12"),
                ("learning_rate", "0.005"),
                ("shape", "0.7"),
            ],
        },
    ],
    search: &[
        network::SEARCH_LEARNING_RATE,
        network::SEARCH_SHAPE,
        step_noise::SEARCH_Q_POSITION,
        step_noise::SEARCH_Q_VELOCITY,
    ],
};

/// The law and its memory; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RbfnnEkf {
    learner: Learner,
    /// Process noise per unit of time, 9x9.
    q: TargetMatrix,
}

impl RbfnnEkf {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            learner: Learner::new(setup)?,
            q: step_noise::rate(setup)?,
        })
    }
}

impl Adaptation for RbfnnEkf {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        self.q * dt
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
