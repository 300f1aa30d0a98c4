//! `[sensors]`: what the chaser measures. A mission has any subset of them, each at a period of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The sensors of the chaser; an absent one is not on board.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensors {
    /// Range, azimuth and elevation of the target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lidar: Option<Lidar>,
    /// Azimuth and elevation of the target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// Range and range rate of the target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radio: Option<Radio>,
    /// Position and velocity of the chaser relative to the target, in the target's LVLH axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metrology: Option<Metrology>,
    /// Specific force of the chaser.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accelerometer: Option<Accelerometer>,
}

impl Sensors {
    /// Whether any sensor sees the target.
    pub fn see_the_target(&self) -> bool {
        self.lidar.is_some() || self.camera.is_some() || self.radio.is_some() || self.metrology.is_some()
    }
}

/// Faults that every sensor of the target has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faults {
    /// Beyond this distance nothing is seen, m.
    pub max_range_m: f64,
    /// Probability that a sample is missing.
    pub dropout_probability: f64,
    /// Probability that a sample is an outlier.
    pub outlier_probability: f64,
    /// Noise of an outlier in multiples of the standard deviation.
    pub outlier_scale: f64,
}

macro_rules! sensor {
    ($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident: $type:ty),* $(,)? }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// Time between samples, s; absent: `time.sample_period_s`.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub period_s: Option<f64>,
            $($(#[$field_meta])* pub $field: $type,)*
            /// Beyond this distance nothing is seen, m.
            #[serde(default = "far")]
            pub max_range_m: f64,
            /// Probability that a sample is missing.
            #[serde(default)]
            pub dropout_probability: f64,
            /// Probability that a sample is an outlier.
            #[serde(default)]
            pub outlier_probability: f64,
            /// Noise of an outlier in multiples of the standard deviation, on all its channels.
            #[serde(default = "ten")]
            pub outlier_scale: f64,
        }

        impl $name {
            /// What can go wrong with a sample.
            pub fn faults(&self) -> Faults {
                Faults {
                    max_range_m: self.max_range_m,
                    dropout_probability: self.dropout_probability,
                    outlier_probability: self.outlier_probability,
                    outlier_scale: self.outlier_scale,
                }
            }
        }
    };
}

sensor! {
    /// Flash LiDAR: range, azimuth and elevation.
    Lidar {
        /// Standard deviation of the range, m.
        #[serde(default = "lidar_range")]
        sigma_range_m: f64,
        /// Standard deviation of azimuth and elevation, deg.
        #[serde(default = "lidar_angle")]
        sigma_angle_deg: f64,
        /// Full width of the square field of view, deg.
        #[serde(default = "lidar_view")]
        field_of_view_deg: f64,
    }
}

sensor! {
    /// Camera: azimuth and elevation alone.
    Camera {
        /// Standard deviation of azimuth and elevation, deg.
        #[serde(default = "camera_angle")]
        sigma_angle_deg: f64,
        /// Full width of the square field of view, deg.
        #[serde(default = "camera_view")]
        field_of_view_deg: f64,
    }
}

sensor! {
    /// Radio link: range and range rate.
    Radio {
        /// Standard deviation of the range, m.
        #[serde(default = "radio_range")]
        sigma_range_m: f64,
        /// Standard deviation of the range rate, m/s.
        #[serde(default = "radio_rate")]
        sigma_range_rate_m_s: f64,
    }
}

sensor! {
    /// Relative metrology: the whole relative state.
    Metrology {
        /// Standard deviation of the position per axis, m.
        #[serde(default = "metrology_position")]
        sigma_position_m: f64,
        /// Standard deviation of the velocity per axis, m/s.
        #[serde(default = "metrology_velocity")]
        sigma_velocity_m_s: f64,
    }
}

/// Accelerometer: the specific force, with a bias that wanders.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accelerometer {
    /// Time between samples, s; absent: `time.sample_period_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_s: Option<f64>,
    /// What a reading is.
    #[serde(default)]
    pub output: AccelerometerOutput,
    /// Standard deviation of the noise per sample and axis, m/s2.
    #[serde(default = "accelerometer_sigma")]
    pub sigma_m_s2: f64,
    /// Bias at the start on each body axis, m/s2.
    #[serde(default)]
    pub bias0_m_s2: [f64; 3],
    /// Standard deviation that the bias walk gains in 1 s, m/s2.
    #[serde(default)]
    pub bias_sigma_m_s2: f64,
    /// Time constant with which the bias decays, s.
    #[serde(default = "hour")]
    pub bias_time_constant_s: f64,
}

/// What an accelerometer reading is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AccelerometerOutput {
    /// The specific force just after the epoch, as the papers have it; right only where it is constant until the next sample.
    #[default]
    Instantaneous,
    /// The mean specific force since the last sample, in body axes as they are at this one: as a strapdown unit does, which turns
    /// what it felt earlier along with its axes.
    Mean,
}

fn far() -> f64 {
    1e9
}

fn ten() -> f64 {
    10.0
}

fn lidar_range() -> f64 {
    0.08
}

fn lidar_angle() -> f64 {
    0.04
}

fn lidar_view() -> f64 {
    5.0
}

fn camera_angle() -> f64 {
    0.02
}

fn camera_view() -> f64 {
    20.0
}

fn radio_range() -> f64 {
    1.0
}

fn radio_rate() -> f64 {
    1e-3
}

fn metrology_position() -> f64 {
    1e-2
}

fn metrology_velocity() -> f64 {
    1e-4
}

fn accelerometer_sigma() -> f64 {
    3.433e-6
}

fn hour() -> f64 {
    3600.0
}
