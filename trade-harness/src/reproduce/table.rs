//! The study of Table 3, which several chapters look up, and the lines that such tables are made of.

use super::chapter::NETWORK_PAPER;
use super::line::Line;
use super::notebook::Notebook;
use super::request::Request;

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

/// Filters beside those of the paper, and how they come by their Q.
pub(super) const BASELINES: [(&str, &str); 3] = [
    ("snc", "no network, constant Q, set by hand for this world"),
    (
        "fixed_q@slow",
        "no network, the acceleration as a state, s set by hand for this world",
    ),
    (
        "rbfnn_ekf@light",
        "the paper's network with a Q and a learning rate that a search found",
    ),
];

/// The study: the filters of the table, and the plain ones beside them.
pub(super) fn request() -> Request {
    Request::of("network_figures_6_and_7_and_table_3")
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

/// The first over the second.
pub(super) fn ratio(first: Option<f64>, second: Option<f64>) -> Option<f64> {
    Option::zip(first, second).map(|(a, b)| a / b)
}
