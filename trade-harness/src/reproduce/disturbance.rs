//! Sec. IV.B: how well the network reconstructs the acceleration that its filter's model leaves out (Table 2).

use super::chapter::{Chapter, NETWORK_PAPER, SHARE};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use super::table::{consistency, ratio};
use crate::HarnessError;
use crate::bound::Bound;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Table 2: disturbance reconstruction",
    requests,
    write,
};

const FILTER: &str = "rbfnn_aekf";

/// A row of the table.
struct Axis {
    name: &'static str,
    /// What the summary calls the axis.
    column: &'static str,
    /// RMSE, m/s2.
    printed: f64,
    required: bool,
}

const TABLE_2: [Axis; 3] = [
    Axis {
        name: "x",
        column: "r",
        printed: 7.2e-7,
        required: true,
    },
    Axis {
        name: "y",
        column: "t",
        printed: 7.6e-7,
        required: true,
    },
    Axis {
        name: "z",
        column: "n",
        printed: 5.9e-7,
        required: false,
    },
];

fn requests() -> Vec<Request> {
    Request::all("network_table_2")
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    for request in &requests() {
        notebook.run(laboratory, request)?;
        let number = |column: String| notebook.number(request, FILTER, &column);
        let mut lines = Vec::new();
        for axis in &TABLE_2 {
            let item = format!("Table 2, sigma_{}", axis.name);
            let line = Line::new(NETWORK_PAPER, &item, &format!("{FILTER} d_{} RMSE", axis.name), "m/s2")
                .printed(axis.printed)
                .value(number(format!("acc_rmse_{}_m_s2", axis.column)))
                .error(number(format!("acc_rmse_se_{}_m_s2", axis.column)));
            lines.push(if axis.required {
                line.bound(Bound::within(SHARE, axis.printed)).required(true)
            } else {
                line
            });
            let zero = format!("d_{} RMSE of the predictor d = 0", axis.name);
            lines.push(
                Line::new(NETWORK_PAPER, &item, &zero, "m/s2")
                    .value(number(format!("acc_rmse_of_zero_{}_m_s2", axis.column)))
                    .note("what an estimate that is always zero scores over the same epochs"),
            );
            let value = ratio(
                number(format!("acc_rmse_{}_m_s2", axis.column)),
                number(format!("acc_rmse_of_zero_{}_m_s2", axis.column)),
            );
            lines.push(
                Line::new(
                    NETWORK_PAPER,
                    &format!("Sec. IV.B: the network reconstructs d_{}", axis.name),
                    &format!("{FILTER} d_{} RMSE over that of d = 0", axis.name),
                    "1",
                )
                .value(value)
                .bound(Bound::between(0.0, 1.0)),
            );
        }
        lines.extend(consistency(notebook, request, "beside Table 2", FILTER));
        lines.into_iter().for_each(|line| notebook.push(line));
    }
    Ok(())
}
