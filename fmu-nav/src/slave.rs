//! What one slave holds: parameters and inputs as a master sets them on one side, a running [`Navigator`] on the other.

use filters::state::State;
use filters::{Command, FilterError, Navigator, Prediction, Sample, Settings};
use interface::mission::Choice;
use interface::{Signals, Status};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// One slave.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NavModel {
    /// Which mission.
    pub choice: Choice,
    /// Item of the `filter` enumeration, counted from 1.
    pub filter: i32,
    /// The same for tools without enumerations; 0: `filter` counts.
    pub filter_index: i32,
    /// Whether the mission's own burns of the chaser act.
    pub burn_enabled: bool,
    /// The other parameters.
    pub settings: Settings,
    /// Values of the tunables that the mission may state, as they act; from initialization on.
    pub resolved: Vec<f64>,
    /// Inputs as set; they take effect in a step only.
    pub inputs: Signals,
    /// Commands as set, likewise.
    pub command: Command,
    /// Name of the mission, from initialization on.
    pub mission: String,
    /// The filter, from initialization on.
    pub navigator: Option<Navigator>,
    /// Its prediction, once somebody has asked for it since the last step: it costs a time update, and many masters never ask.
    #[serde(skip)]
    pub prediction: OnceLock<Prediction>,
}

impl NavModel {
    /// A value of the running filter, or the default of its type before initialization.
    pub fn read<T: Default>(&self, value: impl Fn(&Navigator) -> T) -> T {
        self.navigator.as_ref().map(value).unwrap_or_default()
    }

    /// Which filter runs, as an index.
    ///
    /// # Errors
    /// When the number is none of a filter's.
    pub fn chosen(&self) -> Result<usize, FilterError> {
        let ordinal = if self.filter_index == 0 {
            self.filter
        } else {
            self.filter_index
        };
        filters::laws::registry::of_ordinal(ordinal)
    }

    /// The estimate at the end of the last step.
    pub fn predicted(&self) -> &Prediction {
        self.prediction.get_or_init(|| self.read(Navigator::predict))
    }

    /// The inputs as a filter takes them.
    pub fn arrived(&self) -> (Sample, State) {
        (Sample::from(&self.inputs), State::from(self.inputs.nav_init))
    }

    /// What the filter is doing.
    pub fn status(&self) -> Status {
        self.navigator.as_ref().map_or(Status::Initialising, Navigator::status)
    }
}
