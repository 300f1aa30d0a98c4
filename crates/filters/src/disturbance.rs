//! An acceleration that a law adds to the dynamics.

use nalgebra::{SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// An acceleration and its partials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Disturbance {
    /// Acceleration, 3.
    pub d: Vector3<f64>,
    /// Partials by relative position and velocity, 3x6.
    pub by_x: SMatrix<f64, 3, 6>,
}

impl Disturbance {
    /// Acts over `dt` on the velocity of a state that begins with relative position and velocity: x gains dt G d and F gains
    /// dt G dd/dx (Pesce, Silvestrini and Lavagna, Eqs. 21, 22 and 26).
    pub fn act<const D: usize>(&self, x: &mut SVector<f64, D>, f: &mut SMatrix<f64, D, D>, dt: f64) {
        let mut velocity = x.fixed_rows_mut::<3>(3);
        velocity += self.d * dt;
        let mut rows = f.fixed_view_mut::<3, 6>(3, 0);
        rows += self.by_x * dt;
    }
}
