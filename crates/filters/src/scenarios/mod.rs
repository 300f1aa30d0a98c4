//! What a filter believes of each world. A scenario is one file with an `ENTRY` and one line in [`SCENARIOS`].

mod formation;
mod leo_venting;
mod nrho_venting;

use crate::{Beliefs, FilterError, Gravity, Units};
use serde::{Deserialize, Serialize};

/// The main measurement of a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Measures {
    /// Range, azimuth and elevation of the target: three rows of a partially observed state.
    RangeAndBearing,
    /// Relative position and velocity in the target's LVLH frame: six rows, the state in full.
    RelativeState,
}

impl Measures {
    /// Rows of the measurement.
    pub fn rows(self) -> usize {
        match self {
            Self::RangeAndBearing => 3,
            Self::RelativeState => 6,
        }
    }
}

/// Values by full name of the parameter, in one or more lists.
pub type Defaults = &'static [&'static [(&'static str, f64)]];

/// Networks in the venting worlds see kilometres and metres per second, and forget within a minute: what they learn from the
/// corrections of the first estimate, hundredths of m/s2, must not stay. Q is that of snc.
const VENTING_NETWORKS: &[(&str, f64)] = &[
    ("rbfnn_aekf.learning_rate", 0.165),
    ("rbfnn_aekf.relaxation", 0.98),
    ("rbfnn_aekf.scale_position", 1e3),
    ("rbfnn_aekf.scale_velocity", 1.0),
    ("rbfnn_aekf.q_position", 3e-10),
    ("rbfnn_aekf.q_velocity", 9e-10),
    ("rbfnn_ekf.learning_rate", 0.165),
    ("rbfnn_ekf.relaxation", 0.98),
    ("rbfnn_ekf.scale_position", 1e3),
    ("rbfnn_ekf.scale_velocity", 1.0),
    ("rbfnn_ekf.q_position", 3e-10),
    ("rbfnn_ekf.q_velocity", 9e-10),
];

/// The value of this full name.
pub(crate) fn default_of(defaults: Defaults, name: &str) -> Option<f64> {
    let mut all = defaults.iter().flat_map(|list| list.iter());
    all.find(|(n, _)| *n == name).map(|(_, value)| *value)
}

/// A world as a filter sees it.
pub struct ScenarioEntry {
    /// Name, as in the FMU's `scenario` enumeration.
    pub name: &'static str,
    /// One line for reports and for the enumeration's description.
    pub about: &'static str,
    /// Nominal duration, s.
    pub duration: f64,
    /// Its main measurement.
    pub measures: Measures,
    /// Units the filter works and adapts in.
    pub units: Units,
    /// Gravity model, in those units, from the user's parameters.
    pub gravity: fn(&Beliefs) -> Result<Gravity, FilterError>,
    /// The scenario's own values (SI unless the parameter says otherwise) for parameters left at -1, by full name.
    pub defaults: Defaults,
}

/// Every scenario, in the order of the FMU's enumeration.
pub const SCENARIOS: &[ScenarioEntry] = &[leo_venting::ENTRY, nrho_venting::ENTRY, formation::ENTRY];

impl ScenarioEntry {
    /// `value`, or the scenario's own when it is left at -1.
    pub(crate) fn resolve(&self, name: &str, value: f64) -> Result<f64, FilterError> {
        if value != Beliefs::OWN {
            return Ok(value);
        }
        default_of(self.defaults, name).ok_or(FilterError::NoScenarioDefault {
            name: name.into(),
            scenario: self.name,
        })
    }
}
