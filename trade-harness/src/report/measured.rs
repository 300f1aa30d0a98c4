//! What each filter of a study has reached and cost.

use study::{FilterResult, Participant, Quantity, Study, StudyResult, Summary, Workers, call_time, ranks};

use super::timing::TimingRow;
use crate::HarnessError;

/// Its rows of `summary.csv` and `timing.csv`.
///
/// * `workers`: those that call the FMUs, where this process does not.
///
/// # Errors
/// None for the results of one study.
pub(crate) fn measured(
    study: &Study,
    result: &StudyResult,
    workers: Option<&Workers>,
) -> Result<(Vec<Summary>, Vec<TimingRow>), HarnessError> {
    let (name, case) = (&study.spec.world.name, &study.case);
    let mut rows: Vec<Summary> = (result.filters.iter())
        .map(|filter| Summary::new(name, case, filter))
        .collect();
    for (at, quantity) in [Quantity::Position, Quantity::Velocity].into_iter().enumerate() {
        for (row, rank) in rows.iter_mut().zip(ranks(&result.filters, quantity)?) {
            row.ranks[at] = rank;
        }
    }
    let timing = |(index, (filter, participant)): (usize, (&FilterResult, &Participant))| {
        let call = match workers {
            Some(workers) => workers.call_time(index),
            None => call_time(&study.spec, participant).unwrap_or_default(),
        };
        TimingRow::new(name, &filter.label, case, &filter.timing, call)
    };
    let timings = (result.filters.iter().zip(&study.spec.filters))
        .enumerate()
        .filter_map(timing);
    Ok((rows, timings.collect()))
}
