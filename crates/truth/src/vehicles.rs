//! The state of both vehicles.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Positions and velocities of target and chaser, axes N, m and m/s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Vehicles {
    /// Position of the target.
    pub r_t: Vector3<f64>,
    /// Velocity of the target.
    pub v_t: Vector3<f64>,
    /// Position of the chaser.
    pub r_c: Vector3<f64>,
    /// Velocity of the chaser.
    pub v_c: Vector3<f64>,
}

impl Vehicles {
    /// Position of the target relative to the chaser, m.
    pub fn r_tc(&self) -> Vector3<f64> {
        self.r_t - self.r_c
    }

    /// Velocity of the target relative to the chaser, m/s.
    pub fn v_tc(&self) -> Vector3<f64> {
        self.v_t - self.v_c
    }

    /// The same twelve numbers, ordered as the fields, for an integrator.
    pub fn to_vector(self) -> SVector<f64, 12> {
        let mut x = SVector::<f64, 12>::zeros();
        for (i, part) in [self.r_t, self.v_t, self.r_c, self.v_c].iter().enumerate() {
            x.fixed_rows_mut::<3>(3 * i).copy_from(part);
        }
        x
    }

    /// Undoes [`Vehicles::to_vector`].
    pub fn from_vector(x: &SVector<f64, 12>) -> Self {
        let part = |i: usize| x.fixed_rows::<3>(3 * i).into_owned();
        Self {
            r_t: part(0),
            v_t: part(1),
            r_c: part(2),
            v_c: part(3),
        }
    }
}
