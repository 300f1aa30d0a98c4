//! Turns a Rust model and its variable table into an FMI 2.0 co-simulation slave.
//!
//! Here: the [`Model`] trait, the [`Table`] of variables, the rendering of `modelDescription.xml`, the call-order state machine,
//! the panic guard, saved states, and [`export_fmu!`], which gives a `cdylib` every function of the standard. Not here: any
//! physics, packing into a `.fmu` file, and the host's side of the interface.
//!
//! Start with [`Model`] and [`TableBuilder`]; a model crate needs those two, [`golden_check`] in a test, and one line:
//!
//! ```ignore
//! fmi2_export::export_fmu!(NavModel);
//! ```

#[doc(hidden)]
pub mod boundary;
mod description;
mod error;
mod export;
mod golden;
mod identity;
mod instance;
mod log;
mod order;

/// What [`export_fmu!`] refers to.
#[doc(hidden)]
pub use fmi2_abi as abi;

pub use description::{guid, render};
pub use fmi_model::{
    Access, Boolean, Bounds, Category, Causality, DefinitionError, Element, Entry, Enumeration, EnumerationItem,
    EnumerationType, Experiment, Integer, Kind, Log, Model, ModelError, ModelInfo, Real, Row, Scalar, Shape, Table,
    TableBuilder, Text, Typed, Variability, Variable, VendorAnnotation,
};
pub use golden::{GoldenError, golden_check};
#[doc(hidden)]
pub use identity::{Exported, GuidCell};
