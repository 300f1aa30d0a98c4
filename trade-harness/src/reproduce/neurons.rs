//! Sec. IV.B names a trade-off between accuracy and time for the number of neurons, but does not show it.

use super::{Chapter, Laboratory, Line, NETWORK_PAPER, Notebook, Request};
use crate::HarnessError;
use crate::models::NAV;
use crate::scenarios::FORMATION;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Number of neurons",
    requests,
    write,
};

const FILTER: &str = "rbfnn_aekf";
const NEURONS: [u32; 6] = [1, 5, 15, 30, 60, 120];

/// The differences sought are far larger than what fewer runs cost in standard error.
const ONE_RUN_IN: u32 = 5;

const NOTE: &str = "learning rate and shape as for 60 neurons; the time per step is in timing.csv";

/// What is written for each number of neurons.
const COLUMNS: [&str; 8] = [
    "neurons",
    "runs",
    "pos_rmse_m",
    "pos_rmse_se_m",
    "acc_rmse_m_s2",
    "acc_rmse_se_m_s2",
    "acc_rmse_of_zero_m_s2",
    "nees",
];

fn requests() -> Vec<Request> {
    let request = |neurons: u32| {
        let request = Request::new(&FORMATION, &format!("neurons_{neurons}"), &[FILTER]).with_j2_alone();
        Request {
            one_run_in: ONE_RUN_IN,
            ..request.set(NAV, "rbfnn_aekf.neurons", &neurons.to_string())
        }
    };
    NEURONS.map(request).to_vec()
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let mut rows = Vec::new();
    for (request, neurons) in requests().iter().zip(NEURONS) {
        notebook.run(laboratory, request)?;
        let number = |column| notebook.number(request, FILTER, column);
        rows.push(
            std::iter::once(Some(f64::from(neurons)))
                .chain(COLUMNS[1..].iter().map(|column| number(column)))
                .collect(),
        );
        let line = |name: &str, unit, value, error| {
            Line::new(
                NETWORK_PAPER,
                "Sec. IV.B, number of neurons",
                &format!("{FILTER} {name}, neurons = {neurons}"),
                unit,
            )
            .value(number(value))
            .error(number(error))
        };
        let lines = [
            line("acceleration RMSE", "m/s2", "acc_rmse_m_s2", "acc_rmse_se_m_s2"),
            line("position RMSE", "m", "pos_rmse_m", "pos_rmse_se_m"),
        ];
        for line in lines {
            notebook.push(line.note(NOTE));
        }
    }
    notebook.push_file("neurons.csv", &COLUMNS, &rows)
}
