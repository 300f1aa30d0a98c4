//! What can go wrong in the simulated world.

use thiserror::Error;

/// A world that cannot be built or cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TruthError {
    /// A parameter is outside its range.
    #[error("{name} is {value}: it must be {allowed}")]
    Parameter {
        /// Name of the FMI variable.
        name: String,
        /// Value given, in the variable's unit.
        value: f64,
        /// What would be accepted.
        allowed: String,
    },
    /// The ordinal names no scenario.
    #[error("scenario {ordinal} does not exist: it must be one of {known}")]
    Scenario {
        /// Ordinal given; the first scenario is 1.
        ordinal: i32,
        /// Ordinals and names of the scenarios there are.
        known: String,
    },
    /// The start time is NaN or infinite.
    #[error("the start time is {start_time} s: it must be a finite number")]
    StartTime {
        /// Start time given, s.
        start_time: f64,
    },
    /// An input is NaN or infinite.
    #[error("input {name}[{axis}] is {value} {unit} at {t} s: it must be a finite number")]
    Input {
        /// Name of the vector.
        name: &'static str,
        /// Axis, from 1.
        axis: usize,
        /// Value given.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Time of the communication point, s.
        t: f64,
    },
    /// The attitude commanded is none.
    #[error(
        "input dcm_cmd_bc_n at {t} s is no rotation, by {defect:.1e}: its rows must be orthonormal and right-handed, or all 0 for the mission's own attitude"
    )]
    NotARotation {
        /// How far its rows are from orthonormal.
        defect: f64,
        /// Time of the communication point, s.
        t: f64,
    },
    /// The next communication point lies before the present one, or is not a number.
    #[error("the world stands at {now} s and cannot go to {asked} s: a step must end later than it begins")]
    Backwards {
        /// Present time, s.
        now: f64,
        /// Time asked for, s.
        asked: f64,
    },
    /// The next communication point lies absurdly far ahead.
    #[error("a step from {now} s to {asked} s is too long: at most {limit} s are simulated in one step")]
    TooFar {
        /// Present time, s.
        now: f64,
        /// Time asked for, s.
        asked: f64,
        /// Longest step, s.
        limit: f64,
    },
    /// The motion has left the numbers.
    #[error("the state of the vehicles is no longer finite at {t} s: the accelerations acting on them are too large")]
    StateNotFinite {
        /// End of the grid interval in which it happened, s.
        t: f64,
    },
    /// The mission file cannot be used.
    #[error(transparent)]
    Mission(#[from] interface::MissionError),
    /// A mission without the orbit that its check asks for.
    #[error("the mission gives no orbit from which a run could begin")]
    NoOrbit,
    /// A field of gravity that cannot be read.
    #[error(transparent)]
    Field(#[from] astro::FieldError),
    /// An orbit or a date that makes no sense.
    #[error(transparent)]
    Astro(#[from] astro::AstroError),
}
