//! Everything the two papers print or claim, rerun and held beside it.
//!
//! A chapter is one file here and one line in [`CHAPTERS`]: the studies it needs, the paper's numbers, and the bounds
//! that ours are held to. Those stand nowhere else, except for the claims of the venting scenarios, which `compare` holds
//! as well. Where the runs come from is a [`Laboratory`]: FMUs, or mocks in tests.
//!
//! Start reading at [`Line`], then `disturbance.rs`, the shortest chapter.

mod beyond;
mod chapter;
mod disturbance;
mod learning;
mod line;
mod milton;
mod neurons;
mod nominal;
mod notebook;
mod off_nominal;
mod render;
mod request;
mod table;

use crate::HarnessError;

pub use chapter::Chapter;
pub use line::{Line, Verdict};
pub use notebook::{FirstRun, Laboratory, Notebook};
pub use render::{csv, line_text, markdown};
pub(crate) use request::MEANT_RUNS;
pub use request::Request;

/// Every chapter, in order; a later one may look up what an earlier one has found.
pub const CHAPTERS: &[Chapter] = &[
    milton::CHAPTER,
    disturbance::CHAPTER,
    learning::CHAPTER,
    nominal::CHAPTER,
    beyond::CHAPTER,
    off_nominal::CHAPTER,
    neurons::CHAPTER,
];

/// Runs every chapter in order.
///
/// * `after`: called after each chapter, so that what has been found can be saved.
///
/// # Errors
/// Those of the laboratory and of `after`.
pub fn fill(
    laboratory: &mut dyn Laboratory,
    mut after: impl FnMut(&Notebook) -> Result<(), HarnessError>,
) -> Result<Notebook, HarnessError> {
    let mut notebook = Notebook::default();
    for chapter in CHAPTERS {
        notebook.begin(chapter.title);
        (chapter.write)(laboratory, &mut notebook)?;
        after(&notebook)?;
    }
    notebook.begin("Runs");
    notebook.count_failures();
    after(&notebook)?;
    Ok(notebook)
}
