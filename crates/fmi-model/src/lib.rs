#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! A model crate needs [`Model`] and [`TableBuilder`]. An exporter renders [`Table::rows`] or, if its standard has no arrays,
//! [`Table::entries`], writes with [`Element`], and drives an [`Instance`]; which calls a [`Phase`] allows is its own business.

mod bounds;
mod builder;
mod check;
mod definition;
mod error;
mod guard;
mod instance;
mod kind;
mod log;
mod lookup;
mod model;
mod phase;
mod snapshot;
mod table;
mod unit;
mod variable;
mod xml;

pub use bounds::Bounds;
pub use builder::{Row, TableBuilder};
pub use check::Checked;
pub use definition::DefinitionError;
pub use error::InstanceError;
pub use guard::guarded;
pub use instance::Instance;
pub use kind::{Boolean, Enumeration, Integer, Kind, Real, Text};
pub use log::{Category, Listener, Log, Wanted};
pub use model::{Experiment, Model, ModelError, ModelInfo, VendorAnnotation};
pub use phase::Phase;
pub use snapshot::{Seal, Snapshot, braced};
pub use table::Table;
pub use unit::{Unit, quantity};
pub use variable::{
    Access, Causality, Each, Entry, EnumerationItem, EnumerationType, Scalar, Shape, Typed, Variability, Variable,
};
pub use xml::{Element, XmlError, number};
