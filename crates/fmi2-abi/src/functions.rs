//! Pointer types of the functions that an FMU exports, under the names of the standard without their prefix: `fmi2DoStep` is
//! [`DoStep`]. Arguments stand in the order of the C headers; a C array is a pointer and its number of elements.

use std::ffi::{c_char, c_int};

use crate::types::{
    Fmi2Boolean, Fmi2Byte, Fmi2CallbackFunctions, Fmi2Component, Fmi2EventInfo, Fmi2FmuState, Fmi2Integer, Fmi2Real,
    Fmi2String, Fmi2ValueReference, RawStatus,
};

// Common to both interfaces: inquiry, life cycle.

/// `fmi2GetTypesPlatform`.
pub type GetTypesPlatform = unsafe extern "C" fn() -> *const c_char;
/// `fmi2GetVersion`.
pub type GetVersion = unsafe extern "C" fn() -> *const c_char;
/// `fmi2SetDebugLogging`: instance, logging on, number of categories, categories.
pub type SetDebugLogging = unsafe extern "C" fn(Fmi2Component, Fmi2Boolean, usize, *const Fmi2String) -> RawStatus;
/// `fmi2Instantiate`: instance name, `fmi2Type`, GUID, resource location (URI), callbacks, visible, logging on.
pub type Instantiate = unsafe extern "C" fn(
    Fmi2String,
    c_int,
    Fmi2String,
    Fmi2String,
    *const Fmi2CallbackFunctions,
    Fmi2Boolean,
    Fmi2Boolean,
) -> Fmi2Component;
/// `fmi2FreeInstance`.
pub type FreeInstance = unsafe extern "C" fn(Fmi2Component);
/// `fmi2SetupExperiment`: instance, tolerance defined, tolerance, start time, stop time defined, stop time.
pub type SetupExperiment =
    unsafe extern "C" fn(Fmi2Component, Fmi2Boolean, Fmi2Real, Fmi2Real, Fmi2Boolean, Fmi2Real) -> RawStatus;
/// `fmi2EnterInitializationMode`.
pub type EnterInitializationMode = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2ExitInitializationMode`.
pub type ExitInitializationMode = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2Terminate`.
pub type Terminate = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2Reset`.
pub type Reset = unsafe extern "C" fn(Fmi2Component) -> RawStatus;

// Common to both interfaces: variables.

/// `fmi2GetReal`.
pub type GetReal = unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *mut Fmi2Real) -> RawStatus;
/// `fmi2GetInteger`.
pub type GetInteger =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *mut Fmi2Integer) -> RawStatus;
/// `fmi2GetBoolean`.
pub type GetBoolean =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *mut Fmi2Boolean) -> RawStatus;
/// `fmi2GetString`: the strings belong to the FMU and hold until the next call on the instance.
pub type GetString =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *mut Fmi2String) -> RawStatus;
/// `fmi2SetReal`.
pub type SetReal = unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *const Fmi2Real) -> RawStatus;
/// `fmi2SetInteger`.
pub type SetInteger =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *const Fmi2Integer) -> RawStatus;
/// `fmi2SetBoolean`.
pub type SetBoolean =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *const Fmi2Boolean) -> RawStatus;
/// `fmi2SetString`.
pub type SetString =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2ValueReference, usize, *const Fmi2String) -> RawStatus;

// Common to both interfaces: saved states, derivatives.

/// `fmi2GetFMUstate`: a non-null handle is filled anew.
pub type GetFmuState = unsafe extern "C" fn(Fmi2Component, *mut Fmi2FmuState) -> RawStatus;
/// `fmi2SetFMUstate`.
pub type SetFmuState = unsafe extern "C" fn(Fmi2Component, Fmi2FmuState) -> RawStatus;
/// `fmi2FreeFMUstate`: sets the handle to null.
pub type FreeFmuState = unsafe extern "C" fn(Fmi2Component, *mut Fmi2FmuState) -> RawStatus;
/// `fmi2SerializedFMUstateSize`.
pub type SerializedFmuStateSize = unsafe extern "C" fn(Fmi2Component, Fmi2FmuState, *mut usize) -> RawStatus;
/// `fmi2SerializeFMUstate`: instance, state, buffer, its size.
pub type SerializeFmuState = unsafe extern "C" fn(Fmi2Component, Fmi2FmuState, *mut Fmi2Byte, usize) -> RawStatus;
/// `fmi2DeSerializeFMUstate`: instance, bytes, their number, state.
pub type DeSerializeFmuState =
    unsafe extern "C" fn(Fmi2Component, *const Fmi2Byte, usize, *mut Fmi2FmuState) -> RawStatus;
/// `fmi2GetDirectionalDerivative`: instance, unknowns and their number, knowns and their number, seed (one for each known),
/// result (one for each unknown).
pub type GetDirectionalDerivative = unsafe extern "C" fn(
    Fmi2Component,
    *const Fmi2ValueReference,
    usize,
    *const Fmi2ValueReference,
    usize,
    *const Fmi2Real,
    *mut Fmi2Real,
) -> RawStatus;

// Co-simulation.

/// `fmi2SetRealInputDerivatives`: instance, references and their number, orders, values.
pub type SetRealInputDerivatives = unsafe extern "C" fn(
    Fmi2Component,
    *const Fmi2ValueReference,
    usize,
    *const Fmi2Integer,
    *const Fmi2Real,
) -> RawStatus;
/// `fmi2GetRealOutputDerivatives`: instance, references and their number, orders, values.
pub type GetRealOutputDerivatives = unsafe extern "C" fn(
    Fmi2Component,
    *const Fmi2ValueReference,
    usize,
    *const Fmi2Integer,
    *mut Fmi2Real,
) -> RawStatus;
/// `fmi2DoStep`: instance, current communication point s, step size s, no state will be set before this point.
pub type DoStep = unsafe extern "C" fn(Fmi2Component, Fmi2Real, Fmi2Real, Fmi2Boolean) -> RawStatus;
/// `fmi2CancelStep`.
pub type CancelStep = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2GetStatus`: instance, `fmi2StatusKind`, answer.
pub type GetStatus = unsafe extern "C" fn(Fmi2Component, c_int, *mut RawStatus) -> RawStatus;
/// `fmi2GetRealStatus`.
pub type GetRealStatus = unsafe extern "C" fn(Fmi2Component, c_int, *mut Fmi2Real) -> RawStatus;
/// `fmi2GetIntegerStatus`.
pub type GetIntegerStatus = unsafe extern "C" fn(Fmi2Component, c_int, *mut Fmi2Integer) -> RawStatus;
/// `fmi2GetBooleanStatus`.
pub type GetBooleanStatus = unsafe extern "C" fn(Fmi2Component, c_int, *mut Fmi2Boolean) -> RawStatus;
/// `fmi2GetStringStatus`.
pub type GetStringStatus = unsafe extern "C" fn(Fmi2Component, c_int, *mut Fmi2String) -> RawStatus;

// Model exchange.

/// `fmi2EnterEventMode`.
pub type EnterEventMode = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2NewDiscreteStates`.
pub type NewDiscreteStates = unsafe extern "C" fn(Fmi2Component, *mut Fmi2EventInfo) -> RawStatus;
/// `fmi2EnterContinuousTimeMode`.
pub type EnterContinuousTimeMode = unsafe extern "C" fn(Fmi2Component) -> RawStatus;
/// `fmi2CompletedIntegratorStep`: instance, no state will be set before this point, enter event mode, terminate.
pub type CompletedIntegratorStep =
    unsafe extern "C" fn(Fmi2Component, Fmi2Boolean, *mut Fmi2Boolean, *mut Fmi2Boolean) -> RawStatus;
/// `fmi2SetTime`.
pub type SetTime = unsafe extern "C" fn(Fmi2Component, Fmi2Real) -> RawStatus;
/// `fmi2SetContinuousStates`.
pub type SetContinuousStates = unsafe extern "C" fn(Fmi2Component, *const Fmi2Real, usize) -> RawStatus;
/// `fmi2GetDerivatives`.
pub type GetDerivatives = unsafe extern "C" fn(Fmi2Component, *mut Fmi2Real, usize) -> RawStatus;
/// `fmi2GetEventIndicators`.
pub type GetEventIndicators = unsafe extern "C" fn(Fmi2Component, *mut Fmi2Real, usize) -> RawStatus;
/// `fmi2GetContinuousStates`.
pub type GetContinuousStates = unsafe extern "C" fn(Fmi2Component, *mut Fmi2Real, usize) -> RawStatus;
/// `fmi2GetNominalsOfContinuousStates`.
pub type GetNominalsOfContinuousStates = unsafe extern "C" fn(Fmi2Component, *mut Fmi2Real, usize) -> RawStatus;
