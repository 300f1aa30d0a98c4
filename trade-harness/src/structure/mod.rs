//! System structures (SSP): the one that [`packed`] writes of our FMUs, and anybody's as a plan of a study ([`told`]).

pub mod packed;
pub mod told;
mod values;
mod wiring;

pub use packed::{SSP, write};
pub use told::{Told, read};
