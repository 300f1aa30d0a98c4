//! `regret.csv`: one row for each mission, level and filter.

use serde::{Deserialize, Serialize};
use study::{Quantity, Ratio, Tally};

use crate::HarnessError;
use crate::report::column::{self, Column, count, number, text};

/// What a filter is in the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// It is held against the best of constant noise.
    Law,
    /// Its noise is constant.
    Fixed,
    /// It is told by the truth what no filter knows.
    Bound,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Law => "law",
            Self::Fixed => "fixed",
            Self::Bound => "bound",
        }
    }
}

/// One filter in one mission at one level.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the mission.
    pub mission: String,
    /// Name of the level.
    pub level: String,
    /// Label of the filter; of a member of a family with its values.
    pub filter: String,
    /// What it is.
    pub kind: Kind,
    /// Runs.
    pub runs: u64,
    /// What they sum up to.
    pub tally: Tally,
    /// The best of constant noise by position and by velocity.
    pub best: [Option<String>; 2],
    /// RMSE of position and of velocity over that of the best; of a bound's family the best member has it alone.
    pub ratios: [Option<Ratio>; 2],
}

/// A label without the values of a member of a family.
pub(super) fn family(label: &str) -> &str {
    label.split_once('(').map_or(label, |(family, _)| family)
}

fn end(row: &Row, quantity: usize, end: usize) -> Option<f64> {
    row.ratios[quantity]?.interval.map(|interval| interval[end])
}

/// Every column, in order.
pub const COLUMNS: &[Column<Row>] = &[
    text("mission", "mission", |r| r.mission.as_str().into()),
    text("level", "level of disturbance", |r| r.level.as_str().into()),
    text("filter", "filter; of a family with its values", |r| {
        r.filter.as_str().into()
    }),
    text(
        "family",
        "filter without its values, the same for all of a family",
        |r| family(&r.filter).into(),
    ),
    text(
        "kind",
        "law, fixed: of constant noise, or bound: told by the truth",
        |r| r.kind.name().into(),
    ),
    count("runs", "runs", |r| Some(r.runs)),
    count("failed", "runs that ended with an error", |r| {
        Some(r.tally.failed.into())
    }),
    count("diverged", "runs that lost the target", |r| {
        Some(r.tally.diverged.into())
    }),
    number(
        "pos_rmse_m",
        "m",
        "root mean square of the norm of the position error",
        |r| r.tally.rmse(Quantity::Position),
    ),
    number("vel_rmse_m_s", "m/s", "the same of velocity", |r| {
        r.tally.rmse(Quantity::Velocity)
    }),
    number("nees6", "1", "mean NEES of position and velocity alone, over 6", |r| {
        r.tally.nees6()
    }),
    text(
        "pos_best",
        "filter of constant noise that had the least position error in hindsight, of those whose nees6 is 1.5 or less and that lost no run",
        |r| r.best[0].as_deref().unwrap_or_default().into(),
    ),
    number(
        "pos_ratio",
        "1",
        "position RMSE over that of pos_best, in the same runs; of a bound's family for its best by position alone",
        |r| Some(r.ratios[0]?.value),
    ),
    number(
        "pos_ratio_low",
        "1",
        "lower end of its 95 % interval, from 1000 draws of the runs; empty below 5 runs",
        |r| end(r, 0, 0),
    ),
    number("pos_ratio_high", "1", "upper end of it", |r| end(r, 0, 1)),
    text("vel_best", "as pos_best, by velocity", |r| {
        r.best[1].as_deref().unwrap_or_default().into()
    }),
    number(
        "vel_ratio",
        "1",
        "velocity RMSE over that of vel_best, in the same runs; of a bound's family for its best by velocity alone",
        |r| Some(r.ratios[1]?.value),
    ),
    number("vel_ratio_low", "1", "lower end of its 95 % interval", |r| end(r, 1, 0)),
    number("vel_ratio_high", "1", "upper end of it", |r| end(r, 1, 1)),
];

/// Contents of `regret.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rows: &[Row]) -> Result<Vec<u8>, HarnessError> {
    column::render(COLUMNS, rows)
}

/// A row by the names of its columns.
pub fn told(row: &Row) -> serde_json::Map<String, serde_json::Value> {
    column::fields(COLUMNS, row)
}

#[cfg(test)]
mod tests {
    use super::family;

    #[test]
    fn members_of_a_family_are_known_by_what_stands_before_their_values() {
        let members = [
            "dmc(sigma=1e-5,time_constant=1e2)",
            "dmc(sigma=1e-6,time_constant=1e3)",
            "dmc",
        ];
        assert_eq!(members.map(family), ["dmc"; 3]);
        assert_eq!(family("milton@consistent"), "milton@consistent");
    }
}
