//! Sec. IV.C: the filters against each other under their nominal tuning (Table 3), with those of `beyond` beside them.

use super::chapter::{Chapter, NETWORK_PAPER, SHARE};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use super::table::{TABLE_3, consistency, errors, ratio, request};
use crate::HarnessError;
use crate::bound::Bound;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Table 3: relative navigation, nominal tuning",
    requests,
    write,
};

fn requests() -> Vec<Request> {
    vec![request()]
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let request = request();
    notebook.run(laboratory, &request)?;
    let mut lines = Vec::new();
    for row in &TABLE_3 {
        let [position, velocity] = errors(notebook, &request, "Table 3", row.filter);
        lines.push(held(position, row.position));
        lines.push(held(velocity, row.velocity));
    }
    for row in &TABLE_3 {
        lines.extend(consistency(notebook, &request, "beside Table 3", row.filter));
    }
    let best = |filters: &[&str], column: &str| {
        let of = |filter: &&str| notebook.number(&request, filter, column);
        filters.iter().filter_map(of).reduce(f64::min)
    };
    let worst = |filters: &[&str], column: &str| {
        let of = |filter: &&str| notebook.number(&request, filter, column);
        filters.iter().filter_map(of).reduce(f64::max)
    };
    lines.push(compared(
        "the AEKF and the nonlinear EKF outperform the others in position",
        "pos_rmse_m, larger of rbfnn_aekf and ekf_j2 over smaller of observer and rbfnn_ekf",
        worst(&["rbfnn_aekf", "ekf_j2"], "pos_rmse_m"),
        best(&["observer", "rbfnn_ekf"], "pos_rmse_m"),
    ));
    lines.push(compared(
        "the observer has the better velocity",
        "vel_rmse_m_s, observer over best of the others",
        worst(&["observer"], "vel_rmse_m_s"),
        best(&["rbfnn_aekf", "rbfnn_ekf", "ekf_j2"], "vel_rmse_m_s"),
    ));
    lines.into_iter().for_each(|line| notebook.push(line));
    Ok(())
}

fn held(line: Line, printed: f64) -> Line {
    line.printed(printed)
        .bound(Bound::within(SHARE, printed))
        .required(true)
}

/// A claim that the first number is the smaller one.
fn compared(claim: &str, quantity: &str, first: Option<f64>, second: Option<f64>) -> Line {
    Line::new(NETWORK_PAPER, &format!("Sec. IV.C: {claim}"), quantity, "1")
        .value(ratio(first, second))
        .bound(Bound::between(0.0, 1.0))
}
