//! Where each quantity stands in the state and the matrix types built on it (Mamich and Zanetti, Eq. 1).
//!
//! The 18 states are r_tc, v_tc, a_t, r_c, v_c (axes N) and b_c (chaser body axes). The first nine, the target's, are what
//! a law adapts; r_c and v_c are consider states.

use nalgebra::{SMatrix, SVector};
use std::ops::Range;

/// Number of states.
pub const N: usize = 18;
/// Number of states that a law adapts: r_tc, v_tc, a_t.
pub const N_TARGET: usize = 9;

/// Slots of the state.
pub mod idx {
    use super::Range;
    /// Target relative to chaser, position.
    pub const R_TC: Range<usize> = 0..3;
    /// Target relative to chaser, velocity.
    pub const V_TC: Range<usize> = 3..6;
    /// Unmodelled acceleration of the target.
    pub const A_T: Range<usize> = 6..9;
    /// Chaser position.
    pub const R_C: Range<usize> = 9..12;
    /// Chaser velocity.
    pub const V_C: Range<usize> = 12..15;
    /// Accelerometer bias.
    pub const B_C: Range<usize> = 15..18;
    /// The consider states r_c and v_c.
    pub const CONSIDER: Range<usize> = 9..15;
}

/// The whole state.
pub type State = SVector<f64, N>;
/// Covariance or transition matrix of the whole state.
pub type StateMatrix = SMatrix<f64, N, N>;
/// The target's nine states.
pub type Target = SVector<f64, N_TARGET>;
/// Covariance, transition or process-noise matrix of the target's nine states.
pub type TargetMatrix = SMatrix<f64, N_TARGET, N_TARGET>;
/// Most rows that the sensors of the target have together.
pub const MAX_ROWS: usize = interface::Sensor::ALL_ROWS;
/// Rows of the sensors of the target over the target's nine states, in the places of [`crate::Layout`].
pub type Rows = SMatrix<f64, MAX_ROWS, N_TARGET>;
/// One value for each row.
pub type RowVector = SVector<f64, MAX_ROWS>;
/// Covariance of the rows.
pub type RowMatrix = SMatrix<f64, MAX_ROWS, MAX_ROWS>;
