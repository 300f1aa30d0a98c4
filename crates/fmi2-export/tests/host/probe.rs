//! The example model as an FMU.

#[path = "../../../fmi-export/tests/probe/mod.rs"]
mod model;

pub use model::*;

fmi2_export::export_fmu!(Probe);
