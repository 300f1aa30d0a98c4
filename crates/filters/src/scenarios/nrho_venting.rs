//! Near-rectilinear halo orbit with a venting target: three-body gravity in rotating axes (Mamich and Zanetti, Sec. IV.B).
//!
//! The filter works and adapts in nondimensional units, as the paper does; what it is given and gives is SI.

use super::{Measures, ScenarioEntry, VENTING_NETWORKS};
use crate::{Beliefs, FilterError, Gravity, Units};
use astro::Cr3bp;
use astro::cr3bp::{EARTH_MOON_LENGTH as LENGTH, EARTH_MOON_TIME as TIME};

pub(super) const ENTRY: ScenarioEntry = ScenarioEntry {
    name: "nrho_venting",
    about: "rendezvous on a near-rectilinear halo orbit with a crewed target that vents (Mamich and Zanetti, Sec. IV.B)",
    duration: 5500.0,
    measures: Measures::RangeAndBearing,
    units: Units {
        length: LENGTH,
        time: TIME,
    },
    gravity,
    defaults: &[VENTING_NETWORKS, OWN],
};

const OWN: &[(&str, f64)] = &[
    // Eq. (37), printed nondimensionally.
    ("p0.sigma_position", 2.5e-8 * LENGTH),
    ("p0.sigma_velocity", 2.5e-11 * LENGTH / TIME),
    ("p0.sigma_acceleration", 3.5e-7 * LENGTH / (TIME * TIME)),
    ("p0.sigma_bias", 3.5e-7 * LENGTH / (TIME * TIME)),
    // "There is no process noise applied to the chaser vehicle dynamics."
    ("chaser.q_c", 0.0),
    ("snc.q", 3e-5),
    ("dmc.sigma", 5e-6),
    ("dmc.time_constant", 10.0),
    ("constrained_q.r_w", 1.0),
    ("milton.psi0", 1e-2),
    ("milton.q_w", 1e-7),
    ("milton.r_w", 1e-2),
    // 1e-6 nondimensional.
    ("milton.s0", 4.457_858_762_880_507e-12),
];

fn gravity(beliefs: &Beliefs) -> Result<Gravity, FilterError> {
    let mass_ratio = beliefs.gravity_mass_ratio;
    if mass_ratio > 0.0 && mass_ratio < 1.0 {
        return Ok(Gravity::Cr3bp(Cr3bp { mass_ratio }));
    }
    let (name, permitted) = ("gravity.mass_ratio".into(), "between 0 and 1".into());
    Err(FilterError::OutOfRange {
        name,
        value: mass_ratio,
        unit: "",
        permitted,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_of_s_is_the_printed_one_in_nondimensional_units() {
        let s0 = OWN.iter().find(|(name, _)| *name == "milton.s0").unwrap().1;
        assert!((s0 / ENTRY.units.root_jerk_density() / 1e-6 - 1.0).abs() < 1e-12);
    }
}
