#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`System`]: add slaves, connect, run. The [`Slave`] trait is what FMUs and mocks share; the exchange of values is in
//! `exchange`, the stepping in `master`, what it costs in `timing`.

mod clock;
mod error;
mod exchange;
mod fmu;
mod master;
mod probe;
mod slave;
mod system;
mod timing;
mod units;

pub use error::{CosimError, SlaveError};
pub use fmi2_import::{BaseType, BaseUnit, Causality, Experiment, Unit, Value};
pub use fmu::FmuSlave;
pub use master::{Isolated, OnSlaveError, RunOptions, RunReport, Scheme, StepContext};
pub use probe::{Handle, Probe, Readable, Sample, Values};
pub use slave::{Port, Slave, SlaveId};
pub use system::{System, UnconnectedInput};
pub use timing::SlaveTiming;
