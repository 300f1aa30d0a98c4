//! Rendezvous on a near-rectilinear halo orbit of the Moon with a target that vents.

use astro::cr3bp::{EARTH_MOON_LENGTH, EARTH_MOON_MASS_RATIO, EARTH_MOON_TIME};
use nalgebra::{Matrix3, Vector3};

use super::{Scenario, Signals, VENTING_FILTERS, VENTING_SIGNALS, milton_claims, rtn, target};
use crate::signals::TruthSample;

const OVERLAY: &str = "estimated and sample 3 sigma of relative position nearly overlay (Fig. 8)";
const OVER_ESTIMATED: &str =
    "velocity and acceleration are over-estimated, though less than in low Earth orbit (Figs. 9 and 10)";
const INSIDE: &str = "the runs stay inside the estimated 3 sigma (Figs. 8-10)";
const UNBIASED: &str = "the mean error is zero within its sampling noise (Figs. 8-10)";

pub(crate) const SCENARIO: Scenario = Scenario {
    name: "nrho_venting",
    about: "Chaser approaches a venting target near the Moon; dynamics and adaptation in rotating nondimensional axes",
    reference: "Mamich and Zanetti, Sec. IV.B, Tables 5-7, Figs. 8-13",
    duration: 5500.0,
    scored_from: 300.0,
    signals: Signals {
        report_axes: rtn_about_the_moon,
        ..VENTING_SIGNALS
    },
    filters: VENTING_FILTERS,
    claims: &milton_claims(OVERLAY, OVER_ESTIMATED, INSIDE, UNBIASED),
};

/// Rows R, T, N of the target's orbit about the Moon, from its position and its inertial velocity relative to the Moon.
///
/// Axes N rotate with Earth and Moon about z, so the inertial velocity is that in N plus the rotation's.
fn rtn_about_the_moon(truth: &TruthSample) -> Option<Matrix3<f64>> {
    let (r, v) = target(truth)?;
    let r = r - Vector3::x() * ((1.0 - EARTH_MOON_MASS_RATIO) * EARTH_MOON_LENGTH);
    rtn(&r, &(v + Vector3::z().cross(&r) / EARTH_MOON_TIME))
}
