//! The example model as an FMU of both versions, as one library may hold it.

#[path = "../../../fmi-export/tests/probe/mod.rs"]
mod model;

pub use model::*;

fmi2_export::export_fmu!(Probe);
fmi3_export::export_fmu!(Probe);
