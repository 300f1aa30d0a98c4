//! `[environment]`: gravity, and what else the surroundings do to the vehicles.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What surrounds the vehicles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Gravity of the central body, or of two bodies.
    pub gravity: Gravity,
    /// The central body, where Sun, Moon, the turning field or air matter.
    #[serde(default)]
    pub body: Body,
    /// How body-fixed axes turn, for `harmonics` and drag; absent: as the central body does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// Bodies that pull beside the central one: `sun`, `moon`, `earth`.
    #[serde(default)]
    pub third_bodies: Vec<String>,
    /// Radiation pressure of the Sun; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radiation: Option<Radiation>,
    /// Drag; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<Drag>,
}

/// The central body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// The Earth.
    #[default]
    Earth,
    /// The Moon.
    Moon,
    /// Any other: no ephemeris and no atmosphere but the one stated.
    Other,
}

/// A turning of body-fixed axes about the z axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Rate, deg/s.
    pub rate_deg_s: f64,
    /// Angle from the inertial x axis to the body-fixed one at the start, deg.
    #[serde(default)]
    pub angle_deg: f64,
}

/// A model of gravity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Gravity {
    /// A point mass.
    TwoBody(TwoBody),
    /// A point mass and zonal harmonics from J2 on.
    Zonal(Zonal),
    /// Spherical harmonics to degree and order 20 at most, in turning axes.
    Harmonics(Harmonics),
    /// The circular restricted three-body problem; axes N are the rotating ones.
    Cr3bp(Cr3bp),
}

/// A point mass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoBody {
    /// Gravitational parameter, m3/s2.
    pub mu_m3_s2: f64,
    /// Radius of the body, m.
    pub radius_m: f64,
}

/// A point mass and zonal harmonics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zonal {
    /// Gravitational parameter, m3/s2.
    pub mu_m3_s2: f64,
    /// Reference radius of the coefficients, m.
    pub radius_m: f64,
    /// J2, J3, ... to J6 at most.
    pub j: Vec<f64>,
}

/// Spherical harmonics, by name or from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonics {
    /// Name of a field that comes with the project: `egm96_3x3`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// Coefficient file, from the folder of the mission file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Degree to use; absent: all there are, 20 at most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub degree: Option<u8>,
    /// Order to use; absent: the degree.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u8>,
}

/// The circular restricted three-body problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cr3bp {
    /// Mass of the smaller body over the sum of both.
    pub mass_ratio: f64,
    /// Distance of the two bodies, m.
    pub length_m: f64,
    /// Inverse of their mean motion, s.
    pub time_s: f64,
    /// Angle by which axes N have turned from the inertial ones at the end of the run, rad.
    #[serde(default)]
    pub inertial_angle_at_end_rad: f64,
}

/// Radiation pressure of the Sun.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Shape of the central body's shadow.
    #[serde(default)]
    pub shadow: Shadow,
}

/// Shape of the central body's shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shadow {
    /// A cylinder of the body's radius.
    #[default]
    Cylindrical,
    /// The Sun is never hidden.
    None,
}

/// Drag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Model of the density.
    #[serde(default)]
    pub atmosphere: Atmosphere,
    /// Density at `reference_altitude_m`, kg/m3; with this and the next two, one exponential layer in place of the Earth's table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
    /// Altitude of that density, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_altitude_m: Option<f64>,
    /// Scale height of the layer, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_height_m: Option<f64>,
}

/// Model of the density of air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Atmosphere {
    /// Falls exponentially, the Earth's by a table of layers.
    #[default]
    Exponential,
}

impl Gravity {
    /// Radius of the body that must not be hit, m; `None` in the three-body problem and for a field in a file.
    pub fn radius_m(&self) -> Option<f64> {
        match self {
            Self::TwoBody(TwoBody { radius_m, .. }) | Self::Zonal(Zonal { radius_m, .. }) => Some(*radius_m),
            // The one field that has a name is the Earth's.
            Self::Harmonics(field) => field.field.as_ref().map(|_| 6_378_136.3),
            Self::Cr3bp(_) => None,
        }
    }

    /// Gravitational parameter of the central body, m3/s2, where the file states it.
    pub fn mu_m3_s2(&self) -> Option<f64> {
        match self {
            Self::TwoBody(TwoBody { mu_m3_s2, .. }) | Self::Zonal(Zonal { mu_m3_s2, .. }) => Some(*mu_m3_s2),
            Self::Harmonics(_) | Self::Cr3bp(_) => None,
        }
    }

    /// The three-body problem, where that is the model.
    pub fn cr3bp(&self) -> Option<&Cr3bp> {
        match self {
            Self::Cr3bp(problem) => Some(problem),
            _ => None,
        }
    }
}
