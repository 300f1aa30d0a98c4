//! The statistics of one filter in one phase, over the runs of a study.

use stats::{ChiSquareEnsemble, Sum, median};

use crate::fold::FilterResult;
use crate::phase_result::{PhaseResult, PhaseRun};
use crate::summary::CONFIDENCE;

/// One filter in one phase of one world and case; `None` where there is nothing to take a statistic of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PhaseSummary {
    /// World.
    pub scenario: String,
    /// Filter with its preset.
    pub filter: String,
    /// Case.
    pub case: String,
    /// Name of the phase.
    pub phase: String,
    /// Runs asked for.
    pub runs: usize,
    /// Runs that ended with an error; they take no part in the statistics.
    pub failed: usize,
    /// Runs that lost the target.
    pub diverged: usize,
    /// Runs with an estimate in the phase.
    pub present: usize,
    /// Estimates in the phase, over all runs.
    pub samples: u64,
    /// Errors of position, m, velocity, m/s, and acceleration, m/s2.
    pub errors: [ErrorSummary; 3],
    /// Median and 95 % quantile over runs of the time until the position error was back inside 3 sigma, s; a run in which it
    /// was not has an infinite one, and a quantile that is infinite is absent.
    pub back: [Option<f64>; 2],
    /// Runs in which it was not.
    pub never_back: Option<usize>,
    /// NEES over its dimension.
    pub nees: ChiSquareSummary,
    /// NEES of position and velocity alone over 6.
    pub nees6: ChiSquareSummary,
    /// Median of it over runs and time, to 0.024 %.
    pub nees6_median: Option<f64>,
    /// Share of its values that one in a thousand exceeds by chance.
    pub nees6_beyond: Option<f64>,
    /// NIS over its rows.
    pub nis: ChiSquareSummary,
}

/// Errors of one quantity, in its unit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorSummary {
    /// Root mean square of the norm.
    pub rmse: Option<f64>,
    /// 95 % interval of it, from runs drawn again.
    pub interval: Option<[f64; 2]>,
    /// 50, 95 and 99.7 % quantile of the norm; not of the acceleration.
    pub quantiles: [Option<f64>; 3],
    /// Largest norm; not of the acceleration.
    pub largest: Option<f64>,
    /// Root mean square over runs of the norm at the last epoch of the phase.
    pub last: Option<f64>,
}

/// A normalised square; 1 on average when consistent.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ChiSquareSummary {
    /// Mean over runs and time.
    pub mean: Option<f64>,
    /// 95 % bounds of the mean over runs, at one epoch at which all runs are in the phase.
    pub bounds: Option<[f64; 2]>,
    /// Share of epochs whose mean over the runs is within the bounds for as many as there are.
    pub inside: Option<f64>,
}

impl PhaseSummary {
    /// The statistics of one filter, phase by phase.
    pub fn of(scenario: &str, case: &str, result: &FilterResult) -> Vec<Self> {
        let phases = result.phases.iter();
        let new = |phase: &PhaseResult| Self {
            scenario: scenario.to_owned(),
            filter: result.label.clone(),
            case: case.to_owned(),
            runs: result.runs.len(),
            failed: result.failed(),
            diverged: result.diverged(),
            ..Self::new(phase, result.seed)
        };
        phases.map(new).collect()
    }

    fn new(phase: &PhaseResult, seed: i32) -> Self {
        let intervals = phase.intervals(seed);
        let error = |at: usize| ErrorSummary {
            rmse: pooled(phase, |run| run.squares[at]).map(f64::sqrt),
            interval: intervals.rmse[at],
            ..ErrorSummary::new(phase, at)
        };
        let mut back: Vec<f64> = phase.runs.iter().filter_map(|run| run.back).collect();
        back.sort_by(f64::total_cmp);
        let never = back.iter().filter(|t| t.is_infinite()).count();
        Self {
            phase: phase.name.clone(),
            present: phase.runs.iter().filter(|run| run.squares[0].values > 0).count(),
            samples: phase.norms[0].total(),
            errors: [0, 1, 2].map(error),
            back: [0.5, 0.95].map(|share| quantile(&back, share).filter(|t| t.is_finite())),
            never_back: (!back.is_empty()).then_some(never),
            nees: ChiSquareSummary::new(&phase.nees, pooled(phase, |run| run.nees)),
            nees6: ChiSquareSummary::new(&phase.nees6, pooled(phase, |run| run.nees6)),
            nees6_median: phase.nees6_values.median(),
            nees6_beyond: phase.nees6.share_beyond(),
            nis: ChiSquareSummary::new(&phase.nis, pooled(phase, |run| run.nis)),
            ..Self::default()
        }
    }
}

impl ErrorSummary {
    /// What the histograms, the largest and the last hold.
    fn new(phase: &PhaseResult, at: usize) -> Self {
        let mut last = Sum::default();
        phase
            .runs
            .iter()
            .filter_map(|run| run.last[at])
            .for_each(|square| last.push(square));
        let largest = phase
            .runs
            .iter()
            .filter_map(|run| *run.largest.get(at)?)
            .reduce(f64::max);
        // A quantile is placed by bins, which may reach beyond the largest value.
        let of = |share| {
            phase
                .norms
                .get(at)?
                .quantile(share)
                .map(|q| largest.map_or(q, |most| most.min(q)))
        };
        Self {
            quantiles: [0.5, 0.95, 0.997].map(of),
            largest,
            last: last.mean().map(f64::sqrt),
            ..Self::default()
        }
    }
}

impl ChiSquareSummary {
    fn new(ensemble: &ChiSquareEnsemble, mean: Option<f64>) -> Self {
        Self {
            mean,
            bounds: ensemble.bounds(CONFIDENCE).map(|b| [b.low, b.high]),
            inside: ensemble.share_inside(CONFIDENCE),
        }
    }
}

/// Mean over all values of all runs.
fn pooled(phase: &PhaseResult, of: impl Fn(&PhaseRun) -> Sum) -> Option<f64> {
    let (total, values) = phase.runs.iter().map(of).fold((0.0, 0.0), |(total, values), sum| {
        (total + sum.total, values + f64::from(sum.values))
    });
    (values > 0.0).then(|| total / values)
}

/// Quantile of sorted values: the smallest that at least this share is not above; the median of two is between them.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    if (share - 0.5).abs() < f64::EPSILON && sorted.last().is_some_and(|t| t.is_finite()) {
        return median(sorted.iter().copied());
    }
    let place = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(place.saturating_sub(1)).copied()
}
