//! `runs.csv`, `failures.csv` and `paired.csv`: run by run, and filter against filter in the same runs.

use study::{FilterResult, Pair, Quantity, RunRow, Spec, pairs};

use super::column::{self, Cell, Column, count, number, text};
use crate::{HarnessError, format};

/// One world's results with what names them.
#[derive(Debug, Clone, Copy)]
pub struct Named<'a> {
    /// What every run shared.
    pub spec: &'a Spec,
    /// Case.
    pub case: &'a str,
    /// Its filters.
    pub filters: &'a [FilterResult],
}

/// A run of a filter, with what names it.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    scenario: String,
    filter: String,
    case: String,
    seed: i32,
    run: RunRow,
    /// `MODEL.VARIABLE` and value of what the run has drawn for the world and for this filter.
    drawn: Vec<(String, f64)>,
}

pub(crate) const RUNS: &[Column<Line>] = &[
    text("scenario", "world", |l| l.scenario.as_str().into()),
    text("filter", "filter with its preset", |l| l.filter.as_str().into()),
    text("case", "case", |l| l.case.as_str().into()),
    count("run", "number of the run", |l| Some(l.run.run.into())),
    count("failed", "1 when the run has no result", |l| {
        Some(l.run.failure.is_some().into())
    }),
    count("diverged", "1 when the target was lost, be it before it failed", |l| {
        Some(l.run.diverged.into())
    }),
    number(
        "pos_rmse_m",
        "m",
        "root mean square over time of the norm of the position error",
        |l| l.run.rmse[0],
    ),
    number("vel_rmse_m_s", "m/s", "the same of velocity", |l| l.run.rmse[1]),
    number("acc_rmse_m_s2", "m/s2", "the same of acceleration", |l| l.run.rmse[2]),
    number("nees", "1", "mean over time of NEES over its dimension", |l| l.run.nees),
    number("nis", "1", "mean over time of NIS over its rows", |l| l.run.nis),
];

/// Contents of `runs.csv`: each run of each filter, for finding the run to replay; behind the columns of every study one for each
/// varied parameter, empty in rows that it does not concern.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_runs(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    let lines = lines(studies);
    let mut varied: Vec<&str> = Vec::new();
    for (name, _) in lines.iter().flat_map(|l| &l.drawn) {
        if !varied.contains(&name.as_str()) {
            varied.push(name);
        }
    }
    let names: Vec<&str> = RUNS.iter().map(|c| c.name).chain(varied.iter().copied()).collect();
    let cells = lines.iter().map(|line| {
        let value = |name: &&str| line.drawn.iter().find(|(n, _)| n == name).map(|(_, value)| *value);
        let drawn = varied.iter().map(|name| Cell::Number(value(name)));
        RUNS.iter().map(|c| c.cell(line)).chain(drawn).collect::<Vec<_>>()
    });
    format::csv_bytes(&names, cells)
}

fn lines(studies: &[Named<'_>]) -> Vec<Line> {
    let filters = studies.iter().flat_map(|s| s.filters.iter().map(move |f| (s, f)));
    let line = |(s, f, run): (&Named<'_>, &FilterResult, &RunRow)| Line {
        scenario: s.spec.world.name.clone(),
        filter: f.label.clone(),
        case: s.case.to_owned(),
        seed: s.spec.seed,
        run: run.clone(),
        drawn: {
            let filter = s.spec.filters.iter().find(|p| p.label == f.label);
            let parts = std::iter::once(&s.spec.truth).chain(filter);
            parts.flat_map(|part| part.drawn(s.spec.seed, run.run)).collect()
        },
    };
    filters
        .flat_map(|(s, f)| f.runs.iter().map(move |run| (s, f, run)))
        .map(line)
        .collect()
}

pub(crate) const FAILURES: &[Column<Line>] = &[
    text("scenario", "world", |l| l.scenario.as_str().into()),
    text("filter", "filter with its preset", |l| l.filter.as_str().into()),
    text("case", "case", |l| l.case.as_str().into()),
    count("study_seed", "seed of the study", |l| u64::try_from(l.seed).ok()),
    count("run", "number of the run", |l| Some(l.run.run.into())),
    number("time_s", "s", "when it ended; empty before the first step", |l| {
        l.run.failure.as_ref()?.time
    }),
    text("message", "what happened", |l| {
        l.run.failure.as_ref().map_or("", |f| f.message.as_str()).into()
    }),
];

/// Contents of `failures.csv`: every run without a result, with what it takes to replay it.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_failures(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    let mut failed = lines(studies);
    failed.retain(|l| l.run.failure.is_some());
    column::render(FAILURES, &failed)
}

/// A filter against another, in the runs that both have a result of.
#[derive(Debug, Clone)]
pub(crate) struct Against {
    scenario: String,
    filter: String,
    reference: String,
    case: String,
    pair: Pair,
}

pub(crate) const PAIRED: &[Column<Against>] = &[
    text("scenario", "world", |p| p.scenario.as_str().into()),
    text("filter", "filter with its preset", |p| p.filter.as_str().into()),
    text("reference", "filter it is held against, earlier in the study", |p| {
        p.reference.as_str().into()
    }),
    text("case", "case", |p| p.case.as_str().into()),
    text("quantity", "column of summary.csv, which names the unit", |p| {
        quantity(p.pair.quantity).into()
    }),
    count("runs", "runs with a result of both", |p| {
        Some(p.pair.by_run.runs as u64)
    }),
    number(
        "mean_difference",
        "of quantity",
        "mean over the runs of each run's RMSE, filter minus reference",
        |p| Some(p.pair.by_run.mean),
    ),
    number("standard_error", "of quantity", "standard error of that mean", |p| {
        p.pair.by_run.standard_error
    }),
    number(
        "difference",
        "of quantity",
        "RMSE pooled over those runs, filter minus reference",
        |p| Some(p.pair.difference),
    ),
    number(
        "low",
        "of quantity",
        "lower end of the 95 % interval of difference, from 1000 draws of the same runs for both; empty below 5 runs",
        |p| p.pair.interval.map(|[low, _]| low),
    ),
    number("high", "of quantity", "upper end of it", |p| {
        p.pair.interval.map(|[_, high]| high)
    }),
];

/// Name of its RMSE; pairs are of motion alone.
fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Position => "pos_rmse_m",
        Quantity::Velocity => "vel_rmse_m_s",
        _ => "acc_rmse_m_s2",
    }
}

/// Contents of `paired.csv`: every pair of filters of a study, in the runs that both have a result of.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_paired(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    let mut lines = Vec::new();
    for s in studies {
        let label = |filter: usize| s.filters[filter].label.clone();
        lines.extend(pairs(s.filters)?.into_iter().map(|pair| Against {
            scenario: s.spec.world.name.clone(),
            filter: label(pair.filter),
            reference: label(pair.reference),
            case: s.case.to_owned(),
            pair,
        }));
    }
    column::render(PAIRED, &lines)
}
