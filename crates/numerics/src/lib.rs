//! Small numerical tools without physics: fixed-step Runge-Kutta, the matrix exponential, symmetric positive definite
//! helpers and seeded random streams.
//!
//! What knows about orbits lives in `astro`, about measurements in `sensors`. Start reading at [`rk4::step`].

pub mod expm;
pub mod rk4;
pub mod spd;
pub mod streams;

pub use expm::expm;
pub use streams::{Generator, Source, stream};
