//! Navigation filters: one extended Kalman filter and, plugged into it, one file per adaptation law.
//!
//! * [`Navigator`] takes sensor samples one by one and holds the estimate; start reading there.
//! * [`dynamics`] moves what is estimated, [`update`] takes measurements in, [`laws`] choose the process noise: three things. A
//!   registered filter names one of each; adding a law is one file and one line.
//! * `estimators` puts a state, its dynamics and its update together for a frame: both vehicles in axes N, 18 states, or the
//!   relative state in the target's LVLH axes, nine.
//! * A law may keep filters of its own beside the estimator's (`laws::bank`); what is reported is then their mixture. Which samples
//!   are passed by is said in `editing`.
//! * What a filter is told of a mission is [`interface::Navigation`]; [`Beliefs`] are what a user sets in its place, and
//!   [`tunable`] says how a law's start values come from the mission's scales.
//!
//! Nothing here knows of the simulated truth, but for the two filters that are bounds and are told by it ([`Untold`]); nothing here
//! knows of FMI.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod beliefs;
mod commands;
mod disturbance;
pub mod dynamics;
mod editing;
mod error;
mod estimators;
mod gravity;
mod innovation;
pub mod jerk;
pub mod laws;
mod layout;
mod navigator;
mod prediction;
mod sample;
mod source;
pub mod state;
pub mod tunable;
mod units;
pub mod update;

pub use beliefs::Beliefs;
pub use commands::Command;
pub use disturbance::Disturbance;
pub use error::FilterError;
pub use gravity::Gravity;
pub use innovation::Innovation;
pub use interface::{Navigation, Status};
pub use layout::{Layout, Measured};
pub use navigator::{Estimate, Navigator, Settings};
pub use prediction::Prediction;
pub use sample::{Reading, Sample, SpecificForce, Untold};
pub use units::Units;
