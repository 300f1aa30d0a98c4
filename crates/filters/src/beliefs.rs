//! What a filter believes of the world, apart from its law: the mission's values but for those that a user sets. One list, from
//! which come the values, their check and the FMU's variables.

use crate::error::FilterError;
use interface::Bound::{self, Any, AtLeast, NonNegative, Positive};
use interface::mission::{Frame, Gravity};
use interface::{Navigation, Sensor};
use serde::{Deserialize, Serialize};

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
    /// Values that it accepts. It must exclude [`Beliefs::OWN`] where that is the start; that of a zonal coefficient does, and no
    /// body comes near it.
    pub bound: Bound,
    /// Meaning.
    pub about: &'static str,
    /// Where its value stands.
    pub place: Place,
}

impl Belief {
    /// Whether it starts at [`Beliefs::OWN`], which leaves it to the mission.
    pub fn own(&self) -> bool {
        matches!(self.place, Place::Real(at) if is_own(*at(&mut Beliefs::default())))
    }
}

macro_rules! beliefs {
    ($($field:ident: $kind:ident($type:ty) = $start:expr, $name:literal, $unit:literal, $bound:expr, $about:literal;)+) => {
        /// Tuning that all laws share, SI. A value of [`Beliefs::OWN`] means "the mission's own".
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub struct Beliefs {
            $(#[doc = $about] pub $field: $type,)+
        }

        impl Default for Beliefs {
            /// Everything that the mission states is its own.
            fn default() -> Self {
                Self { $($field: $start,)+ }
            }
        }

        /// Every belief, in the order of the model description.
        pub const BELIEFS: &[Belief] = &[$(Belief {
            name: $name,
            unit: $unit,
            bound: $bound,
            about: $about,
            place: Place::$kind(|b| &mut b.$field),
        },)+];
    };
}

const OWN: f64 = Beliefs::OWN;

beliefs! {
    p0_sigma_position: Real(f64) = OWN, "p0.sigma_position", "m", Positive, "initial standard deviation of one vehicle's position per axis, or of the relative one in the LVLH frame";
    p0_sigma_velocity: Real(f64) = OWN, "p0.sigma_velocity", "m/s", Positive, "initial standard deviation of one vehicle's velocity per axis, or of the relative one in the LVLH frame";
    p0_sigma_acceleration: Real(f64) = OWN, "p0.sigma_acceleration", "m/s2", Positive, "initial standard deviation of the unmodelled acceleration, per axis";
    p0_sigma_bias: Real(f64) = OWN, "p0.sigma_bias", "m/s2", Positive, "initial standard deviation of the accelerometer bias, per axis";
    chaser_q_c: Real(f64) = OWN, "chaser.q_c", "m2/s3", NonNegative, "white acceleration density of the chaser, per axis";
    chaser_q_coupled: Boolean(bool) = true, "chaser.q_coupled", "", Any, "whether the chaser's process noise also enters v_tc, with opposite sign";
    accelerometer_gate: Real(f64) = OWN, "accelerometer.gate", "m/s2", NonNegative, "readings of at least this norm drive the propagation, as does a mean that noise cannot account for; others observe the bias";
    accelerometer_beta: Real(f64) = OWN, "accelerometer.beta", "1/s", NonNegative, "inverse time constant of the accelerometer bias";
    accelerometer_bias_sigma: Real(f64) = OWN, "accelerometer.bias_sigma", "m/s2", NonNegative, "standard deviation of the bias walk per 1 s";
    r_sigma_range: Real(f64) = OWN, "r.sigma_range", "m", Positive, "standard deviation of the range";
    r_sigma_angle: Real(f64) = OWN, "r.sigma_angle", "rad", Positive, "standard deviation of azimuth and elevation";
    r_sigma_accelerometer: Real(f64) = OWN, "r.sigma_accelerometer", "m/s2", Positive, "standard deviation of an accelerometer sample, per axis";
    r_sigma_position: Real(f64) = OWN, "r.sigma_position", "m", Positive, "standard deviation of a relative position in LVLH, per axis";
    r_sigma_velocity: Real(f64) = OWN, "r.sigma_velocity", "m/s", Positive, "standard deviation of a relative velocity in LVLH, per axis";
    reference_orbit_semi_major_axis: Real(f64) = OWN, "reference_orbit.semi_major_axis", "m", Positive, "of the circular orbit that the Clohessy-Wiltshire equations are written about";
    off_nominal: Real(f64) = 1.0, "off_nominal", "1", Positive, "factor on the process noise of the filter (that it starts from, if it adapts) or on its constant gain, for studies of mistuning";
    gravity_mu: Real(f64) = OWN, "gravity.mu", "m3/s2", Positive, "gravitational parameter of the central body";
    gravity_radius: Real(f64) = OWN, "gravity.radius", "m", Positive, "reference radius of the zonal harmonics";
    gravity_j2: Real(f64) = OWN, "gravity.j2", "1", AtLeast(-0.5), "second zonal harmonic";
    gravity_j3: Real(f64) = OWN, "gravity.j3", "1", AtLeast(-0.5), "third zonal harmonic";
    gravity_j4: Real(f64) = OWN, "gravity.j4", "1", AtLeast(-0.5), "fourth zonal harmonic";
    gravity_mass_ratio: Real(f64) = OWN, "gravity.mass_ratio", "1", Positive, "mass ratio of the three-body problem";
    divergence_nis: Real(f64) = 100.0, "divergence.nis", "1", Positive, "the filter calls itself diverged when the running mean of NIS over its rows exceeds this";
    editing_mode: Integer(i32) = -1, "editing.mode", "", AtLeast(-1.0), "whether samples that are most likely outliers are passed by: 1 yes, 0 no, -1 as the filter has it (those that reproduce a paper do not)";
    editing_outlier_share: Real(f64) = 0.01, "editing.outlier_share", "1", Positive, "share of outliers, of ten times the noise, that it reckons with; below one half";
    editing_most_in_a_row: Integer(i32) = 3, "editing.most_in_a_row", "", AtLeast(0.0), "most samples of a sensor that are passed by one after the other; twice as many where those beyond it disagree with those before";
    accelerometer_noise_enters: Integer(i32) = -1, "accelerometer.noise_enters", "", AtLeast(-1.0), "whether the noise of a reading of the instant enters the covariance while it drives the propagation, as that of a mean always does: 1 yes, 0 no, -1 as the filter has it (those that reproduce a paper do not)";
    divergence_samples: Integer(i32) = 60, "divergence.samples", "", AtLeast(1.0), "time constant of that running mean, samples";
}

impl Beliefs {
    /// Stands for "the mission's own value".
    pub const OWN: f64 = -1.0;

    /// A switch of [`Place::Integer`] as it acts.
    ///
    /// * `own`: as the filter has it.
    ///
    /// # Errors
    /// When it is none of -1, 0 and 1.
    pub(crate) fn switched(name: &str, mode: i32, own: bool) -> Result<bool, FilterError> {
        match mode {
            -1 => Ok(own),
            0 | 1 => Ok(mode == 1),
            other => Err(FilterError::OutOfRange {
                name: name.into(),
                value: f64::from(other),
                unit: "",
                permitted: "-1, 0 or 1".into(),
            }),
        }
    }
}

/// Whether a value stands for the mission's own.
pub(crate) fn is_own(value: f64) -> bool {
    value.to_bits() == Beliefs::OWN.to_bits()
}

impl Beliefs {
    /// Puts a real belief that is not the mission's own into its place, and holds what then stands there against its bound.
    fn put(&self, name: &str, place: &mut f64) -> Result<(), FilterError> {
        let Some(belief) = BELIEFS.iter().find(|belief| belief.name == name) else {
            return Ok(());
        };
        if let Place::Real(at) = belief.place {
            let value = *at(&mut self.clone());
            if !is_own(value) {
                *place = value;
            }
        }
        belief.bound.check(name, *place, belief.unit)?;
        Ok(())
    }

    /// What a filter is told of a mission, with every value that is set here in place of the mission's own. What a mission
    /// has not, such as the noise of a sensor that is not on board, is passed by.
    ///
    /// # Errors
    /// When a value is out of range.
    pub(crate) fn over(&self, navigation: &Navigation) -> Result<Navigation, FilterError> {
        let mut told = navigation.clone();
        self.put("p0.sigma_position", &mut told.p0.position)?;
        self.put("p0.sigma_velocity", &mut told.p0.velocity)?;
        self.put("p0.sigma_acceleration", &mut told.p0.acceleration)?;
        if told.frame == Frame::Inertial {
            self.put("p0.sigma_bias", &mut told.p0.bias)?;
        }
        self.put("chaser.q_c", &mut told.chaser_q_c_m2_s3)?;
        if let Some(s) = &mut told.accelerometer {
            self.put("accelerometer.gate", &mut s.gate_m_s2)?;
            let mut beta = 1.0 / s.bias_time_constant_s;
            self.put("accelerometer.beta", &mut beta)?;
            if !is_own(self.accelerometer_beta) {
                s.bias_time_constant_s = 1.0 / beta;
            }
            self.put("accelerometer.bias_sigma", &mut s.bias_sigma_m_s2)?;
            self.put("r.sigma_accelerometer", &mut s.sigma_m_s2)?;
        }
        for (name, sensor, place) in [
            ("r.sigma_range", Sensor::Lidar, 0),
            ("r.sigma_angle", Sensor::Lidar, 1),
            ("r.sigma_position", Sensor::Metrology, 0),
            ("r.sigma_velocity", Sensor::Metrology, 1),
        ] {
            if let Some(sigma) = told.sigma_mut(sensor, place) {
                self.put(name, sigma)?;
            }
        }
        if told.reference_orbit_a_m.is_some() || !is_own(self.reference_orbit_semi_major_axis) {
            let a = told.reference_orbit_a_m.get_or_insert_default();
            self.put("reference_orbit.semi_major_axis", a)?;
        }
        self.gravity_over(&mut told.gravity)?;
        Ok(told)
    }

    fn gravity_over(&self, gravity: &mut Gravity) -> Result<(), FilterError> {
        match gravity {
            Gravity::TwoBody(body) => {
                self.put("gravity.mu", &mut body.mu_m3_s2)?;
                self.put("gravity.radius", &mut body.radius_m)
            }
            Gravity::Zonal(body) => {
                self.put("gravity.mu", &mut body.mu_m3_s2)?;
                self.put("gravity.radius", &mut body.radius_m)?;
                body.j.resize(body.j.len().max(3), 0.0);
                for (name, place) in ["gravity.j2", "gravity.j3", "gravity.j4"].into_iter().zip(&mut body.j) {
                    self.put(name, place)?;
                }
                Ok(())
            }
            Gravity::Cr3bp(problem) => {
                let name = "gravity.mass_ratio";
                self.put(name, &mut problem.mass_ratio)?;
                if problem.mass_ratio < 1.0 {
                    return Ok(());
                }
                Err(FilterError::OutOfRange {
                    name: name.into(),
                    value: problem.mass_ratio,
                    unit: "",
                    permitted: "between 0 and 1".into(),
                })
            }
            Gravity::Harmonics(_) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Place::{Boolean, Integer, Real};

    #[test]
    fn what_is_left_to_the_mission_is_out_of_bounds_and_every_other_start_within() {
        for belief in BELIEFS {
            if let Real(at) = belief.place {
                let start = *at(&mut Beliefs::default());
                assert_eq!(belief.bound.allows(start), !belief.own(), "{}: {start}", belief.name);
            }
        }
    }

    /// Whatever is left to the mission is put over it somewhere, under its own name.
    #[test]
    fn every_belief_of_the_mission_is_heard() {
        let missions: Vec<Navigation> = (interface::mission::EMBEDDED.iter())
            .map(|entry| entry.mission().unwrap().navigation())
            .collect();
        for belief in BELIEFS.iter().filter(|belief| belief.own()) {
            let mut all = Beliefs::default();
            let Real(at) = belief.place else { continue };
            *at(&mut all) = f64::NAN;
            let refused = |told: &Navigation| {
                all.over(told)
                    .is_err_and(|error| error.to_string().contains(belief.name))
            };
            assert!(missions.iter().any(refused), "{}", belief.name);
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
