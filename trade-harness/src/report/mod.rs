//! What a study leaves behind: CSV tables, a manifest, and the table on the terminal.
//!
//! Everything but `timing.csv` and the manifest's `environment` is a function of the study alone.

pub mod best;
pub mod claims;
pub mod epochs;
pub mod manifest;
pub mod runs;
pub mod searched;
pub mod summary;
pub mod table;
pub mod timing;

use serde::Serialize;

use crate::HarnessError;

/// A CSV file with a header, also when there are no rows; absent values are empty cells.
pub(crate) fn csv_bytes(
    columns: &[&str],
    rows: impl IntoIterator<Item = impl Serialize>,
) -> Result<Vec<u8>, HarnessError> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(columns)?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer
        .into_inner()
        .map_err(|e| HarnessError::Csv(e.into_error().into()))
}

/// Shortest text that reads back as the same number; empty for what is absent or no number.
pub(crate) fn cell(value: Option<f64>) -> String {
    value
        .filter(|v| v.is_finite())
        .map(|v| format!("{v:?}"))
        .unwrap_or_default()
}
