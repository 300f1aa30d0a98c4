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

/// A named part of the run: the epochs at which every condition given holds. `scored` (the scored time) is always there and, where
/// something unannounced may push the target, `vents` and `quiet`, while it does and does not, and `after_push` and `calm`, until a
/// minute after it has and later.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// Begin, s; absent: `time.scored_from_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// End, s; that epoch counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_s: Option<f64>,
    /// Least true distance between the vehicles, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_from_m: Option<f64>,
    /// Largest true distance between the vehicles, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_to_m: Option<f64>,
    /// Whether something that no filter is told of pushes the target: a vent, a burn, an input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vents: Option<bool>,
    /// Only this long after the end of a burn of either vehicle, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_burn_s: Option<f64>,
    /// Only while something that no filter is told of pushes the target, and this long after, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pushed_within_s: Option<f64>,
    /// Only where nothing of the kind has pushed the target for longer than this, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calm_for_s: Option<f64>,
}

impl Phase {
    /// Names that are always there.
    pub const OWN: [&'static str; 5] = ["scored", "vents", "quiet", "after_push", "calm"];

    /// Checks what no type does.
    ///
    /// # Errors
    /// What is wrong and what is allowed.
    pub fn check(&self) -> Result<(), String> {
        let Self {
            name,
            from_s,
            to_s,
            range_from_m,
            range_to_m,
            vents,
            after_burn_s,
            pushed_within_s,
            calm_for_s,
        } = self;
        if Self::OWN.contains(&name.as_str()) {
            return Err(format!("'{name}' is always there; give another name"));
        }
        let numbers = [
            from_s,
            to_s,
            range_from_m,
            range_to_m,
            after_burn_s,
            pushed_within_s,
            calm_for_s,
        ];
        if let Some(bad) = numbers.into_iter().flatten().find(|x| !(x.is_finite() && **x >= 0.0)) {
            return Err(format!("'{name}' has a {bad}: give finite numbers, 0 or more"));
        }
        if numbers.iter().all(|x| x.is_none()) && vents.is_none() {
            return Err(format!(
                "'{name}' has no condition: give from_s, to_s, range_from_m, range_to_m, vents, after_burn_s, pushed_within_s or calm_for_s"
            ));
        }
        for (low, high, unit, names) in [
            (from_s, to_s, "s", "from_s < to_s"),
            (range_from_m, range_to_m, "m", "range_from_m < range_to_m"),
        ] {
            if let (Some(low), Some(high)) = (low, high)
                && low >= high
            {
                return Err(format!("'{name}' from {low} to {high} {unit} is empty: give {names}"));
            }
        }
        Ok(())
    }
}
