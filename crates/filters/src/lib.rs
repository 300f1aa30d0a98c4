//! Navigation filters: one extended Kalman filter and, plugged into it, one file per adaptation law.
//!
//! * [`Navigator`] takes sensor samples one by one and holds the estimate; start reading there.
//! * [`ekf`] updates, for all; it is written once, so a difference in results is a difference in the law.
//! * `plants` holds what is estimated and how it is measured: range and angles with 18 states, or the relative state in full
//!   with nine.
//! * [`laws`] holds the laws and their registry: adding a filter is one file and one line.
//! * [`scenarios`] holds what a filter believes of each world: gravity, initial covariance, defaults of the laws.
//!
//! Nothing here knows of the simulated truth, and nothing here knows of FMI.

mod beliefs;
pub mod ekf;
mod error;
mod gravity;
pub mod jerk;
pub mod laws;
mod navigator;
mod plants;
mod sample;
pub mod scenarios;
pub mod state;
pub mod tunable;
mod units;

pub use beliefs::Beliefs;
pub use error::FilterError;
pub use gravity::Gravity;
pub use interface::Status;
pub use navigator::{Estimate, Innovation, Navigator, Settings};
pub use sample::Sample;
pub use units::Units;
