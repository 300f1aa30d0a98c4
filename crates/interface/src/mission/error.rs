//! What can be wrong with a mission file.

use std::fmt;

use thiserror::Error;

/// One thing that is wrong, with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file, or what the text was called.
    pub origin: String,
    /// Line and column, from 1; `None` where the whole file is meant.
    pub place: Option<(usize, usize)>,
    /// What is wrong and what is allowed.
    pub what: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Some((line, column)) => write!(f, "{}:{line}:{column}: {}", self.origin, self.what),
            None => write!(f, "{}: {}", self.origin, self.what),
        }
    }
}

/// A mission that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MissionError {
    /// The file cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: String,
        /// What the system says.
        reason: String,
    },
    /// Something in it is wrong; every problem that was found, one a line.
    #[error("{}", lines(.0))]
    Invalid(Vec<Problem>),
    /// A key to be set does not exist.
    #[error("mission.{key} cannot be set: {reason}")]
    Set {
        /// As given, without the leading `mission.`.
        key: String,
        /// Why.
        reason: String,
    },
    /// No embedded mission of this name.
    #[error("mission {name:?} does not come with the project: there are {known}")]
    Unknown {
        /// As given.
        name: String,
        /// Names there are.
        known: String,
    },
    /// No item of the `scenario` enumeration.
    #[error("scenario {ordinal} does not exist: it must be one of {known}")]
    Scenario {
        /// As given; the first is 1.
        ordinal: i32,
        /// Numbers and names there are.
        known: String,
    },
    /// The mission cannot be written as TOML.
    #[error("mission {name} cannot be written: {reason}")]
    Write {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
}

fn lines(problems: &[Problem]) -> String {
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("\n")
}
