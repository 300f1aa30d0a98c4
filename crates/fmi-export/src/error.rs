//! Why a call was not answered, and the text that tells the host.

use std::error::Error;
use std::fmt::Write;

use fmi_model::{DefinitionError, InstanceError, Phase};

use crate::status::Status;

/// Why a call ends in something other than OK. All but a failure of the model leave the instance as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CallError {
    /// The function may not be called now.
    #[error("not allowed in phase '{phase}', only in: {allowed}")]
    CallOrder {
        /// Where the instance is in its life.
        phase: Phase,
        /// Where the function may be called.
        allowed: String,
    },
    /// The function belongs to another interface than co-simulation.
    #[error("this FMU is co-simulation only")]
    CoSimulationOnly,
    /// The FMU cannot do it, as its description says.
    #[error("not supported: {why}")]
    NotSupported {
        /// Why not.
        why: &'static str,
    },

    /// A pointer cannot be followed.
    #[error("argument {argument} is a null or misaligned pointer")]
    BadPointer {
        /// Name of the argument.
        argument: &'static str,
    },
    /// An array cannot be as long as is said.
    #[error("argument {argument} would have {length} elements, more than fit into memory")]
    TooLong {
        /// Name of the argument.
        argument: &'static str,
        /// Number of elements, as given.
        length: usize,
    },
    /// A text is of another encoding.
    #[error("argument {argument} is not UTF-8")]
    NotUtf8 {
        /// Name of the argument.
        argument: &'static str,
    },

    /// The table or the facts around it are faulty.
    #[error("the FMU could not be set up")]
    Definition(#[from] DefinitionError),
    /// The host read another description, or did not say where what the FMU was packed with lies.
    #[error("the {kind} given is '{given}', that of this FMU is '{own}': {suspicion}")]
    WrongIdentifier {
        /// What the standard calls it.
        kind: &'static str,
        /// As given.
        given: String,
        /// That of the library, with what it was packed with where that was found.
        own: String,
        /// What may have led to it.
        suspicion: String,
    },
    /// The instance would have no name.
    #[error("the instance name is empty")]
    EmptyName,
    /// No such log category.
    #[error("unknown log category '{given}', known are: {known}")]
    UnknownCategory {
        /// As given.
        given: String,
        /// All there are.
        known: String,
    },

    /// A text cannot be handed out.
    #[error("the value of '{name}' holds a NUL character, which a C string cannot")]
    NulInText {
        /// The variable.
        name: String,
    },

    /// A handle is not what it should be.
    #[error("argument {argument} is no state of this FMU")]
    ForeignState {
        /// Name of the argument.
        argument: &'static str,
    },
    /// A serialized state does not fit.
    #[error("the state needs {needed} bytes, the buffer has {given}")]
    BufferTooSmall {
        /// Bytes of the state.
        needed: usize,
        /// Bytes of the buffer.
        given: usize,
    },
    /// The instance refused, or its model failed.
    #[error(transparent)]
    Instance(#[from] InstanceError),
    /// A reason that only one version of the standard knows.
    #[error("{reason}")]
    OfVersion {
        /// How the call ends.
        status: Status,
        /// What is wrong.
        reason: Box<dyn Error + Send + Sync>,
    },
}

impl CallError {
    /// The status that the host gets.
    pub fn status(&self) -> Status {
        match self {
            Self::OfVersion { status, .. } => *status,
            // Nothing has changed, and another step may be taken: less than an error, after which a host has to give up.
            Self::Instance(InstanceError::StepRefused(_)) => Status::Discard,
            _ => Status::Error,
        }
    }

    /// The message with that of each source after it.
    pub fn chain(&self) -> String {
        let mut text = self.to_string();
        let mut source = self.source();
        while let Some(error) = source {
            // writing into a String cannot fail
            let _ = write!(text, ": {error}");
            source = error.source();
        }
        text
    }
}
