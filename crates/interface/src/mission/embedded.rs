//! The missions that come with the project and travel inside both FMUs.

use super::{Mission, MissionError};

/// A mission file that comes with the project.
#[derive(Debug, Clone, Copy)]
pub struct Embedded {
    /// Its name, also that of the file without `.toml`.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
    /// Whether it is an item of the FMUs' `scenario` enumeration. Items are counted in this order and never change.
    pub scenario: bool,
}

macro_rules! embedded {
    ($($name:literal, $scenario:literal;)*) => {
        &[$(Embedded {
            name: $name,
            text: include_str!(concat!("../../../../missions/", $name, ".toml")),
            scenario: $scenario,
        }),*]
    };
}

/// Every mission that comes with the project; those of the `scenario` enumeration first, in its order.
pub const EMBEDDED: &[Embedded] = embedded! {
    "leo_venting", true;
    "nrho_venting", true;
    "formation", true;
    "formation_j2", false;
    "lunar_inspection", false;
    "elliptic_rendezvous", false;
    "fast_approach", false;
};

impl Embedded {
    /// The mission.
    ///
    /// # Errors
    /// None for the files as they come: a test reads each.
    pub fn mission(&self) -> Result<Mission, MissionError> {
        Mission::parse(&format!("{}.toml", self.name), self.text)
    }

    /// Every item of the `scenario` enumeration.
    pub fn scenarios() -> impl Iterator<Item = &'static Self> {
        EMBEDDED.iter().filter(|e| e.scenario)
    }
}

/// The mission of this name that comes with the project.
///
/// # Errors
/// [`MissionError::Unknown`], with the names there are.
pub fn embedded(name: &str) -> Result<&'static Embedded, MissionError> {
    EMBEDDED
        .iter()
        .find(|e| e.name == name)
        .ok_or_else(|| MissionError::Unknown {
            name: name.to_owned(),
            known: EMBEDDED.iter().map(|e| e.name).collect::<Vec<_>>().join(", "),
        })
}
