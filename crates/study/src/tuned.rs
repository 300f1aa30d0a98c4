//! Parameter sets that a search has found.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::arguments::PAPER;

/// The best values of one filter in one world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TunedSet {
    /// The file it was read from, for messages.
    #[serde(skip)]
    pub file: Option<PathBuf>,
    /// World in which it was tuned, and alone counts.
    pub scenario: String,
    /// Filter of fmu-nav, or label of a foreign filter.
    pub filter: String,
    /// Preset that the search started from, and that holds for all it did not vary.
    pub preset: String,
    /// Name of this set after the `@`.
    pub name: String,
    /// Parameter and value; empty when the starting point was best.
    pub values: BTreeMap<String, f64>,
    /// What differed from the mission as it stands where it was found ([`crate::Plan::deviations`]).
    #[serde(default)]
    pub conditions: Vec<String>,
    /// Objective on the search's own worlds, m, m/s or m/s2.
    pub search_objective: Option<f64>,
    /// NEES over its dimension there.
    pub search_nees: Option<f64>,
    /// Whether no run went wrong there and the NEES was within its limits.
    pub feasible: bool,
}

impl TunedSet {
    /// What to say where it is used under other conditions than those it was found in; `None` under the same.
    ///
    /// * `here`: what differs from the mission as it stands.
    pub(crate) fn elsewhere(&self, here: &[String]) -> Option<String> {
        let sorted = |of: &[String]| of.iter().cloned().collect::<BTreeSet<_>>();
        let told = |of: &[String]| match of {
            [] => "the mission as it stands".to_owned(),
            differs => differs.join(", "),
        };
        (sorted(&self.conditions) != sorted(here)).then(|| {
            let (filter, name) = (&self.filter, &self.name);
            format!(
                "{filter}@{name} was found in {}, not in {}",
                told(&self.conditions),
                told(here)
            )
        })
    }

    /// Name after the `@` of what a search makes of a preset.
    pub fn name_for(preset: &str) -> String {
        if preset == PAPER {
            "tuned".to_owned()
        } else {
            format!("{preset}-tuned")
        }
    }
}
