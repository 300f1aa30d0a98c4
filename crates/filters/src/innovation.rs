//! What the sensors of the target said against what was predicted.

use crate::state::RowVector;
use serde::{Deserialize, Serialize};

/// The newest innovation, SI, with a place for every row of every sensor ([`interface::Sensor::channels`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Innovation {
    /// Measured minus predicted; zero where nothing was measured.
    pub residual: RowVector,
    /// Their predicted variances; zero likewise, and without a covariance.
    pub variance: RowVector,
    /// Normalised innovation squared of all rows; zero without a covariance.
    pub nis: f64,
    /// Number of rows that were measured.
    pub rows: usize,
}
