//! Pointer types of the functions that an FMU exports, under the names of the standard without their prefix: `fmi3DoStep` is
//! [`DoStep`]. Arguments stand in the order of the C headers; a C array is a pointer and, unless said otherwise, its number of elements.

use std::ffi::c_char;

use crate::types::{
    ClockUpdateCallback, Fmi3Binary, Fmi3Boolean, Fmi3Byte, Fmi3Clock, Fmi3Float32, Fmi3Float64, Fmi3FmuState,
    Fmi3Instance, Fmi3InstanceEnvironment, Fmi3Int8, Fmi3Int16, Fmi3Int32, Fmi3Int64, Fmi3String, Fmi3UInt8,
    Fmi3UInt16, Fmi3UInt32, Fmi3UInt64, Fmi3ValueReference, IntermediateUpdateCallback, LockPreemptionCallback,
    LogMessageCallback, RawDependencyKind, RawIntervalQualifier, RawStatus, UnlockPreemptionCallback,
};

// Inquiry, life cycle.

/// `fmi3GetVersion`.
pub type GetVersion = unsafe extern "C" fn() -> *const c_char;
/// `fmi3SetDebugLogging`: instance, logging on, number of categories, categories.
pub type SetDebugLogging = unsafe extern "C" fn(Fmi3Instance, Fmi3Boolean, usize, *const Fmi3String) -> RawStatus;
/// `fmi3InstantiateModelExchange`: instance name, instantiation token, resource path, visible, logging on, environment, logger.
pub type InstantiateModelExchange = unsafe extern "C" fn(
    Fmi3String,
    Fmi3String,
    Fmi3String,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3InstanceEnvironment,
    Option<LogMessageCallback>,
) -> Fmi3Instance;
/// `fmi3InstantiateCoSimulation`: instance name, instantiation token, resource path, visible, logging on, event mode used, early
/// return allowed, required intermediate variables and their number, environment, logger, intermediate update.
pub type InstantiateCoSimulation = unsafe extern "C" fn(
    Fmi3String,
    Fmi3String,
    Fmi3String,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3Boolean,
    *const Fmi3ValueReference,
    usize,
    Fmi3InstanceEnvironment,
    Option<LogMessageCallback>,
    Option<IntermediateUpdateCallback>,
) -> Fmi3Instance;
/// `fmi3InstantiateScheduledExecution`: instance name, instantiation token, resource path, visible, logging on, environment, logger,
/// clock update, lock and unlock preemption.
pub type InstantiateScheduledExecution = unsafe extern "C" fn(
    Fmi3String,
    Fmi3String,
    Fmi3String,
    Fmi3Boolean,
    Fmi3Boolean,
    Fmi3InstanceEnvironment,
    Option<LogMessageCallback>,
    Option<ClockUpdateCallback>,
    Option<LockPreemptionCallback>,
    Option<UnlockPreemptionCallback>,
) -> Fmi3Instance;
/// `fmi3FreeInstance`.
pub type FreeInstance = unsafe extern "C" fn(Fmi3Instance);
/// `fmi3EnterInitializationMode`: instance, tolerance defined, tolerance, start time, stop time defined, stop time.
pub type EnterInitializationMode =
    unsafe extern "C" fn(Fmi3Instance, Fmi3Boolean, Fmi3Float64, Fmi3Float64, Fmi3Boolean, Fmi3Float64) -> RawStatus;
/// `fmi3ExitInitializationMode`.
pub type ExitInitializationMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3EnterEventMode`.
pub type EnterEventMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3Terminate`.
pub type Terminate = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3Reset`.
pub type Reset = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;

// Variables: instance, references and their number, values of all elements and their number.

/// `fmi3GetFloat32`.
pub type GetFloat32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Float32, usize) -> RawStatus;
/// `fmi3GetFloat64`.
pub type GetFloat64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetInt8`.
pub type GetInt8 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Int8, usize) -> RawStatus;
/// `fmi3GetUInt8`.
pub type GetUInt8 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3UInt8, usize) -> RawStatus;
/// `fmi3GetInt16`.
pub type GetInt16 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Int16, usize) -> RawStatus;
/// `fmi3GetUInt16`.
pub type GetUInt16 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3UInt16, usize) -> RawStatus;
/// `fmi3GetInt32`.
pub type GetInt32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Int32, usize) -> RawStatus;
/// `fmi3GetUInt32`.
pub type GetUInt32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3UInt32, usize) -> RawStatus;
/// `fmi3GetInt64`.
pub type GetInt64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Int64, usize) -> RawStatus;
/// `fmi3GetUInt64`.
pub type GetUInt64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3UInt64, usize) -> RawStatus;
/// `fmi3GetBoolean`.
pub type GetBoolean =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Boolean, usize) -> RawStatus;
/// `fmi3GetString`: the strings belong to the FMU and hold until the next call on the instance.
pub type GetString =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3String, usize) -> RawStatus;
/// `fmi3GetBinary`: instance, references and their number, sizes, values, number of both; the values belong to the FMU.
pub type GetBinary = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *mut usize,
    *mut Fmi3Binary,
    usize,
) -> RawStatus;
/// `fmi3GetClock`: instance, references and their number, one value each.
pub type GetClock = unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Clock) -> RawStatus;
/// `fmi3SetFloat32`.
pub type SetFloat32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Float32, usize) -> RawStatus;
/// `fmi3SetFloat64`.
pub type SetFloat64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Float64, usize) -> RawStatus;
/// `fmi3SetInt8`.
pub type SetInt8 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Int8, usize) -> RawStatus;
/// `fmi3SetUInt8`.
pub type SetUInt8 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3UInt8, usize) -> RawStatus;
/// `fmi3SetInt16`.
pub type SetInt16 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Int16, usize) -> RawStatus;
/// `fmi3SetUInt16`.
pub type SetUInt16 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3UInt16, usize) -> RawStatus;
/// `fmi3SetInt32`.
pub type SetInt32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Int32, usize) -> RawStatus;
/// `fmi3SetUInt32`.
pub type SetUInt32 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3UInt32, usize) -> RawStatus;
/// `fmi3SetInt64`.
pub type SetInt64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Int64, usize) -> RawStatus;
/// `fmi3SetUInt64`.
pub type SetUInt64 =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3UInt64, usize) -> RawStatus;
/// `fmi3SetBoolean`.
pub type SetBoolean =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Boolean, usize) -> RawStatus;
/// `fmi3SetString`.
pub type SetString =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3String, usize) -> RawStatus;
/// `fmi3SetBinary`: instance, references and their number, sizes, values, number of both.
pub type SetBinary = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *const usize,
    *const Fmi3Binary,
    usize,
) -> RawStatus;
/// `fmi3SetClock`: instance, references and their number, one value each.
pub type SetClock = unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Clock) -> RawStatus;

// Dependencies, saved states, derivatives.

/// `fmi3GetNumberOfVariableDependencies`: instance, variable, answer.
pub type GetNumberOfVariableDependencies =
    unsafe extern "C" fn(Fmi3Instance, Fmi3ValueReference, *mut usize) -> RawStatus;
/// `fmi3GetVariableDependencies`: instance, dependent; for each dependency the element of the dependent, the independent, its element,
/// the kind; their number.
pub type GetVariableDependencies = unsafe extern "C" fn(
    Fmi3Instance,
    Fmi3ValueReference,
    *mut usize,
    *mut Fmi3ValueReference,
    *mut usize,
    *mut RawDependencyKind,
    usize,
) -> RawStatus;
/// `fmi3GetFMUState`: a non-null handle is filled anew.
pub type GetFmuState = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3FmuState) -> RawStatus;
/// `fmi3SetFMUState`.
pub type SetFmuState = unsafe extern "C" fn(Fmi3Instance, Fmi3FmuState) -> RawStatus;
/// `fmi3FreeFMUState`: sets the handle to null.
pub type FreeFmuState = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3FmuState) -> RawStatus;
/// `fmi3SerializedFMUStateSize`.
pub type SerializedFmuStateSize = unsafe extern "C" fn(Fmi3Instance, Fmi3FmuState, *mut usize) -> RawStatus;
/// `fmi3SerializeFMUState`: instance, state, buffer, its size.
pub type SerializeFmuState = unsafe extern "C" fn(Fmi3Instance, Fmi3FmuState, *mut Fmi3Byte, usize) -> RawStatus;
/// `fmi3DeserializeFMUState`: instance, bytes, their number, state.
pub type DeserializeFmuState =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3Byte, usize, *mut Fmi3FmuState) -> RawStatus;
/// `fmi3GetDirectionalDerivative`: instance, unknowns and their number, knowns and their number, seed and its number of elements,
/// sensitivity and its number of elements.
pub type GetDirectionalDerivative = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *const Fmi3ValueReference,
    usize,
    *const Fmi3Float64,
    usize,
    *mut Fmi3Float64,
    usize,
) -> RawStatus;
/// `fmi3GetAdjointDerivative`: as [`GetDirectionalDerivative`].
pub type GetAdjointDerivative = GetDirectionalDerivative;

// Configuration, clocks, events. Arrays of clocks have one element for each reference.

/// `fmi3EnterConfigurationMode`.
pub type EnterConfigurationMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3ExitConfigurationMode`.
pub type ExitConfigurationMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3GetIntervalDecimal`: instance, clocks and their number, intervals s, qualifiers.
pub type GetIntervalDecimal = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *mut Fmi3Float64,
    *mut RawIntervalQualifier,
) -> RawStatus;
/// `fmi3GetIntervalFraction`: instance, clocks and their number, counters, resolutions, qualifiers.
pub type GetIntervalFraction = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *mut Fmi3UInt64,
    *mut Fmi3UInt64,
    *mut RawIntervalQualifier,
) -> RawStatus;
/// `fmi3GetShiftDecimal`: instance, clocks and their number, shifts s.
pub type GetShiftDecimal =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3Float64) -> RawStatus;
/// `fmi3GetShiftFraction`: instance, clocks and their number, counters, resolutions.
pub type GetShiftFraction =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *mut Fmi3UInt64, *mut Fmi3UInt64) -> RawStatus;
/// `fmi3SetIntervalDecimal`: instance, clocks and their number, intervals s.
pub type SetIntervalDecimal =
    unsafe extern "C" fn(Fmi3Instance, *const Fmi3ValueReference, usize, *const Fmi3Float64) -> RawStatus;
/// `fmi3SetIntervalFraction`: instance, clocks and their number, counters, resolutions.
pub type SetIntervalFraction = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *const Fmi3UInt64,
    *const Fmi3UInt64,
) -> RawStatus;
/// `fmi3SetShiftDecimal`: as [`SetIntervalDecimal`].
pub type SetShiftDecimal = SetIntervalDecimal;
/// `fmi3SetShiftFraction`: as [`SetIntervalFraction`].
pub type SetShiftFraction = SetIntervalFraction;
/// `fmi3EvaluateDiscreteStates`.
pub type EvaluateDiscreteStates = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3UpdateDiscreteStates`: instance; answers: discrete states need an update, terminate, nominals of continuous states changed,
/// their values changed, the next event is known, its time s.
pub type UpdateDiscreteStates = unsafe extern "C" fn(
    Fmi3Instance,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Float64,
) -> RawStatus;

// Model exchange.

/// `fmi3EnterContinuousTimeMode`.
pub type EnterContinuousTimeMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3CompletedIntegratorStep`: instance, no state will be set before this point, enter event mode, terminate.
pub type CompletedIntegratorStep =
    unsafe extern "C" fn(Fmi3Instance, Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Boolean) -> RawStatus;
/// `fmi3SetTime`.
pub type SetTime = unsafe extern "C" fn(Fmi3Instance, Fmi3Float64) -> RawStatus;
/// `fmi3SetContinuousStates`.
pub type SetContinuousStates = unsafe extern "C" fn(Fmi3Instance, *const Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetContinuousStateDerivatives`.
pub type GetContinuousStateDerivatives = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetEventIndicators`.
pub type GetEventIndicators = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetContinuousStates`.
pub type GetContinuousStates = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetNominalsOfContinuousStates`.
pub type GetNominalsOfContinuousStates = unsafe extern "C" fn(Fmi3Instance, *mut Fmi3Float64, usize) -> RawStatus;
/// `fmi3GetNumberOfEventIndicators`.
pub type GetNumberOfEventIndicators = unsafe extern "C" fn(Fmi3Instance, *mut usize) -> RawStatus;
/// `fmi3GetNumberOfContinuousStates`.
pub type GetNumberOfContinuousStates = unsafe extern "C" fn(Fmi3Instance, *mut usize) -> RawStatus;

// Co-simulation, scheduled execution.

/// `fmi3EnterStepMode`.
pub type EnterStepMode = unsafe extern "C" fn(Fmi3Instance) -> RawStatus;
/// `fmi3GetOutputDerivatives`: instance, references and their number, one order for each, values and their number.
pub type GetOutputDerivatives = unsafe extern "C" fn(
    Fmi3Instance,
    *const Fmi3ValueReference,
    usize,
    *const Fmi3Int32,
    *mut Fmi3Float64,
    usize,
) -> RawStatus;
/// `fmi3DoStep`: instance, current communication point s, step size s, no state will be set before this point; answers: event
/// handling is needed, terminate, the step ended early, where it ended s.
pub type DoStep = unsafe extern "C" fn(
    Fmi3Instance,
    Fmi3Float64,
    Fmi3Float64,
    Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Boolean,
    *mut Fmi3Float64,
) -> RawStatus;
/// `fmi3ActivateModelPartition`: instance, clock, time of the activation s.
pub type ActivateModelPartition = unsafe extern "C" fn(Fmi3Instance, Fmi3ValueReference, Fmi3Float64) -> RawStatus;
