//! No network and no adaptation, but the J2 relative model in place of Clohessy-Wiltshire: "EKF - nonlinear" of Pesce,
//! Silvestrini and Lavagna.

use super::step_noise::{self, Q_POSITION, Q_VELOCITY};
use super::{AccelerationModel, Adaptation, FilterEntry, Law, Only, RelativeModel, Setup};
use crate::FilterError;
use crate::scenarios::Measures;
use crate::state::TargetMatrix;
use crate::tunable::Preset;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "ekf_j2",
    about: "nonlinear J2 relative dynamics about the target's known orbit, constant Q (Pesce, Silvestrini and Lavagna)",
    tunables: &[Q_POSITION, Q_VELOCITY],
    presets: &[Preset {
        name: "paper",
        about: "the Q that fits the paper's Table 3",
        sets: &[],
    }],
    search: &[step_noise::SEARCH_Q_POSITION, step_noise::SEARCH_Q_VELOCITY],
    only: Some(Only {
        measures: Measures::RelativeState,
        why: "it is the J2 model in the target's LVLH frame; elsewhere every filter already has the full gravity, as in snc",
    }),
    build,
};

fn build(setup: &Setup<'_>) -> Result<Law, FilterError> {
    Ok(EkfJ2 {
        q: step_noise::rate(setup)?,
    }
    .into())
}

/// Constant variances per unit of time; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct EkfJ2 {
    q: TargetMatrix,
}

impl Adaptation for EkfJ2 {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn relative_model(&self) -> RelativeModel {
        RelativeModel::J2
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        self.q * dt
    }
}
