//! Which mission an FMU runs: said by a file, by the FMU's own resources, or by the `scenario` enumeration.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Embedded, Mission, MissionError};

/// Name, in an FMU's resources, of the mission that it was packed with.
pub const PACKED: &str = "mission.toml";

/// Folder, in an FMU's resources, of the missions that come with it.
pub const SHIPPED: &str = "missions";

/// What chooses a mission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Choice {
    /// Item of the `scenario` enumeration, counted from 1.
    pub scenario: i32,
    /// The same for tools without enumerations; 0: `scenario` counts.
    pub scenario_index: i32,
    /// Path of a mission file, or the name, with or without `.toml`, of one that comes with the project; empty: none.
    pub mission_file: String,
    /// The FMU's resources, where there are any. Those of this instance: a saved state has none.
    #[serde(skip)]
    pub resources: Option<PathBuf>,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            scenario: 1,
            scenario_index: 0,
            mission_file: String::new(),
            resources: None,
        }
    }
}

impl Choice {
    /// The mission: that of `mission_file`; else that of `scenario_index` where it is not 0; else, with the first scenario, the one
    /// that the FMU was packed with, if it was; else the scenario's.
    ///
    /// # Errors
    /// When the file cannot be used or the scenario does not exist.
    pub fn mission(&self) -> Result<Mission, MissionError> {
        if !self.mission_file.is_empty() {
            let path = Path::new(&self.mission_file);
            let shipped = self.resources.as_ref().map(|folder| folder.join(SHIPPED).join(path));
            // A bare name means ours whatever lies about in the present folder.
            if let Ok(entry) = super::embedded(&self.mission_file) {
                return entry.mission();
            }
            if path.is_file() {
                return Mission::read(path);
            }
            if let Some(shipped) = shipped.filter(|shipped| shipped.is_file()) {
                return Mission::read(&shipped);
            }
            let name = self.mission_file.strip_suffix(".toml").unwrap_or(&self.mission_file);
            return match super::embedded(name) {
                Ok(entry) => entry.mission(),
                Err(_) => Mission::read(path),
            };
        }
        if let Some(packed) = self
            .resources
            .as_deref()
            .and_then(packed)
            .filter(|_| self.scenario == 1 && self.scenario_index == 0)
        {
            return Mission::read(&packed);
        }
        let ordinal = if self.scenario_index == 0 {
            self.scenario
        } else {
            self.scenario_index
        };
        let place = usize::try_from(i64::from(ordinal) - 1).ok();
        let entry = place.and_then(|place| Embedded::scenarios().nth(place));
        entry
            .ok_or_else(|| {
                let names = Embedded::scenarios()
                    .zip(1..)
                    .map(|(entry, number)| format!("{number} ({})", entry.name));
                MissionError::Scenario {
                    ordinal,
                    known: names.collect::<Vec<_>>().join(", "),
                }
            })?
            .mission()
    }
}

/// The mission that an FMU was packed with.
fn packed(resources: &Path) -> Option<PathBuf> {
    Some(resources.join(PACKED)).filter(|path| path.is_file())
}

/// Identifier of an FMU whose own is `own` once it is packed with a mission, braces as in `own`; `None` when it is not.
///
/// A library and its description belong together, and so do both with the mission inside.
pub fn packed_guid(own: &str, resources: &Path) -> Option<String> {
    Some(guid_with(own, &std::fs::read(packed(resources)?).ok()?))
}

/// Identifier of an FMU whose own is `own`, tied to what it is packed with, be it its description or a mission: a name-based UUID
/// of the text in the namespace of the FMU's own.
pub fn guid_with(own: &str, text: &[u8]) -> String {
    let bare = own.trim_matches(['{', '}']);
    let own_id = uuid::Uuid::parse_str(bare).unwrap_or_default();
    let with = uuid::Uuid::new_v5(&own_id, text).to_string();
    own.replace(bare, &with)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_goes_before_the_packed_mission_and_that_before_the_first_scenario() {
        let folder = tempfile::tempdir().unwrap();
        let resources = folder.path().join("resources");
        std::fs::create_dir_all(resources.join(SHIPPED)).unwrap();
        let text = super::super::EMBEDDED[0].text;
        std::fs::write(
            resources.join(PACKED),
            text.replace("name = \"leo_venting\"", "name = \"packed\""),
        )
        .unwrap();
        std::fs::write(
            resources.join(SHIPPED).join("other.toml"),
            text.replace("name = \"leo_venting\"", "name = \"other\""),
        )
        .unwrap();
        let indexed = |scenario_index, scenario, file: &str, resources: Option<&Path>| {
            let choice = Choice {
                scenario,
                scenario_index,
                mission_file: file.to_owned(),
                resources: resources.map(Path::to_owned),
            };
            choice.mission().map(|m| m.name)
        };
        let name = |scenario, file: &str, resources| indexed(0, scenario, file, resources);
        let all = Some(resources.as_path());
        assert_eq!(name(1, "", None).unwrap(), "leo_venting");
        assert_eq!(name(1, "", all).unwrap(), "packed");
        assert_eq!(name(2, "", all).unwrap(), "nrho_venting");
        assert_eq!(name(1, "other.toml", all).unwrap(), "other");
        assert!(name(1, "other.toml", None).is_err());
        // A scenario goes by its name too, packed or not.
        for file in ["leo_venting", "leo_venting.toml"] {
            assert_eq!(name(1, file, all).unwrap(), "leo_venting");
        }
        // The number goes before the enumeration and before what was packed, and after the file.
        assert_eq!(indexed(3, 2, "", all).unwrap(), "formation");
        assert_eq!(indexed(1, 1, "", all).unwrap(), "leo_venting");
        assert_eq!(indexed(3, 1, "other.toml", all).unwrap(), "other");
        assert!(indexed(9, 1, "", None).is_err());
        let error = name(9, "", None).unwrap_err().to_string();
        assert!(error.contains('9') && error.contains("1 (leo_venting)"), "{error}");
    }

    #[test]
    fn a_packed_mission_makes_another_identifier() {
        let own = "{7f1f3d1c-0d7e-5f6a-9b1e-1c2d3e4f5a6b}";
        let with = guid_with(own, b"a");
        assert!(with.starts_with('{') && with.ends_with('}') && with.len() == own.len());
        assert_ne!(with, own);
        assert_eq!(with, guid_with(own, b"a"));
        assert_ne!(with, guid_with(own, b"b"));
    }
}
