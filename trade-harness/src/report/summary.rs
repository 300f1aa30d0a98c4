//! `summary.csv`: one row for each scenario, filter and case.

use nalgebra::Vector3;
use serde::Serialize;
use stats::{mean_chi_square_bounds, mean_error_in_sigmas, rmse_standard_error, standard_error};

use super::csv_bytes;
use crate::HarnessError;
use crate::score::Quantity;
use crate::study::{FilterResult, RunRow, mean_vector};

/// Confidence of the bounds of the NEES.
const CONFIDENCE: f64 = 0.95;

row! {
    /// One row; `None` is an empty cell.
    pub struct SummaryRow {
        /// Scenario.
        scenario: String,
        /// Filter with its preset.
        filter: String,
        /// Case.
        case: String,
        /// Runs asked for.
        runs: u32,
        /// Runs that ended with an error; they take no part in the statistics.
        failed: usize,
        /// Runs that lost the target.
        diverged: usize,
        /// Root mean square of the norm of the position error, m.
        pos_rmse_m: Option<f64>,
        /// The same of velocity, m/s.
        vel_rmse_m_s: Option<f64>,
        /// The same of acceleration, m/s2.
        acc_rmse_m_s2: Option<f64>,
        /// Median over time and axes of estimated over sample sigma of position.
        ratio_pos: Option<f64>,
        /// The same of velocity.
        ratio_vel: Option<f64>,
        /// The same of acceleration.
        ratio_acc: Option<f64>,
        /// Root mean square over time and axes of mean error over its standard error.
        mean_err_sigma: Option<f64>,
        /// Mean NEES over its dimension.
        nees: Option<f64>,
        /// Median NEES over its dimension.
        nees_median: Option<f64>,
        /// Mean NIS over its rows.
        nis: Option<f64>,
        /// `ratio_pos` of the first axis alone: radial, or LVLH x.
        ratio_pos_r: Option<f64>,
        /// Second axis: transverse, or LVLH y.
        ratio_pos_t: Option<f64>,
        /// Third axis: normal, or LVLH z.
        ratio_pos_n: Option<f64>,
        /// `ratio_vel` of the first axis.
        ratio_vel_r: Option<f64>,
        /// Second axis.
        ratio_vel_t: Option<f64>,
        /// Third axis.
        ratio_vel_n: Option<f64>,
        /// `ratio_acc` of the first axis.
        ratio_acc_r: Option<f64>,
        /// Second axis.
        ratio_acc_t: Option<f64>,
        /// Third axis.
        ratio_acc_n: Option<f64>,
        /// Root mean square of the norm of the bias error, m/s2.
        bias_rmse_m_s2: Option<f64>,
        /// Median over time and axes of estimated over sample sigma of the bias.
        ratio_bias: Option<f64>,
        /// Share of position errors within three of the filter's sigmas; 0.9973 for a Gaussian.
        coverage_3s_pos: Option<f64>,
        /// The same of velocity.
        coverage_3s_vel: Option<f64>,
        /// The same of acceleration.
        coverage_3s_acc: Option<f64>,
        /// The same of the bias.
        coverage_3s_bias: Option<f64>,
        /// Lower 95 % bound of the mean over runs of NEES over its dimension, at one epoch.
        nees_low: Option<f64>,
        /// Upper bound.
        nees_high: Option<f64>,
        /// Share of epochs whose mean NEES is within those bounds.
        nees_inside: Option<f64>,
        /// Number of states of the NEES.
        nees_dimension: Option<usize>,
        /// Samples whose covariance was not symmetric, positive definite and finite.
        cov_broken: u64,
        /// Root mean square of the position error on the first axis (radial, or LVLH x), m.
        pos_rmse_r_m: Option<f64>,
        /// Second axis (transverse, or LVLH y).
        pos_rmse_t_m: Option<f64>,
        /// Third axis (normal, or LVLH z).
        pos_rmse_n_m: Option<f64>,
        /// Root mean square of the velocity error on the first axis (radial, or LVLH x), m/s.
        vel_rmse_r_m_s: Option<f64>,
        /// Second axis (transverse, or LVLH y).
        vel_rmse_t_m_s: Option<f64>,
        /// Third axis (normal, or LVLH z).
        vel_rmse_n_m_s: Option<f64>,
        /// Root mean square of the acceleration error on the first axis (radial, or LVLH x), m/s2.
        acc_rmse_r_m_s2: Option<f64>,
        /// Second axis (transverse, or LVLH y).
        acc_rmse_t_m_s2: Option<f64>,
        /// Third axis (normal, or LVLH z).
        acc_rmse_n_m_s2: Option<f64>,
        /// Standard error of `pos_rmse_m` over the runs, m.
        pos_rmse_se_m: Option<f64>,
        /// The same of `vel_rmse_m_s`, m/s.
        vel_rmse_se_m_s: Option<f64>,
        /// The same of `acc_rmse_m_s2`, m/s2.
        acc_rmse_se_m_s2: Option<f64>,
        /// Standard error of `acc_rmse_r_m_s2`, m/s2.
        acc_rmse_se_r_m_s2: Option<f64>,
        /// Standard error of `acc_rmse_t_m_s2`, m/s2.
        acc_rmse_se_t_m_s2: Option<f64>,
        /// Standard error of `acc_rmse_n_m_s2`, m/s2.
        acc_rmse_se_n_m_s2: Option<f64>,
        /// Standard error of `nees` over the runs.
        nees_se: Option<f64>,
        /// Standard error of `nis` over the runs.
        nis_se: Option<f64>,
        /// Root mean square of the true acceleration: the RMSE of an estimate that is always zero, m/s2.
        acc_rmse_of_zero_m_s2: Option<f64>,
        /// The same on the first axis.
        acc_rmse_of_zero_r_m_s2: Option<f64>,
        /// Second axis.
        acc_rmse_of_zero_t_m_s2: Option<f64>,
        /// Third axis.
        acc_rmse_of_zero_n_m_s2: Option<f64>,
    }
}

impl SummaryRow {
    /// The statistics of one filter.
    pub fn new(scenario: &str, case: &str, result: &FilterResult) -> Self {
        let time = result.first_scored..usize::MAX;
        let rmse = |q| result.ensemble(q).rmse(time.clone());
        let ratio = |q| result.ensemble(q).ratio(time.clone());
        let coverage = |q| result.ensemble(q).coverage(time.clone());
        let by_axis = |q| match result.ensemble(q).ratio_by_axis(time.clone()) {
            Some(ratios) => ratios.map(Some),
            None => [None; 3],
        };
        let [ratio_pos_r, ratio_pos_t, ratio_pos_n] = by_axis(Quantity::Position);
        let [ratio_vel_r, ratio_vel_t, ratio_vel_n] = by_axis(Quantity::Velocity);
        let [ratio_acc_r, ratio_acc_t, ratio_acc_n] = by_axis(Quantity::Acceleration);
        let rmse_by_axis = |q| match result.ensemble(q).rmse_by_axis(time.clone()) {
            Some(rmse) => [Some(rmse.x), Some(rmse.y), Some(rmse.z)],
            None => [None; 3],
        };
        let [pos_rmse_r_m, pos_rmse_t_m, pos_rmse_n_m] = rmse_by_axis(Quantity::Position);
        let [vel_rmse_r_m_s, vel_rmse_t_m_s, vel_rmse_n_m_s] = rmse_by_axis(Quantity::Velocity);
        let [acc_rmse_r_m_s2, acc_rmse_t_m_s2, acc_rmse_n_m_s2] = rmse_by_axis(Quantity::Acceleration);
        let mean_squares = |of: &dyn Fn(&RunRow) -> Option<Vector3<f64>>, part: fn(Vector3<f64>) -> f64| {
            result.runs.iter().filter_map(of).map(part).collect::<Vec<_>>()
        };
        let rmse_error = |q: Quantity| rmse_standard_error(&mean_squares(&|r| r.mean_squares[q as usize], |v| v.sum()));
        let acc_error = |axis: fn(Vector3<f64>) -> f64| {
            rmse_standard_error(&mean_squares(
                &|r| r.mean_squares[Quantity::Acceleration as usize],
                axis,
            ))
        };
        let scalar_error =
            |of: fn(&RunRow) -> Option<f64>| standard_error(&result.runs.iter().filter_map(of).collect::<Vec<_>>());
        let of_zero = mean_vector(result.runs.iter().filter_map(|r| r.true_acceleration_mean_square));
        let dimension = result.dimension;
        let bounds_for = |runs: u32| mean_chi_square_bounds(runs as usize, dimension, CONFIDENCE).ok();
        let finished = result.runs.len() - result.failed();
        let bounds = bounds_for(u32::try_from(finished).unwrap_or(u32::MAX));
        Self {
            scenario: scenario.to_owned(),
            filter: result.label.clone(),
            case: case.to_owned(),
            runs: u32::try_from(result.runs.len()).unwrap_or(u32::MAX),
            failed: result.failed(),
            diverged: result.diverged(),
            pos_rmse_m: rmse(Quantity::Position),
            vel_rmse_m_s: rmse(Quantity::Velocity),
            acc_rmse_m_s2: rmse(Quantity::Acceleration),
            ratio_pos: ratio(Quantity::Position),
            ratio_vel: ratio(Quantity::Velocity),
            ratio_acc: ratio(Quantity::Acceleration),
            mean_err_sigma: mean_error_in_sigmas(
                &[result.ensemble(Quantity::Position), result.ensemble(Quantity::Velocity)],
                time.clone(),
            ),
            nees: result.nees.mean(),
            nees_median: result.nees.median(),
            nis: result.nis.mean(),
            ratio_pos_r,
            ratio_pos_t,
            ratio_pos_n,
            ratio_vel_r,
            ratio_vel_t,
            ratio_vel_n,
            ratio_acc_r,
            ratio_acc_t,
            ratio_acc_n,
            bias_rmse_m_s2: rmse(Quantity::Bias),
            ratio_bias: ratio(Quantity::Bias),
            coverage_3s_pos: coverage(Quantity::Position),
            coverage_3s_vel: coverage(Quantity::Velocity),
            coverage_3s_acc: coverage(Quantity::Acceleration),
            coverage_3s_bias: coverage(Quantity::Bias),
            nees_low: bounds.map(|b| b.low),
            nees_high: bounds.map(|b| b.high),
            nees_inside: result.nees.share_of_epochs_inside(bounds_for),
            nees_dimension: (dimension > 0).then_some(dimension),
            cov_broken: result.covariances_broken,
            pos_rmse_r_m,
            pos_rmse_t_m,
            pos_rmse_n_m,
            vel_rmse_r_m_s,
            vel_rmse_t_m_s,
            vel_rmse_n_m_s,
            acc_rmse_r_m_s2,
            acc_rmse_t_m_s2,
            acc_rmse_n_m_s2,
            pos_rmse_se_m: rmse_error(Quantity::Position),
            vel_rmse_se_m_s: rmse_error(Quantity::Velocity),
            acc_rmse_se_m_s2: rmse_error(Quantity::Acceleration),
            acc_rmse_se_r_m_s2: acc_error(|v| v[0]),
            acc_rmse_se_t_m_s2: acc_error(|v| v[1]),
            acc_rmse_se_n_m_s2: acc_error(|v| v[2]),
            nees_se: scalar_error(|r| r.nees),
            nis_se: scalar_error(|r| r.nis),
            acc_rmse_of_zero_m_s2: of_zero.map(|v| v.sum().sqrt()),
            acc_rmse_of_zero_r_m_s2: of_zero.map(|v| v[0].sqrt()),
            acc_rmse_of_zero_t_m_s2: of_zero.map(|v| v[1].sqrt()),
            acc_rmse_of_zero_n_m_s2: of_zero.map(|v| v[2].sqrt()),
        }
    }

    /// The number in a column; `None` where the cell is empty, holds text or does not exist.
    pub fn number(&self, column: &str) -> Option<f64> {
        serde_json::to_value(self).ok()?.get(column)?.as_f64()
    }
}

/// Contents of `summary.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rows: &[SummaryRow]) -> Result<Vec<u8>, HarnessError> {
    csv_bytes(COLUMNS, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns that study scripts rely on, in the words of the interface.
    #[test]
    fn the_promised_columns_come_first() {
        let promised = "scenario,filter,case,runs,failed,diverged,pos_rmse_m,vel_rmse_m_s,acc_rmse_m_s2,\
            ratio_pos,ratio_vel,ratio_acc,mean_err_sigma,nees,nees_median,nis";
        assert!(COLUMNS.join(",").starts_with(promised));
        let text = String::from_utf8(render(&[]).unwrap()).unwrap();
        assert_eq!(text, format!("{}\n", COLUMNS.join(",")));
    }
}
