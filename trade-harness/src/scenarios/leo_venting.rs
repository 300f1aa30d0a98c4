//! Rendezvous in low Earth orbit with a target that vents.

use super::{Bound, Scenario, Signal, Signals, target_rtn};

const RATIO: &str = "estimated and sample 3 sigma of relative position nearly overlay (Fig. 1)";
const OVER: &str = "velocity and acceleration are over-estimated (Figs. 2 and 3)";

pub(super) const SCENARIO: Scenario = Scenario {
    name: "leo_venting",
    about: "Chaser approaches a target that vents CO2 every 600 s and waste water once; flash LiDAR and accelerometer at 1 Hz",
    reference: "Mamich and Zanetti, Sec. IV, Tables 1-4, Figs. 1-6",
    duration: 5680.0,
    scored_from: 300.0,
    signals: Signals {
        position: Signal {
            truth: "truth.r_tc_n",
            estimate: "est.r_tc_n",
        },
        velocity: Signal {
            truth: "truth.v_tc_n",
            estimate: "est.v_tc_n",
        },
        acceleration: Signal {
            truth: "truth.a_t_n",
            estimate: "est.a_t_n",
        },
        bias: Some(Signal {
            truth: "truth.b_c_bc",
            estimate: "est.b_c_bc",
        }),
        chaser: Some(["truth.r_c_n", "truth.v_c_n"]),
        measurement_valid: "lidar.valid",
        residual: [
            ("innov.range", "m"),
            ("innov.azimuth", "rad"),
            ("innov.elevation", "rad"),
        ],
        nis_rows: 3,
        axes: ["r", "t", "n"],
        report_axes: target_rtn,
    },
    bounds: &[
        Bound {
            filter: "milton",
            column: "ratio_pos_r",
            low: 0.95,
            high: 1.2,
            claim: RATIO,
        },
        Bound {
            filter: "milton",
            column: "ratio_pos_t",
            low: 0.95,
            high: 1.2,
            claim: RATIO,
        },
        Bound {
            filter: "milton",
            column: "ratio_pos_n",
            low: 0.95,
            high: 1.2,
            claim: RATIO,
        },
        Bound {
            filter: "milton",
            column: "ratio_vel",
            low: 1.2,
            high: f64::INFINITY,
            claim: OVER,
        },
        Bound {
            filter: "milton",
            column: "ratio_acc",
            low: 1.2,
            high: f64::INFINITY,
            claim: OVER,
        },
        Bound {
            filter: "milton",
            column: "mean_err_sigma",
            low: 0.0,
            high: 1.2,
            claim: "the mean error is zero within its sampling noise (Figs. 1-3)",
        },
        Bound {
            filter: "milton",
            column: "diverged",
            low: 0.0,
            high: 0.0,
            claim: "no run diverges",
        },
        Bound {
            filter: "milton",
            column: "failed",
            low: 0.0,
            high: 0.0,
            claim: "no run fails",
        },
    ],
};
