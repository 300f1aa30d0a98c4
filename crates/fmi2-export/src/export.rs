//! The macro that gives a library its C functions.

/// Exports every function of FMI 2.0 for a [`Model`](crate::Model), in a module `fmi2`. One per library, at its top:
/// `export_fmu!(NavModel);`.
///
/// The functions only forward; see [`Model`](crate::Model) for what reaches the model. For the host:
///
/// - Every call runs under one panic guard. After a panic the instance answers `fmi2Fatal` and can only be freed; nothing is printed.
/// - A step that the model does not take ([`Model::check_step`](crate::Model::check_step): too long, or with inputs that make no
///   sense) is `fmi2Discard` and changes nothing; any other refused call (out of order, unknown or unfit variable, value out of
///   bounds, times that do not fit) is `fmi2Error` and changes nothing. The instance stays usable. Status queries are `fmi2Discard`
///   where the standard wants a pending step.
/// - While logging is on, the logger is told why a call ended in something else than `fmi2OK`, and more, under the categories
///   that the host has asked for. While it is off, the logger is not called at all. Callbacks, or some of them, may be null.
/// - An error of the model while it initialises or steps ends in `fmi2Error`; variables can then still be read, and
///   `fmi2Reset` or `fmi2SetFMUstate` bring the instance back.
/// - Calls on one instance must not overlap; those that do are refused. Instances are independent of each other.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        type Fmi2ExportedModel = $model;

        impl $crate::Exported<$crate::Fmi2> for $model {
            fn guid_cell() -> &'static $crate::GuidCell {
                static CELL: $crate::GuidCell = $crate::GuidCell::new();
                &CELL
            }
        }

        /// The functions of FMI 2.0, under their C names.
        #[allow(unsafe_code, missing_docs, non_snake_case)]
        #[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
        pub mod fmi2 {
            use super::Fmi2ExportedModel as Exported;
            use $crate::abi::*;

            #[unsafe(no_mangle)]
            pub extern "C" fn fmi2GetTypesPlatform() -> *const ::std::ffi::c_char {
                $crate::boundary::get_types_platform()
            }
            const _: functions::GetTypesPlatform = fmi2GetTypesPlatform;

            #[unsafe(no_mangle)]
            pub extern "C" fn fmi2GetVersion() -> *const ::std::ffi::c_char {
                $crate::boundary::get_version()
            }
            const _: functions::GetVersion = fmi2GetVersion;

            $crate::__forward! {
                SetDebugLogging: fmi2SetDebugLogging = set_debug_logging(
                    c: Fmi2Component, on: Fmi2Boolean, n: usize, categories: *const Fmi2String) -> RawStatus;
                Instantiate: fmi2Instantiate = instantiate(
                    name: Fmi2String, kind: ::std::ffi::c_int, guid: Fmi2String, resources: Fmi2String,
                    functions: *const Fmi2CallbackFunctions, visible: Fmi2Boolean, on: Fmi2Boolean) -> Fmi2Component;
                FreeInstance: fmi2FreeInstance = free_instance(c: Fmi2Component) -> ();
                SetupExperiment: fmi2SetupExperiment = setup_experiment(
                    c: Fmi2Component, tolerance_defined: Fmi2Boolean, tolerance: Fmi2Real,
                    start: Fmi2Real, stop_defined: Fmi2Boolean, stop: Fmi2Real) -> RawStatus;
                EnterInitializationMode: fmi2EnterInitializationMode =
                    enter_initialization_mode(c: Fmi2Component) -> RawStatus;
                ExitInitializationMode: fmi2ExitInitializationMode =
                    exit_initialization_mode(c: Fmi2Component) -> RawStatus;
                Terminate: fmi2Terminate = terminate(c: Fmi2Component) -> RawStatus;
                Reset: fmi2Reset = reset(c: Fmi2Component) -> RawStatus;

                GetReal: fmi2GetReal = get_real(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *mut Fmi2Real) -> RawStatus;
                GetInteger: fmi2GetInteger = get_integer(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *mut Fmi2Integer) -> RawStatus;
                GetBoolean: fmi2GetBoolean = get_boolean(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *mut Fmi2Boolean) -> RawStatus;
                GetString: fmi2GetString = get_string(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *mut Fmi2String) -> RawStatus;
                SetReal: fmi2SetReal = set_real(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *const Fmi2Real) -> RawStatus;
                SetInteger: fmi2SetInteger = set_integer(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *const Fmi2Integer) -> RawStatus;
                SetBoolean: fmi2SetBoolean = set_boolean(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *const Fmi2Boolean) -> RawStatus;
                SetString: fmi2SetString = set_string(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize, v: *const Fmi2String) -> RawStatus;

                GetFmuState: fmi2GetFMUstate = get_fmu_state(
                    c: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus;
                SetFmuState: fmi2SetFMUstate = set_fmu_state(
                    c: Fmi2Component, state: Fmi2FmuState) -> RawStatus;
                FreeFmuState: fmi2FreeFMUstate = free_fmu_state(
                    c: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus;
                SerializedFmuStateSize: fmi2SerializedFMUstateSize = serialized_fmu_state_size(
                    c: Fmi2Component, state: Fmi2FmuState, size: *mut usize) -> RawStatus;
                SerializeFmuState: fmi2SerializeFMUstate = serialize_fmu_state(
                    c: Fmi2Component, state: Fmi2FmuState, bytes: *mut Fmi2Byte, n: usize) -> RawStatus;
                DeSerializeFmuState: fmi2DeSerializeFMUstate = de_serialize_fmu_state(
                    c: Fmi2Component, bytes: *const Fmi2Byte, n: usize, state: *mut Fmi2FmuState) -> RawStatus;
                GetDirectionalDerivative: fmi2GetDirectionalDerivative = get_directional_derivative(
                    c: Fmi2Component, unknowns: *const Fmi2ValueReference, unknown_count: usize,
                    knowns: *const Fmi2ValueReference, known_count: usize,
                    seed: *const Fmi2Real, result: *mut Fmi2Real) -> RawStatus;

                SetRealInputDerivatives: fmi2SetRealInputDerivatives = set_real_input_derivatives(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize,
                    orders: *const Fmi2Integer, v: *const Fmi2Real) -> RawStatus;
                GetRealOutputDerivatives: fmi2GetRealOutputDerivatives = get_real_output_derivatives(
                    c: Fmi2Component, vr: *const Fmi2ValueReference, n: usize,
                    orders: *const Fmi2Integer, v: *mut Fmi2Real) -> RawStatus;
                DoStep: fmi2DoStep = do_step(
                    c: Fmi2Component, t: Fmi2Real, h: Fmi2Real, no_state_set: Fmi2Boolean) -> RawStatus;
                CancelStep: fmi2CancelStep = cancel_step(c: Fmi2Component) -> RawStatus;
                GetStatus: fmi2GetStatus = get_status(
                    c: Fmi2Component, kind: ::std::ffi::c_int, v: *mut RawStatus) -> RawStatus;
                GetRealStatus: fmi2GetRealStatus = get_real_status(
                    c: Fmi2Component, kind: ::std::ffi::c_int, v: *mut Fmi2Real) -> RawStatus;
                GetIntegerStatus: fmi2GetIntegerStatus = get_integer_status(
                    c: Fmi2Component, kind: ::std::ffi::c_int, v: *mut Fmi2Integer) -> RawStatus;
                GetBooleanStatus: fmi2GetBooleanStatus = get_boolean_status(
                    c: Fmi2Component, kind: ::std::ffi::c_int, v: *mut Fmi2Boolean) -> RawStatus;
                GetStringStatus: fmi2GetStringStatus = get_string_status(
                    c: Fmi2Component, kind: ::std::ffi::c_int, v: *mut Fmi2String) -> RawStatus;

                EnterEventMode: fmi2EnterEventMode = enter_event_mode(c: Fmi2Component) -> RawStatus;
                NewDiscreteStates: fmi2NewDiscreteStates = new_discrete_states(
                    c: Fmi2Component, info: *mut Fmi2EventInfo) -> RawStatus;
                EnterContinuousTimeMode: fmi2EnterContinuousTimeMode =
                    enter_continuous_time_mode(c: Fmi2Component) -> RawStatus;
                CompletedIntegratorStep: fmi2CompletedIntegratorStep = completed_integrator_step(
                    c: Fmi2Component, no_state_set: Fmi2Boolean,
                    enter_event_mode: *mut Fmi2Boolean, terminate: *mut Fmi2Boolean) -> RawStatus;
                SetTime: fmi2SetTime = set_time(c: Fmi2Component, t: Fmi2Real) -> RawStatus;
                SetContinuousStates: fmi2SetContinuousStates = set_continuous_states(
                    c: Fmi2Component, x: *const Fmi2Real, n: usize) -> RawStatus;
                GetDerivatives: fmi2GetDerivatives = get_derivatives(
                    c: Fmi2Component, x: *mut Fmi2Real, n: usize) -> RawStatus;
                GetEventIndicators: fmi2GetEventIndicators = get_event_indicators(
                    c: Fmi2Component, x: *mut Fmi2Real, n: usize) -> RawStatus;
                GetContinuousStates: fmi2GetContinuousStates = get_continuous_states(
                    c: Fmi2Component, x: *mut Fmi2Real, n: usize) -> RawStatus;
                GetNominalsOfContinuousStates: fmi2GetNominalsOfContinuousStates =
                    get_nominals_of_continuous_states(
                        c: Fmi2Component, x: *mut Fmi2Real, n: usize) -> RawStatus;
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
