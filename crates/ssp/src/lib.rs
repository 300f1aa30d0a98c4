#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`Package::open`] for a file or folder, and [`flatten`] for what a master needs: components, what leads from which output to
//! which input, and the values of each component.

mod error;
mod flat;
mod model;
mod package;
mod parameters;
mod read;
mod tree;
mod way;
mod write;

pub use error::SspError;
pub use flat::{Flat, FlatComponent, FlatConnection, FlatParameter, FlatPort, flatten};
pub use model::{
    BaseUnit, Binding, Component, Connection, Connector, DataType, Element, End, Experiment, FMU, Kind, Linear,
    MappingEntry, Other, Parameter, ParameterSet, System, SystemStructure, Unit, Value,
};
pub use package::{Package, STRUCTURE};
pub use way::{NamedUnit, Way};
