//! The macro that gives a library its C functions.

/// Exports every function of FMI 3.0 for a [`Model`](crate::Model), in a module `fmi3`. One per library, at its top:
/// `export_fmu!(NavModel);`. It stands beside the macro of `fmi2-export` of the same name, for a library with both interfaces.
///
/// The functions only forward; see [`Model`](crate::Model) for what reaches the model. For the host:
///
/// - Every call runs under one panic guard. After a panic the instance answers `fmi3Fatal` and can only be freed; nothing is printed.
/// - A step that the model does not take ([`Model::check_step`](crate::Model::check_step): too long, or with inputs that make no
///   sense) is `fmi3Discard` and changes nothing; any other refused call (out of order, unknown or unfit variable, wrong number of
///   values, value out of bounds, times that do not fit) is `fmi3Error` and changes nothing. The instance stays usable, and the logger
///   is told why if logging is on.
/// - An error of the model while it initialises or steps ends in `fmi3Error`; variables can then still be read, and
///   `fmi3Reset` or `fmi3SetFMUState` bring the instance back.
/// - Calls on one instance must not overlap; those that do are refused. Instances are independent of each other.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        type Fmi3ExportedModel = $model;

        impl $crate::Exported<$crate::Fmi3> for $model {
            fn guid_cell() -> &'static $crate::GuidCell {
                static CELL: $crate::GuidCell = $crate::GuidCell::new();
                &CELL
            }
        }

        /// The functions of FMI 3.0, under their C names.
        #[allow(unsafe_code, missing_docs, non_snake_case)]
        #[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
        pub mod fmi3 {
            use super::Fmi3ExportedModel as Exported;
            use $crate::abi::*;

            #[unsafe(no_mangle)]
            pub extern "C" fn fmi3GetVersion() -> *const ::std::ffi::c_char {
                $crate::boundary::get_version()
            }
            const _: functions::GetVersion = fmi3GetVersion;

            $crate::__forward! {
                SetDebugLogging: fmi3SetDebugLogging = set_debug_logging(
                    c: Fmi3Instance, logging_on: Fmi3Boolean, n_categories: usize,
                    categories: *const Fmi3String) -> RawStatus;
                InstantiateModelExchange: fmi3InstantiateModelExchange = instantiate_model_exchange(
                    instance_name: Fmi3String, instantiation_token: Fmi3String, resource_path: Fmi3String,
                    visible: Fmi3Boolean, logging_on: Fmi3Boolean, instance_environment: Fmi3InstanceEnvironment,
                    log_message: Option<LogMessageCallback>) -> Fmi3Instance;
                InstantiateCoSimulation: fmi3InstantiateCoSimulation = instantiate_co_simulation(
                    instance_name: Fmi3String, instantiation_token: Fmi3String, resource_path: Fmi3String,
                    visible: Fmi3Boolean, logging_on: Fmi3Boolean, event_mode_used: Fmi3Boolean,
                    early_return_allowed: Fmi3Boolean, required_intermediate_variables: *const Fmi3ValueReference,
                    n_required_intermediate_variables: usize, instance_environment: Fmi3InstanceEnvironment,
                    log_message: Option<LogMessageCallback>,
                    intermediate_update: Option<IntermediateUpdateCallback>) -> Fmi3Instance;
                InstantiateScheduledExecution: fmi3InstantiateScheduledExecution = instantiate_scheduled_execution(
                    instance_name: Fmi3String, instantiation_token: Fmi3String, resource_path: Fmi3String,
                    visible: Fmi3Boolean, logging_on: Fmi3Boolean, instance_environment: Fmi3InstanceEnvironment,
                    log_message: Option<LogMessageCallback>, clock_update: Option<ClockUpdateCallback>,
                    lock_preemption: Option<LockPreemptionCallback>,
                    unlock_preemption: Option<UnlockPreemptionCallback>) -> Fmi3Instance;
                FreeInstance: fmi3FreeInstance = free_instance(c: Fmi3Instance) -> ();
                EnterInitializationMode: fmi3EnterInitializationMode = enter_initialization_mode(
                    c: Fmi3Instance, tolerance_defined: Fmi3Boolean, tolerance: Fmi3Float64, start_time: Fmi3Float64,
                    stop_time_defined: Fmi3Boolean, stop_time: Fmi3Float64) -> RawStatus;
                ExitInitializationMode: fmi3ExitInitializationMode = exit_initialization_mode(
                    c: Fmi3Instance) -> RawStatus;
                EnterEventMode: fmi3EnterEventMode = enter_event_mode(c: Fmi3Instance) -> RawStatus;
                Terminate: fmi3Terminate = terminate(c: Fmi3Instance) -> RawStatus;
                Reset: fmi3Reset = reset(c: Fmi3Instance) -> RawStatus;
                GetFloat32: fmi3GetFloat32 = get_float32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Float32,
                    n_v: usize) -> RawStatus;
                GetFloat64: fmi3GetFloat64 = get_float64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Float64,
                    n_v: usize) -> RawStatus;
                GetInt8: fmi3GetInt8 = get_int8(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Int8,
                    n_v: usize) -> RawStatus;
                GetUInt8: fmi3GetUInt8 = get_uint8(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3UInt8,
                    n_v: usize) -> RawStatus;
                GetInt16: fmi3GetInt16 = get_int16(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Int16,
                    n_v: usize) -> RawStatus;
                GetUInt16: fmi3GetUInt16 = get_uint16(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3UInt16,
                    n_v: usize) -> RawStatus;
                GetInt32: fmi3GetInt32 = get_int32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Int32,
                    n_v: usize) -> RawStatus;
                GetUInt32: fmi3GetUInt32 = get_uint32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3UInt32,
                    n_v: usize) -> RawStatus;
                GetInt64: fmi3GetInt64 = get_int64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Int64,
                    n_v: usize) -> RawStatus;
                GetUInt64: fmi3GetUInt64 = get_uint64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3UInt64,
                    n_v: usize) -> RawStatus;
                GetBoolean: fmi3GetBoolean = get_boolean(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Boolean,
                    n_v: usize) -> RawStatus;
                GetString: fmi3GetString = get_string(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3String,
                    n_v: usize) -> RawStatus;
                GetBinary: fmi3GetBinary = get_binary(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, value_sizes: *mut usize,
                    v: *mut Fmi3Binary, n_v: usize) -> RawStatus;
                GetClock: fmi3GetClock = get_clock(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *mut Fmi3Clock) -> RawStatus;
                SetFloat32: fmi3SetFloat32 = set_float32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Float32,
                    n_v: usize) -> RawStatus;
                SetFloat64: fmi3SetFloat64 = set_float64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Float64,
                    n_v: usize) -> RawStatus;
                SetInt8: fmi3SetInt8 = set_int8(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Int8,
                    n_v: usize) -> RawStatus;
                SetUInt8: fmi3SetUInt8 = set_uint8(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3UInt8,
                    n_v: usize) -> RawStatus;
                SetInt16: fmi3SetInt16 = set_int16(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Int16,
                    n_v: usize) -> RawStatus;
                SetUInt16: fmi3SetUInt16 = set_uint16(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3UInt16,
                    n_v: usize) -> RawStatus;
                SetInt32: fmi3SetInt32 = set_int32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Int32,
                    n_v: usize) -> RawStatus;
                SetUInt32: fmi3SetUInt32 = set_uint32(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3UInt32,
                    n_v: usize) -> RawStatus;
                SetInt64: fmi3SetInt64 = set_int64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Int64,
                    n_v: usize) -> RawStatus;
                SetUInt64: fmi3SetUInt64 = set_uint64(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3UInt64,
                    n_v: usize) -> RawStatus;
                SetBoolean: fmi3SetBoolean = set_boolean(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Boolean,
                    n_v: usize) -> RawStatus;
                SetString: fmi3SetString = set_string(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3String,
                    n_v: usize) -> RawStatus;
                SetBinary: fmi3SetBinary = set_binary(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, value_sizes: *const usize,
                    v: *const Fmi3Binary, n_v: usize) -> RawStatus;
                SetClock: fmi3SetClock = set_clock(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, v: *const Fmi3Clock) -> RawStatus;
                GetNumberOfVariableDependencies: fmi3GetNumberOfVariableDependencies = get_number_of_variable_dependencies(
                    c: Fmi3Instance, vr: Fmi3ValueReference, n_dependencies: *mut usize) -> RawStatus;
                GetVariableDependencies: fmi3GetVariableDependencies = get_variable_dependencies(
                    c: Fmi3Instance, dependent: Fmi3ValueReference, element_indices_of_dependent: *mut usize,
                    independents: *mut Fmi3ValueReference, element_indices_of_independents: *mut usize,
                    dependency_kinds: *mut RawDependencyKind, n_dependencies: usize) -> RawStatus;
                GetFmuState: fmi3GetFMUState = get_fmu_state(
                    c: Fmi3Instance, f_m_u_state: *mut Fmi3FmuState) -> RawStatus;
                SetFmuState: fmi3SetFMUState = set_fmu_state(c: Fmi3Instance, f_m_u_state: Fmi3FmuState) -> RawStatus;
                FreeFmuState: fmi3FreeFMUState = free_fmu_state(
                    c: Fmi3Instance, f_m_u_state: *mut Fmi3FmuState) -> RawStatus;
                SerializedFmuStateSize: fmi3SerializedFMUStateSize = serialized_fmu_state_size(
                    c: Fmi3Instance, f_m_u_state: Fmi3FmuState, size: *mut usize) -> RawStatus;
                SerializeFmuState: fmi3SerializeFMUState = serialize_fmu_state(
                    c: Fmi3Instance, f_m_u_state: Fmi3FmuState, serialized_state: *mut Fmi3Byte,
                    size: usize) -> RawStatus;
                DeserializeFmuState: fmi3DeserializeFMUState = deserialize_fmu_state(
                    c: Fmi3Instance, serialized_state: *const Fmi3Byte, size: usize,
                    f_m_u_state: *mut Fmi3FmuState) -> RawStatus;
                GetDirectionalDerivative: fmi3GetDirectionalDerivative = get_directional_derivative(
                    c: Fmi3Instance, unknowns: *const Fmi3ValueReference, n_unknowns: usize,
                    knowns: *const Fmi3ValueReference, n_knowns: usize, seed: *const Fmi3Float64, n_seed: usize,
                    sensitivity: *mut Fmi3Float64, n_sensitivity: usize) -> RawStatus;
                GetAdjointDerivative: fmi3GetAdjointDerivative = get_adjoint_derivative(
                    c: Fmi3Instance, unknowns: *const Fmi3ValueReference, n_unknowns: usize,
                    knowns: *const Fmi3ValueReference, n_knowns: usize, seed: *const Fmi3Float64, n_seed: usize,
                    sensitivity: *mut Fmi3Float64, n_sensitivity: usize) -> RawStatus;
                EnterConfigurationMode: fmi3EnterConfigurationMode = enter_configuration_mode(
                    c: Fmi3Instance) -> RawStatus;
                ExitConfigurationMode: fmi3ExitConfigurationMode = exit_configuration_mode(
                    c: Fmi3Instance) -> RawStatus;
                GetIntervalDecimal: fmi3GetIntervalDecimal = get_interval_decimal(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, intervals: *mut Fmi3Float64,
                    qualifiers: *mut RawIntervalQualifier) -> RawStatus;
                GetIntervalFraction: fmi3GetIntervalFraction = get_interval_fraction(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, counters: *mut Fmi3UInt64,
                    resolutions: *mut Fmi3UInt64, qualifiers: *mut RawIntervalQualifier) -> RawStatus;
                GetShiftDecimal: fmi3GetShiftDecimal = get_shift_decimal(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, shifts: *mut Fmi3Float64) -> RawStatus;
                GetShiftFraction: fmi3GetShiftFraction = get_shift_fraction(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, counters: *mut Fmi3UInt64,
                    resolutions: *mut Fmi3UInt64) -> RawStatus;
                SetIntervalDecimal: fmi3SetIntervalDecimal = set_interval_decimal(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize,
                    intervals: *const Fmi3Float64) -> RawStatus;
                SetIntervalFraction: fmi3SetIntervalFraction = set_interval_fraction(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, counters: *const Fmi3UInt64,
                    resolutions: *const Fmi3UInt64) -> RawStatus;
                SetShiftDecimal: fmi3SetShiftDecimal = set_shift_decimal(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize,
                    shifts: *const Fmi3Float64) -> RawStatus;
                SetShiftFraction: fmi3SetShiftFraction = set_shift_fraction(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, counters: *const Fmi3UInt64,
                    resolutions: *const Fmi3UInt64) -> RawStatus;
                EvaluateDiscreteStates: fmi3EvaluateDiscreteStates = evaluate_discrete_states(
                    c: Fmi3Instance) -> RawStatus;
                UpdateDiscreteStates: fmi3UpdateDiscreteStates = update_discrete_states(
                    c: Fmi3Instance, discrete_states_need_update: *mut Fmi3Boolean,
                    terminate_simulation: *mut Fmi3Boolean, nominals_of_continuous_states_changed: *mut Fmi3Boolean,
                    values_of_continuous_states_changed: *mut Fmi3Boolean, next_event_time_defined: *mut Fmi3Boolean,
                    next_event_time: *mut Fmi3Float64) -> RawStatus;
                EnterContinuousTimeMode: fmi3EnterContinuousTimeMode = enter_continuous_time_mode(
                    c: Fmi3Instance) -> RawStatus;
                CompletedIntegratorStep: fmi3CompletedIntegratorStep = completed_integrator_step(
                    c: Fmi3Instance, no_set_fmu_state_prior_to_current_point: Fmi3Boolean,
                    enter_event_mode: *mut Fmi3Boolean, terminate_simulation: *mut Fmi3Boolean) -> RawStatus;
                SetTime: fmi3SetTime = set_time(c: Fmi3Instance, time: Fmi3Float64) -> RawStatus;
                SetContinuousStates: fmi3SetContinuousStates = set_continuous_states(
                    c: Fmi3Instance, continuous_states: *const Fmi3Float64, n_continuous_states: usize) -> RawStatus;
                GetContinuousStateDerivatives: fmi3GetContinuousStateDerivatives = get_continuous_state_derivatives(
                    c: Fmi3Instance, derivatives: *mut Fmi3Float64, n_continuous_states: usize) -> RawStatus;
                GetEventIndicators: fmi3GetEventIndicators = get_event_indicators(
                    c: Fmi3Instance, event_indicators: *mut Fmi3Float64, n_event_indicators: usize) -> RawStatus;
                GetContinuousStates: fmi3GetContinuousStates = get_continuous_states(
                    c: Fmi3Instance, continuous_states: *mut Fmi3Float64, n_continuous_states: usize) -> RawStatus;
                GetNominalsOfContinuousStates: fmi3GetNominalsOfContinuousStates = get_nominals_of_continuous_states(
                    c: Fmi3Instance, nominals: *mut Fmi3Float64, n_continuous_states: usize) -> RawStatus;
                GetNumberOfEventIndicators: fmi3GetNumberOfEventIndicators = get_number_of_event_indicators(
                    c: Fmi3Instance, n_event_indicators: *mut usize) -> RawStatus;
                GetNumberOfContinuousStates: fmi3GetNumberOfContinuousStates = get_number_of_continuous_states(
                    c: Fmi3Instance, n_continuous_states: *mut usize) -> RawStatus;
                EnterStepMode: fmi3EnterStepMode = enter_step_mode(c: Fmi3Instance) -> RawStatus;
                GetOutputDerivatives: fmi3GetOutputDerivatives = get_output_derivatives(
                    c: Fmi3Instance, vr: *const Fmi3ValueReference, n: usize, orders: *const Fmi3Int32,
                    v: *mut Fmi3Float64, n_v: usize) -> RawStatus;
                DoStep: fmi3DoStep = do_step(
                    c: Fmi3Instance, current_communication_point: Fmi3Float64, communication_step_size: Fmi3Float64,
                    no_set_fmu_state_prior_to_current_point: Fmi3Boolean, event_handling_needed: *mut Fmi3Boolean,
                    terminate_simulation: *mut Fmi3Boolean, early_return: *mut Fmi3Boolean,
                    last_successful_time: *mut Fmi3Float64) -> RawStatus;
                ActivateModelPartition: fmi3ActivateModelPartition = activate_model_partition(
                    c: Fmi3Instance, clock_reference: Fmi3ValueReference, activation_time: Fmi3Float64) -> RawStatus;
            }
        }
    };
}

/// One exported function for each line, its signature held against that of the standard.
#[doc(hidden)]
#[macro_export]
macro_rules! __forward {
    ($(
        $signature:ident: $name:ident = $generic:ident($($argument:ident: $type:ty),*) -> $answer:ty;
    )*) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name($($argument: $type),*) -> $answer {
                // SAFETY: the host keeps its side of the standard, which is what the generic function asks for.
                unsafe { $crate::boundary::$generic::<Exported>($($argument),*) }
            }
            const _: functions::$signature = $name;
        )*
    };
}
