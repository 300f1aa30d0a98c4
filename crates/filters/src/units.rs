//! The units a filter works in.

use serde::{Deserialize, Serialize};

/// Length and time of one internal unit. SI worlds use 1 m and 1 s; the three-body world its characteristic ones.
///
/// This is the only crossing between SI, in which everything enters and leaves a filter, and internal units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Units {
    /// One internal length, m.
    pub length: f64,
    /// One internal time, s.
    pub time: f64,
}

impl Units {
    /// Metres and seconds.
    pub const SI: Self = Self { length: 1.0, time: 1.0 };

    /// Those of a mission.
    pub fn of(told: &interface::mission::Units) -> Self {
        Self {
            length: told.length_m,
            time: told.time_s,
        }
    }

    /// One internal velocity, m/s.
    pub fn velocity(&self) -> f64 {
        self.length / self.time
    }

    /// One internal acceleration, m/s2.
    pub fn acceleration(&self) -> f64 {
        self.length / (self.time * self.time)
    }

    /// One internal square root of an acceleration density, m/s^1.5.
    pub fn root_acceleration_density(&self) -> f64 {
        self.velocity() / self.time.sqrt()
    }

    /// One internal square root of a jerk density, m/s^2.5.
    pub fn root_jerk_density(&self) -> f64 {
        self.length / (self.time * self.time * self.time.sqrt())
    }

    /// SI size of one internal unit of each of the 18 states, in the order of [`crate::state::idx`].
    pub fn of_state(&self, slot: usize) -> f64 {
        match slot / 3 {
            0 | 3 => self.length,
            1 | 4 => self.velocity(),
            _ => self.acceleration(),
        }
    }
}
