//! One self-contained HTML page from the folder of a study.
//!
//! The page is made of the files alone (`manifest.json`, `summary.csv`, `runs.csv`, `paired.csv`, `failures.csv`,
//! `epochs/*.csv`, and where they are there `run_errors/*.csv`, `paths/*.csv`, `phases.csv`, `requirements.csv`, `search.csv`; of
//! `reproduce` and `regret` their own tables), so that a folder that somebody has sent gives the same page. It asks no host for anything.
//!
//! Start reading at [`html`]; [`Verdict`] says which filter is best and how surely, [`drawn`] draws the same figures as
//! files. Inside, `figures` gathers what is drawn, `series` thins curves over time, `learning` those of `reproduce`, `window` sums
//! what the page makes errors of any stretch of time of, `pack` writes numbers short, `page`, `reproduced` and `regret` fill the templates,
//! and `frame` what all of these share.

mod drawn;
mod error;
mod events;
mod figures;
mod folder;
mod frame;
mod kept;
mod learning;
mod matrix;
mod number;
mod pack;
mod page;
mod regret;
mod reproduced;
mod search;
mod series;
mod verdict;
mod window;

use std::path::Path;

pub use drawn::{Format, drawn};
pub use error::ReportError;
pub use number::short;
pub use verdict::{Rival, RunValues, Verdict};

/// The page of a folder.
///
/// * `folder`: where `compare`, `tune`, `reproduce` or `regret` has written.
///
/// # Errors
/// [`ReportError`]: the folder holds no study, or a file of it cannot be understood; of `regret`, [`ReportError::NoFont`] too.
pub fn html(folder: &Path) -> Result<String, ReportError> {
    if folder.join(reproduced::TABLE).is_file() {
        return reproduced::render(folder);
    }
    if folder.join(drawn::regret::TABLE).is_file() {
        return regret::render(folder);
    }
    page::render(&folder::Folder::read(folder)?)
}
