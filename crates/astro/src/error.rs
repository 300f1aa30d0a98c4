//! What can go wrong in this crate.

use thiserror::Error;

use crate::FieldError;

/// Numbers and names that describe no orbit, no body and no force.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AstroError {
    /// The semi-major axis is not a positive length.
    #[error("semi-major axis {a} m: a closed orbit needs a positive, finite one")]
    SemiMajorAxis {
        /// Value given, m.
        a: f64,
    },
    /// The eccentricity is outside [0, 1).
    #[error("eccentricity {e}: a closed orbit needs 0 <= e < 1")]
    Eccentricity {
        /// Value given.
        e: f64,
    },
    /// An angle is NaN or infinite.
    #[error("{name} is {value} rad: give a finite angle")]
    Angle {
        /// Which of the four angles.
        name: &'static str,
        /// Value given, rad.
        value: f64,
    },
    /// A state that escapes, falls straight down, or is not finite.
    #[error(
        "position {r:?} m and velocity {v:?} m/s: a closed orbit needs finite, non-parallel ones and a speed below that \
         of escape"
    )]
    NoClosedOrbit {
        /// Position given, m.
        r: [f64; 3],
        /// Velocity given, m/s.
        v: [f64; 3],
    },
    /// A constant that is positive by its meaning and is not.
    #[error("{name} is {value} {unit}: give a positive, finite number")]
    NotPositive {
        /// Which constant.
        name: &'static str,
        /// Value given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A constant that is NaN or infinite.
    #[error("{name} is {value} {unit}: give a finite number")]
    NotFinite {
        /// Which constant.
        name: &'static str,
        /// Value given.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// More zonal coefficients than the model has.
    #[error("{given} zonal coefficients: J2 to J{last}, {allowed} at most", last = allowed + 1)]
    Zonals {
        /// How many were given.
        given: usize,
        /// How many there may be.
        allowed: usize,
    },
    /// A layer whose density at the surface is no number.
    #[error(
        "an atmosphere with a scale height of {scale_height} m and its density given at {altitude} m is infinitely dense \
         at the surface: give the density lower down"
    )]
    Layer {
        /// Scale height, m.
        scale_height: f64,
        /// Altitude of the density given, m.
        altitude: f64,
    },
    /// The mass ratio of a three-body problem is out of range.
    #[error("mass ratio {mass_ratio}: mass of the smaller primary over the sum of both, above 0, at most 0.5")]
    MassRatio {
        /// Value given.
        mass_ratio: f64,
    },
    /// A date that cannot be read.
    #[error(
        "date \"{text}\" {reason}: write year, month, day and time of day as in 2020-01-01T00:00:00, universal time"
    )]
    Epoch {
        /// What was given.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A body whose place nobody here knows.
    #[error("no place is known of \"{name}\": one of {known}")]
    UnknownBody {
        /// Name asked for.
        name: String,
        /// Names there are.
        known: String,
    },
    /// A body that cannot stand at the centre.
    #[error("\"{name}\" is no central body whose surroundings are known: one of {known}")]
    UnknownCentre {
        /// Name asked for.
        name: String,
        /// Names there are.
        known: String,
    },
    /// A body that is to disturb the motion about itself.
    #[error("\"{name}\" is the central body and cannot be a third one: one of {others}")]
    ThirdIsCentre {
        /// Name asked for.
        name: &'static str,
        /// Names that can.
        others: String,
    },
    /// The central body has no atmosphere of its own.
    #[error("no atmosphere is known of \"{name}\": give one layer by its density, altitude and scale height")]
    NoAtmosphere {
        /// The central body.
        name: &'static str,
    },
    /// Axes that are asked for where they do not exist.
    #[error("axes {axes}: {reason}")]
    Axes {
        /// Which axes.
        axes: &'static str,
        /// Why there are none.
        reason: &'static str,
    },
    /// A gravity field.
    #[error(transparent)]
    Field(#[from] FieldError),
}

/// `value`, if it is positive and finite.
pub(crate) fn positive(name: &'static str, value: f64, unit: &'static str) -> Result<f64, AstroError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(AstroError::NotPositive { name, value, unit })
    }
}

/// `value`, if it is finite.
pub(crate) fn finite(name: &'static str, value: f64, unit: &'static str) -> Result<f64, AstroError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(AstroError::NotFinite { name, value, unit })
    }
}
