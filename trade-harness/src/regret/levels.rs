//! At what laws are tried, and what they are held against.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use study::{Assignment, check_case};

use crate::HarnessError;

/// The file that comes with the project.
pub const OWN: &str = include_str!("levels.toml");

/// Levels of disturbance, the filters of constant noise, and the bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// Each a study of its own.
    #[serde(rename = "level")]
    pub levels: Vec<Level>,
    /// The best of all of them, in hindsight, is what laws are held against.
    #[serde(rename = "fixed")]
    pub families: Vec<Family>,
    /// Told by the truth what no law knows, of each the best of its values in hindsight. `clairvoyant` alone cannot be passed:
    /// `times_known` is told when something pushes, never how hard.
    #[serde(rename = "bound", default)]
    pub bounds: Vec<Family>,
}

/// A level of disturbance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// Name in tables and files: letters, digits, `.`, `_` and `-`.
    pub name: String,
    /// What happens in it.
    #[serde(default)]
    pub about: String,
    /// Missions that it is for; every one where there are none.
    #[serde(default)]
    pub missions: Vec<String>,
    /// What differs from the mission, as `MODEL.VARIABLE=VALUE`.
    #[serde(default)]
    pub set: Vec<Assignment>,
}

/// A filter with every combination of these values of its tunables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Family {
    /// Name of a filter of fmu-nav.
    pub filter: String,
    /// Tunables without the filter's prefix, and their values.
    pub values: BTreeMap<String, Vec<f64>>,
}

impl Level {
    /// Whether it is for this mission.
    pub fn is_for(&self, mission: &str) -> bool {
        self.missions.is_empty() || self.missions.iter().any(|name| name == mission)
    }
}

impl Family {
    /// Every combination: tunables, with the filter's prefix, and values.
    pub fn members(&self) -> Vec<Vec<(String, f64)>> {
        let mut members = vec![Vec::new()];
        for (tunable, values) in &self.values {
            let longer = |member: &Vec<(String, f64)>| {
                let with = |value: &f64| {
                    let mut longer = member.clone();
                    longer.push((format!("{}.{tunable}", self.filter), *value));
                    longer
                };
                values.iter().map(with).collect::<Vec<_>>()
            };
            members = members.iter().flat_map(longer).collect();
        }
        members
    }
}

impl Levels {
    /// Those of a file; those of the project without one.
    ///
    /// # Errors
    /// [`HarnessError::Read`], [`HarnessError::Levels`].
    pub fn read(path: Option<&Path>) -> Result<Self, HarnessError> {
        let Some(path) = path else {
            return Self::parse("the project's own levels", OWN);
        };
        let text = interface::text::read(path).map_err(|source| HarnessError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&path.display().to_string(), &text)
    }

    fn parse(file: &str, text: &str) -> Result<Self, HarnessError> {
        let wrong = |problem: String| HarnessError::Levels {
            file: file.to_owned(),
            problem,
        };
        let levels: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        let mut names = BTreeSet::new();
        for level in &levels.levels {
            check_case(&level.name).map_err(|why| wrong(format!("level '{}': {why}", level.name)))?;
            if !names.insert(&level.name) {
                return Err(wrong(format!("there are two levels '{}'", level.name)));
            }
        }
        let fixed = levels.families.iter().map(|family| ("fixed", family));
        let bounds = levels.bounds.iter().map(|family| ("bound", family));
        for (kind, family) in fixed.chain(bounds) {
            let all = family.values.values().flatten();
            if family.values.is_empty() || family.members().is_empty() || !all.clone().all(|v| v.is_finite()) {
                let text = format!(
                    "[[{kind}]] of '{}' has no values: give values = {{ TUNABLE = [...] }}",
                    family.filter
                );
                return Err(wrong(text));
            }
        }
        if levels.levels.is_empty() || levels.families.is_empty() {
            return Err(wrong("give at least one [[level]] and one [[fixed]]".to_owned()));
        }
        Ok(levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn our_own_are_read_and_cover_every_mission_of_the_papers() {
        let own = Levels::read(None).unwrap();
        for mission in ["leo_venting", "nrho_venting", "formation"] {
            assert!(own.levels.iter().any(|level| level.is_for(mission)));
        }
        let dmc = own.families.iter().find(|f| f.filter == "dmc").unwrap();
        assert_eq!(
            dmc.members().len(),
            dmc.values["sigma"].len() * dmc.values["time_constant"].len()
        );
        assert!(dmc.members().iter().all(|member| member.len() == 2));
        let bounds: Vec<_> = own.bounds.iter().map(|bound| bound.filter.as_str()).collect();
        assert_eq!(bounds, ["clairvoyant", "times_known"]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let fixed = "[[fixed]]\nfilter = \"snc\"\nvalues = { q = [1.0] }\n";
        for (text, says) in [
            (
                format!("[[level]]\nname = \"a\"\n[[level]]\nname = \"a\"\n{fixed}"),
                "two levels",
            ),
            (format!("[[level]]\nname = \"a b\"\n{fixed}"), "a b"),
            (format!("[[level]]\nname = \"a\"\nfrom = 1\n{fixed}"), "from"),
            (
                "[[level]]\nname = \"a\"\n[[fixed]]\nfilter = \"snc\"\nvalues = {}\n".to_owned(),
                "no values",
            ),
            (
                format!("[[level]]\nname = \"a\"\n{fixed}[[bound]]\nfilter = \"clairvoyant\"\nvalues = {{ q = [] }}"),
                "[[bound]] of 'clairvoyant'",
            ),
            (format!("level = []\n{fixed}"), "at least one"),
        ] {
            let error = Levels::parse("x.toml", &text).unwrap_err().to_string();
            assert!(error.contains(says) && error.contains("x.toml"), "{error}");
        }
    }
}
