//! Sensors of the chaser, one file each: what they measure, its Jacobian, the covariance of its noise.
//!
//! Pure functions: the simulated world and the filters both call them and share nothing else. When a sample is taken, drops
//! out or is an outlier is told by `truth`. Start reading at [`lidar`].

pub mod accelerometer;
pub mod camera;
pub mod lidar;
pub mod metrology;
mod noise;
pub mod radio;
mod view;

pub use noise::normal3;
pub use view::View;
