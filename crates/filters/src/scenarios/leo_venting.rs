//! Low Earth orbit with a venting target: two-body gravity with J2 to J4 (Mamich and Zanetti, Sec. IV.A).

use super::{Measures, ScenarioEntry};
use crate::tunable::Bound;
use crate::{Beliefs, FilterError, Gravity, Units};
use astro::ZonalGravity;

pub(super) const ENTRY: ScenarioEntry = ScenarioEntry {
    name: "leo_venting",
    about: "rendezvous in low Earth orbit with a crewed target that vents (Mamich and Zanetti, Sec. IV.A)",
    duration: 5680.0,
    measures: Measures::RangeAndBearing,
    units: Units::SI,
    gravity: zonal_gravity,
    defaults: &[
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
        // The network sees kilometres and metres per second and forgets within a minute: what it learns from the corrections of
        // the first estimate, hundredths of m/s2, must not stay. Q is that of snc.
        ("rbfnn_aekf.learning_rate", 0.165),
        ("rbfnn_aekf.relaxation", 0.98),
        ("rbfnn_aekf.scale_position", 1e3),
        ("rbfnn_aekf.scale_velocity", 1.0),
        ("rbfnn_aekf.q_position", 3e-10),
        ("rbfnn_aekf.q_velocity", 9e-10),
        ("rbfnn_ekf.learning_rate", 0.165),
        ("rbfnn_ekf.relaxation", 0.98),
        ("rbfnn_ekf.scale_position", 1e3),
        ("rbfnn_ekf.scale_velocity", 1.0),
        ("rbfnn_ekf.q_position", 3e-10),
        ("rbfnn_ekf.q_velocity", 9e-10),
    ],
};

/// Two-body attraction and the zonal harmonics of the beliefs.
pub(super) fn zonal_gravity(beliefs: &Beliefs) -> Result<Gravity, FilterError> {
    let [j2, j3, j4] = beliefs.gravity_j;
    Ok(Gravity::Zonal(ZonalGravity {
        mu: Bound::Positive.check("gravity.mu", beliefs.gravity_mu, "m3/s2")?,
        r_ref: Bound::Positive.check("gravity.radius", beliefs.gravity_radius, "m")?,
        j: [j2, j3, j4, 0.0, 0.0],
    }))
}
