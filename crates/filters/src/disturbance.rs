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
    /// Acts over `dt` on the velocity of a state that begins with relative position and velocity: x gains dt G d (Pesce,
    /// Silvestrini and Lavagna, Eqs. 21 and 22).
    pub fn act<const D: usize>(&self, x: &mut SVector<f64, D>, dt: f64) {
        let mut velocity = x.fixed_rows_mut::<3>(3);
        velocity += self.d * dt;
    }

    /// What the rows of velocity of F gain meanwhile, dt dd/dx, 3x6 (Eq. 26).
    pub fn by_x_over(&self, dt: f64) -> SMatrix<f64, 3, 6> {
        self.by_x * dt
    }
}
