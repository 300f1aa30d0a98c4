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
    pub defaults: &'static [(&'static str, f64)],
}

/// Every scenario, in the order of the FMU's enumeration.
pub const SCENARIOS: &[ScenarioEntry] = &[leo_venting::ENTRY, nrho_venting::ENTRY, formation::ENTRY];

impl ScenarioEntry {
    /// `value`, or the scenario's own when it is left at -1.
    pub(crate) fn resolve(&self, name: &str, value: f64) -> Result<f64, FilterError> {
        if value != Beliefs::OWN {
            return Ok(value);
        }
        let own = self.defaults.iter().find(|(n, _)| *n == name);
        own.map(|(_, v)| *v).ok_or(FilterError::NoScenarioDefault {
            name: name.into(),
            scenario: self.name,
        })
    }
}
