//! Couples slaves by equal names and steps them on a fixed grid.
//!
//! Here: the [`Slave`] trait that FMUs and plain Rust mocks share, wiring by name, and a fixed-step master for both
//! Gauss-Seidel and Jacobi coupling. Not here: loading FMUs (`fmi2-import`), or what to do with the results.
//!
//! Start with [`System`]: add slaves, connect, run. The exchange of values is in `exchange`, the stepping in `master`.

mod error;
mod exchange;
mod fmu;
mod master;
mod probe;
mod slave;
mod system;

pub use error::{CosimError, SlaveError};
pub use fmi2_import::{BaseType, Causality, Experiment, Value};
pub use fmu::FmuSlave;
pub use master::{Isolated, OnSlaveError, RunOptions, RunReport, Scheme, SlaveTiming, StepContext};
pub use probe::{Handle, Probe, Readable, Sample, Values};
pub use slave::{Port, Slave};
pub use system::{SlaveId, System, UnconnectedInput};
