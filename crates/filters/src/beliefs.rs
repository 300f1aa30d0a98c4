//! What a filter believes of the world, apart from its law: the mission's values but for those that a user sets.

use crate::error::FilterError;
use interface::Bound::{Any, NonNegative, Positive};
use interface::mission::{Frame, Gravity};
use interface::{Bound, Navigation, Sensor};
use serde::{Deserialize, Serialize};

/// Tuning that all laws share, SI. A value of [`Beliefs::OWN`] means "the mission's own".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Beliefs {
    /// Initial standard deviation of one vehicle's position, or of the relative one in the LVLH frame, m.
    pub p0_sigma_position: f64,
    /// Initial standard deviation of one vehicle's velocity, or of the relative one likewise, m/s.
    pub p0_sigma_velocity: f64,
    /// Initial standard deviation of the target's unmodelled acceleration, m/s2.
    pub p0_sigma_acceleration: f64,
    /// Initial standard deviation of the accelerometer bias, m/s2.
    pub p0_sigma_bias: f64,
    /// White acceleration density of the chaser, m2/s3.
    pub chaser_q_c: f64,
    /// Whether the chaser's process noise also enters v_tc with opposite sign.
    pub chaser_q_coupled: bool,
    /// Accelerometer readings at or above this norm drive the propagation, those below observe the bias; m/s2.
    pub accelerometer_gate: f64,
    /// Inverse time constant of the accelerometer bias, 1/s.
    pub accelerometer_beta: f64,
    /// Standard deviation of the bias walk per 1 s, m/s2.
    pub accelerometer_bias_sigma: f64,
    /// Standard deviation of the LiDAR's range, m.
    pub r_sigma_range: f64,
    /// Standard deviation of the LiDAR's azimuth and elevation, rad.
    pub r_sigma_angle: f64,
    /// Standard deviation of an accelerometer sample, m/s2.
    pub r_sigma_accelerometer: f64,
    /// Standard deviation of a relative position in LVLH, m.
    pub r_sigma_position: f64,
    /// Standard deviation of a relative velocity in LVLH, m/s.
    pub r_sigma_velocity: f64,
    /// Semi-major axis of the circular orbit that Clohessy-Wiltshire is written about, m.
    pub reference_orbit_semi_major_axis: f64,
    /// Factor on the process noise that a law has (that it starts from, if it adapts) or on an observer's gain: 1 unless
    /// mistuning is studied.
    pub off_nominal: f64,
    /// Two-body and zonal gravity: gravitational parameter, m3/s2.
    pub gravity_mu: f64,
    /// Two-body and zonal gravity: reference radius, m.
    pub gravity_radius: f64,
    /// Zonal gravity: J2, J3, J4.
    pub gravity_j: [f64; 3],
    /// Three-body gravity: mass ratio.
    pub gravity_mass_ratio: f64,
    /// Mean normalised NIS above which the filter calls itself diverged.
    pub divergence_nis: f64,
    /// Number of samples over which that mean is taken.
    pub divergence_samples: i32,
}

impl Beliefs {
    /// Stands for "the mission's own value".
    pub const OWN: f64 = -1.0;
}

impl Default for Beliefs {
    /// Everything is the mission's own.
    fn default() -> Self {
        Self {
            p0_sigma_position: Self::OWN,
            p0_sigma_velocity: Self::OWN,
            p0_sigma_acceleration: Self::OWN,
            p0_sigma_bias: Self::OWN,
            chaser_q_c: Self::OWN,
            chaser_q_coupled: true,
            accelerometer_gate: Self::OWN,
            accelerometer_beta: Self::OWN,
            accelerometer_bias_sigma: Self::OWN,
            r_sigma_range: Self::OWN,
            r_sigma_angle: Self::OWN,
            r_sigma_accelerometer: Self::OWN,
            r_sigma_position: Self::OWN,
            r_sigma_velocity: Self::OWN,
            reference_orbit_semi_major_axis: Self::OWN,
            off_nominal: 1.0,
            gravity_mu: Self::OWN,
            gravity_radius: Self::OWN,
            gravity_j: [Self::OWN; 3],
            gravity_mass_ratio: Self::OWN,
            divergence_nis: 100.0,
            divergence_samples: 60,
        }
    }
}

/// Whether a value stands for the mission's own.
pub(crate) fn is_own(value: f64) -> bool {
    value.to_bits() == Beliefs::OWN.to_bits()
}

/// Puts a value that is not the mission's own into its place, and holds what then stands there against its bound.
fn put(name: &str, bound: Bound, unit: &'static str, value: f64, place: &mut f64) -> Result<(), FilterError> {
    if !is_own(value) {
        *place = value;
    }
    bound.check(name, *place, unit)?;
    Ok(())
}

impl Beliefs {
    /// What a filter is told of a mission, with every value that is set here in place of the mission's own. What a mission
    /// has not, such as the noise of a sensor that is not on board, is passed by.
    ///
    /// # Errors
    /// When a value is out of range.
    pub(crate) fn over(&self, navigation: &Navigation) -> Result<Navigation, FilterError> {
        let mut told = navigation.clone();
        let p0 = &mut told.p0;
        put(
            "p0.sigma_position",
            Positive,
            "m",
            self.p0_sigma_position,
            &mut p0.position,
        )?;
        put(
            "p0.sigma_velocity",
            Positive,
            "m/s",
            self.p0_sigma_velocity,
            &mut p0.velocity,
        )?;
        let (name, value) = ("p0.sigma_acceleration", self.p0_sigma_acceleration);
        put(name, Positive, "m/s2", value, &mut p0.acceleration)?;
        if told.frame == Frame::Inertial {
            put("p0.sigma_bias", Positive, "m/s2", self.p0_sigma_bias, &mut p0.bias)?;
        }
        put(
            "chaser.q_c",
            NonNegative,
            "m2/s3",
            self.chaser_q_c,
            &mut told.chaser_q_c_m2_s3,
        )?;
        if let Some(s) = &mut told.accelerometer {
            put(
                "accelerometer.gate",
                NonNegative,
                "m/s2",
                self.accelerometer_gate,
                &mut s.gate_m_s2,
            )?;
            let mut beta = 1.0 / s.bias_time_constant_s;
            put(
                "accelerometer.beta",
                NonNegative,
                "1/s",
                self.accelerometer_beta,
                &mut beta,
            )?;
            if !is_own(self.accelerometer_beta) {
                s.bias_time_constant_s = 1.0 / beta;
            }
            let (name, value) = ("accelerometer.bias_sigma", self.accelerometer_bias_sigma);
            put(name, NonNegative, "m/s2", value, &mut s.bias_sigma_m_s2)?;
            put(
                "r.sigma_accelerometer",
                Positive,
                "m/s2",
                self.r_sigma_accelerometer,
                &mut s.sigma_m_s2,
            )?;
        }
        for (name, sensor, place, value) in [
            ("r.sigma_range", Sensor::Lidar, 0, self.r_sigma_range),
            ("r.sigma_angle", Sensor::Lidar, 1, self.r_sigma_angle),
            ("r.sigma_position", Sensor::Metrology, 0, self.r_sigma_position),
            ("r.sigma_velocity", Sensor::Metrology, 1, self.r_sigma_velocity),
        ] {
            if let Some(sigma) = told.sigma_mut(sensor, place) {
                put(name, Positive, sensor.sigmas()[place].quantity.unit(), value, sigma)?;
            }
        }
        let (name, value) = ("reference_orbit.semi_major_axis", self.reference_orbit_semi_major_axis);
        if let Some(a) = &mut told.reference_orbit_a_m {
            put(name, Positive, "m", value, a)?;
        } else if !is_own(value) {
            told.reference_orbit_a_m = Some(Positive.check(name, value, "m")?);
        }
        self.gravity_over(&mut told.gravity)?;
        Ok(told)
    }

    fn gravity_over(&self, gravity: &mut Gravity) -> Result<(), FilterError> {
        let point = |mu: &mut f64, radius: &mut f64| {
            put("gravity.mu", Positive, "m3/s2", self.gravity_mu, mu)?;
            put("gravity.radius", Positive, "m", self.gravity_radius, radius)
        };
        match gravity {
            Gravity::TwoBody(body) => point(&mut body.mu_m3_s2, &mut body.radius_m),
            Gravity::Zonal(body) => {
                point(&mut body.mu_m3_s2, &mut body.radius_m)?;
                body.j.resize(body.j.len().max(self.gravity_j.len()), 0.0);
                for (n, (value, place)) in (2..).zip(self.gravity_j.iter().zip(&mut body.j)) {
                    put(&format!("gravity.j{n}"), Any, "", *value, place)?;
                }
                Ok(())
            }
            Gravity::Cr3bp(problem) => {
                let (name, value) = ("gravity.mass_ratio", self.gravity_mass_ratio);
                put(name, Positive, "", value, &mut problem.mass_ratio)?;
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
