#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! A model crate needs [`Model`], [`TableBuilder`], [`golden_check`] in a test, and one line of [`export_fmu!`]. Inside,
//! `boundary` holds the C functions, `order` says when each may be called, `instance` what it does, and `description` renders.

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
