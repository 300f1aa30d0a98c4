#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`Fmu::open`]: its [`ModelDescription`] answers questions without loading anything, and [`Fmu::instantiate`] gives an
//! [`Instance`] to drive.

mod archive;
mod description;
mod error;
mod fmu;
mod guard;
mod handles;
mod instance;
mod library;
pub mod limits;
pub mod loader;
mod logger;
mod notation;
mod platform;
mod status;
mod suggestion;
mod value;
mod xml;

pub use description::{
    BaseUnit, Causality, CoSimulation, DefaultExperiment, DisplayUnit, EnumerationItem, EnumerationType, Initial,
    LogCategory, ModelDescription, Unit, Variability, Variable, VariableKind, VendorAnnotation,
};
pub use error::ImportError;
pub use fmi2_abi::Fmi2Status;
pub use fmu::Fmu;
pub use handles::FmuState;
pub use instance::{Experiment, Instance, Outcome};
pub use logger::LogMessage;
pub use platform::{LIBRARY_SUFFIX, PLATFORM};
pub use status::Status;
pub use suggestion::suggest;
pub use value::{BaseType, Value};
