//! The estimators there are, as a closed set that a saved FMU state can hold.

use super::estimator::Estimator;
use super::lvlh::LvlhState;
use super::two_vehicles::InertialState;
use crate::beliefs::Beliefs;
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::laws::Motion;
use crate::state::RowVector;
use crate::update::ConstantGain;
use interface::Navigation;
use interface::mission::Frame;
use serde::{Deserialize, Serialize};

/// The estimator of a running filter.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Kind {
    Inertial(Box<InertialState>),
    Lvlh(Box<LvlhState>),
}

impl Kind {
    /// The estimator of a mission's frame.
    ///
    /// * `told`: the mission, what a user believes included.
    /// * `motion`: dynamics that the filter asks for; `ours`: whether it reproduces no paper.
    /// * `gain`: set for a constant gain in place of that of a covariance.
    ///
    /// # Errors
    /// When the mission tells of something that the frame cannot use, or a belief is out of range.
    pub(crate) fn new(
        told: &Navigation,
        beliefs: &Beliefs,
        motion: Motion,
        ours: bool,
        gain: Option<ConstantGain>,
        acceleration: AccelerationModel,
    ) -> Result<Self, FilterError> {
        Ok(match told.frame {
            Frame::Inertial => Self::Inertial(Box::new(InertialState::new(told, beliefs, ours, acceleration)?)),
            Frame::Lvlh => Self::Lvlh(Box::new(LvlhState::new(told, motion, gain, acceleration)?)),
        })
    }

    /// Noise variances of the sensors of the target, internal units, in the places of a mission's layout.
    ///
    /// * `told`: the mission, what a user believes included.
    pub(crate) fn noise(told: &Navigation) -> RowVector {
        super::sights::noise(told)
    }

    pub(crate) fn get(&self) -> &dyn Estimator {
        match self {
            Self::Inertial(state) => state.as_ref(),
            Self::Lvlh(state) => state.as_ref(),
        }
    }

    pub(crate) fn get_mut(&mut self) -> &mut dyn Estimator {
        match self {
            Self::Inertial(state) => state.as_mut(),
            Self::Lvlh(state) => state.as_mut(),
        }
    }

    /// Does something with a copy that stands on the stack: a prediction asks for no memory.
    pub(crate) fn with_copy<T>(&self, with: impl FnOnce(&mut dyn Estimator) -> T) -> T {
        match self {
            Self::Inertial(state) => with(&mut InertialState::clone(state)),
            Self::Lvlh(state) => with(&mut LvlhState::clone(state)),
        }
    }
}
