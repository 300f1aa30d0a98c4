//! `runs.csv`, `failures.csv` and `paired.csv`: run by run, and filter against filter in the same runs.

use serde::Serialize;
use stats::paired_difference;

use super::csv_bytes;
use crate::HarnessError;
use crate::run::Spec;
use crate::study::{FilterResult, RunRow};

/// One scenario's results with what names them.
#[derive(Debug, Clone, Copy)]
pub struct Named<'a> {
    /// What every run shared.
    pub spec: &'a Spec,
    /// Case.
    pub case: &'a str,
    /// Its filters.
    pub filters: &'a [FilterResult],
}

const RUNS: &[&str] = &[
    "scenario",
    "filter",
    "case",
    "run",
    "failed",
    "diverged",
    "pos_rmse_m",
    "vel_rmse_m_s",
    "acc_rmse_m_s2",
    "nees",
    "nis",
];

/// Contents of `runs.csv`: each run of each filter, for finding the run to replay.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_runs(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    #[derive(Serialize)]
    struct Line<'a>(
        &'a str,
        &'a str,
        &'a str,
        u32,
        u8,
        u8,
        [Option<f64>; 3],
        [Option<f64>; 2],
    );
    let lines = studies.iter().flat_map(|s| {
        s.filters.iter().flat_map(move |f| {
            f.runs.iter().map(move |r| {
                let (failed, diverged) = (u8::from(r.failure.is_some()), u8::from(r.diverged));
                Line(
                    s.spec.scenario.name,
                    &f.label,
                    s.case,
                    r.run,
                    failed,
                    diverged,
                    r.rmse,
                    [r.nees, r.nis],
                )
            })
        })
    });
    csv_bytes(RUNS, lines)
}

const FAILURES: &[&str] = &["scenario", "filter", "case", "study_seed", "run", "time_s", "message"];

/// Contents of `failures.csv`: every run without a result, with what it takes to replay it.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_failures(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    #[derive(Serialize)]
    struct Line<'a>(&'a str, &'a str, &'a str, i32, u32, Option<f64>, &'a str);
    let lines = studies.iter().flat_map(|s| {
        s.filters.iter().flat_map(move |f| {
            f.runs.iter().filter_map(move |r| {
                let failure = r.failure.as_ref()?;
                let Named { spec, case, .. } = s;
                let name = spec.scenario.name;
                Some(Line(
                    name,
                    &f.label,
                    case,
                    spec.seed,
                    r.run,
                    failure.time,
                    &failure.message,
                ))
            })
        })
    });
    csv_bytes(FAILURES, lines)
}

const PAIRED: &[&str] = &[
    "scenario",
    "filter",
    "reference",
    "case",
    "quantity",
    "runs",
    "mean_difference",
    "standard_error",
];

/// Contents of `paired.csv`: mean over the runs of RMSE minus that of the first filter, with its standard error.
///
/// Only runs with a result of both take part.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_paired(studies: &[Named<'_>]) -> Result<Vec<u8>, HarnessError> {
    #[derive(Serialize)]
    struct Line<'a>(
        &'a str,
        &'a str,
        &'a str,
        &'a str,
        &'static str,
        usize,
        f64,
        Option<f64>,
    );
    let mut lines = Vec::new();
    for s in studies {
        let Some((reference, others)) = s.filters.split_first() else {
            continue;
        };
        for other in others {
            for (index, quantity) in ["pos_rmse_m", "vel_rmse_m_s", "acc_rmse_m_s2"].into_iter().enumerate() {
                let both = |(a, b): (&RunRow, &RunRow)| Option::zip(a.rmse[index], b.rmse[index]);
                let (first, second): (Vec<_>, Vec<_>) = other.runs.iter().zip(&reference.runs).filter_map(both).unzip();
                if let Some(d) = paired_difference(&first, &second)? {
                    let name = s.spec.scenario.name;
                    let (filter, reference) = (&other.label, &reference.label);
                    lines.push(Line(
                        name,
                        filter,
                        reference,
                        s.case,
                        quantity,
                        d.runs,
                        d.mean,
                        d.standard_error,
                    ));
                }
            }
        }
    }
    csv_bytes(PAIRED, lines)
}
