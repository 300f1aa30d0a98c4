//! What a version of the standard adds to what all of them do.

use std::fmt;

use fmi_model::{Category, DefinitionError, Element, ModelInfo, Table};

use crate::status::Status;

/// The host's end of the log: its callback, and what goes with it.
pub trait Sink: Clone + fmt::Debug {
    /// Whether the host has given a callback.
    fn has_listener(&self) -> bool;

    /// Sends a message.
    fn send(&self, status: Status, category: Category, message: &dyn fmt::Display);
}

/// A version of the standard, as a type without values.
pub trait Version: Sized + 'static {
    /// The host's end of the log.
    type Sink: Sink;

    /// What `fmiVersion` says.
    const FMI_VERSION: &'static str;
    /// Major number, as a digit: tells handles and serialized states of two versions apart.
    const DIGIT: u8;
    /// What every C name begins with.
    const PREFIX: &'static str;
    /// The crate that makes such FMUs.
    const TOOL: &'static str;
    /// The attribute that ties a library to its description.
    const IDENTIFIER: &'static str;
    /// What messages call it.
    const IDENTIFIER_NAME: &'static str;
    /// The argument by which functions take a saved state.
    const STATE: &'static str;

    /// `modelDescription.xml` with this identifier.
    ///
    /// # Errors
    /// A mistake in `info` or `table` that only this version's description shows.
    fn document<M>(info: &ModelInfo, table: &Table<M>, identifier: &str) -> Result<Element, DefinitionError>;
}
