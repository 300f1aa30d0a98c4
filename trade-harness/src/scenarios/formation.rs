//! Leader and follower on one eccentric orbit, seen by a relative metrology.

use nalgebra::Matrix3;

use super::{Residual, Scenario, Signal, Signals};
use crate::signals::TruthSample;

pub(crate) const SCENARIO: Scenario = Scenario {
    name: "formation",
    about: "Two spacecraft 12 m apart on an eccentric orbit; relative position and velocity are measured in full at 1 Hz",
    reference: "Pesce, Silvestrini and Lavagna, Sec. IV, Tables 1-4, Figs. 4-7",
    duration: 21939.0,
    scored_from: 300.0,
    signals: Signals {
        position: Signal {
            truth: "truth.rho_lvlh",
            estimate: "est.rho_lvlh",
        },
        velocity: Signal {
            truth: "truth.rho_dot_lvlh",
            estimate: "est.rho_dot_lvlh",
        },
        acceleration: Signal {
            truth: "truth.d_lvlh",
            estimate: "est.d_lvlh",
        },
        bias: None,
        chaser: None,
        measurement_valid: "metrology.valid",
        residual: [
            Some(Residual {
                names: ["innov.rho[1]", "innov.rho[2]", "innov.rho[3]"],
                units: ["m"; 3],
                variance: "innov.rho_s",
            }),
            Some(Residual {
                names: ["innov.rho_dot[1]", "innov.rho_dot[2]", "innov.rho_dot[3]"],
                units: ["m_s"; 3],
                variance: "innov.rho_dot_s",
            }),
        ],
        nis_rows: 6,
        axes: ["x", "y", "z"],
        report_axes: as_they_are,
    },
    filters: &[
        "snc",
        "fixed_q",
        "rbfnn_aekf",
        "rbfnn_aekf@repaired",
        "rbfnn_ekf",
        "observer",
        "ekf_j2",
    ],
    // What its source prints is compared by `reproduce`, which runs this world in several ways.
    claims: &[],
};

/// The variables are in the target's LVLH axes already.
fn as_they_are(_: &TruthSample) -> Option<Matrix3<f64>> {
    Some(Matrix3::identity())
}
