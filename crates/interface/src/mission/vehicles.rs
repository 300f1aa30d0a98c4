//! `[target]` and `[chaser]`: what the vehicles are and where they fly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A vehicle. One of the two has an `orbit`, the other that or `relative`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Mass, kg; matters to air and light.
    #[serde(default = "hundred")]
    pub mass_kg: f64,
    /// Cross section for air and light, m2.
    #[serde(default = "one")]
    pub area_m2: f64,
    /// Drag coefficient.
    #[serde(default = "usual_cd")]
    pub cd: f64,
    /// Coefficient of radiation pressure.
    #[serde(default = "usual_cr")]
    pub cr: f64,
    /// How it points.
    #[serde(default)]
    pub attitude: Attitude,
    /// Its orbit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<Orbit>,
    /// Its place beside the other vehicle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative: Option<Relative>,
}

fn one() -> f64 {
    1.0
}

fn hundred() -> f64 {
    100.0
}

fn usual_cd() -> f64 {
    2.2
}

fn usual_cr() -> f64 {
    1.3
}

/// How a vehicle points: which axes its body axes are.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Attitude {
    /// Body y to the other vehicle.
    #[default]
    LineOfSight,
    /// Body x, y, z along radial, transverse and normal of its own orbit.
    Rtn,
    /// Body axes along axes N (in the three-body problem along the inertial ones).
    Inertial,
    /// Turns at this constant rate, deg/s, about a body axis, from the inertial attitude at the start.
    SpinDegS([f64; 3]),
}

/// When a state holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum At {
    /// At the begin of the run.
    #[default]
    Start,
    /// At its end; the start is found by going back.
    End,
}

/// An orbit: elements or a state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// When it holds.
    #[serde(default)]
    pub at: At,
    /// Keplerian elements; not in the three-body problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<Elements>,
    /// Position and velocity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<StateVector>,
}

/// Keplerian elements about the central body, axes N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elements {
    /// Semi-major axis, m.
    pub a_m: f64,
    /// Eccentricity, 0 to below 1.
    #[serde(default)]
    pub e: f64,
    /// Inclination, deg.
    #[serde(default)]
    pub i_deg: f64,
    /// Right ascension of the ascending node, deg.
    #[serde(default)]
    pub raan_deg: f64,
    /// Argument of periapsis, deg.
    #[serde(default)]
    pub argp_deg: f64,
    /// Mean anomaly, deg; this or the true one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_anomaly_deg: Option<f64>,
    /// True anomaly, deg; this or the mean one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub true_anomaly_deg: Option<f64>,
}

/// Position and velocity, axes N; in the three-body problem rotating axes, from the barycentre, in SI or nondimensional.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateVector {
    /// Position, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub r_m: Option<[f64; 3]>,
    /// Velocity, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v_m_s: Option<[f64; 3]>,
    /// Position, nondimensional.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub r_nd: Option<[f64; 3]>,
    /// Velocity, nondimensional.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v_nd: Option<[f64; 3]>,
}

/// A place beside the other vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Relative {
    /// When it holds; the same as the other vehicle's orbit.
    #[serde(default)]
    pub at: At,
    /// Axes of both vectors.
    #[serde(default)]
    pub axes: RelativeAxes,
    /// Target minus chaser, m.
    pub r_tc_m: [f64; 3],
    /// Its rate of change in those axes, m/s.
    #[serde(default)]
    pub v_tc_m_s: [f64; 3],
}

/// Axes in which one vehicle stands beside the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RelativeAxes {
    /// Axes N.
    #[default]
    N,
    /// Radial, transverse, normal of the target's orbit (in the three-body problem about the smaller body), held still:
    /// velocities are inertial ones.
    Rtn,
    /// The same axes, turning with that orbit: velocities are seen in them.
    Lvlh,
    /// Inertial axes, in the three-body problem: those from which axes N have turned.
    Inertial,
}
