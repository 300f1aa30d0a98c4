//! `[sensors]`: what the chaser measures. A mission has any subset of them, each at a period of its own.
//!
//! The sensors that see the target stand in one list here, [`Sensor`]. Whatever handles them all (checks, the FMUs' parameters,
//! sampling, rows of an update, what a study reads) goes through that list; what one of them measures is `sensors::of`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a row of a measurement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A length, m.
    Length,
    /// An angle, rad; in the mission file deg.
    Angle,
    /// A velocity, m/s.
    Velocity,
}

impl Quantity {
    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Angle => "rad",
            Self::Velocity => "m/s",
        }
    }

    /// From the unit of the mission file.
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::Angle => value.to_radians(),
            Self::Length | Self::Velocity => value,
        }
    }

    /// Into the unit of the mission file.
    pub fn from_si(self, value: f64) -> f64 {
        match self {
            Self::Angle => value.to_degrees(),
            Self::Length | Self::Velocity => value,
        }
    }
}

/// A standard deviation of a sensor's noise, which holds for one or more rows of what it measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sigma {
    /// Key in the sensor's table, with its unit.
    pub key: &'static str,
    /// What it is a deviation of.
    pub quantity: Quantity,
    /// Rows that have it, one behind the other.
    pub rows: usize,
    /// Key in `[navigation.sensors]` of what a filter believes of it.
    pub believed: &'static str,
    /// Meaning, as its key in the sensor's table is documented: "Standard deviation of the range, m."
    pub about: &'static str,
}

impl Sigma {
    /// The key without its unit, as FMI variables have it.
    pub fn name(&self) -> &'static str {
        let unit = match self.quantity {
            Quantity::Length => "_m",
            Quantity::Angle => "_deg",
            Quantity::Velocity => "_m_s",
        };
        self.key.strip_suffix(unit).unwrap_or(self.key)
    }

    /// The meaning within a sentence and without its unit: "standard deviation of the range".
    pub fn meaning(&self) -> String {
        let about = self.about.trim().trim_end_matches('.');
        let about = about.rsplit_once(", ").map_or(about, |(about, _)| about);
        let mut letters = about.chars();
        letters
            .next()
            .into_iter()
            .flat_map(char::to_lowercase)
            .chain(letters)
            .collect()
    }
}

/// What can go wrong with a sample of any sensor of the target.
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

/// A sensor of the target as a mission has it on board, whichever it is.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoard {
    /// Which.
    pub sensor: Sensor,
    /// Time between samples, s; `None`: `time.sample_period_s`.
    pub period_s: Option<f64>,
    /// Standard deviations in the order of [`Sensor::sigmas`], in the units of the file.
    pub sigmas: Vec<f64>,
    /// Full width of the square field of view, deg; `None` for a sensor that looks everywhere.
    pub field_of_view_deg: Option<f64>,
    /// What can go wrong with a sample.
    pub faults: Faults,
}

/// The list of the sensors that see the target. From it come the tables of the mission file, [`Sensors`], [`Believed`] and
/// [`Sensor`] with everything that depends on which sensors there are.
macro_rules! sensors_of_the_target {
    ($(
        $(#[doc = $about:literal])*
        $name:ident: $kind:ident, named $word:literal {
            $(
                #[doc = $sigma_about:literal]
                $sigma:ident: $quantity:ident in $rows:literal $(row)? $(rows)? = $default:literal;
                #[doc = $believed_about:literal]
                believed $believed:ident;
            )+
            $($view:ident = $width:literal;)?
        }
    )+) => {
        /// A sensor that sees the target.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Sensor {
            $($(#[doc = $about])* $kind,)+
        }

        impl Sensor {
            /// Every sensor, in the order of their rows.
            pub const ALL: [Self; [$(stringify!($kind)),+].len()] = [$(Self::$kind),+];

            /// Its table in the mission file and the first part of its ports' names.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => stringify!($name),)+
                }
            }

            /// Whether it has a field of view.
            pub const fn looks_ahead(self) -> bool {
                match self {
                    $(Self::$kind => ![$(stringify!($view),)?""][0].is_empty(),)+
                }
            }

            /// What it is called in a sentence.
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$kind => $word,)+
                }
            }

            /// The deviations of its noise, in the order of the rows that they are of.
            pub const fn sigmas(self) -> &'static [Sigma] {
                match self {
                    $(Self::$kind => &[$(Sigma {
                        key: stringify!($sigma),
                        quantity: Quantity::$quantity,
                        rows: $rows,
                        believed: stringify!($believed),
                        about: $sigma_about,
                    }),+],)+
                }
            }
        }

        $(
            $(#[doc = $about])*
            #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
            #[serde(default, deny_unknown_fields)]
            pub struct $kind {
                /// Time between samples, s; absent: `time.sample_period_s`.
                #[serde(skip_serializing_if = "Option::is_none")]
                pub period_s: Option<f64>,
                $(#[doc = $sigma_about] pub $sigma: f64,)+
                $(
                    /// Full width of the square field of view, deg.
                    pub $view: f64,
                )?
                /// Beyond this distance nothing is seen, m.
                pub max_range_m: f64,
                /// Probability that a sample is missing.
                pub dropout_probability: f64,
                /// Probability that a sample is an outlier.
                pub outlier_probability: f64,
                /// Noise of an outlier in multiples of the standard deviation, on all its channels.
                pub outlier_scale: f64,
            }

            impl Default for $kind {
                fn default() -> Self {
                    Self {
                        period_s: None,
                        $($sigma: $default,)+
                        $($view: $width,)?
                        max_range_m: 1e9,
                        dropout_probability: 0.0,
                        outlier_probability: 0.0,
                        outlier_scale: 10.0,
                    }
                }
            }

            impl $kind {
                fn on_board(&self) -> OnBoard {
                    OnBoard {
                        sensor: Sensor::$kind,
                        period_s: self.period_s,
                        sigmas: vec![$(self.$sigma),+],
                        field_of_view_deg: None $(.or(Some(self.$view)))?,
                        faults: Faults {
                            max_range_m: self.max_range_m,
                            dropout_probability: self.dropout_probability,
                            outlier_probability: self.outlier_probability,
                            outlier_scale: self.outlier_scale,
                        },
                    }
                }

                fn place(&mut self, key: &str) -> Option<&mut f64> {
                    match key {
                        $(stringify!($sigma) => Some(&mut self.$sigma),)+
                        $(stringify!($view) => Some(&mut self.$view),)?
                        "max_range_m" => Some(&mut self.max_range_m),
                        "dropout_probability" => Some(&mut self.dropout_probability),
                        "outlier_probability" => Some(&mut self.outlier_probability),
                        "outlier_scale" => Some(&mut self.outlier_scale),
                        _ => None,
                    }
                }
            }
        )+

        /// The sensors of the chaser; an absent one is not on board.
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct Sensors {
            $(
                $(#[doc = $about])*
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $name: Option<$kind>,
            )+
            /// Specific force of the chaser.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub accelerometer: Option<Accelerometer>,
        }

        impl Sensors {
            /// Those on board that see the target, in the order of [`Sensor::ALL`].
            pub fn of_the_target(&self) -> impl Iterator<Item = OnBoard> {
                [$(self.$name.as_ref().map($kind::on_board)),+].into_iter().flatten()
            }

            /// A number of a sensor of the target, by its key: a deviation, `field_of_view_deg`, `max_range_m`,
            /// `dropout_probability`, `outlier_probability` or `outlier_scale`. `None` when the sensor is not on board or has no such key.
            pub fn place(&mut self, sensor: Sensor, key: &str) -> Option<&mut f64> {
                match sensor {
                    $(Sensor::$kind => self.$name.as_mut()?.place(key),)+
                }
            }
        }

        /// Noises that the filter believes in, each absent where it is the sensor's own.
        #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct BelievedSensors {
            $($(
                #[doc = $believed_about]
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $believed: Option<f64>,
            )+)+
            /// Of an accelerometer sample, m/s2.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub accelerometer_sigma_m_s2: Option<f64>,
            /// That the accelerometer's bias walk gains in 1 s, m/s2.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub accelerometer_bias_sigma_m_s2: Option<f64>,
            /// Time constant of the accelerometer's bias, s.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub accelerometer_bias_time_constant_s: Option<f64>,
            /// Readings of at least this norm drive the propagation, as does a mean that noise cannot account for; others observe the bias,
            /// m/s2.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub accelerometer_gate_m_s2: Option<f64>,
        }

        impl BelievedSensors {
            /// What is believed of the deviations of a sensor of the target, in the order of [`Sensor::sigmas`], in the units of
            /// the file.
            pub fn of(&self, sensor: Sensor) -> Vec<Option<f64>> {
                match sensor {
                    $(Sensor::$kind => vec![$(self.$believed),+],)+
                }
            }
        }
    };
}

sensors_of_the_target! {
    /// Flash LiDAR: range, azimuth and elevation of the target.
    lidar: Lidar, named "LiDAR" {
        /// Standard deviation of the range, m.
        sigma_range_m: Length in 1 row = 0.08;
        /// Of the LiDAR's range, m.
        believed lidar_sigma_range_m;
        /// Standard deviation of azimuth and elevation, deg.
        sigma_angle_deg: Angle in 2 rows = 0.04;
        /// Of the LiDAR's angles, deg.
        believed lidar_sigma_angle_deg;
        field_of_view_deg = 5.0;
    }

    /// Camera: azimuth and elevation of the target alone.
    camera: Camera, named "camera" {
        /// Standard deviation of azimuth and elevation, deg.
        sigma_angle_deg: Angle in 2 rows = 0.02;
        /// Of the camera's angles, deg.
        believed camera_sigma_angle_deg;
        field_of_view_deg = 20.0;
    }

    /// Radio link: range and range rate of the target.
    radio: Radio, named "radio" {
        /// Standard deviation of the range, m.
        sigma_range_m: Length in 1 row = 1.0;
        /// Of the radio's range, m.
        believed radio_sigma_range_m;
        /// Standard deviation of the range rate, m/s.
        sigma_range_rate_m_s: Velocity in 1 row = 1e-3;
        /// Of the radio's range rate, m/s.
        believed radio_sigma_range_rate_m_s;
    }

    /// Relative metrology: position and velocity of the chaser relative to the target, in the target's LVLH axes.
    metrology: Metrology, named "metrology" {
        /// Standard deviation of the position per axis, m.
        sigma_position_m: Length in 3 rows = 1e-2;
        /// Of the metrology's position, m.
        believed metrology_sigma_position_m;
        /// Standard deviation of the velocity per axis, m/s.
        sigma_velocity_m_s: Velocity in 3 rows = 1e-4;
        /// Of the metrology's velocity, m/s.
        believed metrology_sigma_velocity_m_s;
    }
}

impl Sensor {
    /// How many sensors there are.
    pub const COUNT: usize = Self::ALL.len();
    /// Most rows that one of them measures.
    pub const MOST_ROWS: usize = {
        let mut most = 0;
        let mut i = 0;
        while i < Self::COUNT {
            let rows = Self::ALL[i].rows();
            most = if rows > most { rows } else { most };
            i += 1;
        }
        most
    };
    /// Rows of all of them together.
    pub const ALL_ROWS: usize = {
        let mut all = 0;
        let mut i = 0;
        while i < Self::COUNT {
            all += Self::ALL[i].rows();
            i += 1;
        }
        all
    };

    /// Number of rows that it measures.
    pub const fn rows(self) -> usize {
        let mut rows = 0;
        let mut i = 0;
        while i < self.sigmas().len() {
            rows += self.sigmas()[i].rows;
            i += 1;
        }
        rows
    }

    /// Its places where every row of every sensor has one.
    pub fn channels(self) -> std::ops::Range<usize> {
        let first = Self::ALL[..self as usize].iter().map(|other| other.rows()).sum();
        first..first + self.rows()
    }

    /// What each of its rows is.
    pub fn quantities(self) -> impl Iterator<Item = Quantity> {
        self.sigmas()
            .iter()
            .flat_map(|sigma| std::iter::repeat_n(sigma.quantity, sigma.rows))
    }

    /// The value of each of its deviations, repeated for each row that has it.
    pub fn by_row<'a>(self, sigmas: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let pairs = self.sigmas().iter().zip(sigmas);
        pairs.flat_map(|(sigma, value)| std::iter::repeat_n(*value, sigma.rows))
    }

    /// Whether it measures more than directions.
    pub fn tells_distance(self) -> bool {
        self.quantities().any(|quantity| quantity != Quantity::Angle)
    }

    /// The table of the mission file that puts it on board.
    pub fn table(self) -> String {
        format!("[sensors.{}]", self.name())
    }
}

impl Sensors {
    /// Whether any sensor sees the target.
    pub fn see_the_target(&self) -> bool {
        self.of_the_target().next().is_some()
    }

    /// Time between the samples of each sensor on board, s: those of the target in their order, then the accelerometer.
    ///
    /// * `period_s`: of every sensor that states none.
    pub fn periods(&self, period_s: f64) -> Vec<f64> {
        let own = self.of_the_target().map(|sensor| sensor.period_s);
        let all = own.chain(self.accelerometer.map(|a| a.period_s));
        all.map(|own| own.unwrap_or(period_s)).collect()
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

fn accelerometer_sigma() -> f64 {
    3.433e-6
}

fn hour() -> f64 {
    3600.0
}
