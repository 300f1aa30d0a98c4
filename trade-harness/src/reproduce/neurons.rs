//! Sec. IV.B names a trade-off between accuracy and time for the number of neurons, but does not show it.
//!
//! Where the Gaussians are as wide as the motion, all m neurons answer alike: the output moves by the learning rate times
//! sum Phi_i^2, some 1 / m, for each error, whatever else the neurons are. So the number is swept twice: at the paper's
//! learning rate, where more neurons mean a smaller gain, and with the rate in proportion, where only the number changes.

use study::NAV;

use super::chapter::{Chapter, NETWORK_PAPER};
use super::line::Line;
use super::notebook::{Laboratory, Notebook};
use super::request::{FORMATION, Request};
use crate::HarnessError;

pub(super) const CHAPTER: Chapter = Chapter {
    title: "Number of neurons",
    requests,
    write,
};

const FILTER: &str = "rbfnn_aekf";
const NEURONS: [u32; 6] = [1, 5, 15, 30, 60, 120];

/// The paper's number, and the learning rate that goes with it, 1/s2.
const PAPER_NEURONS: f64 = 60.0;
const PAPER_LEARNING_RATE: f64 = 0.165;

/// The differences sought are far larger than what fewer runs cost in standard error.
const ONE_RUN_IN: u32 = 5;

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

/// Neurons and learning rate of each study: the paper's rate, then that which keeps the gain.
fn sweep() -> impl Iterator<Item = (u32, f64)> {
    let kept = |neurons: u32| PAPER_LEARNING_RATE * f64::from(neurons) / PAPER_NEURONS;
    let at_paper_rate = NEURONS.map(|neurons| (neurons, PAPER_LEARNING_RATE));
    at_paper_rate
        .into_iter()
        .chain(NEURONS.map(|neurons| (neurons, kept(neurons))))
}

fn requests() -> Vec<Request> {
    let request = |(index, (neurons, rate)): (usize, (u32, f64))| {
        let kind = if index < NEURONS.len() { "" } else { "_same_gain" };
        Request::new(FORMATION, &format!("neurons_{neurons}{kind}"), &[FILTER])
            .with_j2_alone()
            .set(NAV, "rbfnn_aekf.neurons", &neurons.to_string())
            .set(NAV, "rbfnn_aekf.learning_rate", &format!("{rate:?}"))
            // The paper has no limit, and one neuron is beyond ours.
            .set(NAV, "rbfnn_aekf.gain_limit", "1")
            .one_run_in(ONE_RUN_IN)
    };
    sweep().enumerate().map(request).collect()
}

fn write(laboratory: &mut dyn Laboratory, notebook: &mut Notebook) -> Result<(), HarnessError> {
    let mut rows = Vec::new();
    for (request, (neurons, rate)) in requests().iter().zip(sweep()) {
        notebook.run(laboratory, request)?;
        let number = |column| notebook.number(request, FILTER, column);
        rows.push(
            [Some(f64::from(neurons)), Some(rate)]
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
