//! How what is estimated moves between samples: one file each.
//!
//! * [`two_vehicles`]: both vehicles in axes N under gravity, 18 states; [`transition`], how their errors move, by parts.
//! * [`relative`]: what dynamics of the relative state in the target's LVLH frame offer, nine states;
//!   [`clohessy_wiltshire`] and [`j2`] offer it.
//! * `decay`: accelerations that die away faster than a step.

pub mod acceleration;
pub mod clohessy_wiltshire;
pub(crate) mod decay;
pub mod j2;
pub mod relative;
pub mod transition;
pub mod two_vehicles;

pub use acceleration::AccelerationModel;
pub use two_vehicles::{Drive, Thrust, TwoVehicles, initial_covariance};
