//! What can go wrong in this crate.

use thiserror::Error;

/// Orbital elements that describe no closed orbit.
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
}
