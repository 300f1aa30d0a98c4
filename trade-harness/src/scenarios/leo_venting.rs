//! Rendezvous in low Earth orbit with a target that vents.

use super::{Bound, Scenario, VENTING_SIGNALS};

const RATIO: &str = "estimated and sample 3 sigma of relative position nearly overlay (Fig. 1)";
const OVER: &str = "velocity and acceleration are over-estimated (Figs. 2 and 3)";

pub(super) const SCENARIO: Scenario = Scenario {
    name: "leo_venting",
    about: "Chaser approaches a target that vents CO2 every 600 s and waste water once; flash LiDAR and accelerometer at 1 Hz",
    reference: "Mamich and Zanetti, Sec. IV, Tables 1-4, Figs. 1-6",
    duration: 5680.0,
    scored_from: 300.0,
    signals: VENTING_SIGNALS,
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
