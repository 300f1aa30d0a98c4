#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! A model crate needs [`Model`], [`TableBuilder`], [`golden_check`] in a test, and one line of [`export_fmu!`]. Inside,
//! `boundary` holds the C functions, `order` says when each may be called, `rows` finds what a value reference means, and
//! `description` renders; what is the same in every version of FMI is that of `fmi-export`.

#[doc(hidden)]
pub mod boundary;
mod description;
mod error;
mod export;
mod golden;
mod log;
mod order;
mod rows;
mod version;

/// What [`export_fmu!`] refers to.
#[doc(hidden)]
pub use fmi3_abi as abi;

pub use fmi_export::GoldenError;
#[doc(hidden)]
pub use fmi_export::{Exported, GuidCell};
pub use fmi_model::{
    DefinitionError, Element, Experiment, Log, Model, ModelError, ModelInfo, Shape, Table, TableBuilder,
    VendorAnnotation,
};
pub use golden::{golden_check, instantiation_token, render};
pub use rows::{TIME, value_reference};
#[doc(hidden)]
pub use version::Fmi3;
