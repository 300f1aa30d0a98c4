//! What is kept of runs where only sums matter, as in a search: a study keeps ensembles over time.
//!
//! Hundreds of filters run side by side, each with thousands of samples, so nothing here grows with their number.

use std::convert::Infallible;

use serde::{Deserialize, Serialize};
use stats::{Sum, pooled_mean};

use crate::ordered::in_order;
use crate::phase_result::resamples;
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
    /// Means of the squared norms of the errors of position, velocity and acceleration.
    squares: [Option<f64>; 3],
    nees6: Option<f64>,
}

impl Tally {
    /// Of these runs of a filter.
    pub fn of(runs: &[RunTally]) -> Self {
        let count = |of: fn(&RunTally) -> bool| runs.iter().map(|run| u32::from(of(run))).sum();
        let all: Vec<u32> = (0..).take(runs.len()).collect();
        let mean = |of: &dyn Fn(&RunTally) -> Sum| {
            let sums: Vec<Sum> = runs.iter().map(of).collect();
            pooled_mean(&sums, &all)
        };
        Self {
            failed: count(|run| run.failed),
            diverged: count(|run| run.lost),
            bad_runs: count(|run| run.failed || run.lost || run.broken),
            squares: [0, 1, 2].map(|at| mean(&|run| run.counted().squares[at])),
            nees6: mean(&|run| run.counted().nees6),
        }
    }

    /// Root mean square of the norm of an error; `None` without samples and for quantities that are not kept.
    pub fn rmse(&self, quantity: Quantity) -> Option<f64> {
        self.squares.get(quantity as usize)?.map(f64::sqrt)
    }

    /// Mean NEES of position and velocity, the states that all filters share, over 6; `None` without a covariance.
    pub fn nees6(&self) -> Option<f64> {
        self.nees6
    }
}

/// The same of one run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RunTally {
    /// Sums of the squared norms of the errors of position, velocity and acceleration.
    #[serde(with = "sums")]
    squares: [Sum; 3],
    /// Of the NEES of position and velocity alone, over 6.
    #[serde(with = "sum")]
    nees6: Sum,
    /// Whether it lost the target.
    lost: bool,
    /// Whether a covariance was none.
    broken: bool,
    /// Whether it ended with an error.
    failed: bool,
}

impl RunTally {
    fn push(&mut self, record: &Record) {
        for (sum, quantity) in self.squares.iter_mut().zip(Quantity::ALL) {
            if let Some(error) = record.error(quantity) {
                sum.push(error.norm_squared());
            }
        }
        if let Some(nees6) = record.nees6() {
            self.nees6.push(nees6);
        }
        self.lost |= record.lost;
        self.broken |= record.covariance_broken;
    }

    /// What counts of it: nothing of a failed run.
    fn counted(&self) -> Self {
        if self.failed { Self::default() } else { *self }
    }
}

/// A ratio of root mean squares over the same runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Of the errors pooled over the runs.
    pub value: f64,
    /// 95 % interval of it, from the same runs drawn again for both; `None` below five runs.
    pub interval: Option<[f64; 2]>,
}

/// RMSE of a filter over that of another in the runs that both have a result of; `None` without any.
///
/// * `seed`: selects the runs that are drawn again.
pub fn ratio(own: &[RunTally], other: &[RunTally], quantity: Quantity, seed: i32) -> Option<Ratio> {
    let sum = |run: &RunTally| run.counted().squares.get(quantity as usize).copied();
    let sums = own.iter().zip(other).filter_map(|(a, b)| Option::zip(sum(a), sum(b)));
    let (own, other): (Vec<Sum>, Vec<Sum>) = sums.filter(|(a, b)| a.values > 0 && b.values > 0).unzip();
    let ratio = |runs: &[u32]| Some((pooled_mean(&own, runs)? / pooled_mean(&other, runs)?).sqrt());
    let all: Vec<u32> = (0..).take(own.len()).collect();
    Some(Ratio {
        value: ratio(&all)?,
        interval: resamples(own.len(), seed).interval(ratio),
    })
}

/// Runs every filter of the spec through the first runs of its seed, on `jobs` threads.
///
/// * `finished`: called after each run.
/// * returns: by filter, in the order of the spec; the same for any number of threads.
///
/// What goes wrong in a run is counted.
pub fn evaluate(spec: &Spec, runs: u32, jobs: usize, finished: impl FnMut()) -> Vec<Tally> {
    let each = evaluate_each(spec, runs, jobs, finished);
    each.iter().map(|runs| Tally::of(runs)).collect()
}

/// The same, run by run.
///
/// * returns: by filter, then by run.
pub fn evaluate_each(spec: &Spec, runs: u32, jobs: usize, mut finished: impl FnMut()) -> Vec<Vec<RunTally>> {
    let mut tallies: Vec<Vec<RunTally>> = vec![Vec::new(); spec.filters.len()];
    let Ok(()) = in_order(
        runs,
        jobs,
        // A handful of sums may wait without harm.
        u32::try_from(jobs).unwrap_or(u32::MAX),
        |run| one_run(spec, run),
        |_, results| {
            for (runs, run) in tallies.iter_mut().zip(results) {
                runs.push(run);
            }
            finished();
            Ok::<(), Infallible>(())
        },
    );
    tallies
}

fn one_run(spec: &Spec, run: u32) -> Vec<RunTally> {
    let first = spec.first_scored();
    let mut results = vec![RunTally::default(); spec.filters.len()];
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

/// A sum as a pair of its total and number.
mod sum {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use stats::Sum;

    pub(super) fn serialize<S: Serializer>(sum: &Sum, serializer: S) -> Result<S::Ok, S::Error> {
        (sum.total, sum.values).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Sum, D::Error> {
        let (total, values) = Deserialize::deserialize(deserializer)?;
        Ok(Sum { total, values })
    }
}

/// Three of them.
mod sums {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use stats::Sum;

    pub(super) fn serialize<S: Serializer>(sums: &[Sum; 3], serializer: S) -> Result<S::Ok, S::Error> {
        sums.map(|sum| (sum.total, sum.values)).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[Sum; 3], D::Error> {
        let sums: [(f64, u32); 3] = Deserialize::deserialize(deserializer)?;
        Ok(sums.map(|(total, values)| Sum { total, values }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(squares: f64, values: u32) -> RunTally {
        let sum = Sum { total: squares, values };
        RunTally {
            squares: [sum; 3],
            nees6: sum,
            ..RunTally::default()
        }
    }

    #[test]
    fn a_failed_run_counts_as_such_and_for_nothing_else() {
        let failed = RunTally {
            failed: true,
            lost: true,
            ..run(1e9, 10)
        };
        let tally = Tally::of(&[run(90.0, 10), failed, run(70.0, 30)]);
        assert_eq!((tally.failed, tally.diverged, tally.bad_runs), (1, 1, 1));
        assert!((tally.rmse(Quantity::Position).unwrap() - 2.0).abs() < 1e-15);
        assert!((tally.nees6().unwrap() - 4.0).abs() < 1e-15);
        assert_eq!(Tally::of(&[failed]).rmse(Quantity::Velocity), None);
    }

    /// A filter whose error is twice that of another in every run has a ratio of two without any spread; one run that failed
    /// for either takes no part.
    #[test]
    fn a_ratio_is_of_the_same_runs() {
        let other: Vec<RunTally> = (1..=20).map(|k| run(f64::from(k), 10)).collect();
        let mut own: Vec<RunTally> = (1..=20).map(|k| run(4.0 * f64::from(k), 10)).collect();
        own[7] = RunTally {
            failed: true,
            ..run(1e9, 10)
        };
        let found = ratio(&own, &other, Quantity::Position, 1).unwrap();
        assert!((found.value - 2.0).abs() < 1e-14);
        let [low, high] = found.interval.unwrap();
        assert!((low - 2.0).abs() < 1e-14 && (high - 2.0).abs() < 1e-14);
        assert!(
            ratio(&own[..3], &other[..3], Quantity::Position, 1)
                .unwrap()
                .interval
                .is_none()
        );
        assert!(ratio(&[], &[], Quantity::Position, 1).is_none());
    }
}
