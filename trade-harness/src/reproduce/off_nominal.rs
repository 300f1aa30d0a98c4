//! Sec. IV.D: the same filters with process noise or gain off by a random factor (Table 4).

use super::chapter::{Chapter, NETWORK_PAPER, SHARE};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use super::table::{self, Row, TABLE_3, ratio};
use crate::HarnessError;
use crate::bound::Bound;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Table 4: relative navigation, tuning off by a random factor",
    requests,
    write,
};

const TABLE_4: [Row; 4] = [
    Row {
        filter: "observer",
        position: 0.0149,
        velocity: 5.98e-5,
    },
    Row {
        filter: "rbfnn_aekf",
        position: 0.0064,
        velocity: 4.79e-5,
    },
    Row {
        filter: "rbfnn_ekf",
        position: 0.0090,
        velocity: 9.34e-5,
    },
    Row {
        filter: "ekf_j2",
        position: 0.0110,
        velocity: 9.55e-5,
    },
];

/// Rows held to the table: filter, and whether position and velocity are. The others are held to the direction alone.
const HELD: [(&str, [bool; 2]); 2] = [("rbfnn_aekf", [true, true]), ("observer", [true, false])];

/// The filter that the paper finds robust.
const ADAPTIVE: &str = "rbfnn_aekf";
/// "Very similar": growth of an error that is taken for it at most.
const SIMILAR: f64 = 1.1;
const READING: &str =
    "uniform in 0.1 to 10 spans two orders of magnitude, but its mean is 5: process noise is mostly too large";

fn requests() -> Vec<Request> {
    Request::all("network_table_4")
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let nominal = table::request();
    for request in &requests() {
        notebook.run(laboratory, request)?;
        let mut lines = Vec::new();
        for row in &TABLE_4 {
            let held = HELD.iter().find(|(filter, _)| *filter == row.filter);
            let held = held.map_or([false; 2], |(_, which)| *which);
            let found = table::errors(notebook, request, "Table 4", row.filter);
            let columns = ["pos_rmse_m", "vel_rmse_m_s"];
            let printed = [row.position, row.velocity];
            for (index, line) in found.into_iter().enumerate() {
                let line = line.printed(printed[index]).required(true);
                let before = notebook.number(&nominal, row.filter, columns[index]);
                lines.push(if held[index] {
                    line.bound(Bound::within(SHARE, printed[index]))
                } else {
                    // Without a nominal number there is no direction, and the line fails.
                    line.bound(Bound::between(before.unwrap_or(f64::INFINITY), f64::INFINITY))
                        .note("held to the direction only: worse than under nominal tuning")
                });
            }
            lines.extend(table::consistency(notebook, request, "beside Table 4", row.filter));
        }
        let columns = [("position", "pos_rmse_m"), ("velocity", "vel_rmse_m_s")];
        for (index, (name, column)) in columns.into_iter().enumerate() {
            let printed = |row: &Row| [row.position, row.velocity][index];
            let suffered = |filter| {
                ratio(
                    notebook.number(request, filter, column),
                    notebook.number(&nominal, filter, column),
                )
            };
            for (row, before) in TABLE_4.iter().zip(&TABLE_3) {
                let quantity = format!("{} {name} RMSE, off-nominal over nominal", row.filter);
                let line = Line::new(NETWORK_PAPER, "Tables 3 and 4", &quantity, "1")
                    .printed(printed(row) / printed(before))
                    .value(suffered(row.filter));
                lines.push(line.note(READING));
            }
            let others = TABLE_4.iter().filter(|row| row.filter != ADAPTIVE);
            let least = others.filter_map(|row| suffered(row.filter)).reduce(f64::min);
            let claim = |claim: &str, quantity: &str, value, most| {
                Line::new(
                    NETWORK_PAPER,
                    &format!("Sec. IV.D: {claim}"),
                    &format!("{name}, {quantity}"),
                    "1",
                )
                .value(value)
                .bound(Bound::between(0.0, most))
            };
            lines.push(claim(
                "the error of the AEKF is very similar to the nominal case",
                "off-nominal over nominal RMSE",
                suffered(ADAPTIVE),
                SIMILAR,
            ));
            lines.push(claim(
                "the AEKF suffers less than the others",
                "its off-nominal over nominal RMSE over the least of the others'",
                ratio(suffered(ADAPTIVE), least),
                1.0,
            ));
        }
        lines.into_iter().for_each(|line| notebook.push(line));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_tables_have_the_same_rows() {
        let filters = |table: &[Row]| table.iter().map(|row| row.filter).collect::<Vec<_>>();
        assert_eq!(filters(&TABLE_4), filters(&TABLE_3));
        assert!(HELD.iter().all(|(filter, _)| filters(&TABLE_4).contains(filter)));
    }
}
