//! What is kept of runs where only sums matter, as in a search: a study keeps ensembles over time.
//!
//! Hundreds of filters run side by side, each with thousands of samples, so nothing here grows with their number.

use std::convert::Infallible;

use crate::ordered::in_order;
use crate::record::{Quantity, Record};
use crate::run::run_once;
use crate::score::score;
use crate::spec::Spec;

/// Sums over the scored samples of the runs that did not fail.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// Runs that ended with an error.
    pub failed: u32,
    /// Runs that lost the target, before they failed or without failing.
    pub diverged: u32,
    /// Runs that failed, diverged or had a covariance that is none.
    pub bad_runs: u32,
    /// Squared norms of the errors of position, velocity and acceleration.
    squares: [Sum; 3],
    nees: Sum,
}

impl Tally {
    /// Root mean square of the norm of an error; `None` without samples and for quantities that are not kept.
    pub fn rmse(&self, quantity: Quantity) -> Option<f64> {
        self.squares.get(quantity as usize)?.mean().map(f64::sqrt)
    }

    /// Mean NEES over its dimension; `None` without a covariance.
    pub fn nees(&self) -> Option<f64> {
        self.nees.mean()
    }

    fn add(&mut self, run: &OneRun) {
        let failed = run.failed;
        let diverged = run.lost;
        self.failed += u32::from(failed);
        self.diverged += u32::from(diverged);
        self.bad_runs += u32::from(failed || diverged || run.broken);
        if !failed {
            for (total, more) in self.squares.iter_mut().zip(run.squares) {
                total.add(more);
            }
            self.nees.add(run.nees);
        }
    }
}

#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Sum {
    total: f64,
    values: u64,
}

impl Sum {
    fn push(&mut self, value: f64) {
        self.add(Self {
            total: value,
            values: 1,
        });
    }

    fn add(&mut self, other: Self) {
        self.total += other.total;
        self.values += other.values;
    }

    fn mean(&self) -> Option<f64> {
        (self.values > 0).then(|| self.total / self.values as f64)
    }
}

/// The same of one run.
#[derive(Clone, Copy, Default)]
struct OneRun {
    squares: [Sum; 3],
    nees: Sum,
    lost: bool,
    broken: bool,
    failed: bool,
}

impl OneRun {
    fn push(&mut self, record: &Record) {
        for (sum, quantity) in self.squares.iter_mut().zip(Quantity::ALL) {
            if let Some(error) = record.error(quantity) {
                sum.push(error.norm_squared());
            }
        }
        if let Some(nees) = record.nees() {
            self.nees.push(nees);
        }
        self.lost |= record.lost;
        self.broken |= record.covariance_broken;
    }
}

/// Runs every filter of the spec through the first runs of its seed, on `jobs` threads.
///
/// * `finished`: called after each run.
/// * returns: by filter, in the order of the spec; the same for any number of threads.
///
/// What goes wrong in a run is counted.
pub fn evaluate(spec: &Spec, runs: u32, jobs: usize, mut finished: impl FnMut()) -> Vec<Tally> {
    let mut tallies = vec![Tally::default(); spec.filters.len()];
    let Ok(()) = in_order(
        runs,
        jobs,
        // A handful of sums may wait without harm.
        u32::try_from(jobs).unwrap_or(u32::MAX),
        |run| one_run(spec, run),
        |_, results| {
            for (tally, run) in tallies.iter_mut().zip(&results) {
                tally.add(run);
            }
            finished();
            Ok::<(), Infallible>(())
        },
    );
    tallies
}

fn one_run(spec: &Spec, run: u32) -> Vec<OneRun> {
    let first = spec.first_scored();
    let mut results = vec![OneRun::default(); spec.filters.len()];
    let report = run_once(spec, run, |filter, truth, estimate| {
        let record = score(&spec.world, truth, estimate)
            .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
        if record.epoch as usize >= first {
            results[filter].push(&record);
        }
        Ok(())
    });
    for (result, ending) in results.iter_mut().zip(&report.endings) {
        result.failed = ending.failure.is_some();
        result.lost |= ending.says_diverged;
    }
    results
}
