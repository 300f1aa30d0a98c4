//! What one slave holds: parameters and inputs as a master sets them on one side, a running [`Navigator`] on the other.

use filters::{Navigator, Settings};
use interface::mission::Choice;
use interface::{Signals, Status};
use serde::{Deserialize, Serialize};

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NavModel {
    /// Which mission.
    pub choice: Choice,
    /// The other parameters.
    pub settings: Settings,
    /// Values of the tunables that the mission may state, as they act; from initialization on.
    pub resolved: Vec<f64>,
    /// Inputs as set; they take effect in a step only.
    pub inputs: Signals,
    /// The filter, from initialization on.
    pub navigator: Option<Navigator>,
}

impl NavModel {
    /// A value of the running filter, or the default of its type before initialization.
    pub fn read<T: Default>(&self, value: impl Fn(&Navigator) -> T) -> T {
        self.navigator.as_ref().map(value).unwrap_or_default()
    }

    /// What the filter is doing.
    pub fn status(&self) -> Status {
        self.navigator.as_ref().map_or(Status::Initialising, Navigator::status)
    }
}
