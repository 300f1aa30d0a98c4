//! `search.csv`: every candidate of a search.

use super::column::{self, Column, count, number, text};
use crate::HarnessError;
use crate::tuning::ranges::Axis;
use crate::tuning::standing::Objective;
use crate::tuning::study::{Evaluation, Searched};

/// A candidate, with what names it.
pub(crate) struct Line {
    scenario: String,
    filter: String,
    number: u64,
    values: String,
    ranges: String,
    objective: Objective,
    evaluation: Evaluation,
}

pub(crate) const COLUMNS: &[Column<Line>] = &[
    text("scenario", "world", |l| l.scenario.as_str().into()),
    text("filter", "filter with its preset", |l| l.filter.as_str().into()),
    count("evaluation", "number of the candidate, from 1", |l| Some(l.number)),
    count("round", "round of the search, from 0: the whole box", |l| {
        Some(l.evaluation.round as u64)
    }),
    text(
        "values",
        "NAME=VALUE of each parameter; empty for the starting point",
        |l| l.values.as_str().into(),
    ),
    text(
        "ranges",
        "NAME=LOW:HIGH of each parameter: the edges of the search",
        |l| l.ranges.as_str().into(),
    ),
    text("objective", "the error that is made small", |l| {
        l.objective.name().into()
    }),
    number("value", "m, m/s or m/s2", "RMSE of the objective", |l| {
        l.evaluation.tally.rmse(l.objective.quantity())
    }),
    number("nees6", "1", "mean NEES of position and velocity alone, over 6", |l| {
        l.evaluation.tally.nees6()
    }),
    count("failed", "runs that ended with an error", |l| {
        Some(l.evaluation.tally.failed.into())
    }),
    count("diverged", "runs that lost the target", |l| {
        Some(l.evaluation.tally.diverged.into())
    }),
    count("bad_runs", "both, and runs with a covariance that is none", |l| {
        Some(l.evaluation.tally.bad_runs.into())
    }),
    count(
        "feasible",
        "1 when no run went wrong and nees6 is within its limits",
        |l| Some(l.evaluation.standing.feasible().into()),
    ),
];

/// Contents of `search.csv`, by world.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render<'a>(
    worlds: impl Iterator<Item = (&'a str, &'a [Searched])>,
    objective: Objective,
) -> Result<Vec<u8>, HarnessError> {
    let mut lines = Vec::new();
    for (scenario, filter) in worlds.flat_map(|(w, filters)| filters.iter().map(move |f| (w, f))) {
        let line = |(evaluation, number): (&Evaluation, u64)| Line {
            scenario: scenario.to_owned(),
            filter: filter.contender.base.label.clone(),
            number,
            ranges: ranges(&filter.contender.axes),
            values: settings(filter.settings(evaluation)),
            objective,
            evaluation: evaluation.clone(),
        };
        lines.extend(filter.evaluations.iter().zip(1..).map(line));
    }
    column::render(COLUMNS, &lines)
}

fn ranges(axes: &[Axis]) -> String {
    let range = |a: &Axis| format!("{}={:?}:{:?}", a.variable, a.low, a.high);
    axes.iter().map(range).collect::<Vec<_>>().join(" ")
}

/// Values as `NAME=VALUE NAME=VALUE`.
pub fn settings<'a>(values: impl Iterator<Item = (&'a str, f64)>) -> String {
    values
        .map(|(name, value)| format!("{name}={value:?}"))
        .collect::<Vec<_>>()
        .join(" ")
}
