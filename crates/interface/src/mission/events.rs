//! `[[burn]]` and `[[vent]]`: what pushes the vehicles, and when.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::number::number_or;

/// Which vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    /// The one that navigates.
    #[default]
    Chaser,
    /// The one that is approached.
    Target,
}

/// Axes of a direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axes {
    /// Axes N.
    #[default]
    N,
    /// Inertial axes; in the three-body problem held in N over each grid interval, as at its middle.
    Inertial,
    /// Body axes of the vehicle.
    Body,
    /// Radial, transverse, normal of the vehicle's orbit.
    Rtn,
}

/// A manoeuvre of constant acceleration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Burn {
    /// Which vehicle; the chaser's burns are felt by its accelerometer.
    #[serde(default)]
    pub vehicle: Which,
    /// Name, unlike any other burn's.
    pub name: String,
    /// Begin, s.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Size, m/s2.
    pub acceleration_m_s2: f64,
    /// Direction, any length.
    pub direction: [f64; 3],
    /// Axes of the direction.
    #[serde(default)]
    pub axes: Axes,
    /// Whether the filter is told: it then stands in the filter's dynamics.
    #[serde(default)]
    pub told: bool,
    /// Whether it takes part in finding the start from the end; absent: the chaser's do, the target's do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_propagated: Option<bool>,
}

impl Burn {
    /// Whether it takes part in finding the start from the end.
    pub fn is_back_propagated(&self) -> bool {
        self.back_propagated.unwrap_or(self.vehicle == Which::Chaser)
    }
}

/// Accelerations of the target that never stop and that no filter is told of; random streams of their own, axes N, constant over
/// each grid interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Unmodelled {
    /// Steady standard deviation, per axis, of a first-order Gauss-Markov acceleration, m/s2; 0: none.
    pub wander_sigma_m_s2: f64,
    /// Its time constant, s.
    pub wander_time_constant_s: f64,
    /// Square root of the density of a white acceleration, per axis, m/s^1.5; 0: none.
    pub white_m_s1_5: f64,
}

impl Default for Unmodelled {
    fn default() -> Self {
        Self {
            wander_sigma_m_s2: 0.0,
            wander_time_constant_s: 300.0,
            white_m_s1_5: 0.0,
        }
    }
}

/// A kind of vent of the target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vent {
    /// Name, unlike any other vent's; it selects the random streams.
    pub name: String,
    /// Begin of the first.
    pub first_s: First,
    /// How many.
    #[serde(default = "one")]
    pub count: u32,
    /// Time from begin to begin, s; needed when there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period_s: Option<f64>,
    /// Length of each, s.
    pub duration_s: f64,
    /// Size of each.
    pub magnitude_m_s2: Magnitude,
    /// Direction of the acceleration in body axes of the target, any length.
    pub direction_body: [f64; 3],
    /// Spread of the direction, drawn for each vent: rotation by a normal angle of this standard deviation about each of two
    /// axes across it, deg.
    #[serde(default)]
    pub direction_sigma_deg: f64,
    /// How the acceleration goes over the length.
    #[serde(default)]
    pub profile: Profile,
}

fn one() -> u32 {
    1
}

/// Begin of the first vent of a kind: a number, or drawn for each run.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum First {
    /// At this time, s.
    At(f64),
    /// Drawn, or after another kind.
    From(FirstTable),
}

/// The table form of [`First`]; exactly one of `uniform_integer`, `uniform`, `after`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FirstTable {
    /// One of the whole seconds from the first to the second, all equally likely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform_integer: Option<[u32; 2]>,
    /// Between the two, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<[f64; 2]>,
    /// After the first vent of this name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<String>,
    /// By this much, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_s: Option<f64>,
}

impl<'de> Deserialize<'de> for First {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a number of seconds, { uniform_integer = [a, b] }, { uniform = [a, b] } or { after = \"name\", offset_s = x }";
        number_or(deserializer, expected, Self::At, Self::From)
    }
}

/// Size of a vent, m/s2: a number, or drawn for each vent.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Magnitude {
    /// Always this.
    Fixed(f64),
    /// Drawn.
    Drawn(Distribution),
}

/// A distribution of sizes, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Absolute value of a normal draw with this standard deviation.
    HalfNormal(f64),
    /// Mean and standard deviation.
    Normal([f64; 2]),
    /// Mean and standard deviation of the natural logarithm.
    Lognormal([f64; 2]),
    /// Between the two.
    Uniform([f64; 2]),
}

impl<'de> Deserialize<'de> for Magnitude {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a number in m/s2, { half_normal = sigma }, { normal = [mean, sigma] }, { lognormal = [mu, sigma] } or { uniform = [a, b] }";
        number_or(deserializer, expected, Self::Fixed, Self::Drawn)
    }
}

/// How a vent's acceleration goes over its length.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// Its size from begin to end.
    #[default]
    OnOff,
    /// Its size at the begin, falling exponentially with this time constant, s.
    DecayS(f64),
    /// Rising linearly to its size over this time, s, and falling likewise before the end.
    RampS(f64),
}
