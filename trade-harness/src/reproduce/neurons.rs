//! Sec. IV.B names a trade-off between accuracy and time for the number of neurons, but does not show it.
//!
//! Where the Gaussians are as wide as the motion, all m neurons answer alike: the output moves by the learning rate times
//! sum Phi_i^2, some 1 / m, for each error, whatever else the neurons are. So the number is swept twice: at the paper's
//! learning rate, where more neurons mean a smaller gain, and with the rate in proportion, where only the number changes.

use super::chapter::{Chapter, NETWORK_PAPER};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use crate::HarnessError;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Number of neurons",
    requests,
    write,
};

const FILTER: &str = "rbfnn_aekf";
/// What is written for each number of neurons.
const COLUMNS: [&str; 9] = [
    "neurons",
    "learning_rate_1_s2",
    "runs",
    "pos_rmse_m",
    "pos_rmse_se_m",
    "acc_rmse_m_s2",
    "acc_rmse_se_m_s2",
    "acc_rmse_of_zero_m_s2",
    "nees",
];

fn requests() -> Vec<Request> {
    Request::all("network_neurons")
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let mut rows = Vec::new();
    for request in &requests() {
        let set = |name| request.value(name).unwrap_or(f64::NAN);
        let (neurons, rate) = (set("rbfnn_aekf.neurons"), set("rbfnn_aekf.learning_rate"));
        notebook.run(laboratory, request)?;
        let number = |column| notebook.number(request, FILTER, column);
        rows.push(
            [Some(neurons), Some(rate)]
                .into_iter()
                .chain(COLUMNS[2..].iter().map(|column| number(column)))
                .collect(),
        );
        let line = |name: &str, unit, value, error| {
            Line::new(
                NETWORK_PAPER,
                "Sec. IV.B, number of neurons",
                &format!("{FILTER} {name}, neurons = {neurons}, learning rate = {rate:.3}"),
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
            notebook.push(line.note("shape as for 60 neurons; the time per step is in timing.csv"));
        }
    }
    notebook.push_file("neurons.csv", &COLUMNS, &rows)
}
