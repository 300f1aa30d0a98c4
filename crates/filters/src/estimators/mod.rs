//! What a filter estimates and how its sensors see it: a state with its dynamics and its update, one file each.

mod accelerometer;
mod estimator;
mod kind;
mod lvlh;
mod sights;
mod told;
mod two_vehicles;

pub(crate) use estimator::{Gap, Reported};
pub(crate) use kind::Kind;
