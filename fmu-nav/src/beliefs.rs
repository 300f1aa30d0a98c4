//! What a user may tell every filter of the world: one row for each parameter, whatever its law.

use filters::Beliefs;
use interface::Bound;

/// Where a belief stands; read and written through the same place.
#[derive(Clone, Copy)]
pub enum Place {
    /// A real number.
    Real(fn(&mut Beliefs) -> &mut f64),
    /// A whole number.
    Integer(fn(&mut Beliefs) -> &mut i32),
    /// A switch.
    Boolean(fn(&mut Beliefs) -> &mut bool),
}

/// A parameter that all filters share.
pub struct Belief {
    /// Name of the FMI variable.
    pub name: &'static str,
    /// Unit; empty for none.
    pub unit: &'static str,
    /// Values that it accepts.
    pub bound: Bound,
    /// Whether it starts at -1, which leaves it to the mission; else at its value in `Beliefs::default`.
    pub own: bool,
    /// Meaning.
    pub about: &'static str,
    /// Where its value stands.
    pub place: Place,
}

const fn row(
    name: &'static str,
    unit: &'static str,
    bound: Bound,
    own: bool,
    about: &'static str,
    place: Place,
) -> Belief {
    Belief {
        name,
        unit,
        bound,
        own,
        about,
        place,
    }
}

/// Left to the mission unless set. The bound must exclude -1; that of a zonal coefficient does, and no body comes near it.
const OWN: bool = true;
/// The same in every mission unless set.
const SAME: bool = false;

use Bound::{Any, AtLeast, NonNegative, Positive};
use Place::{Boolean, Integer, Real};

/// Every belief, in the order of the model description.
#[rustfmt::skip]
pub const BELIEFS: &[Belief] = &[
    row("p0.sigma_position", "m", Positive, OWN, "initial standard deviation of one vehicle's position per axis, or of the relative one in the LVLH frame", Real(|b| &mut b.p0_sigma_position)),
    row("p0.sigma_velocity", "m/s", Positive, OWN, "initial standard deviation of one vehicle's velocity per axis, or of the relative one in the LVLH frame", Real(|b| &mut b.p0_sigma_velocity)),
    row("p0.sigma_acceleration", "m/s2", Positive, OWN, "initial standard deviation of the unmodelled acceleration, per axis", Real(|b| &mut b.p0_sigma_acceleration)),
    row("p0.sigma_bias", "m/s2", Positive, OWN, "initial standard deviation of the accelerometer bias, per axis", Real(|b| &mut b.p0_sigma_bias)),
    row("chaser.q_c", "m2/s3", NonNegative, OWN, "white acceleration density of the chaser, per axis", Real(|b| &mut b.chaser_q_c)),
    row("chaser.q_coupled", "", Any, SAME, "whether the chaser's process noise also enters v_tc, with opposite sign", Boolean(|b| &mut b.chaser_q_coupled)),
    row("accelerometer.gate", "m/s2", NonNegative, OWN, "readings of at least this norm drive the propagation, those below observe the bias", Real(|b| &mut b.accelerometer_gate)),
    row("accelerometer.beta", "1/s", NonNegative, OWN, "inverse time constant of the accelerometer bias", Real(|b| &mut b.accelerometer_beta)),
    row("accelerometer.bias_sigma", "m/s2", NonNegative, OWN, "standard deviation of the bias walk per 1 s", Real(|b| &mut b.accelerometer_bias_sigma)),
    row("r.sigma_range", "m", Positive, OWN, "standard deviation of the range", Real(|b| &mut b.r_sigma_range)),
    row("r.sigma_angle", "rad", Positive, OWN, "standard deviation of azimuth and elevation", Real(|b| &mut b.r_sigma_angle)),
    row("r.sigma_accelerometer", "m/s2", Positive, OWN, "standard deviation of an accelerometer sample, per axis", Real(|b| &mut b.r_sigma_accelerometer)),
    row("r.sigma_position", "m", Positive, OWN, "standard deviation of a relative position in LVLH, per axis", Real(|b| &mut b.r_sigma_position)),
    row("r.sigma_velocity", "m/s", Positive, OWN, "standard deviation of a relative velocity in LVLH, per axis", Real(|b| &mut b.r_sigma_velocity)),
    row("reference_orbit.semi_major_axis", "m", Positive, OWN, "of the circular orbit that the Clohessy-Wiltshire equations are written about", Real(|b| &mut b.reference_orbit_semi_major_axis)),
    row("off_nominal", "1", Positive, SAME, "factor on the process noise of the filter (that it starts from, if it adapts) or on its constant gain, for studies of mistuning", Real(|b| &mut b.off_nominal)),
    row("gravity.mu", "m3/s2", Positive, OWN, "gravitational parameter of the central body", Real(|b| &mut b.gravity_mu)),
    row("gravity.radius", "m", Positive, OWN, "reference radius of the zonal harmonics", Real(|b| &mut b.gravity_radius)),
    row("gravity.j2", "1", AtLeast(-0.5), OWN, "second zonal harmonic", Real(|b| &mut b.gravity_j[0])),
    row("gravity.j3", "1", AtLeast(-0.5), OWN, "third zonal harmonic", Real(|b| &mut b.gravity_j[1])),
    row("gravity.j4", "1", AtLeast(-0.5), OWN, "fourth zonal harmonic", Real(|b| &mut b.gravity_j[2])),
    row("gravity.mass_ratio", "1", Positive, OWN, "mass ratio of the three-body problem", Real(|b| &mut b.gravity_mass_ratio)),
    row("divergence.nis", "1", Positive, SAME, "the filter calls itself diverged when the running mean of NIS over its rows exceeds this", Real(|b| &mut b.divergence_nis)),
    row("divergence.samples", "", AtLeast(1.0), SAME, "time constant of that running mean, samples", Integer(|b| &mut b.divergence_samples)),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_left_to_the_mission_where_the_filters_say_so() {
        let mut start = Beliefs::default();
        for belief in BELIEFS {
            match belief.place {
                Real(at) => {
                    let value = *at(&mut start);
                    assert_eq!(value.to_bits() == Beliefs::OWN.to_bits(), belief.own, "{}", belief.name);
                    assert!(belief.own || belief.bound.allows(value), "{}: {value}", belief.name);
                }
                Integer(at) => assert!(belief.bound.allows(f64::from(*at(&mut start))), "{}", belief.name),
                Boolean(_) => (),
            }
        }
    }

    #[test]
    fn every_row_has_a_place_of_its_own() {
        let mut all = Beliefs::default();
        for (number, belief) in (1..).zip(BELIEFS) {
            match belief.place {
                Real(at) => *at(&mut all) = f64::from(number),
                Integer(at) => *at(&mut all) = number,
                Boolean(at) => *at(&mut all) = false,
            }
        }
        for (number, belief) in (1..).zip(BELIEFS) {
            let same = match belief.place {
                Real(at) => at(&mut all).to_bits() == f64::from(number).to_bits(),
                Integer(at) => *at(&mut all) == number,
                Boolean(at) => !*at(&mut all),
            };
            assert!(same, "{}", belief.name);
        }
    }
}
