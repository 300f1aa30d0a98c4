//! What a filter believes of the world, apart from its law: all SI, never read from the truth.

use serde::{Deserialize, Serialize};

/// Tuning that all laws share. A value of [`Beliefs::OWN`] means "the scenario's own".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Beliefs {
    /// Initial standard deviation of one vehicle's position, or of the relative one where that is measured in full, m.
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
    /// Standard deviation of the range, m.
    pub r_sigma_range: f64,
    /// Standard deviation of azimuth and elevation, rad.
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
    /// Zonal gravity: gravitational parameter, m3/s2.
    pub gravity_mu: f64,
    /// Zonal gravity: reference radius, m.
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
    /// Stands for "the scenario's own value".
    pub const OWN: f64 = -1.0;
}

impl Default for Beliefs {
    /// Values of Mamich and Zanetti, Sec. IV; those that differ between scenarios are [`Beliefs::OWN`].
    fn default() -> Self {
        let [j2, j3, j4, ..] = astro::earth::FILTER.j;
        Self {
            p0_sigma_position: Self::OWN,
            p0_sigma_velocity: Self::OWN,
            p0_sigma_acceleration: Self::OWN,
            p0_sigma_bias: Self::OWN,
            chaser_q_c: Self::OWN,
            chaser_q_coupled: true,
            accelerometer_gate: 1e-4,
            accelerometer_beta: 1.0 / 3600.0,
            accelerometer_bias_sigma: 3.433e-8,
            r_sigma_range: 0.08,
            r_sigma_angle: 0.04_f64.to_radians(),
            r_sigma_accelerometer: 3.433e-6,
            r_sigma_position: 1e-2,
            r_sigma_velocity: 1e-4,
            reference_orbit_semi_major_axis: 8.1431e6,
            off_nominal: 1.0,
            gravity_mu: astro::earth::FILTER.mu,
            gravity_radius: astro::earth::FILTER.r_ref,
            gravity_j: [j2, j3, j4],
            gravity_mass_ratio: astro::cr3bp::EARTH_MOON_MASS_RATIO,
            divergence_nis: 100.0,
            divergence_samples: 60,
        }
    }
}
