//! `phases.csv`: one row for each world, filter, case and phase.

use study::PhaseSummary;

use super::column::{self, Column, count, number, text};
use crate::HarnessError;

/// Every column, in order.
pub const COLUMNS: &[Column<PhaseSummary>] = &[
    text("scenario", "world", |p| p.scenario.as_str().into()),
    text("filter", "filter with its preset", |p| p.filter.as_str().into()),
    text("case", "case", |p| p.case.as_str().into()),
    text(
        "phase",
        "part of the run: scored is the scored time, vents and quiet are those of it with and without an unannounced push on the target, after_push reaches until a minute after one and calm is the rest; others are the mission's and the study's",
        |p| p.phase.as_str().into(),
    ),
    count("runs", "runs asked for", |p| Some(p.runs as u64)),
    count(
        "failed",
        "runs that ended with an error; they take no part in the statistics",
        |p| Some(p.failed as u64),
    ),
    count(
        "diverged",
        "runs that lost the target at any time, those included that then failed",
        |p| Some(p.diverged as u64),
    ),
    count("present", "runs with an estimate in the phase", |p| {
        Some(p.present as u64)
    }),
    count("samples", "estimates in the phase, over all runs", |p| Some(p.samples)),
    number(
        "pos_rmse_m",
        "m",
        "root mean square of the norm of the position error",
        |p| p.errors[0].rmse,
    ),
    number(
        "pos_rmse_low_m",
        "m",
        "lower end of its 95 % interval, from 1000 draws of the runs; empty below 5 runs",
        |p| p.errors[0].interval.map(|[low, _]| low),
    ),
    number("pos_rmse_high_m", "m", "upper end of it", |p| {
        p.errors[0].interval.map(|[_, high]| high)
    }),
    number(
        "pos_p50_m",
        "m",
        "median of the norm of the position error, over runs and time, to 0.024 %",
        |p| p.errors[0].quantiles[0],
    ),
    number("pos_p95_m", "m", "95 % quantile of it", |p| p.errors[0].quantiles[1]),
    number("pos_p997_m", "m", "99.7 % quantile of it", |p| p.errors[0].quantiles[2]),
    number("pos_max_m", "m", "largest norm of the position error", |p| {
        p.errors[0].largest
    }),
    number(
        "pos_final_m",
        "m",
        "root mean square over runs of that norm at the last epoch of the phase in each run",
        |p| p.errors[0].last,
    ),
    number(
        "vel_rmse_m_s",
        "m/s",
        "root mean square of the norm of the velocity error",
        |p| p.errors[1].rmse,
    ),
    number("vel_rmse_low_m_s", "m/s", "lower end of its 95 % interval", |p| {
        p.errors[1].interval.map(|[low, _]| low)
    }),
    number("vel_rmse_high_m_s", "m/s", "upper end of it", |p| {
        p.errors[1].interval.map(|[_, high]| high)
    }),
    number("vel_p50_m_s", "m/s", "median of the norm of the velocity error", |p| {
        p.errors[1].quantiles[0]
    }),
    number("vel_p95_m_s", "m/s", "95 % quantile of it", |p| {
        p.errors[1].quantiles[1]
    }),
    number("vel_p997_m_s", "m/s", "99.7 % quantile of it", |p| {
        p.errors[1].quantiles[2]
    }),
    number("vel_max_m_s", "m/s", "largest norm of the velocity error", |p| {
        p.errors[1].largest
    }),
    number("vel_final_m_s", "m/s", "as pos_final_m, of velocity", |p| {
        p.errors[1].last
    }),
    number(
        "acc_rmse_m_s2",
        "m/s2",
        "root mean square of the norm of the acceleration error",
        |p| p.errors[2].rmse,
    ),
    number("acc_rmse_low_m_s2", "m/s2", "lower end of its 95 % interval", |p| {
        p.errors[2].interval.map(|[low, _]| low)
    }),
    number("acc_rmse_high_m_s2", "m/s2", "upper end of it", |p| {
        p.errors[2].interval.map(|[_, high]| high)
    }),
    number("acc_final_m_s2", "m/s2", "as pos_final_m, of acceleration", |p| {
        p.errors[2].last
    }),
    number(
        "back_p50_s",
        "s",
        "median over runs of the time to be back inside 3 sigma: from the begin of an unbroken stretch of the phase to the first epoch from which the position error is within 3 claimed sigma on every axis for 60 s, or to the end of the stretch; the longest stretch of each run counts; empty when infinite",
        |p| p.back[0],
    ),
    number(
        "back_p95_s",
        "s",
        "95 % quantile over runs of it; empty when infinite, as when more than 5 % of the runs were outside at the end of a stretch",
        |p| p.back[1],
    ),
    count("back_never", "runs that were outside at the end of a stretch", |p| {
        p.never_back.map(|n| n as u64)
    }),
    number("nees", "1", "mean NEES over its dimension; 1 when consistent", |p| {
        p.nees.mean
    }),
    number(
        "nees_low",
        "1",
        "lower 95 % bound of the mean over runs of it, at the epoch of the phase that most runs have",
        |p| p.nees.bounds.map(|[low, _]| low),
    ),
    number("nees_high", "1", "upper 95 % bound of it", |p| {
        p.nees.bounds.map(|[_, high]| high)
    }),
    number(
        "nees_inside",
        "1",
        "share of epochs whose mean over the runs is within the bounds for as many as there are; 0.95 when consistent",
        |p| p.nees.inside,
    ),
    number(
        "nees6",
        "1",
        "mean NEES of position and velocity alone, over 6; 1 when consistent",
        |p| p.nees6.mean,
    ),
    number("nees6_low", "1", "as nees_low, of nees6", |p| {
        p.nees6.bounds.map(|[low, _]| low)
    }),
    number("nees6_high", "1", "as nees_high, of nees6", |p| {
        p.nees6.bounds.map(|[_, high]| high)
    }),
    number("nees6_inside", "1", "as nees_inside, of nees6", |p| p.nees6.inside),
    number(
        "nees6_median",
        "1",
        "median of nees6 over runs and time, to 0.024 %; 0.891 when consistent",
        |p| p.nees6_median,
    ),
    number(
        "nees6_beyond",
        "1",
        "share of the estimates whose nees6 is beyond what one in a thousand exceeds by chance; 0.001 when consistent",
        |p| p.nees6_beyond,
    ),
    number("nis", "1", "mean NIS over its rows; 1 when consistent", |p| p.nis.mean),
    number("nis_low", "1", "as nees_low, of nis", |p| {
        p.nis.bounds.map(|[low, _]| low)
    }),
    number("nis_high", "1", "as nees_high, of nis", |p| {
        p.nis.bounds.map(|[_, high]| high)
    }),
    number("nis_inside", "1", "as nees_inside, of nis", |p| p.nis.inside),
];

/// Contents of `phases.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rows: &[PhaseSummary]) -> Result<Vec<u8>, HarnessError> {
    column::render(COLUMNS, rows)
}
