//! Scalar types, handles, enumerations and structs.

use std::ffi::{c_char, c_int, c_uint, c_void};
use std::fmt;

/// `fmi2Component`: opaque handle of an instance, owned by the FMU.
pub type Fmi2Component = *mut c_void;

/// `fmi2ComponentEnvironment`: opaque pointer of the host, handed back to its callbacks.
pub type Fmi2ComponentEnvironment = *mut c_void;

/// `fmi2FMUstate`: opaque handle of a saved state, owned by the FMU.
pub type Fmi2FmuState = *mut c_void;

/// `fmi2ValueReference`: handle of a variable.
pub type Fmi2ValueReference = c_uint;

/// `fmi2Real`.
pub type Fmi2Real = f64;

/// `fmi2Integer`; enumerations travel as this, too.
pub type Fmi2Integer = c_int;

/// `fmi2Boolean`: [`FMI2_FALSE`] or [`FMI2_TRUE`].
pub type Fmi2Boolean = c_int;

/// `fmi2Char`.
pub type Fmi2Char = c_char;

/// `fmi2String`: NUL-terminated UTF-8.
pub type Fmi2String = *const c_char;

/// `fmi2Byte`: one byte of a serialized state.
pub type Fmi2Byte = c_char;

/// `fmi2True`.
pub const FMI2_TRUE: Fmi2Boolean = 1;

/// `fmi2False`.
pub const FMI2_FALSE: Fmi2Boolean = 0;

/// A truth value as it crosses the boundary.
pub const fn boolean(value: bool) -> Fmi2Boolean {
    if value { FMI2_TRUE } else { FMI2_FALSE }
}

/// The truth value that arrived: any number but 0 is true, as in C.
pub const fn truth(raw: Fmi2Boolean) -> bool {
    raw != FMI2_FALSE
}

/// `fmi2Status` as it crosses the boundary: any integer, read by [`Fmi2Status::from_raw`].
pub type RawStatus = c_int;

/// `fmi2Status`: how a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i32)]
pub enum Fmi2Status {
    /// All well.
    Ok = 0,
    /// Not quite right, but the computation can go on.
    Warning = 1,
    /// The request could not be answered, e.g. information that does not exist; the instance is as before.
    Discard = 2,
    /// An error; only this instance is concerned.
    Error = 3,
    /// An error after which the instance can no longer be used.
    Fatal = 4,
    /// The step is still being computed (asynchronous slaves only).
    Pending = 5,
}

impl Fmi2Status {
    /// The status with this number, or `None` for a number the standard does not know.
    pub const fn from_raw(raw: RawStatus) -> Option<Self> {
        match raw {
            0 => Some(Self::Ok),
            1 => Some(Self::Warning),
            2 => Some(Self::Discard),
            3 => Some(Self::Error),
            4 => Some(Self::Fatal),
            5 => Some(Self::Pending),
            _ => None,
        }
    }

    /// The number that crosses the boundary.
    pub const fn raw(self) -> RawStatus {
        self as RawStatus
    }

    /// The name in the C headers, e.g. `fmi2Error`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "fmi2OK",
            Self::Warning => "fmi2Warning",
            Self::Discard => "fmi2Discard",
            Self::Error => "fmi2Error",
            Self::Fatal => "fmi2Fatal",
            Self::Pending => "fmi2Pending",
        }
    }
}

impl fmt::Display for Fmi2Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// `fmi2Type`: the interface an instance is created for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(i32)]
pub enum Fmi2Type {
    /// The host integrates.
    ModelExchange = 0,
    /// The FMU steps itself.
    CoSimulation = 1,
}

impl Fmi2Type {
    /// The type with this number, or `None` for a number the standard does not know.
    pub const fn from_raw(raw: c_int) -> Option<Self> {
        match raw {
            0 => Some(Self::ModelExchange),
            1 => Some(Self::CoSimulation),
            _ => None,
        }
    }

    /// The number that crosses the boundary.
    pub const fn raw(self) -> c_int {
        self as c_int
    }
}

/// `fmi2StatusKind`: what the `fmi2Get...Status` functions are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(i32)]
pub enum Fmi2StatusKind {
    /// Status of a step that was pending.
    DoStepStatus = 0,
    /// Text about a pending step.
    PendingStatus = 1,
    /// End of the last successful step, s.
    LastSuccessfulTime = 2,
    /// Whether the slave wants the simulation to end.
    Terminated = 3,
}

impl Fmi2StatusKind {
    /// The kind with this number, or `None` for a number the standard does not know.
    pub const fn from_raw(raw: c_int) -> Option<Self> {
        match raw {
            0 => Some(Self::DoStepStatus),
            1 => Some(Self::PendingStatus),
            2 => Some(Self::LastSuccessfulTime),
            3 => Some(Self::Terminated),
            _ => None,
        }
    }

    /// The number that crosses the boundary.
    pub const fn raw(self) -> c_int {
        self as c_int
    }
}

/// `fmi2CallbackLogger`: environment, instance name, status, category, `printf` format, and its arguments.
pub type CallbackLogger = unsafe extern "C" fn(
    environment: Fmi2ComponentEnvironment,
    instance_name: Fmi2String,
    status: RawStatus,
    category: Fmi2String,
    message: Fmi2String,
    ...
);

/// `fmi2CallbackAllocateMemory`: like `calloc`.
pub type CallbackAllocateMemory = unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void;

/// `fmi2CallbackFreeMemory`: like `free`.
pub type CallbackFreeMemory = unsafe extern "C" fn(memory: *mut c_void);

/// `fmi2StepFinished`: called by asynchronous slaves at the end of a step.
pub type StepFinished = unsafe extern "C" fn(environment: Fmi2ComponentEnvironment, status: RawStatus);

/// `fmi2CallbackFunctions`: what the host offers to an instance. `None` is a null pointer.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Fmi2CallbackFunctions {
    /// Takes the messages of the instance.
    pub logger: Option<CallbackLogger>,
    /// Allocates zeroed memory.
    pub allocate_memory: Option<CallbackAllocateMemory>,
    /// Frees what `allocate_memory` returned.
    pub free_memory: Option<CallbackFreeMemory>,
    /// Hears of the end of asynchronous steps.
    pub step_finished: Option<StepFinished>,
    /// Handed back in every callback.
    pub component_environment: Fmi2ComponentEnvironment,
}

/// `fmi2EventInfo`: result of `fmi2NewDiscreteStates` (model exchange).
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Fmi2EventInfo {
    /// Another event iteration is needed.
    pub new_discrete_states_needed: Fmi2Boolean,
    /// The simulation shall end.
    pub terminate_simulation: Fmi2Boolean,
    /// Nominal values of continuous states have changed.
    pub nominals_of_continuous_states_changed: Fmi2Boolean,
    /// Values of continuous states have changed.
    pub values_of_continuous_states_changed: Fmi2Boolean,
    /// `next_event_time` holds a value.
    pub next_event_time_defined: Fmi2Boolean,
    /// Time of the next event, s.
    pub next_event_time: Fmi2Real,
}
