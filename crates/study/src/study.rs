//! Many runs of one world, reduced to statistics as they come.

use std::time::{Duration, Instant};

use crate::error::StudyError;
use crate::fold::{FilterResult, RunRow};
use crate::ordered::in_order;
use crate::record::Record;
use crate::run::{RunReport, run_once};
use crate::score::score;
use crate::spec::Spec;

/// Runs whose records may wait for an earlier run, beside those that the threads are at: they are what a study needs its
/// memory for, and runs of one study take about the same time.
const WAITING: u32 = 1;

/// A Monte Carlo study of one world.
#[derive(Debug)]
pub struct Study {
    /// What every run shares.
    pub spec: Spec,
    /// Number of runs; run j has the parameter `run` = j.
    pub runs: u32,
    /// Threads.
    pub jobs: usize,
    /// Text of the `case` column.
    pub case: String,
}

/// Everything a study found.
#[derive(Debug)]
pub struct StudyResult {
    /// By filter, in the order of the study.
    pub filters: Vec<FilterResult>,
    /// Time on the clock.
    pub wall: Duration,
}

impl Study {
    /// Runs the study. Results are folded in the order of the runs, so they do not depend on the number of threads.
    ///
    /// * `finished`: called after each run with its number and how it ended for each filter.
    ///
    /// # Errors
    /// [`StudyError::Stats`] only; what goes wrong in a run is counted in its results.
    pub fn run(&self, mut finished: impl FnMut(u32, &[RunRow])) -> Result<StudyResult, StudyError> {
        let begin = Instant::now();
        let labels = self.spec.filters.iter().map(|f| &f.label);
        let mut filters: Vec<_> = labels.map(|label| FilterResult::new(label, &self.spec)).collect();
        in_order(
            self.runs,
            self.jobs,
            WAITING,
            |run| self.one_run(run),
            |run, (parts, report)| {
                for ((filter, (row, records)), nav) in filters.iter_mut().zip(parts).zip(report.filter_times) {
                    filter.fold(row, &records)?;
                    filter.timing.add(report.steps, nav, report.truth_time);
                }
                let rows: Vec<RunRow> = filters.iter().filter_map(|f| f.runs.last().cloned()).collect();
                finished(run, &rows);
                Ok::<(), StudyError>(())
            },
        )?;
        Ok(StudyResult {
            filters,
            wall: begin.elapsed(),
        })
    }

    /// Each filter's part of one run, on its way to the statistics.
    fn one_run(&self, run: u32) -> (Vec<(RunRow, Vec<Record>)>, RunReport) {
        let epochs = self.spec.epochs();
        let mut records: Vec<_> = self.spec.filters.iter().map(|_| Vec::with_capacity(epochs)).collect();
        let report = run_once(&self.spec, run, |filter, truth, estimate| {
            let record = score(&self.spec.world, truth, estimate)
                .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
            records[filter].push(record);
            Ok(())
        });
        let first = self.spec.first_scored();
        let parts = records.into_iter().zip(&report.endings).map(|(records, ending)| {
            let row = RunRow::new(run, &records, first, ending);
            // Those of a failed run count for nothing, and need no memory while they wait.
            let kept = if ending.failure.is_none() { records } else { Vec::new() };
            (row, kept)
        });
        (parts.collect(), report)
    }
}
