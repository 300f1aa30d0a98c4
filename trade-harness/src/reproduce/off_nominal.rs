//! Sec. IV.D: the same filters with process noise or gain off by a random factor (Table 4).

use super::nominal::{self, Row};
use super::{Bound, Chapter, Laboratory, Line, NETWORK_PAPER, Notebook, Request, SHARE};
use crate::HarnessError;
use crate::models::{Distribution, NAV, Variation};
use crate::scenarios::FORMATION;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Table 4: relative navigation, tuning off by a random factor",
    requests,
    write,
};

/// "Uniform, centred in the nominal value, two orders of magnitude", read as one factor for each run.
const FACTOR: Distribution = Distribution::Uniform(0.1, 10.0);

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

fn requests() -> Vec<Request> {
    let filters = TABLE_4.map(|row| row.filter);
    let mut request = Request::new(&FORMATION, "off_nominal", &filters);
    request.variations.push(Variation {
        model: NAV.to_owned(),
        variable: "off_nominal".to_owned(),
        distribution: FACTOR,
    });
    vec![request]
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let nominal = nominal::request();
    for request in &requests() {
        notebook.run(laboratory, request)?;
        let mut lines = Vec::new();
        for row in &TABLE_4 {
            let held = HELD.iter().find(|(filter, _)| *filter == row.filter);
            let held = held.map_or([false; 2], |(_, which)| *which);
            let found = nominal::errors(notebook, request, "Table 4", row.filter);
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
            lines.extend(nominal::consistency(notebook, request, "beside Table 4", row.filter));
        }
        for (row, before) in TABLE_4.iter().zip(&nominal::TABLE_3) {
            let now = notebook.number(request, row.filter, "pos_rmse_m");
            let then = notebook.number(&nominal, row.filter, "pos_rmse_m");
            let quantity = format!("{} position RMSE, off-nominal over nominal", row.filter);
            let item = "Tables 3 and 4: the AEKF hardly suffers, the others do";
            lines.push(
                Line::new(NETWORK_PAPER, item, &quantity, "1")
                    .printed(row.position / before.position)
                    .value(Option::zip(now, then).map(|(now, then)| now / then)),
            );
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
        assert_eq!(filters(&TABLE_4), filters(&nominal::TABLE_3));
        assert!(HELD.iter().all(|(filter, _)| filters(&TABLE_4).contains(filter)));
    }
}
