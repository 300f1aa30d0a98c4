//! What each filter of a study has reached and cost.

use study::{FilterResult, Participant, Study, StudyResult, Summary, Workers, call_time};

use super::timing::TimingRow;

/// Its rows of `summary.csv` and `timing.csv`.
///
/// * `workers`: those that call the FMUs, where this process does not.
pub(crate) fn measured(
    study: &Study,
    result: &StudyResult,
    workers: Option<&Workers>,
) -> (Vec<Summary>, Vec<TimingRow>) {
    let (name, case) = (&study.spec.world.name, &study.case);
    let rows = result.filters.iter().map(|filter| Summary::new(name, case, filter));
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
    (rows.collect(), timings.collect())
}
