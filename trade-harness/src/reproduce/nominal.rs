//! Sec. IV.C: the filters against each other under their nominal tuning (Table 3), with those of `beyond` beside them.

use super::{Bound, Chapter, Laboratory, Line, NETWORK_PAPER, Notebook, Request, SHARE, beyond};
use crate::HarnessError;
use crate::scenarios::FORMATION;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Table 3: relative navigation, nominal tuning",
    requests,
    write,
};

/// A row of Table 3 or 4.
pub(super) struct Row {
    pub(super) filter: &'static str,
    /// RMSE of position, m.
    pub(super) position: f64,
    /// RMSE of velocity, m/s.
    pub(super) velocity: f64,
}

pub(super) const TABLE_3: [Row; 4] = [
    Row {
        filter: "observer",
        position: 0.0079,
        velocity: 2.39e-5,
    },
    Row {
        filter: "rbfnn_aekf",
        position: 0.0063,
        velocity: 4.49e-5,
    },
    Row {
        filter: "rbfnn_ekf",
        position: 0.0074,
        velocity: 4.03e-5,
    },
    Row {
        filter: "ekf_j2",
        position: 0.0064,
        velocity: 3.92e-5,
    },
];

pub(super) fn request() -> Request {
    let filters: Vec<_> = TABLE_3
        .iter()
        .map(|row| row.filter)
        .chain(beyond::baselines())
        .collect();
    Request::new(&FORMATION, "nominal", &filters)
}

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
        .value(beyond::ratio(first, second))
        .bound(Bound::between(0.0, 1.0))
}

/// RMSE of position and velocity, with standard errors.
pub(super) fn errors(notebook: &Notebook, request: &Request, table: &str, filter: &str) -> [Line; 2] {
    [
        ("position", "m", "pos_rmse_m", "pos_rmse_se_m"),
        ("velocity", "m/s", "vel_rmse_m_s", "vel_rmse_se_m_s"),
    ]
    .map(|(name, unit, value, error)| {
        Line::new(
            NETWORK_PAPER,
            &format!("{table}, {filter}"),
            &format!("{filter} {name} RMSE"),
            unit,
        )
        .value(notebook.number(request, filter, value))
        .error(notebook.number(request, filter, error))
    })
}

/// NEES and NIS of a filter that has a covariance.
pub(super) fn consistency(notebook: &Notebook, request: &Request, table: &str, filter: &str) -> Vec<Line> {
    let quantities = [
        ("NEES over its dimension", "nees", "nees_se"),
        ("NIS over its rows", "nis", "nis_se"),
    ];
    let line = |(name, value, error)| {
        let value = notebook.number(request, filter, value)?;
        let line = Line::new(
            NETWORK_PAPER,
            &format!("{table}, {filter}"),
            &format!("{filter} {name}"),
            "1",
        );
        Some(
            line.value(Some(value))
                .error(notebook.number(request, filter, error))
                .note("1 when consistent"),
        )
    };
    quantities.into_iter().filter_map(line).collect()
}
