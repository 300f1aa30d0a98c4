//! What a study leaves behind: CSV tables, a manifest, and the table on the terminal.
//!
//! Everything but `timing.csv` and the manifest's `environment` is a function of the study alone. Each table is one list
//! of its columns, see [`column::Column`].

pub mod best;
pub mod column;
pub mod columns;
pub mod epochs;
pub mod histories;
pub mod kept;
pub mod manifest;
pub(crate) mod measured;
pub mod phases;
pub mod runs;
pub mod searched;
pub mod summary;
pub mod table;
pub mod timing;
