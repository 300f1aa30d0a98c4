//! What Table 3 leaves out: plain filters beside the network, the same filters with less noise, and lighter spacecraft.

use super::chapter::{Chapter, NETWORK_PAPER};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
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

fn requests() -> Vec<Request> {
    vec![less_noise(), light()]
}

fn less_noise() -> Request {
    Request::of("beyond_less_noise")
}

fn light() -> Request {
    Request::of("beyond_ten_kilograms")
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
