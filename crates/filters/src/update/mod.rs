//! How a measurement changes an estimate: a kind of update, one file each.

mod constant_gain;
pub mod kalman;

pub use constant_gain::ConstantGain;
