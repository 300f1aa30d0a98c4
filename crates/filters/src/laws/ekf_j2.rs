//! No network and no adaptation, but the J2 relative model in place of Clohessy-Wiltshire: "EKF - nonlinear" of Pesce,
//! Silvestrini and Lavagna.

use super::adaptation::{Adaptation, Setup};
use super::entry::{FilterEntry, Motion, Update};
use super::step_noise::{self, Q_POSITION, Q_VELOCITY};
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::state::TargetMatrix;
use crate::tunable::Preset;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "ekf_j2",
    about: "nonlinear J2 relative dynamics about the target's known orbit, constant Q (Pesce, Silvestrini and Lavagna)",
    motion: Motion::J2,
    update: Update::Kalman,
    ours: false,
    bound: false,
    tunables: &[Q_POSITION, Q_VELOCITY],
    presets: &[Preset {
        name: "paper",
        about: "the Q that fits the paper's Table 3",
        other_reading: false,
        sets: &[],
    }],
    search: &[step_noise::SEARCH_Q_POSITION, step_noise::SEARCH_Q_VELOCITY],
};

/// Constant variances per unit of time; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct EkfJ2 {
    q: TargetMatrix,
}

impl EkfJ2 {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(Self {
            q: step_noise::rate(setup)?,
        })
    }
}

impl Adaptation for EkfJ2 {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        self.q * dt
    }
}
