//! Rendezvous in low Earth orbit with a target that vents.

use super::{Scenario, VENTING_FILTERS, VENTING_SIGNALS, milton_claims};

const OVERLAY: &str = "estimated and sample 3 sigma of relative position nearly overlay (Fig. 1)";
const OVER_ESTIMATED: &str = "velocity and acceleration are over-estimated (Figs. 2 and 3)";
const INSIDE: &str = "the runs stay inside the estimated 3 sigma (Figs. 1-3)";
const UNBIASED: &str = "the mean error is zero within its sampling noise (Figs. 1-3)";

pub(crate) const SCENARIO: Scenario = Scenario {
    name: "leo_venting",
    about: "Chaser approaches a target that vents CO2 every 600 s and waste water once; flash LiDAR and accelerometer at 1 Hz",
    reference: "Mamich and Zanetti, Sec. IV, Tables 1-4, Figs. 1-6",
    duration: 5680.0,
    scored_from: 300.0,
    signals: VENTING_SIGNALS,
    filters: VENTING_FILTERS,
    claims: &milton_claims(OVERLAY, OVER_ESTIMATED, INSIDE, UNBIASED),
};
