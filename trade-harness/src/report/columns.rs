//! The documentation of every CSV file, from the lists that write them.

use super::column::FileColumns;
use super::{best, histories, phases, runs, searched, summary, timing};

/// The columns of every file.
pub fn all() -> Vec<FileColumns> {
    let tables = [
        FileColumns::new("summary.csv", "a world, filter and case", summary::COLUMNS),
        FileColumns::new("phases.csv", "a world, filter, case and phase", phases::COLUMNS),
        FileColumns::new(
            "requirements.csv",
            "a requirement and what it is asked of, in studies that have any",
            crate::requirements::COLUMNS,
        ),
        FileColumns::new(
            "runs.csv",
            "a run of a filter; then `MODEL.VARIABLE`, the value drawn in that run, for each `--vary`",
            runs::RUNS,
        ),
        FileColumns::new(
            "paired.csv",
            "a pair of filters and a quantity, in the runs that both have a result of",
            runs::PAIRED,
        ),
        FileColumns::new("failures.csv", "a run without a result", runs::FAILURES),
        FileColumns::new("timing.csv", "a world, filter and case", timing::COLUMNS),
        FileColumns::new("best.csv", "a filter at its own best, by tune", best::COLUMNS),
        FileColumns::new(
            "regret.csv",
            "a mission, level and filter, by regret",
            crate::regret::COLUMNS,
        ),
        FileColumns::new("search.csv", "a candidate of a search, by tune", searched::COLUMNS),
    ];
    tables.into_iter().chain(histories::all()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_has_a_name_of_its_own_and_a_meaning() {
        for file in all() {
            let mut names: Vec<&str> = file.columns.iter().map(|[name, ..]| *name).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), file.columns.len(), "{}", file.file);
            assert!(
                file.columns.iter().all(|[_, _, meaning]| !meaning.is_empty()),
                "{}",
                file.file
            );
        }
    }
}
