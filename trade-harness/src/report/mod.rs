//! What a study leaves behind: CSV tables, a manifest, and the table on the terminal.
//!
//! Everything but `timing.csv` and the manifest's `environment` is a function of the study alone.

/// A row of a table and its columns, in one list.
macro_rules! row {
    ($(#[$of:meta])* $visible:vis struct $name:ident { $($(#[$doc:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$of])*
        #[derive(Debug, Clone, Default, PartialEq, Serialize)]
        $visible struct $name {
            $($(#[$doc])* $visible $field: $type,)*
        }

        /// Columns of the file, in order.
        $visible const COLUMNS: &[&str] = &[$(stringify!($field),)*];
    };
}

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
use crate::models::Participant;
use crate::run::call_time;
use crate::study::{FilterResult, Study, StudyResult};
use summary::SummaryRow;
use timing::TimingRow;

/// What each filter of a study has reached and cost: its rows of `summary.csv` and `timing.csv`.
pub(crate) fn measured(study: &Study, result: &StudyResult) -> (Vec<SummaryRow>, Vec<TimingRow>) {
    let (name, case) = (study.spec.scenario.name, &study.case);
    let rows = result.filters.iter().map(|filter| SummaryRow::new(name, case, filter));
    let timing = |(filter, participant): (&FilterResult, &Participant)| {
        let call = call_time(&study.spec, participant).unwrap_or_default();
        TimingRow::new(name, &filter.label, case, &filter.timing, call)
    };
    let timings = result.filters.iter().zip(&study.spec.filters).filter_map(timing);
    (rows.collect(), timings.collect())
}

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
    finished(writer)
}

/// The bytes of a CSV file.
pub(crate) fn finished(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, HarnessError> {
    writer
        .into_inner()
        .map_err(|e| HarnessError::Csv(e.into_error().into()))
}

/// A JSON file that people can read, with a final newline.
pub(crate) fn json_bytes(value: &impl Serialize) -> Result<Vec<u8>, HarnessError> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Shortest text that reads back as the same number; empty for what is absent or no number.
pub(crate) fn cell(value: Option<f64>) -> String {
    value
        .filter(|v| v.is_finite())
        .map(|v| format!("{v:?}"))
        .unwrap_or_default()
}
