//! What each filter of a study has reached and cost.

use study::{FilterResult, Participant, Study, StudyResult, Summary, call_time};

use super::timing::TimingRow;

/// Its rows of `summary.csv` and `timing.csv`.
pub(crate) fn measured(study: &Study, result: &StudyResult) -> (Vec<Summary>, Vec<TimingRow>) {
    let (name, case) = (&study.spec.world.name, &study.case);
    let rows = result.filters.iter().map(|filter| Summary::new(name, case, filter));
    let timing = |(filter, participant): (&FilterResult, &Participant)| {
        let call = call_time(&study.spec, participant).unwrap_or_default();
        TimingRow::new(name, &filter.label, case, &filter.timing, call)
    };
    let timings = result.filters.iter().zip(&study.spec.filters).filter_map(timing);
    (rows.collect(), timings.collect())
}
