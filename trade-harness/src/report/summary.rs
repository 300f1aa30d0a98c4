//! `summary.csv`: one row for each world, filter and case.

use study::Summary;

use super::column::{self, Column, count, find, number, text};
use crate::HarnessError;

/// Every column, in order: the file, the tables on the terminal and the bounds of the papers read this list.
pub const COLUMNS: &[Column<Summary>] = &[
    text("scenario", "world", |s| s.scenario.as_str().into()),
    text("filter", "filter with its preset", |s| s.filter.as_str().into()),
    text("case", "case", |s| s.case.as_str().into()),
    count("runs", "runs asked for", |s| Some(s.runs.into())),
    count(
        "failed",
        "runs that ended with an error; they take no part in the statistics",
        |s| Some(s.failed as u64),
    ),
    count(
        "diverged",
        "runs that lost the target, those included that then failed",
        |s| Some(s.diverged as u64),
    ),
    number(
        "pos_rmse_m",
        "m",
        "root mean square of the norm of the position error",
        |s| s.position.rmse,
    ),
    number(
        "vel_rmse_m_s",
        "m/s",
        "root mean square of the norm of the velocity error",
        |s| s.velocity.rmse,
    ),
    number(
        "acc_rmse_m_s2",
        "m/s2",
        "root mean square of the norm of the acceleration error",
        |s| s.acceleration.rmse,
    ),
    number(
        "ratio_pos",
        "1",
        "sigma claimed over sigma of the errors of position, median over time and axes",
        |s| s.position.ratio,
    ),
    number(
        "ratio_vel",
        "1",
        "sigma claimed over sigma of the errors of velocity, median over time and axes",
        |s| s.velocity.ratio,
    ),
    number(
        "ratio_acc",
        "1",
        "sigma claimed over sigma of the errors of acceleration, median over time and axes",
        |s| s.acceleration.ratio,
    ),
    number(
        "mean_err_sigma",
        "1",
        "mean error of position and velocity over its standard error (sample sigma about the mean over root N), rms over time and axes; about 1 when unbiased; empty below 5 runs",
        |s| s.mean_error_sigma,
    ),
    number("nees", "1", "mean NEES over its dimension; 1 when consistent", |s| {
        s.nees.mean
    }),
    number("nees_median", "1", "median NEES over its dimension", |s| s.nees.median),
    number("nis", "1", "mean NIS over its rows; 1 when consistent", |s| s.nis.mean),
    number(
        "ratio_pos_r",
        "1",
        "ratio_pos of the first axis (radial, or LVLH x) alone",
        |s| s.position.ratio_axes[0],
    ),
    number(
        "ratio_pos_t",
        "1",
        "ratio_pos of the second axis (transverse, or LVLH y) alone",
        |s| s.position.ratio_axes[1],
    ),
    number(
        "ratio_pos_n",
        "1",
        "ratio_pos of the third axis (normal, or LVLH z) alone",
        |s| s.position.ratio_axes[2],
    ),
    number(
        "ratio_vel_r",
        "1",
        "ratio_vel of the first axis (radial, or LVLH x) alone",
        |s| s.velocity.ratio_axes[0],
    ),
    number(
        "ratio_vel_t",
        "1",
        "ratio_vel of the second axis (transverse, or LVLH y) alone",
        |s| s.velocity.ratio_axes[1],
    ),
    number(
        "ratio_vel_n",
        "1",
        "ratio_vel of the third axis (normal, or LVLH z) alone",
        |s| s.velocity.ratio_axes[2],
    ),
    number(
        "ratio_acc_r",
        "1",
        "ratio_acc of the first axis (radial, or LVLH x) alone",
        |s| s.acceleration.ratio_axes[0],
    ),
    number(
        "ratio_acc_t",
        "1",
        "ratio_acc of the second axis (transverse, or LVLH y) alone",
        |s| s.acceleration.ratio_axes[1],
    ),
    number(
        "ratio_acc_n",
        "1",
        "ratio_acc of the third axis (normal, or LVLH z) alone",
        |s| s.acceleration.ratio_axes[2],
    ),
    number(
        "bias_rmse_m_s2",
        "m/s2",
        "root mean square of the norm of the accelerometer bias error",
        |s| s.bias.rmse,
    ),
    number(
        "ratio_bias",
        "1",
        "sigma claimed over sigma of the errors of accelerometer bias, median over time and axes",
        |s| s.bias.ratio,
    ),
    number(
        "coverage_3s_pos",
        "1",
        "share of position errors within 3 sigma as claimed; 0.9973 for a Gaussian",
        |s| s.position.coverage,
    ),
    number(
        "coverage_3s_vel",
        "1",
        "share of velocity errors within 3 sigma as claimed; 0.9973 for a Gaussian",
        |s| s.velocity.coverage,
    ),
    number(
        "coverage_3s_acc",
        "1",
        "share of acceleration errors within 3 sigma as claimed; 0.9973 for a Gaussian",
        |s| s.acceleration.coverage,
    ),
    number(
        "coverage_3s_bias",
        "1",
        "share of accelerometer bias errors within 3 sigma as claimed; 0.9973 for a Gaussian",
        |s| s.bias.coverage,
    ),
    number(
        "nees_low",
        "1",
        "lower 95 % bound of the mean over runs of NEES over its dimension, at one epoch",
        |s| s.nees_bounds.map(|[low, _]| low),
    ),
    number("nees_high", "1", "upper 95 % bound of it", |s| {
        s.nees_bounds.map(|[_, high]| high)
    }),
    number(
        "nees_inside",
        "1",
        "share of epochs whose mean NEES is within those bounds",
        |s| s.nees_inside,
    ),
    count("nees_dimension", "number of states of the NEES", |s| {
        s.nees_dimension.map(|n| n as u64)
    }),
    count(
        "cov_broken",
        "samples whose covariance was not symmetric, positive definite and finite",
        |s| Some(s.covariances_broken),
    ),
    number(
        "pos_rmse_r_m",
        "m",
        "root mean square of the position error, first axis (radial, or LVLH x)",
        |s| s.position.rmse_axes[0],
    ),
    number(
        "pos_rmse_t_m",
        "m",
        "root mean square of the position error, second axis (transverse, or LVLH y)",
        |s| s.position.rmse_axes[1],
    ),
    number(
        "pos_rmse_n_m",
        "m",
        "root mean square of the position error, third axis (normal, or LVLH z)",
        |s| s.position.rmse_axes[2],
    ),
    number(
        "vel_rmse_r_m_s",
        "m/s",
        "root mean square of the velocity error, first axis (radial, or LVLH x)",
        |s| s.velocity.rmse_axes[0],
    ),
    number(
        "vel_rmse_t_m_s",
        "m/s",
        "root mean square of the velocity error, second axis (transverse, or LVLH y)",
        |s| s.velocity.rmse_axes[1],
    ),
    number(
        "vel_rmse_n_m_s",
        "m/s",
        "root mean square of the velocity error, third axis (normal, or LVLH z)",
        |s| s.velocity.rmse_axes[2],
    ),
    number(
        "acc_rmse_r_m_s2",
        "m/s2",
        "root mean square of the acceleration error, first axis (radial, or LVLH x)",
        |s| s.acceleration.rmse_axes[0],
    ),
    number(
        "acc_rmse_t_m_s2",
        "m/s2",
        "root mean square of the acceleration error, second axis (transverse, or LVLH y)",
        |s| s.acceleration.rmse_axes[1],
    ),
    number(
        "acc_rmse_n_m_s2",
        "m/s2",
        "root mean square of the acceleration error, third axis (normal, or LVLH z)",
        |s| s.acceleration.rmse_axes[2],
    ),
    number(
        "pos_rmse_se_m",
        "m",
        "standard error of pos_rmse_m over the runs",
        |s| s.position.rmse_error,
    ),
    number(
        "vel_rmse_se_m_s",
        "m/s",
        "standard error of vel_rmse_m_s over the runs",
        |s| s.velocity.rmse_error,
    ),
    number(
        "acc_rmse_se_m_s2",
        "m/s2",
        "standard error of acc_rmse_m_s2 over the runs",
        |s| s.acceleration.rmse_error,
    ),
    number(
        "acc_rmse_se_r_m_s2",
        "m/s2",
        "standard error of acc_rmse_r_m_s2 over the runs",
        |s| s.acceleration.rmse_error_axes[0],
    ),
    number(
        "acc_rmse_se_t_m_s2",
        "m/s2",
        "standard error of acc_rmse_t_m_s2 over the runs",
        |s| s.acceleration.rmse_error_axes[1],
    ),
    number(
        "acc_rmse_se_n_m_s2",
        "m/s2",
        "standard error of acc_rmse_n_m_s2 over the runs",
        |s| s.acceleration.rmse_error_axes[2],
    ),
    number("nees_se", "1", "standard error of nees over the runs", |s| s.nees.error),
    number("nis_se", "1", "standard error of nis over the runs", |s| s.nis.error),
    number(
        "acc_rmse_of_zero_m_s2",
        "m/s2",
        "root mean square of the true acceleration: the RMSE of an estimate that is always zero",
        |s| s.zero_acceleration,
    ),
    number(
        "acc_rmse_of_zero_r_m_s2",
        "m/s2",
        "acc_rmse_of_zero_m_s2 on the first axis (radial, or LVLH x)",
        |s| s.zero_acceleration_axes[0],
    ),
    number(
        "acc_rmse_of_zero_t_m_s2",
        "m/s2",
        "acc_rmse_of_zero_m_s2 on the second axis (transverse, or LVLH y)",
        |s| s.zero_acceleration_axes[1],
    ),
    number(
        "acc_rmse_of_zero_n_m_s2",
        "m/s2",
        "acc_rmse_of_zero_m_s2 on the third axis (normal, or LVLH z)",
        |s| s.zero_acceleration_axes[2],
    ),
    number(
        "nees6",
        "1",
        "mean NEES of position and velocity alone, over 6; 1 when consistent",
        |s| s.nees6.mean,
    ),
    number("nees6_se", "1", "standard error of nees6 over the runs", |s| {
        s.nees6.error
    }),
    number(
        "mean_err_bound",
        "1",
        "value that mean_err_sigma exceeds in 5 % of studies by chance alone, from 199 random flips of the signs of whole runs at up to 256 epochs; empty below 6 runs",
        |s| s.mean_error_bound,
    ),
    number(
        "mean_err_sigma_about_zero",
        "1",
        "mean_err_sigma with the sample sigma about zero, Eqs. (31) and (32) of Mamich and Zanetti: never above root N",
        |s| s.mean_error_sigma_about_zero,
    ),
    number(
        "pos_rmse_low_m",
        "m",
        "lower end of the 95 % interval of pos_rmse_m, from 1000 draws of the runs; empty below 5 runs",
        |s| s.position.interval.map(|[low, _]| low),
    ),
    number("pos_rmse_high_m", "m", "upper end of it", |s| {
        s.position.interval.map(|[_, high]| high)
    }),
    number(
        "vel_rmse_low_m_s",
        "m/s",
        "lower end of the 95 % interval of vel_rmse_m_s",
        |s| s.velocity.interval.map(|[low, _]| low),
    ),
    number("vel_rmse_high_m_s", "m/s", "upper end of it", |s| {
        s.velocity.interval.map(|[_, high]| high)
    }),
    number(
        "acc_rmse_low_m_s2",
        "m/s2",
        "lower end of the 95 % interval of acc_rmse_m_s2",
        |s| s.acceleration.interval.map(|[low, _]| low),
    ),
    number("acc_rmse_high_m_s2", "m/s2", "upper end of it", |s| {
        s.acceleration.interval.map(|[_, high]| high)
    }),
    number("nees_mean_low", "1", "lower end of the 95 % interval of nees", |s| {
        s.nees_interval.map(|[low, _]| low)
    }),
    number("nees_mean_high", "1", "upper end of it", |s| {
        s.nees_interval.map(|[_, high]| high)
    }),
    count(
        "rank_pos",
        "group by pos_rmse_m, 1 the best: with its best filter are those whose paired difference to it has an interval that holds 0",
        |s| s.ranks[0].map(u64::from),
    ),
    count("rank_vel", "the same by vel_rmse_m_s", |s| s.ranks[1].map(u64::from)),
    text(
        "kind",
        "filter, or bound: told by the truth what no filter knows, and without a rank",
        |s| if s.bound { "bound" } else { "filter" }.into(),
    ),
    count(
        "missing_epochs",
        "samples of the world, over all runs with a result, that the filter did not answer: stale, or passed by",
        |s| Some(s.missing_epochs),
    ),
];

/// The number in a column; `None` where the cell is empty, holds text or does not exist.
pub fn value(row: &Summary, name: &str) -> Option<f64> {
    find(COLUMNS, name).and_then(|c| c.cell(row).as_f64())
}

/// Contents of `summary.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rows: &[Summary]) -> Result<Vec<u8>, HarnessError> {
    column::render(COLUMNS, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns that study scripts rely on, in the words of the interface.
    #[test]
    fn the_promised_columns_come_first_and_none_comes_twice() {
        let promised = "scenario,filter,case,runs,failed,diverged,pos_rmse_m,vel_rmse_m_s,acc_rmse_m_s2,\
            ratio_pos,ratio_vel,ratio_acc,mean_err_sigma,nees,nees_median,nis";
        let mut names: Vec<&str> = COLUMNS.iter().map(|c| c.name).collect();
        assert!(names.join(",").starts_with(promised));
        let text = String::from_utf8(render(&[]).unwrap()).unwrap();
        assert_eq!(text, format!("{}\n", names.join(",")));
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), COLUMNS.len());
    }

    /// A suffix of a name is the unit of its column.
    #[test]
    fn names_end_in_their_units() {
        for column in COLUMNS {
            let suffix = match column.unit {
                "m" => "_m",
                "m/s" => "_m_s",
                "m/s2" => "_m_s2",
                _ => continue,
            };
            assert!(column.name.ends_with(suffix), "{} in {}", column.name, column.unit);
        }
    }
}
