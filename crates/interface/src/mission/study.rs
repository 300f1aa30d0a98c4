//! `[study]`: how filters are compared in this mission.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a study compares filters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Filters that are compared unless others are asked for: `NAME` or `NAME@PRESET`.
    #[serde(default = "plain_filters")]
    pub filters: Vec<String>,
    /// Axes of the results; absent: `lvlh` where the filter works in them, else `rtn`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<ResultAxes>,
    /// Named parts of the run, `[[study.phase]]`.
    #[serde(default, rename = "phase", skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<Phase>,
}

fn plain_filters() -> Vec<String> {
    ["snc", "dmc", "fixed_q"].map(str::to_owned).to_vec()
}

impl Default for Study {
    fn default() -> Self {
        Self {
            filters: plain_filters(),
            axes: None,
            phases: Vec::new(),
        }
    }
}

/// Axes of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ResultAxes {
    /// Radial, transverse, normal of the target's orbit.
    Rtn,
    /// The target's turning LVLH axes.
    Lvlh,
}

/// A named part of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// Name.
    pub name: String,
    /// Begin, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
}
