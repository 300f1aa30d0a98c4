#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! A model crate needs [`Model`], [`TableBuilder`], [`golden_check`] in a test, and one line of [`export_fmu!`]. Inside,
//! `boundary` holds the C functions, `order` says when each may be called, and `description` renders; what is the same in every
//! version of FMI is that of `fmi-export`.

#[doc(hidden)]
pub mod boundary;
mod description;
mod error;
mod export;
mod golden;
mod log;
mod order;
mod version;

/// What [`export_fmu!`] refers to.
#[doc(hidden)]
pub use fmi2_abi as abi;

pub use fmi_export::GoldenError;
#[doc(hidden)]
pub use fmi_export::{Exported, GuidCell};
pub use fmi_model::{
    Access, Boolean, Bounds, Category, Causality, DefinitionError, Element, Entry, Enumeration, EnumerationItem,
    EnumerationType, Experiment, Integer, Kind, Log, Model, ModelError, ModelInfo, Real, Row, Scalar, Shape, Table,
    TableBuilder, Text, Typed, Variability, Variable, VendorAnnotation,
};
pub use golden::{golden_check, guid, render};
#[doc(hidden)]
pub use version::Fmi2;
