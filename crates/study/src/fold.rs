//! Runs, one after the other, folded into what a study says of a filter.

use nalgebra::Vector3;
use numerics::{Source, stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use stats::{Ensemble, FLIPS, ScalarEnsemble, SignFlips};

use crate::error::StudyError;
use crate::kept::{KEPT_RUNS, KeptRun};
use crate::participant::Participant;
use crate::phase_result::PhaseResult;
use crate::record::{QUANTITIES, Quantity, Record};
use crate::run::{Ending, Failure, SlaveTime};
use crate::spec::Layout;

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
    /// The filter or the distance to the truth said so, of a run without a result before it ended.
    pub diverged: bool,
    /// Parameters that the filter calculated, by contract name; of the first run alone.
    pub calculated: Vec<(String, f64)>,
    /// Samples of the world that the filter has not answered: its estimate was that of an earlier one, and takes no part.
    pub missing: u64,
    /// Set when the run has no result; then it takes no part in the statistics.
    pub failure: Option<Failure>,
}

/// CPU time taken by the runs of a study, see [`cosim::SlaveTiming`].
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
    /// Whether it is a bound and no filter.
    pub bound: bool,
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
    /// By phase; the first is the scored time.
    pub phases: Vec<PhaseResult>,
    /// Seed of the study.
    pub seed: i32,
    flips: SignFlips,
    /// Thinned errors of the first runs that did not fail.
    pub kept: Vec<KeptRun>,
    epochs: usize,
}

impl FilterResult {
    pub(crate) fn of(filter: &Participant, layout: &Layout) -> Self {
        Self {
            bound: filter.bound,
            ..Self::new(&filter.label, layout)
        }
    }

    pub(crate) fn new(label: &str, layout: &Layout) -> Self {
        let &Layout {
            epochs,
            first_scored,
            sample_period,
            seed,
            ..
        } = layout;
        let names = layout.phases.iter().zip(0..);
        Self {
            label: label.to_owned(),
            bound: false,
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
            phases: names
                .map(|(name, bit)| PhaseResult::new(name, bit, sample_period))
                .collect(),
            seed,
            flips: SignFlips::new(epochs, first_scored),
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

    /// Runs that diverged, with a result or before they failed.
    pub fn diverged(&self) -> usize {
        self.runs.iter().filter(|r| r.diverged).count()
    }

    /// Value that the mean error in sigmas exceeds by chance alone in 5 % of studies; `None` for fewer than six runs.
    pub fn mean_error_bound(&self) -> Option<f64> {
        self.flips.bound()
    }

    /// Samples that went unanswered in runs that have a result.
    pub fn missing(&self) -> u64 {
        let with_result = self.runs.iter().filter(|run| run.failure.is_none());
        with_result.map(|run| run.missing).sum()
    }

    /// Takes in one run.
    ///
    /// * `records`: of its estimates; those of a failed run count for nothing.
    pub(crate) fn fold(&mut self, row: RunRow, records: &[Record]) -> Result<(), StudyError> {
        if row.failure.is_none() {
            let mut generator = stream(self.seed.unsigned_abs().into(), row.run.into(), Source::SignFlip);
            let signs: [bool; FLIPS] = std::array::from_fn(|_| generator.random());
            for record in records {
                self.fold_record(record)?;
                let motion = [Quantity::Position, Quantity::Velocity].map(|q| record.error(q));
                if let [Some(position), Some(velocity)] = motion {
                    self.flips.add(record.epoch as usize, &[position, velocity], &signs);
                }
            }
            if self.kept.len() < KEPT_RUNS {
                self.kept.push(KeptRun::new(row.run, records, self.epochs));
            }
        }
        for phase in &mut self.phases {
            phase.fold(if row.failure.is_none() { records } else { &[] })?;
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
        let until_the_end = || records.iter().filter(|r| r.epoch as usize >= first_scored);
        let scored = || until_the_end().filter(|_| !failed);
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
            diverged: ending.says_diverged || until_the_end().any(|r| r.lost),
            calculated: ending.calculated.clone(),
            missing: ending.missing,
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
