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
mod check;
mod description;
mod error;
mod export;
mod golden;
mod guard;
mod instance;
mod log;
mod model;
mod order;
mod snapshot;
mod table;
mod unit;
mod xml;

/// What [`export_fmu!`] refers to.
#[doc(hidden)]
pub use fmi2_abi as abi;

pub use description::{guid, render};
pub use golden::{GoldenError, golden_check};
pub use log::{Category, Log};
pub use model::{Experiment, Model, ModelError, ModelInfo, VendorAnnotation};
pub use table::{
    Access, Boolean, Bounds, Causality, DefinitionError, Enumeration, EnumerationItem, EnumerationType, Integer, Kind,
    Real, Row, Scalar, Table, TableBuilder, Text, Typed, Variability, Variable,
};
pub use xml::Element;
