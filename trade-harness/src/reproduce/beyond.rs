//! What Table 3 leaves out: plain filters beside the network, the same filters with less noise, and lighter spacecraft.

use study::{NAV, TRUTH};

use super::chapter::{Chapter, NETWORK_PAPER};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::{FORMATION, Request};
use super::table::{self, BASELINES, consistency, errors, ratio};
use crate::HarnessError;
use crate::bound::Bound;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Beyond Table 3: plain filters, other tuning, lighter spacecraft",
    requests,
    write,
};

/// Position and velocity: column of the summary, and what lines call it.
const QUANTITIES: [(&str, &str); 2] = [("pos_rmse_m", "position RMSE"), ("vel_rmse_m_s", "velocity RMSE")];

/// Tuning of the filters that the paper says to have tuned for the best steady state, with far less noise or gain.
const LESS: [(&str, &str); 3] = [
    ("ekf_j2.q_position", "7.6e-8"),
    ("ekf_j2.q_velocity", "1.05e-12"),
    ("observer.k_position", "0.01"),
];

/// Mass of both spacecraft, kg, at which drag and radiation pressure matter more; the paper prints none.
const LIGHT: &str = "10";

fn requests() -> Vec<Request> {
    vec![less_noise(), light()]
}

fn less_noise() -> Request {
    let request = Request::new(FORMATION, "less_noise", &["observer", "ekf_j2"]);
    let request = LESS
        .iter()
        .fold(request, |request, (variable, value)| request.set(NAV, variable, value));
    request.one_run_in(5)
}

fn light() -> Request {
    let filters = ["snc", "rbfnn_aekf", "rbfnn_aekf@repaired", "rbfnn_ekf@light"];
    let request = Request::new(FORMATION, "ten_kilograms", &filters);
    request
        .set(TRUTH, "target.mass", LIGHT)
        .set(TRUTH, "chaser.mass", LIGHT)
        .one_run_in(5)
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let table = table::request();
    let mut lines = Vec::new();
    for (filter, how) in BASELINES {
        let found = errors(notebook, &table, "beside Table 3", filter);
        lines.extend(found.map(|line| line.note(how)));
        lines.extend(consistency(notebook, &table, "beside Table 3", filter));
    }
    for filter in ["rbfnn_aekf", "rbfnn_ekf@light"] {
        for (column, name) in QUANTITIES {
            let of = |filter| notebook.number(&table, filter, column);
            lines.push(
                Line::new(
                    NETWORK_PAPER,
                    "beside Table 3: what the network is worth",
                    &format!("{name}, {filter} over snc"),
                    "1",
                )
                .value(ratio(of(filter), of("snc")))
                .note("the paper's Q is fitted to its table, snc's is set for this world: most of a gap is Q, not the network"),
            );
        }
    }

    let less = less_noise();
    notebook.run(laboratory, &less)?;
    for filter in ["ekf_j2", "observer"] {
        for (column, name) in QUANTITIES {
            let (printed, with_less) = (
                notebook.number(&table, filter, column),
                notebook.number(&less, filter, column),
            );
            // The observer's gain on velocity is the same in both.
            if filter == "observer" && column == "vel_rmse_m_s" {
                continue;
            }
            lines.push(
                Line::new(
                    NETWORK_PAPER,
                    "Sec. IV.C: Q and K_h give the best steady state",
                    &format!("{filter} {name}, as in Table 3 over with less noise or gain"),
                    "1",
                )
                .value(ratio(printed, with_less))
                .bound(Bound::between(0.0, 1.0))
                .note(
                    "a hundredth of Q (ekf_j2), a gain on position of 0.01 per second (observer); above 1: less is better",
                ),
            );
        }
    }

    let light = light();
    notebook.run(laboratory, &light)?;
    for filter in light.filters() {
        let item = "beside Table 3, both masses 10 kg";
        lines.extend(errors(notebook, &light, item, filter).map(|line| line.note("the paper prints no mass")));
        let acceleration = notebook.number(&light, filter, "acc_rmse_m_s2");
        if acceleration.is_some() {
            lines.push(
                Line::new(NETWORK_PAPER, item, &format!("{filter} acceleration RMSE"), "m/s2")
                    .value(acceleration)
                    .error(notebook.number(&light, filter, "acc_rmse_se_m_s2")),
            );
        }
    }
    lines.into_iter().for_each(|line| notebook.push(line));
    Ok(())
}
