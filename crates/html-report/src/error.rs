//! Why there is no page.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Everything that can be wrong with the folder of a study.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A folder without one of the files that make a study.
    #[error(
        "{} is no finished study: it has no {missing}; give the folder that 'trade-harness compare --out' has written",
        path.display()
    )]
    NoStudy {
        /// The folder.
        path: PathBuf,
        /// The file.
        missing: &'static str,
    },
    /// A file that cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A manifest that is none.
    #[error("{} is no manifest as 'trade-harness compare' writes it: {source}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A table that is none.
    #[error("{} is no table as 'trade-harness compare' writes it: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: csv::Error,
    },
    /// A table without a column that the page needs.
    #[error("{} has no column '{column}'; it is not of this version, so run the study again", path.display())]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
    },
    /// Figures whose data cannot be put into JSON.
    #[error("cannot form the data of the figures: {0}")]
    Data(#[from] serde_json::Error),
    /// A template that cannot be filled.
    #[error("cannot fill the page: {0}")]
    Template(#[from] askama::Error),
    /// A system without a font for the figures.
    #[error(
        "no font was found to draw figures with; install one, as with the Debian package fonts-dejavu-core, or leave out --svg and --png"
    )]
    NoFont,
    /// A figure that cannot be drawn.
    #[error("cannot draw a figure: {0}")]
    Drawing(String),
    /// A statistic that cannot be formed.
    #[error(transparent)]
    Statistic(#[from] stats::StatsError),
}
