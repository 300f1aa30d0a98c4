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

    /// State half way to another, from the cubic through both.
    ///
    /// * `h`: time between them, s.
    pub(crate) fn half_way(&self, to: &Self, h: f64) -> Self {
        let position = |r: [&Vector3<f64>; 2], v: [&Vector3<f64>; 2]| (r[0] + r[1]) * 0.5 + (v[0] - v[1]) * (h / 8.0);
        let velocity = |r: [&Vector3<f64>; 2], v: [&Vector3<f64>; 2]| (r[1] - r[0]) * (1.5 / h) - (v[0] + v[1]) * 0.25;
        let (target, chaser) = (
            ([&self.r_t, &to.r_t], [&self.v_t, &to.v_t]),
            ([&self.r_c, &to.r_c], [&self.v_c, &to.v_c]),
        );
        Self {
            r_t: position(target.0, target.1),
            v_t: velocity(target.0, target.1),
            r_c: position(chaser.0, chaser.1),
            v_c: velocity(chaser.0, chaser.1),
        }
    }

    /// The same twelve numbers, ordered as the fields, for an integrator.
    #[inline]
    pub fn to_vector(self) -> SVector<f64, 12> {
        let Self { r_t, v_t, r_c, v_c } = self;
        [
            r_t.x, r_t.y, r_t.z, v_t.x, v_t.y, v_t.z, r_c.x, r_c.y, r_c.z, v_c.x, v_c.y, v_c.z,
        ]
        .into()
    }

    /// Undoes [`Vehicles::to_vector`].
    #[inline]
    pub fn from_vector(x: &SVector<f64, 12>) -> Self {
        let part = |i: usize| Vector3::new(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
        Self {
            r_t: part(0),
            v_t: part(1),
            r_c: part(2),
            v_c: part(3),
        }
    }
}
