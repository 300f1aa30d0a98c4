//! Sensors of the chaser, one file each: what they measure, its Jacobian, the covariance of its noise.
//!
//! Pure functions: the simulated world and the filters both call them and share nothing else. When a sample is taken, drops
//! out or is an outlier is told by `truth`. Start reading at [`lidar`].

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod accelerometer;
pub mod camera;
pub mod lidar;
pub mod metrology;
mod noise;
mod of_target;
pub mod radio;
mod registry;
mod view;

pub use noise::normal3;
pub use of_target::{ByState, OfTarget, Rows, Scene};
pub use registry::of;
pub use view::View;
