//! Low Earth orbit with a venting target: two-body gravity with J2 to J4 (Mamich and Zanetti, Sec. IV.A).

use super::{Measures, ScenarioEntry, VENTING_NETWORKS};
use crate::{Gravity, Units};

pub(super) const ENTRY: ScenarioEntry = ScenarioEntry {
    name: "leo_venting",
    about: "rendezvous in low Earth orbit with a crewed target that vents (Mamich and Zanetti, Sec. IV.A)",
    duration: 5680.0,
    measures: Measures::RangeAndBearing,
    units: Units::SI,
    gravity: Gravity::zonal,
    defaults: &[VENTING_NETWORKS, OWN],
};

const OWN: &[(&str, f64)] = &[
    // Eq. (35); its third block is a_t for the target and b_c for the chaser.
    ("p0.sigma_position", 25.0 / 3.0),
    ("p0.sigma_velocity", 0.1),
    ("p0.sigma_acceleration", 1e-9),
    ("p0.sigma_bias", 1e-9),
    ("chaser.q_c", 1e-12),
    // Of the order of a vent: 1.7e-5 m/s2 for 10 s. Chosen by hand among powers of three for a NEES below one.
    ("snc.q", 3e-5),
    ("dmc.sigma", 5e-6),
    ("dmc.time_constant", 10.0),
    ("constrained_q.r_w", 1.0),
    ("milton.psi0", 1e-3),
    ("milton.q_w", 1e-5),
    ("milton.r_w", 1.0),
    ("milton.s0", 1e-6),
];
