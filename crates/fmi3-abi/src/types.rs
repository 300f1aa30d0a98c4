//! Scalar types, handles, enumerations and callbacks.

use std::ffi::{c_char, c_int, c_void};
use std::fmt;

/// `fmi3Instance`: opaque handle of an instance, owned by the FMU.
pub type Fmi3Instance = *mut c_void;

/// `fmi3InstanceEnvironment`: opaque pointer of the host, handed back to its callbacks.
pub type Fmi3InstanceEnvironment = *mut c_void;

/// `fmi3FMUState`: opaque handle of a saved state, owned by the FMU.
pub type Fmi3FmuState = *mut c_void;

/// `fmi3ValueReference`: handle of a variable, be it a scalar or an array.
pub type Fmi3ValueReference = u32;

/// `fmi3Float32`.
pub type Fmi3Float32 = f32;
/// `fmi3Float64`.
pub type Fmi3Float64 = f64;
/// `fmi3Int8`.
pub type Fmi3Int8 = i8;
/// `fmi3UInt8`.
pub type Fmi3UInt8 = u8;
/// `fmi3Int16`.
pub type Fmi3Int16 = i16;
/// `fmi3UInt16`.
pub type Fmi3UInt16 = u16;
/// `fmi3Int32`.
pub type Fmi3Int32 = i32;
/// `fmi3UInt32`.
pub type Fmi3UInt32 = u32;
/// `fmi3Int64`; enumerations travel as this, too.
pub type Fmi3Int64 = i64;
/// `fmi3UInt64`.
pub type Fmi3UInt64 = u64;

/// `fmi3Boolean`: C's `bool` as the byte that it is. A byte other than 0 and 1 would be no `bool` of Rust, and a host may be written in
/// a language that lets one through.
pub type Fmi3Boolean = u8;

/// `fmi3Char`.
pub type Fmi3Char = c_char;

/// `fmi3String`: NUL-terminated UTF-8.
pub type Fmi3String = *const c_char;

/// `fmi3Byte`: one byte of a serialized state or of a binary value.
pub type Fmi3Byte = u8;

/// `fmi3Binary`: so many bytes as is said beside it.
pub type Fmi3Binary = *const Fmi3Byte;

/// `fmi3Clock`: whether a clock is active, C's `bool` as [`Fmi3Boolean`].
pub type Fmi3Clock = u8;

/// `fmi3True`.
pub const FMI3_TRUE: Fmi3Boolean = 1;

/// `fmi3False`.
pub const FMI3_FALSE: Fmi3Boolean = 0;

/// A truth value as it crosses the boundary.
pub const fn boolean(value: bool) -> Fmi3Boolean {
    if value { FMI3_TRUE } else { FMI3_FALSE }
}

/// The truth value that arrived: any number but 0 is true, as in C.
pub const fn truth(raw: Fmi3Boolean) -> bool {
    raw != FMI3_FALSE
}

/// `fmi3Status` as it crosses the boundary: any integer, read by [`Fmi3Status::from_raw`].
pub type RawStatus = c_int;

/// `fmi3Status`: how a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i32)]
pub enum Fmi3Status {
    /// All well.
    Ok = 0,
    /// Not quite right, but the computation can go on.
    Warning = 1,
    /// The call could not be answered; the instance is as before.
    Discard = 2,
    /// An error; only this instance is concerned.
    Error = 3,
    /// An error after which the instance can no longer be used.
    Fatal = 4,
}

impl Fmi3Status {
    /// The status with this number, or `None` for a number the standard does not know.
    pub const fn from_raw(raw: RawStatus) -> Option<Self> {
        match raw {
            0 => Some(Self::Ok),
            1 => Some(Self::Warning),
            2 => Some(Self::Discard),
            3 => Some(Self::Error),
            4 => Some(Self::Fatal),
            _ => None,
        }
    }

    /// The number that crosses the boundary.
    pub const fn raw(self) -> RawStatus {
        self as RawStatus
    }

    /// The name in the C headers, e.g. `fmi3Error`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "fmi3OK",
            Self::Warning => "fmi3Warning",
            Self::Discard => "fmi3Discard",
            Self::Error => "fmi3Error",
            Self::Fatal => "fmi3Fatal",
        }
    }
}

impl fmt::Display for Fmi3Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// `fmi3DependencyKind` as it crosses the boundary: 0 independent, 1 constant, 2 fixed, 3 tunable, 4 discrete, 5 dependent.
pub type RawDependencyKind = c_int;

/// `fmi3IntervalQualifier` as it crosses the boundary: 0 not yet known, 1 unchanged, 2 changed.
pub type RawIntervalQualifier = c_int;

/// `fmi3LogMessageCallback`: environment, status, category, message. The message is a text, no format.
pub type LogMessageCallback = unsafe extern "C" fn(Fmi3InstanceEnvironment, RawStatus, Fmi3String, Fmi3String);

/// `fmi3ClockUpdateCallback`: environment.
pub type ClockUpdateCallback = unsafe extern "C" fn(Fmi3InstanceEnvironment);

/// `fmi3IntermediateUpdateCallback`: environment, time s, variables may be set, may be read, the step is finished, it can return early;
/// answers whether to return early, and when.
pub type IntermediateUpdateCallback = unsafe extern "C" fn(
    Fmi3InstanceEnvironment,
    Fmi3Float64,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Float64,
);

/// `fmi3LockPreemptionCallback`.
pub type LockPreemptionCallback = unsafe extern "C" fn();

/// `fmi3UnlockPreemptionCallback`.
pub type UnlockPreemptionCallback = unsafe extern "C" fn();
