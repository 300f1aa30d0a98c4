//! Constants, gravity and its gradient, the smaller forces on a satellite of any body, reference frames, attitude, orbital
//! elements and relative motion.
//!
//! What flies in this gravity, and when its thrusters fire, is told by `truth`; what a filter believes of it by `filters`.
//! Start reading at [`ZonalGravity`]; what is known of the central body is in [`bodies`], two satellites are in [`relative`].

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod atmosphere;
pub mod attitude;
pub mod bodies;
mod clohessy_wiltshire;
pub mod cr3bp;
pub mod earth;
pub mod earth_rotation;
mod elements;
pub mod epoch;
mod error;
pub mod frames;
pub mod harmonics;
pub mod moon_rotation;
pub mod precession;
pub mod radiation;
pub mod relative;
pub mod relative_axes;
mod relative_j2;
pub mod sun_moon;
mod zonal;

pub use atmosphere::Atmosphere;
pub use bodies::{CentralBody, ThirdBody, UniformRotation};
pub use clohessy_wiltshire::ClohessyWiltshire;
pub use cr3bp::{Cr3bp, Cr3bpSystem};
pub use elements::Elements;
pub use error::AstroError;
pub use harmonics::{Coefficients, FieldError, SphericalHarmonics};
pub use relative::{Lvlh, LvlhAxes};
pub use relative_axes::RelativeAxes;
pub use relative_j2::{J2RelativeMotion, TargetOrbit};
pub use zonal::ZonalGravity;
