//! One run as a study keeps it: what each filter did in it, with every record that statistics are made of.

use serde::{Deserialize, Serialize};

use crate::fold::RunRow;
use crate::record::Record;
use crate::run::{SlaveTime, run_once};
use crate::score::score;
use crate::spec::Spec;

/// A run that is over, on its way to the statistics and to the journal.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Outcome {
    /// Number of the run.
    pub run: u32,
    /// Communication steps taken.
    pub steps: u64,
    /// Time the truth took.
    pub truth_time: SlaveTime,
    /// By filter, in the order of the study.
    pub parts: Vec<Part>,
}

/// What one filter did in it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Part {
    /// The run in one line.
    pub row: RunRow,
    /// Of its estimates, in order; none of a run without a result.
    pub records: Vec<Record>,
    /// Time the filter took.
    pub time: SlaveTime,
}

impl Outcome {
    /// Makes a run.
    pub fn of(spec: &Spec, run: u32) -> Self {
        let epochs = spec.epochs();
        let mut records: Vec<_> = spec.filters.iter().map(|_| Vec::with_capacity(epochs)).collect();
        let report = run_once(spec, run, |filter, truth, estimate| {
            let record = score(&spec.world, truth, estimate)
                .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
            records[filter].push(record);
            Ok(())
        });
        let first = spec.first_scored();
        let parts = records
            .into_iter()
            .zip(report.endings.iter().zip(report.filter_times))
            .map(|(records, (ending, time))| {
                let row = RunRow::new(run, &records, first, ending);
                // Those of a failed run count for nothing, and need no memory while they wait.
                let records = if ending.failure.is_none() { records } else { Vec::new() };
                Part { row, records, time }
            });
        Self {
            run,
            steps: report.steps,
            truth_time: report.truth_time,
            parts: parts.collect(),
        }
    }
}
