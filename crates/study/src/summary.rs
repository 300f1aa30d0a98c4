//! The statistics of one filter over the runs of a study.

use nalgebra::Vector3;
use stats::{
    ScalarEnsemble, mean_chi_square_bounds, mean_error_in_sigmas, mean_error_in_sigmas_about_zero, rmse_standard_error,
    standard_error,
};

use crate::fold::{FilterResult, RunRow, mean_vector};
use crate::record::Quantity;

/// Confidence of the bounds of the NEES.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// One filter in one world and case; `None` where there is nothing to take a statistic of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// World.
    pub scenario: String,
    /// Filter with its preset.
    pub filter: String,
    /// Whether it is a bound, told by the truth, and no filter.
    pub bound: bool,
    /// Case.
    pub case: String,
    /// Runs asked for.
    pub runs: u32,
    /// Runs that ended with an error; they take no part in the statistics.
    pub failed: usize,
    /// Runs that lost the target.
    pub diverged: usize,
    /// Samples that went unanswered in runs that have a result.
    pub missing_epochs: u64,
    /// Errors of relative position, m.
    pub position: QuantitySummary,
    /// Errors of relative velocity, m/s.
    pub velocity: QuantitySummary,
    /// Errors of the unmodelled acceleration, m/s2.
    pub acceleration: QuantitySummary,
    /// Errors of the accelerometer bias, m/s2.
    pub bias: QuantitySummary,
    /// Root mean square over time and axes, of position and velocity, of mean error over its standard error.
    pub mean_error_sigma: Option<f64>,
    /// Value that it exceeds by chance alone in 5 % of studies.
    pub mean_error_bound: Option<f64>,
    /// The same with the sample sigma about zero, Eqs. (31) and (32) of Mamich and Zanetti.
    pub mean_error_sigma_about_zero: Option<f64>,
    /// NEES over its dimension.
    pub nees: ScalarSummary,
    /// NEES of position and velocity alone, over 6: the same states for every filter.
    pub nees6: ScalarSummary,
    /// NIS over its rows.
    pub nis: ScalarSummary,
    /// 95 % bounds of the mean over runs of NEES over its dimension, at one epoch.
    pub nees_bounds: Option<[f64; 2]>,
    /// Share of epochs whose mean NEES is within those bounds.
    pub nees_inside: Option<f64>,
    /// Number of states of the NEES.
    pub nees_dimension: Option<usize>,
    /// Samples whose covariance was not symmetric, positive definite and finite.
    pub covariances_broken: u64,
    /// Root mean square of the true acceleration, m/s2: the RMSE of an estimate that is always zero.
    pub zero_acceleration: Option<f64>,
    /// The same by axis.
    pub zero_acceleration_axes: [Option<f64>; 3],
    /// 95 % interval of the mean NEES over its dimension, from runs drawn again.
    pub nees_interval: Option<[f64; 2]>,
    /// Group of filters whose position and velocity errors cannot be told apart, from 1; see [`crate::ranks`].
    pub ranks: [Option<u32>; 2],
}

/// Errors of one vector quantity, in its unit; arrays are by axis of the results.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuantitySummary {
    /// Root mean square of the norm.
    pub rmse: Option<f64>,
    /// Its standard error over the runs.
    pub rmse_error: Option<f64>,
    /// Its 95 % interval, from runs drawn again.
    pub interval: Option<[f64; 2]>,
    /// Root mean square.
    pub rmse_axes: [Option<f64>; 3],
    /// Standard error of that over the runs.
    pub rmse_error_axes: [Option<f64>; 3],
    /// Median over time and axes of estimated over sample sigma, Eqs. (32) and (33) of Mamich and Zanetti.
    pub ratio: Option<f64>,
    /// The same of each axis.
    pub ratio_axes: [Option<f64>; 3],
    /// Share of errors within three of the filter's sigmas; 0.9973 for a Gaussian.
    pub coverage: Option<f64>,
}

/// A normalised square over runs and time; 1 on average when consistent.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ScalarSummary {
    /// Mean.
    pub mean: Option<f64>,
    /// Its standard error over the runs.
    pub error: Option<f64>,
    /// Median.
    pub median: Option<f64>,
}

impl Summary {
    /// The statistics of one filter, from the first scored epoch on.
    pub fn new(scenario: &str, case: &str, result: &FilterResult) -> Self {
        let time = result.first_scored..usize::MAX;
        let motion = [Quantity::Position, Quantity::Velocity].map(|q| result.ensemble(q));
        let dimension = result.dimension;
        let bounds_for = |runs: u32| mean_chi_square_bounds(runs as usize, dimension, CONFIDENCE).ok();
        let finished = result.runs.len() - result.failed();
        let bounds = bounds_for(u32::try_from(finished).unwrap_or(u32::MAX));
        let over_runs =
            |of: fn(&RunRow) -> Option<f64>| standard_error(&result.runs.iter().filter_map(of).collect::<Vec<_>>());
        let zero = mean_vector(result.runs.iter().filter_map(|r| r.true_acceleration_mean_square));
        let intervals = result.phases.first().map(|scored| scored.intervals(result.seed));
        let intervals = intervals.unwrap_or_default();
        let quantity = |q: Quantity| QuantitySummary {
            interval: intervals.rmse.get(q as usize).copied().flatten(),
            ..QuantitySummary::new(result, q)
        };
        Self {
            scenario: scenario.to_owned(),
            filter: result.label.clone(),
            bound: result.bound,
            case: case.to_owned(),
            runs: u32::try_from(result.runs.len()).unwrap_or(u32::MAX),
            failed: result.failed(),
            diverged: result.diverged(),
            missing_epochs: result.missing(),
            position: quantity(Quantity::Position),
            velocity: quantity(Quantity::Velocity),
            acceleration: quantity(Quantity::Acceleration),
            bias: quantity(Quantity::Bias),
            mean_error_sigma: mean_error_in_sigmas(&motion, time.clone()),
            mean_error_bound: result.mean_error_bound(),
            mean_error_sigma_about_zero: mean_error_in_sigmas_about_zero(&motion, time),
            nees: ScalarSummary::new(&result.nees, over_runs(|r| r.nees)),
            nees6: ScalarSummary::new(&result.nees6, over_runs(|r| r.nees6)),
            nis: ScalarSummary::new(&result.nis, over_runs(|r| r.nis)),
            nees_bounds: bounds.map(|b| [b.low, b.high]),
            nees_inside: result.nees.share_of_epochs_inside(bounds_for),
            nees_dimension: (dimension > 0).then_some(dimension),
            covariances_broken: result.covariances_broken,
            zero_acceleration: zero.map(|v| v.sum().sqrt()),
            zero_acceleration_axes: by_axis(zero.map(|v| v.map(f64::sqrt))),
            nees_interval: intervals.nees,
            ranks: [None; 2],
        }
    }
}

impl ScalarSummary {
    fn new(values: &ScalarEnsemble, error: Option<f64>) -> Self {
        Self {
            mean: values.mean(),
            error,
            median: values.median(),
        }
    }
}

impl QuantitySummary {
    fn new(result: &FilterResult, quantity: Quantity) -> Self {
        let time = || result.first_scored..usize::MAX;
        let ensemble = result.ensemble(quantity);
        // Mean squares of each run by axis; the runs keep none of what is no part of the motion.
        let squares = result
            .runs
            .iter()
            .map(|r| r.mean_squares.get(quantity as usize).copied());
        let squares: Vec<Vector3<f64>> = squares.filter_map(Option::flatten).collect();
        let error =
            |part: &dyn Fn(&Vector3<f64>) -> f64| rmse_standard_error(&squares.iter().map(part).collect::<Vec<_>>());
        Self {
            rmse: ensemble.rmse(time()),
            rmse_error: error(&|v| v.sum()),
            interval: None,
            rmse_axes: by_axis(ensemble.rmse_by_axis(time())),
            rmse_error_axes: [0, 1, 2].map(|axis| error(&|v| v[axis])),
            ratio: ensemble.ratio(time()),
            ratio_axes: ensemble.ratio_by_axis(time()).map_or([None; 3], |r| r.map(Some)),
            coverage: ensemble.coverage(time()),
        }
    }
}

fn by_axis(v: Option<Vector3<f64>>) -> [Option<f64>; 3] {
    v.map_or([None; 3], |v| [Some(v.x), Some(v.y), Some(v.z)])
}
