//! Runs, one after the other, folded into what a study says of one phase.

use nalgebra::Vector3;
use numerics::{Source, stream};
use rand::RngExt;
use stats::{ChiSquareEnsemble, LogHistogram, Resamples, Sum, pooled_mean};

use crate::error::StudyError;
use crate::record::{Quantity, Record};

/// How long the error has to stay inside 3 sigma to count as back, s.
pub const HOLD_S: f64 = 60.0;

/// Position, velocity and acceleration.
const MOTION: [Quantity; 3] = [Quantity::Position, Quantity::Velocity, Quantity::Acceleration];

/// One filter in one phase, over the runs of a study.
#[derive(Debug, Clone)]
pub struct PhaseResult {
    /// Name.
    pub name: String,
    /// Each run, in order; nothing of those that failed or never were in the phase.
    pub runs: Vec<PhaseRun>,
    /// Norms of the errors of position, m, and velocity, m/s.
    pub norms: [LogHistogram; 2],
    /// NEES over its dimension, by epoch.
    pub nees: ChiSquareEnsemble,
    /// NEES of position and velocity alone over 6, by epoch.
    pub nees6: ChiSquareEnsemble,
    /// NIS over its rows, by epoch.
    pub nis: ChiSquareEnsemble,
    /// NEES of position and velocity alone over 6.
    pub nees6_values: LogHistogram,
    bit: u32,
    sample_period: f64,
}

/// One run in one phase.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PhaseRun {
    /// Squared norms of the errors of position, velocity and acceleration.
    pub squares: [Sum; 3],
    /// Largest norm of the errors of position and velocity.
    pub largest: [Option<f64>; 2],
    /// Squared norms of those of position, velocity and acceleration at the last epoch of the phase.
    pub last: [Option<f64>; 3],
    /// NEES over its dimension.
    pub nees: Sum,
    /// NEES of position and velocity alone over 6.
    pub nees6: Sum,
    /// NIS over its rows.
    pub nis: Sum,
    /// Longest time of the run's windows, unbroken stretches of the phase, until the position error was within 3 sigma on every
    /// axis for [`HOLD_S`] or to the end of the window, s; infinite where it was not.
    pub back: Option<f64>,
}

/// 95 % intervals from runs drawn again.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Intervals {
    /// Of the RMSE of position, velocity and acceleration.
    pub(crate) rmse: [Option<[f64; 2]>; 3],
    /// Of the mean NEES.
    pub(crate) nees: Option<[f64; 2]>,
}

impl PhaseResult {
    /// Nothing yet.
    ///
    /// * `bit`: of the phase in the records.
    pub(crate) fn new(name: &str, bit: u32, sample_period: f64) -> Self {
        Self {
            name: name.to_owned(),
            runs: Vec::new(),
            norms: Default::default(),
            nees: ChiSquareEnsemble::default(),
            nees6: ChiSquareEnsemble::default(),
            nis: ChiSquareEnsemble::default(),
            nees6_values: LogHistogram::default(),
            bit,
            sample_period,
        }
    }

    /// Takes in one run.
    ///
    /// * `records`: of its estimates, in order; none of a failed run.
    pub(crate) fn fold(&mut self, records: &[Record]) -> Result<(), StudyError> {
        let mut run = PhaseRun::default();
        let bit = 1 << self.bit;
        let holds = |record: &Record| record.phases & bit != 0;
        for record in records.iter().filter(|r| holds(r)) {
            let epoch = record.epoch as usize;
            for (at, quantity) in MOTION.into_iter().enumerate() {
                let Some(square) = record.error(quantity).as_ref().map(Vector3::norm_squared) else {
                    continue;
                };
                run.squares[at].push(square);
                run.last[at] = Some(square);
                if let (Some(histogram), Some(largest)) = (self.norms.get_mut(at), run.largest.get_mut(at)) {
                    histogram.add(square.sqrt());
                    *largest = Some(largest.unwrap_or(0.0).max(square.sqrt()));
                }
            }
            if let Some(nees6) = record.nees6() {
                self.nees6_values.add(nees6);
            }
            for (value, freedom, ensemble, sum) in [
                (record.nees(), record.dimension, &mut self.nees, &mut run.nees),
                (record.nees6(), 6, &mut self.nees6, &mut run.nees6),
                (record.nis(), record.nis_rows, &mut self.nis, &mut run.nis),
            ] {
                if let Some(value) = value {
                    ensemble.add(epoch, value, freedom.into())?;
                    sum.push(value);
                }
            }
        }
        let windows = records.chunk_by(|a, b| holds(a) == holds(b));
        let windows = windows.filter(|window| window.first().is_some_and(holds));
        run.back = windows
            .filter_map(|window| PhaseRun::back(window, self.sample_period))
            .reduce(f64::max);
        self.runs.push(run);
        Ok(())
    }

    /// Intervals of what is pooled over the runs that are in the phase.
    pub(crate) fn intervals(&self, seed: i32) -> Intervals {
        let present: Vec<&PhaseRun> = self.runs.iter().filter(|r| r.squares[0].values > 0).collect();
        let resamples = resamples(present.len(), seed);
        let interval = |of: &dyn Fn(&PhaseRun) -> Sum, root: bool| {
            let sums: Vec<Sum> = present.iter().map(|run| of(run)).collect();
            let mean = |runs: &[u32]| pooled_mean(&sums, runs);
            resamples.interval(|runs| mean(runs).map(|m| if root { m.sqrt() } else { m }))
        };
        Intervals {
            rmse: [0, 1, 2].map(|at| interval(&|run| run.squares[at], true)),
            nees: interval(&|run| run.nees, false),
        }
    }
}

/// Runs drawn again, the same for all filters of a study.
pub(crate) fn resamples(runs: usize, seed: i32) -> Resamples<impl FnMut(u32) -> u32 + Clone> {
    let mut generator = stream(seed.unsigned_abs().into(), 0, Source::Bootstrap);
    Resamples::new(u32::try_from(runs).unwrap_or(u32::MAX), move |n| {
        generator.random_range(0..n)
    })
}

impl PhaseRun {
    /// Time from the first epoch of a window, an unbroken stretch of the phase, to the first epoch from which the position error
    /// is within 3 sigma on every axis for [`HOLD_S`], or until the window ends if that comes sooner; 0 where it never left,
    /// infinite where it is outside at the end. `None` of a filter without a covariance.
    fn back(window: &[Record], sample_period: f64) -> Option<f64> {
        let time = |record: &Record| f64::from(record.epoch) * sample_period;
        let begin = time(window.first()?);
        let mut since = None;
        for record in window {
            let (error, variance) = (record.error(Quantity::Position)?, record.variance(Quantity::Position)?);
            let inside = error.iter().zip(&variance).all(|(e, v)| e * e <= 9.0 * v);
            since = inside.then(|| since.unwrap_or_else(|| time(record)));
            if since.is_some_and(|since| time(record) - since >= HOLD_S) {
                break;
            }
        }
        Some(since.map_or(f64::INFINITY, |since| since - begin))
    }

    /// Value of a column of `phases.csv` in this run alone; `None` for those that only many runs have, and where there is none.
    pub fn value(&self, column: &str) -> Option<f64> {
        let rmse = |at: usize| self.squares[at].mean().map(f64::sqrt);
        let last = |at: usize| self.last[at].map(f64::sqrt);
        match column {
            "pos_rmse_m" => rmse(0),
            "vel_rmse_m_s" => rmse(1),
            "acc_rmse_m_s2" => rmse(2),
            "pos_max_m" => self.largest[0],
            "vel_max_m_s" => self.largest[1],
            "pos_final_m" => last(0),
            "vel_final_m_s" => last(1),
            "acc_final_m_s2" => last(2),
            "nees" => self.nees.mean(),
            "nees6" => self.nees6.mean(),
            "nis" => self.nis.mean(),
            "back_p50_s" | "back_p95_s" => self.back,
            _ => None,
        }
    }

    /// Columns that one run has a value of.
    pub const COLUMNS: [&'static str; 13] = [
        "pos_rmse_m",
        "vel_rmse_m_s",
        "acc_rmse_m_s2",
        "pos_max_m",
        "vel_max_m_s",
        "pos_final_m",
        "vel_final_m_s",
        "acc_final_m_s2",
        "nees",
        "nees6",
        "nis",
        "back_p50_s",
        "back_p95_s",
    ];
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    /// Position errors on the first axis of sigma 1, one an epoch of 2 s, in the phase or not.
    fn records(errors: &[(f64, bool)]) -> Vec<Record> {
        let row = |(epoch, (error, inside)): (usize, &(f64, bool))| {
            let mut record = Record::new(epoch);
            record.phases = u32::from(*inside) << 1;
            record.set(
                Quantity::Position,
                Some(Vector3::new(*error, 0.0, 0.0)),
                Some(Vector3::repeat(1.0)),
            );
            record.set(Quantity::Velocity, Some(Vector3::new(0.0, 0.5 * error, 0.0)), None);
            record
        };
        errors.iter().enumerate().map(row).collect()
    }

    fn folded(runs: &[&[(f64, bool)]]) -> PhaseResult {
        let mut phase = PhaseResult::new("p", 1, 2.0);
        runs.iter().for_each(|run| phase.fold(&records(run)).unwrap());
        phase
    }

    #[test]
    fn a_case_worked_by_hand() {
        let phase = folded(&[&[(9.0, false), (3.0, true), (4.0, true), (9.0, false)], &[(9.0, false)]]);
        let run = phase.runs[0];
        assert_eq!(run.squares[0], Sum { total: 25.0, values: 2 });
        assert_eq!(
            (run.largest, run.last),
            ([Some(4.0), Some(2.0)], [Some(16.0), Some(4.0), None])
        );
        assert_eq!(run.value("pos_rmse_m"), Some(12.5_f64.sqrt()));
        assert_eq!(phase.runs[1], PhaseRun::default());
        assert_eq!(phase.norms[0].total(), 2);
    }

    #[test]
    fn back_inside_three_sigma_is_counted_from_the_begin_of_each_window() {
        let back = |errors: &[(f64, bool)]| folded(&[errors]).runs[0].back;
        assert_eq!(back(&[(1.0, true), (2.9, true)]), Some(0.0));
        // Out, in, out, in for good: the third epoch after the first.
        assert_eq!(
            back(&[(4.0, true), (1.0, true), (4.0, true), (1.0, true), (1.0, true)]),
            Some(6.0)
        );
        // Two windows, 2 and 4 s: the longer.
        let two = [
            (4.0, true),
            (1.0, true),
            (0.0, false),
            (4.0, true),
            (4.0, true),
            (1.0, true),
        ];
        assert_eq!(back(&two), Some(4.0));
        assert_eq!(back(&[(1.0, true), (4.0, true)]), Some(f64::INFINITY));
        assert_eq!(back(&[(1.0, false)]), None);
        // Inside for 60 s, 31 epochs of 2 s: what comes later is another matter; for 58 s, it is not.
        let later = |inside: usize| {
            let mut errors = vec![(4.0, true)];
            errors.extend(vec![(1.0, true); inside]);
            errors.extend([(4.0, true), (1.0, true)]);
            back(&errors)
        };
        assert_eq!((later(31), later(30)), (Some(2.0), Some(64.0)));
    }
}
