//! Why an instance refused a call.

use crate::model::ModelError;
use crate::phase::Phase;
use crate::variable::{Causality, Entry, EnumerationType};

/// Why an instance did not do what it was asked for. All but [`Model`](Self::Model) leave it as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InstanceError {
    /// There is no such variable.
    #[error("no variable has value reference {reference}; there are {count}, counted from 0")]
    UnknownReference {
        /// Number of an entry, as given.
        reference: u32,
        /// Number of entries.
        count: usize,
    },
    /// The variable is of another type than the call.
    #[error("'{name}' (value reference {reference}) is of type {declared}")]
    WrongType {
        /// The variable.
        name: String,
        /// Number of its entry.
        reference: u32,
        /// Its type.
        declared: &'static str,
    },
    /// The variable cannot be set now, or never.
    #[error("'{name}' cannot be set in phase '{phase}': it has causality {}", .causality.name())]
    NotSettable {
        /// The variable.
        name: String,
        /// Its causality.
        causality: Causality,
        /// Where the instance is in its life.
        phase: Phase,
    },
    /// A number is infinite or none.
    #[error("{what} = {value} is not finite")]
    NotFinite {
        /// What was given.
        what: String,
        /// The number.
        value: f64,
    },
    /// A value breaks the bounds of its variable.
    #[error("'{name}' = {value} must be {bounds}")]
    OutOfBounds {
        /// The variable.
        name: String,
        /// The value, with its unit.
        value: String,
        /// What it must be.
        bounds: String,
    },
    /// An enumeration has no item of this number.
    #[error("'{name}' = {value} is not an item of its enumeration: {items}")]
    NoSuchItem {
        /// The variable.
        name: String,
        /// The number.
        value: i64,
        /// Numbers and names that exist.
        items: String,
    },
    /// The simulation would end before it begins.
    #[error("stop time {stop} s is before start time {start} s")]
    StopBeforeStart {
        /// Start time, s.
        start: f64,
        /// Stop time, s.
        stop: f64,
    },
    /// The tolerance is not positive.
    #[error("tolerance {tolerance} must be greater than 0")]
    BadTolerance {
        /// As given.
        tolerance: f64,
    },
    /// The step is not positive.
    #[error("communication step size {h} s must be greater than 0")]
    BadStep {
        /// Step, s.
        h: f64,
    },
    /// The step does not begin where the last one ended.
    #[error("communication point {t} s does not follow on the end of the last step, {expected} s")]
    TimeMismatch {
        /// As given, s.
        t: f64,
        /// End of the last step, s.
        expected: f64,
    },
    /// The bytes are something else altogether.
    #[error("the bytes are no serialized state of an FMU made with {tool}")]
    NotAState {
        /// What makes such FMUs.
        tool: &'static str,
    },
    /// The bytes were written by another version of this crate.
    #[error("the bytes are a state of format {found}, this FMU reads format {known}")]
    StateFormat {
        /// Format of the bytes.
        found: u32,
        /// The only format that is read.
        known: u32,
    },
    /// Another FMU wrote the bytes.
    #[error("the bytes are a state of the FMU with GUID '{found}', this one has '{own}'")]
    StateOfOtherFmu {
        /// Who wrote them.
        found: String,
        /// Who was to read them.
        own: String,
    },
    /// Bytes are missing, or there are too many.
    #[error("the serialized state should have {expected} bytes and has {given}")]
    StateLength {
        /// Number that was written.
        expected: u64,
        /// Number that was given.
        given: usize,
    },
    /// A byte has changed.
    #[error("the serialized state is damaged: its checksum does not match")]
    StateChecksum,
    /// The model's state and bytes do not fit each other.
    #[error("the state could not be put into or read from bytes")]
    StateCoding(#[from] postcard::Error),
    /// The bytes hold more than a state.
    #[error("the bytes hold {count} bytes more than a state of this FMU")]
    StateSpare {
        /// So many.
        count: usize,
    },
    /// The model does not take such a step.
    #[error("the model does not take this step")]
    StepRefused(#[source] ModelError),
    /// Something was asked for in initialization that the model cannot compute from the values it has now; others may follow.
    #[error("the model cannot initialise with the values that it has so far")]
    NotYet(#[source] ModelError),
    /// The model could not initialise or step; the instance is in [`Phase::Failed`] now.
    #[error("the model failed, and only a reset or an earlier state helps")]
    Model(#[source] ModelError),
}

impl InstanceError {
    /// [`NoSuchItem`](Self::NoSuchItem) of an entry of this enumeration.
    pub fn no_such_item<M>(entry: Entry<'_, M>, declared: &EnumerationType, value: i64) -> Self {
        let items = (1..).zip(&declared.items);
        let items = items.map(|(value, item): (usize, _)| format!("{value} {}", item.name));
        Self::NoSuchItem {
            name: entry.name().into_owned(),
            value,
            items: items.collect::<Vec<_>>().join(", "),
        }
    }
}
