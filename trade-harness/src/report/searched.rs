//! `search.csv`: every candidate of a search.

use serde::Serialize;

use super::csv_bytes;
use crate::HarnessError;
use crate::tuning::standing::Objective;
use crate::tuning::study::Searched;

const COLUMNS: &[&str] = &[
    "scenario",
    "filter",
    "evaluation",
    "round",
    "values",
    "objective",
    "value",
    "nees",
    "failed",
    "diverged",
    "bad_runs",
    "feasible",
];

/// Contents of `search.csv`, by scenario.
///
/// `values` is empty for the starting point; `value` is the objective, m, m/s or m/s2.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render<'a>(
    scenarios: impl Iterator<Item = (&'a str, &'a [Searched])>,
    objective: Objective,
) -> Result<Vec<u8>, HarnessError> {
    #[derive(Serialize)]
    struct Line<'a> {
        scenario: &'a str,
        filter: &'a str,
        evaluation: usize,
        round: usize,
        values: String,
        objective: &'static str,
        value: Option<f64>,
        nees: Option<f64>,
        failed: u32,
        diverged: u32,
        bad_runs: u32,
        feasible: u8,
    }
    let lines = scenarios.flat_map(|(scenario, filters)| {
        filters.iter().flat_map(move |filter| {
            filter.evaluations.iter().zip(1..).map(move |(e, number)| Line {
                scenario,
                filter: &filter.base.label,
                evaluation: number,
                round: e.round,
                values: settings(filter.settings(e)),
                objective: objective.name(),
                value: e.tally.rmse(objective.quantity()),
                nees: e.tally.nees(),
                failed: e.tally.failed,
                diverged: e.tally.diverged,
                bad_runs: e.tally.bad_runs,
                feasible: u8::from(e.standing.feasible()),
            })
        })
    });
    csv_bytes(COLUMNS, lines)
}

/// Values as `NAME=VALUE NAME=VALUE`.
pub fn settings<'a>(values: impl Iterator<Item = (&'a str, f64)>) -> String {
    values
        .map(|(name, value)| format!("{name}={value:?}"))
        .collect::<Vec<_>>()
        .join(" ")
}
