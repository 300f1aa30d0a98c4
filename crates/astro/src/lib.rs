//! Constants, gravity and its gradient, reference frames and orbital elements.
//!
//! What flies in this gravity, and when its thrusters fire, is told by `truth`; what a filter believes of it by `filters`.
//! Start reading at [`ZonalGravity`].

pub mod cr3bp;
pub mod earth;
mod elements;
mod error;
pub mod frames;
mod zonal;

pub use cr3bp::Cr3bp;
pub use elements::Elements;
pub use error::AstroError;
pub use zonal::ZonalGravity;
