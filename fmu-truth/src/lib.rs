//! The simulated world of `crates/truth` as a co-simulation slave of FMI 2.0 and FMI 3.0.
//!
//! `variables.rs` is the table of everything a master can see, `slave.rs` what the table reads and writes, around a
//! [`truth::Simulation`]; `model.rs` answers what FMI asks. Behaviour belongs in `truth`, the C interfaces in `fmi2-export` and `fmi3-export`;
//! here stands neither.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod model;
mod slave;
#[cfg(test)]
#[path = "../../tests/one_slave/mod.rs"]
mod tests;
mod variables;

use slave::TruthModel;
#[cfg(test)]
use slave::TruthModel as Slave;

// One library with both interfaces: they step the same code, so a run has the same bits in either.
fmi2_export::export_fmu!(TruthModel);
fmi3_export::export_fmu!(TruthModel);
