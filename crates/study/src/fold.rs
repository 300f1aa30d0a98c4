//! Runs, one after the other, folded into what a study says of a filter.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use stats::{Ensemble, ScalarEnsemble};

use crate::error::StudyError;
use crate::kept::{KEPT_RUNS, KeptRun};
use crate::record::{QUANTITIES, Quantity, Record};
use crate::run::{Ending, Failure, SlaveTime};
use crate::spec::Spec;

/// What one filter did in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// The same of position and velocity alone, divided by 6.
    pub nees6: Option<f64>,
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
    /// NEES of position and velocity alone, divided by 6.
    pub nees6: ScalarEnsemble,
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
    /// Thinned errors of the first runs that did not fail.
    pub kept: Vec<KeptRun>,
    epochs: usize,
}

impl FilterResult {
    pub(crate) fn new(label: &str, spec: &Spec) -> Self {
        let epochs = spec.epochs();
        let first_scored = spec.first_scored();
        Self {
            label: label.to_owned(),
            runs: Vec::new(),
            // Of no epochs until there is an error to add: most filters lack some of the quantities.
            ensembles: std::array::from_fn(|_| Ensemble::new(0)),
            nees: ScalarEnsemble::new(epochs, first_scored),
            nees6: ScalarEnsemble::new(epochs, first_scored),
            nis: ScalarEnsemble::new(epochs, first_scored),
            dimension: 0,
            covariances_broken: 0,
            first_scored,
            timing: Timing::default(),
            kept: Vec::new(),
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

    /// Takes in one run.
    ///
    /// * `records`: of its estimates; those of a failed run count for nothing.
    pub(crate) fn fold(&mut self, row: RunRow, records: &[Record]) -> Result<(), StudyError> {
        if row.failure.is_none() {
            for record in records {
                self.fold_record(record)?;
            }
            if self.kept.len() < KEPT_RUNS {
                self.kept.push(KeptRun::new(row.run, records, self.epochs));
            }
        }
        self.runs.push(row);
        Ok(())
    }

    fn fold_record(&mut self, record: &Record) -> Result<(), StudyError> {
        let epoch = record.epoch as usize;
        for (ensemble, quantity) in self.ensembles.iter_mut().zip(Quantity::ALL) {
            if let Some(error) = record.error(quantity) {
                if ensemble.epochs() == 0 {
                    *ensemble = Ensemble::new(self.epochs);
                }
                ensemble.add(epoch, &error, record.variance(quantity).as_ref())?;
            }
        }
        if let Some(nees) = record.nees() {
            self.nees.add(epoch, nees)?;
            self.dimension = self.dimension.max(record.dimension.into());
        }
        if let Some(nees6) = record.nees6() {
            self.nees6.add(epoch, nees6)?;
        }
        if let Some(nis) = record.nis() {
            self.nis.add(epoch, nis)?;
        }
        self.covariances_broken += u64::from(record.covariance_broken);
        Ok(())
    }
}

impl RunRow {
    /// * `records`: the estimates of the run, in order.
    /// * `first_scored`: first epoch that counts in means over time.
    pub(crate) fn new(run: u32, records: &[Record], first_scored: usize, ending: &Ending) -> Self {
        let failed = ending.failure.is_some();
        let scored = || records.iter().filter(|r| r.epoch as usize >= first_scored && !failed);
        let rmse = |q: Quantity| {
            let squares = scored().filter_map(|r| r.error(q).as_ref().map(Vector3::norm_squared));
            mean(squares).map(f64::sqrt)
        };
        let mean_square = |of: &dyn Fn(&Record) -> Option<Vector3<f64>>| {
            mean_vector(scored().filter_map(of).map(|v| v.component_mul(&v)))
        };
        let motion = [Quantity::Position, Quantity::Velocity, Quantity::Acceleration];
        Self {
            run,
            rmse: motion.map(rmse),
            mean_squares: motion.map(|q| mean_square(&|r| r.error(q))),
            true_acceleration_mean_square: mean_square(&Record::true_acceleration),
            nees: mean(scored().filter_map(Record::nees)),
            nees6: mean(scored().filter_map(Record::nees6)),
            nis: mean(scored().filter_map(Record::nis)),
            diverged: !failed && (ending.says_diverged || scored().any(|r| r.lost)),
            failure: ending.failure.clone(),
        }
    }
}

impl Timing {
    pub(crate) fn add(&mut self, steps: u64, nav: SlaveTime, truth: SlaveTime) {
        self.steps += steps;
        for (total, more) in [(&mut self.nav, nav), (&mut self.truth, truth)] {
            total.step += more.step;
            total.exchange += more.exchange;
        }
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
