//! Small numerical tools without physics: fixed-step Runge-Kutta, the matrix exponential, Chebyshev polynomials, symmetric
//! positive definite helpers and seeded random streams.
//!
//! Elementary functions come from [`math`], never from `f64`, so that every platform has the same bits.
//!
//! What knows about orbits lives in `astro`, about measurements in `sensors`. Start reading at [`rk4::step`].

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod chebyshev;
pub mod expm;
pub mod lanes;
pub mod rk4;
pub mod rotation;
pub mod spd;
pub mod streams;

pub use chebyshev::Chebyshev;
pub use elementary as math;
pub use expm::expm;
pub use streams::{Generator, Source, stream};
