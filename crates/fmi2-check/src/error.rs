//! Why a file cannot be checked at all.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Everything that leaves a check without a result; what is wrong with an FMU is a finding and no error.
#[derive(Debug, Error)]
pub enum CheckError {
    /// A file that cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A file that is no archive.
    #[error("{} is no zip archive, and so no FMU: {reason}", path.display())]
    NotAnArchive {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        reason: String,
    },
    /// An archive that cannot be unpacked for want of room or rights.
    #[error("cannot unpack {} to {}", path.display(), target.display())]
    Unpack {
        /// The FMU.
        path: PathBuf,
        /// Where to.
        target: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A process that runs the library and cannot be started or listened to.
    #[error("the process that runs the library cannot be started, or has left no account of itself")]
    Process {
        /// Why not.
        source: io::Error,
    },
    /// What a process was told, or has told, and is not understood.
    #[error("what the process that runs the library was told, or has told, is not understood")]
    Json(#[from] serde_json::Error),
}
