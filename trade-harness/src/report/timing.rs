//! `timing.csv`: what a step costs in CPU time, and how much of it is FMI rather than model. [`cosim::SlaveTiming`] says which clock
//! it is by and how it is read.

use std::time::Duration;

use study::Timing;

use super::column::{self, Column, count, number, text};
use crate::HarnessError;

pub(crate) const COLUMNS: &[Column<TimingRow>] = &[
    text("scenario", "world", |t| t.scenario.as_str().into()),
    text("filter", "filter with its preset", |t| t.filter.as_str().into()),
    text("case", "case", |t| t.case.as_str().into()),
    number(
        "nav_us_per_step",
        "us",
        "CPU time of the thread in fmi2DoStep of the filter, from one step in 16 (outside Unix: time on the wall)",
        |t| Some(t.nav_us_per_step),
    ),
    number("truth_us_per_step", "us", "the same of the truth", |t| {
        Some(t.truth_us_per_step)
    }),
    number(
        "fmi_exchange_us_per_step",
        "us",
        "the same in getting and setting of both, including what the study reads for its statistics",
        |t| Some(t.fmi_exchange_us_per_step),
    ),
    number(
        "fmi_call_us",
        "us",
        "the same in fmi2DoStep of the filter without a new sample",
        |t| Some(t.fmi_call_us),
    ),
    number(
        "fmi_share",
        "1",
        "(exchange + two calls) / (nav + truth + exchange)",
        |t| Some(t.fmi_share),
    ),
    count("steps", "communication steps that the times are a mean of", |t| {
        Some(t.steps)
    }),
];

/// CPU time per communication step, microseconds.
#[derive(Debug, Clone, PartialEq)]
pub struct TimingRow {
    /// Scenario.
    pub scenario: String,
    /// Filter with its preset.
    pub filter: String,
    /// Case.
    pub case: String,
    /// `fmi2DoStep` of the filter.
    pub nav_us_per_step: f64,
    /// `fmi2DoStep` of the truth.
    pub truth_us_per_step: f64,
    /// Getting and setting of both, including what the study reads for its statistics.
    pub fmi_exchange_us_per_step: f64,
    /// `fmi2DoStep` of the filter when there is no new sample: the cost of the call itself.
    pub fmi_call_us: f64,
    /// (exchange + two calls) / (nav + truth + exchange).
    pub fmi_share: f64,
    /// Communication steps that the times are a mean of.
    pub steps: u64,
}

impl TimingRow {
    /// Averages of one filter; `None` when no step was taken.
    pub fn new(scenario: &str, filter: &str, case: &str, timing: &Timing, call: Duration) -> Option<Self> {
        let per_step = |total: Duration| total.as_secs_f64() * 1e6 / timing.steps as f64;
        let nav = per_step(timing.nav.step);
        let truth = per_step(timing.truth.step);
        let exchange = per_step(timing.nav.exchange + timing.truth.exchange);
        let call = call.as_secs_f64() * 1e6;
        (timing.steps > 0).then(|| Self {
            scenario: scenario.to_owned(),
            filter: filter.to_owned(),
            case: case.to_owned(),
            nav_us_per_step: nav,
            truth_us_per_step: truth,
            fmi_exchange_us_per_step: exchange,
            fmi_call_us: call,
            fmi_share: ((exchange + 2.0 * call) / (nav + truth + exchange)).min(1.0),
            steps: timing.steps,
        })
    }
}

/// Contents of `timing.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rows: &[TimingRow]) -> Result<Vec<u8>, HarnessError> {
    column::render(COLUMNS, rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use study::SlaveTime;

    #[test]
    fn shares_of_a_case_worked_by_hand() {
        let time = |step, exchange| SlaveTime {
            step: Duration::from_micros(step),
            exchange: Duration::from_micros(exchange),
        };
        let timing = Timing {
            steps: 10,
            nav: time(60, 20),
            truth: time(30, 10),
        };
        let row = TimingRow::new("s", "f", "c", &timing, Duration::from_nanos(500)).unwrap();
        // Per step 6 + 3 + 3 microseconds, of which 3 + 2 * 0.5 are FMI.
        assert!((row.fmi_share - 4.0 / 12.0).abs() < 1e-12);
        assert!((row.nav_us_per_step - 6.0).abs() < 1e-12);
        assert!(TimingRow::new("s", "f", "c", &Timing::default(), Duration::ZERO).is_none());
    }
}
