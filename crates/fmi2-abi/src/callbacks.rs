//! What a host gives to an FMU: a logger under the variadic type of the standard, and the C library's memory.
#![allow(
    unsafe_code,
    reason = "a function is taken for one of another type, and two of the C library are declared"
)]

use std::ffi::c_void;

use crate::types::{CallbackLogger, Fmi2ComponentEnvironment, Fmi2String, RawStatus};

/// A logger that takes the named arguments and leaves those of the format alone: stable Rust calls variadic functions and defines
/// none.
pub type FixedLogger = unsafe extern "C" fn(
    environment: Fmi2ComponentEnvironment,
    instance_name: Fmi2String,
    status: RawStatus,
    category: Fmi2String,
    message: Fmi2String,
);

/// A logger under the variadic type that the standard asks for; messages come with their conversions unfilled.
pub fn variadic(logger: FixedLogger) -> CallbackLogger {
    // SAFETY: both are C function pointers of one size. In the C calling conventions of the platforms that FMI names (x86-64 and
    // AArch64, System V, Apple and Windows; cdecl on 32-bit x86) the named arguments of a variadic call travel as those of a fixed
    // call and the caller takes the others away, so a function that reads the named ones only works for both.
    unsafe { std::mem::transmute::<FixedLogger, CallbackLogger>(logger) }
}

// The standard asks for zeroed memory that `freeMemory` takes back: the C library's own pair.
// SAFETY: the declarations match the C standard library, which `std` links on every platform with shared libraries.
unsafe extern "C" {
    /// `allocateMemory` of the C library.
    pub fn calloc(count: usize, size: usize) -> *mut c_void;
    /// `freeMemory` of the C library.
    pub fn free(memory: *mut c_void);
}
