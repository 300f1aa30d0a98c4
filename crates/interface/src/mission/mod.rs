//! The mission file: one TOML file that describes a world, what a filter is told of it, and how a study scores it.
//!
//! [`Mission::read`] loads a file, [`Mission::parse`] a text, [`EMBEDDED`] holds the missions that travel inside both FMUs. A
//! key ends in its unit; unknown keys are errors. What a filter may know is [`Mission::navigation`], resolved in full: the
//! filter sees nothing else of the file.

mod check;
mod choice;
mod document;
mod embedded;
mod environment;
mod error;
mod events;
mod navigation;
mod notes;
mod number;
mod schema;
mod sensors;
mod study;
mod vehicles;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use choice::{Choice, PACKED, SHIPPED, guid_with, packed_guid};
pub use document::Document;
pub use embedded::{EMBEDDED, Embedded, embedded};
pub use environment::{
    Atmosphere, Body, Cr3bp, Drag, Environment, Gravity, Harmonics, Radiation, Rotation, Shadow, TwoBody, Zonal,
};
pub use error::{MissionError, Problem};
pub use events::{Axes, Burn, Distribution, First, FirstTable, Magnitude, Profile, Unmodelled, Vent, Which};
pub use navigation::{
    Frame, InitialSigma, KnownAccelerometer, KnownSensor, Navigation, NavigationSection, P0, Scale, Told, Units,
    UnitsChoice,
};
pub use schema::{schema, schema_value};
pub use sensors::{
    Accelerometer, AccelerometerOutput, BelievedSensors, Faults, OnBoard, Quantity, Sensor, Sensors, Sigma,
};
pub use study::{Phase, ResultAxes, Study};
pub use vehicles::{At, Attitude, Elements, Orbit, Relative, RelativeAxes, StateVector, Vehicle};

/// The version of the format that this code reads.
pub const FORMAT: u32 = 1;

/// A mission as its file states it. Everything that the file leaves out has its default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mission {
    /// Version of this format: 1.
    pub mission: u32,
    /// Name in tables and folders: letters, digits, `_` and `-`.
    pub name: String,
    /// What happens in it, in one line.
    #[serde(default)]
    pub about: String,
    /// Where it comes from.
    #[serde(default)]
    pub reference: String,
    /// Length of a run and its time grid.
    pub time: Time,
    /// What surrounds the vehicles.
    pub environment: Environment,
    /// The vehicle that is approached.
    pub target: Vehicle,
    /// The vehicle that navigates.
    pub chaser: Vehicle,
    /// Manoeuvres, `[[burn]]`.
    #[serde(default, rename = "burn")]
    pub burns: Vec<Burn>,
    /// Vents of the target, `[[vent]]`, one entry for each kind.
    #[serde(default, rename = "vent")]
    pub vents: Vec<Vent>,
    /// What pushes the target without ever stopping, and no filter is told of.
    #[serde(default)]
    pub unmodelled: Unmodelled,
    /// Sensors of the chaser; at least one that sees the target.
    #[serde(default)]
    pub sensors: Sensors,
    /// Errors of the estimate that a run begins with, of one vehicle; with `navigation.frame = "lvlh"` of the relative state.
    #[serde(default)]
    pub initial_error: P0,
    /// What the filter is told.
    #[serde(default)]
    pub navigation: NavigationSection,
    /// How a study compares filters.
    #[serde(default)]
    pub study: Study,
    /// Folder that relative paths in the file start from; not a key of the file.
    #[serde(skip)]
    pub folder: PathBuf,
}

/// Length of a run and its time grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Length of a run, s; the world goes on after it without further events.
    pub duration_s: f64,
    /// Statistics are taken from here on, s.
    #[serde(default)]
    pub scored_from_s: f64,
    /// Time between the samples of every sensor that states no `period_s` of its own, s.
    #[serde(default = "one")]
    pub sample_period_s: f64,
    /// Interval of the truth's integration, s; what pushes the vehicles is constant over one.
    #[serde(default = "one")]
    pub grid_s: f64,
    /// Date of the start, UTC, as `2020-01-01T00:00:00`; needed only where Sun, Moon or the turning central body matter.
    #[serde(default, deserialize_with = "date", skip_serializing_if = "Option::is_none")]
    pub epoch_utc: Option<String>,
}

/// A date as TOML writes it or as text.
fn date<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "a date and time as \"2020-01-01T00:00:00\"")]
    enum Date {
        Text(String),
        Toml(toml::value::Datetime),
    }
    Ok(Some(match Date::deserialize(deserializer)? {
        // As TOML writes it, whatever stands between day and time.
        Date::Text(text) => text
            .parse()
            .map_or(text, |date: toml::value::Datetime| date.to_string()),
        Date::Toml(date) => date.to_string(),
    }))
}

fn one() -> f64 {
    1.0
}

impl Mission {
    /// Reads and checks a mission file.
    ///
    /// # Errors
    /// [`MissionError`], naming file, line and column of everything that is wrong, and what would be allowed.
    pub fn read(path: &Path) -> Result<Self, MissionError> {
        Document::read(path)?.mission()
    }

    /// Checks a mission given as text; relative paths in it start from the present folder.
    ///
    /// * `origin`: what messages call the text.
    ///
    /// # Errors
    /// As [`Mission::read`].
    pub fn parse(origin: &str, text: &str) -> Result<Self, MissionError> {
        Document::parse(origin, text)?.mission()
    }

    /// Everything a filter may know, with the world's values where the file states no others.
    pub fn navigation(&self) -> Navigation {
        navigation::resolve(self)
    }

    /// The mission as a TOML text that reads back as the same mission.
    ///
    /// # Errors
    /// [`MissionError::Write`], which a mission that was read does not cause.
    pub fn to_toml(&self) -> Result<String, MissionError> {
        toml::to_string(self).map_err(|source| MissionError::Write {
            name: self.name.clone(),
            reason: source.to_string(),
        })
    }

    /// Files that the mission reads: the key of each, and its path from here.
    pub fn files(&self) -> Vec<(&'static str, PathBuf)> {
        let fields = [
            ("environment.gravity.file", Some(&self.environment.gravity)),
            ("navigation.gravity.file", self.navigation.gravity.as_ref()),
        ];
        let file = |(key, gravity): (_, Option<&Gravity>)| match gravity {
            Some(Gravity::Harmonics(field)) => Some((key, self.locate(field.file.as_ref()?))),
            _ => None,
        };
        fields.into_iter().filter_map(file).collect()
    }

    /// A path of the mission file: as it is when absolute, else from the folder of the file.
    pub fn locate(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}
