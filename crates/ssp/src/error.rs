//! What can be wrong with a system structure.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why a system structure cannot be read, resolved or written.
#[derive(Debug, Error)]
pub enum SspError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file is no zip archive.
    #[error("{}: no SSP, which is a zip archive with SystemStructure.ssd, or a folder of the same contents: {reason}", path.display())]
    NotAnArchive {
        /// The file.
        path: PathBuf,
        /// What the archive lacks.
        reason: String,
    },
    /// A file that is named is not there.
    #[error("{}: {by} names '{name}', which is not there", path.display())]
    Missing {
        /// The SSP.
        path: PathBuf,
        /// Who names it.
        by: String,
        /// What is named.
        name: String,
    },
    /// A file is larger than what is read.
    #[error("{}: '{name}' has more than {limit} bytes", path.display())]
    TooLarge {
        /// The SSP.
        path: PathBuf,
        /// The file in it.
        name: String,
        /// Most bytes.
        limit: u64,
    },
    /// The source of a component or binding lies where nothing is read from.
    #[error("{by}: source '{uri}' {why}; put the file into resources/ and name it by its relative path")]
    Source {
        /// Who names it.
        by: String,
        /// The URI as it stands.
        uri: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A file is no XML.
    #[error("{file}:{line}: {problem}")]
    Xml {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What the parser says.
        problem: String,
    },
    /// The XML says what the standard does not allow, or what is not read.
    #[error("{file}:{line}: {element}: {problem}")]
    Invalid {
        /// The file.
        file: String,
        /// Line of the element, from 1.
        line: usize,
        /// The element, with its name where it has one.
        element: String,
        /// What is wrong, and what is allowed.
        problem: String,
    },
    /// The parts of a structure do not fit together.
    #[error("{element}: {problem}")]
    Structure {
        /// Component, connector, connection or binding.
        element: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A number cannot be converted.
    #[error("numbers in '{from}' cannot be converted to '{to}'; declare both units, with the same dimensions")]
    Units {
        /// Unit that it has.
        from: String,
        /// Unit that is wanted.
        to: String,
    },
    /// The archive cannot be written.
    #[error("cannot write the SSP: {0}")]
    Zip(#[from] zip::result::ZipError),
}

impl SspError {
    pub(crate) fn structure(element: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Structure {
            element: element.into(),
            problem: problem.into(),
        }
    }
}
