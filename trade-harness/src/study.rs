//! Many runs of one scenario, reduced to statistics as they come.

use std::time::{Duration, Instant};

use nalgebra::Vector3;
use stats::{Ensemble, ScalarEnsemble};

use crate::HarnessError;
use crate::ordered::in_order;
use crate::packed::PackedScores;
use crate::run::{Ending, Failure, RunReport, SlaveTime, Spec, run_once};
use crate::score::{QUANTITIES, Quantity, Score, score};

/// Runs whose scores may wait for an earlier run, beside those that the threads are at: they are what a study needs its
/// memory for, and runs of one study take about the same time.
const WAITING: u32 = 1;

/// A Monte Carlo study of one scenario.
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

/// What one filter did in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunRow {
    /// Number of the run.
    pub run: u32,
    /// Root mean square over time of the norm of the position, velocity and acceleration error.
    pub rmse: [Option<f64>; 3],
    /// Mean over time of the squares of those errors on each axis of the results.
    pub mean_squares: [Option<Vector3<f64>>; 3],
    /// The same of the true acceleration: what an estimate of zero would make of this run.
    pub true_acceleration_mean_square: Option<Vector3<f64>>,
    /// Mean over time of the NEES divided by its dimension.
    pub nees: Option<f64>,
    /// Mean over time of the NIS divided by its rows.
    pub nis: Option<f64>,
    /// The filter or the distance to the truth said so.
    pub diverged: bool,
    /// Set when the run has no result; then it takes no part in the statistics.
    pub failure: Option<Failure>,
}

/// Time taken by the runs of a study.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Timing {
    /// Communication steps over all runs.
    pub steps: u64,
    /// The filter.
    pub nav: SlaveTime,
    /// The truth, shared by all filters of a run.
    pub truth: SlaveTime,
}

/// Statistics of one filter over the runs of a study.
#[derive(Debug)]
pub struct FilterResult {
    /// Text of the `filter` column.
    pub label: String,
    /// Each run, in order.
    pub runs: Vec<RunRow>,
    /// Errors by [`Quantity`], over the runs that did not fail.
    pub ensembles: [Ensemble; QUANTITIES],
    /// NEES divided by its dimension.
    pub nees: ScalarEnsemble,
    /// NIS divided by its rows.
    pub nis: ScalarEnsemble,
    /// Number of states of the NEES; 0 without a covariance.
    pub dimension: usize,
    /// Samples whose covariance was not symmetric, positive definite and finite.
    pub covariances_broken: u64,
    /// First epoch that counts in statistics over time.
    pub first_scored: usize,
    /// Time taken.
    pub timing: Timing,
    epochs: usize,
}

impl FilterResult {
    fn new(label: &str, spec: &Spec) -> Self {
        let epochs = spec.epochs();
        let first_scored = spec.first_scored();
        Self {
            label: label.to_owned(),
            runs: Vec::new(),
            // Of no epochs until there is an error to add: most filters lack some of the quantities.
            ensembles: std::array::from_fn(|_| Ensemble::new(0)),
            nees: ScalarEnsemble::new(epochs, first_scored),
            nis: ScalarEnsemble::new(epochs, first_scored),
            dimension: 0,
            covariances_broken: 0,
            first_scored,
            timing: Timing::default(),
            epochs,
        }
    }

    /// Ensemble of one quantity.
    pub fn ensemble(&self, quantity: Quantity) -> &Ensemble {
        &self.ensembles[quantity as usize]
    }

    /// Runs without a result.
    pub fn failed(&self) -> usize {
        self.runs.iter().filter(|r| r.failure.is_some()).count()
    }

    /// Runs with a result that diverged.
    pub fn diverged(&self) -> usize {
        self.runs.iter().filter(|r| r.diverged).count()
    }

    fn fold(&mut self, record: Record) -> Result<(), HarnessError> {
        if record.row.failure.is_none() {
            for score in record.scores.iter() {
                self.fold_score(&score)?;
            }
        }
        self.runs.push(record.row);
        Ok(())
    }

    fn fold_score(&mut self, score: &Score) -> Result<(), HarnessError> {
        for ((ensemble, error), variance) in self.ensembles.iter_mut().zip(&score.errors).zip(&score.variances) {
            if let Some(error) = error {
                if ensemble.epochs() == 0 {
                    *ensemble = Ensemble::new(self.epochs);
                }
                ensemble.add(score.epoch, error, variance.as_ref())?;
            }
        }
        if let Some(nees) = score.nees {
            self.nees.add(score.epoch, nees)?;
            self.dimension = self.dimension.max(score.dimension);
        }
        if let Some(nis) = score.nis {
            self.nis.add(score.epoch, nis)?;
        }
        self.covariances_broken += u64::from(score.covariance_broken);
        Ok(())
    }
}

/// One filter's part of one run, on its way to the statistics.
struct Record {
    row: RunRow,
    scores: PackedScores,
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
    /// [`HarnessError::Stats`] only; what goes wrong in a run is counted in its results.
    pub fn run(&self, mut finished: impl FnMut(u32, &[RunRow])) -> Result<StudyResult, HarnessError> {
        let begin = Instant::now();
        let labels = self.spec.filters.iter().map(|f| &f.label);
        let mut filters: Vec<_> = labels.map(|label| FilterResult::new(label, &self.spec)).collect();
        in_order(
            self.runs,
            self.jobs,
            WAITING,
            |run| self.one_run(run),
            |run, (records, report)| {
                for ((filter, record), nav) in filters.iter_mut().zip(records).zip(report.filter_times) {
                    filter.fold(record)?;
                    filter.timing.add(report.steps, nav, report.truth_time);
                }
                let rows: Vec<RunRow> = filters.iter().filter_map(|f| f.runs.last().cloned()).collect();
                finished(run, &rows);
                Ok::<(), HarnessError>(())
            },
        )?;
        Ok(StudyResult {
            filters,
            wall: begin.elapsed(),
        })
    }

    fn one_run(&self, run: u32) -> (Vec<Record>, RunReport) {
        let epochs = self.spec.epochs();
        let mut scores: Vec<_> = self.spec.filters.iter().map(|_| PackedScores::new(epochs)).collect();
        let report = run_once(&self.spec, run, |filter, truth, estimate| {
            let score = score(self.spec.scenario, truth, estimate)
                .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
            scores[filter].push(&score);
            Ok(())
        });
        let first = self.spec.first_scored();
        let records = scores
            .into_iter()
            .zip(&report.endings)
            .map(|(scores, ending)| Record {
                row: row(run, &scores, first, ending),
                // Those of a failed run count for nothing.
                scores: if ending.failure.is_none() {
                    scores
                } else {
                    PackedScores::default()
                },
            })
            .collect();
        (records, report)
    }
}

fn row(run: u32, scores: &PackedScores, first_scored: usize, ending: &Ending) -> RunRow {
    let failed = ending.failure.is_some();
    let scored = || scores.iter().filter(|s| s.epoch >= first_scored && !failed);
    let rmse = |q: Quantity| {
        let squares = scored().filter_map(|s| s.errors[q as usize].as_ref().map(Vector3::norm_squared));
        mean(squares).map(f64::sqrt)
    };
    let mean_square = |of: &dyn Fn(&Score) -> Option<Vector3<f64>>| {
        mean_vector(scored().filter_map(|s| of(&s)).map(|v| v.component_mul(&v)))
    };
    let of_error = |q: Quantity| mean_square(&|s| s.errors[q as usize]);
    RunRow {
        run,
        rmse: [
            rmse(Quantity::Position),
            rmse(Quantity::Velocity),
            rmse(Quantity::Acceleration),
        ],
        mean_squares: [
            of_error(Quantity::Position),
            of_error(Quantity::Velocity),
            of_error(Quantity::Acceleration),
        ],
        true_acceleration_mean_square: mean_square(&|s| s.true_acceleration),
        nees: mean(scored().filter_map(|s| s.nees)),
        nis: mean(scored().filter_map(|s| s.nis)),
        diverged: !failed && (ending.says_diverged || scored().any(|s| s.lost)),
        failure: ending.failure.clone(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
    (n > 0.0).then(|| sum / n)
}

/// Mean of vectors; `None` without any.
pub(crate) fn mean_vector(values: impl Iterator<Item = Vector3<f64>>) -> Option<Vector3<f64>> {
    let (n, sum) = values.fold((0.0, Vector3::zeros()), |(n, sum), v| (n + 1.0, sum + v));
    (n > 0.0).then(|| sum / n)
}

impl Timing {
    fn add(&mut self, steps: u64, nav: SlaveTime, truth: SlaveTime) {
        self.steps += steps;
        for (total, more) in [(&mut self.nav, nav), (&mut self.truth, truth)] {
            total.step += more.step;
            total.exchange += more.exchange;
        }
    }
}
