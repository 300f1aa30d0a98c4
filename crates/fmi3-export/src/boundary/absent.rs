//! What this FMU does not have: there for hosts that resolve every symbol, and each answered with the reason why not.

use fmi_export::{CallError, Exported, call};
use fmi3_abi::{
    Fmi3Boolean, Fmi3Float64, Fmi3Instance, Fmi3Int32, Fmi3UInt64, Fmi3ValueReference, RawDependencyKind,
    RawIntervalQualifier, RawStatus,
};

use crate::order;
use crate::version::Fmi3;

macro_rules! absent {
    ($why:expr; $($name:ident($($argument:ty),*) as $function:ident;)*) => {
        $(
            #[allow(clippy::too_many_arguments, reason = "those of the standard")]
            pub unsafe fn $name<M: Exported<Fmi3>>(instance: Fmi3Instance, $(_: $argument),*) -> RawStatus {
                // SAFETY: see the module above; the other arguments are not looked at.
                unsafe { call::<Fmi3, M>(instance, &order::$function, |_| Err($why)) }
            }
        )*
    };
}

absent! {
    CallError::NotSupported {
        why: "there are no dependencies by element (providesPerElementDependencies = false)",
    };
    get_number_of_variable_dependencies(Fmi3ValueReference, *mut usize) as GET_NUMBER_OF_VARIABLE_DEPENDENCIES;
    get_variable_dependencies(Fmi3ValueReference, *mut usize, *mut Fmi3ValueReference, *mut usize, *mut RawDependencyKind, usize) as GET_VARIABLE_DEPENDENCIES;
}

absent! {
    CallError::NotSupported {
        why: "there are no partial derivatives (providesDirectionalDerivatives = false)",
    };
    get_directional_derivative(*const Fmi3ValueReference, usize, *const Fmi3ValueReference, usize, *const Fmi3Float64, usize, *mut Fmi3Float64, usize) as GET_DIRECTIONAL_DERIVATIVE;
}

absent! {
    CallError::NotSupported {
        why: "there are no partial derivatives (providesAdjointDerivatives = false)",
    };
    get_adjoint_derivative(*const Fmi3ValueReference, usize, *const Fmi3ValueReference, usize, *const Fmi3Float64, usize, *mut Fmi3Float64, usize) as GET_ADJOINT_DERIVATIVE;
}

absent! {
    CallError::NotSupported {
        why: "there are no structural parameters to configure",
    };
    enter_configuration_mode() as ENTER_CONFIGURATION_MODE;
    exit_configuration_mode() as EXIT_CONFIGURATION_MODE;
}

absent! {
    CallError::NotSupported {
        why: "there are no clocks",
    };
    get_interval_decimal(*const Fmi3ValueReference, usize, *mut Fmi3Float64, *mut RawIntervalQualifier) as GET_INTERVAL_DECIMAL;
    get_interval_fraction(*const Fmi3ValueReference, usize, *mut Fmi3UInt64, *mut Fmi3UInt64, *mut RawIntervalQualifier) as GET_INTERVAL_FRACTION;
    get_shift_decimal(*const Fmi3ValueReference, usize, *mut Fmi3Float64) as GET_SHIFT_DECIMAL;
    get_shift_fraction(*const Fmi3ValueReference, usize, *mut Fmi3UInt64, *mut Fmi3UInt64) as GET_SHIFT_FRACTION;
    set_interval_decimal(*const Fmi3ValueReference, usize, *const Fmi3Float64) as SET_INTERVAL_DECIMAL;
    set_interval_fraction(*const Fmi3ValueReference, usize, *const Fmi3UInt64, *const Fmi3UInt64) as SET_INTERVAL_FRACTION;
    set_shift_decimal(*const Fmi3ValueReference, usize, *const Fmi3Float64) as SET_SHIFT_DECIMAL;
    set_shift_fraction(*const Fmi3ValueReference, usize, *const Fmi3UInt64, *const Fmi3UInt64) as SET_SHIFT_FRACTION;
}

absent! {
    CallError::NotSupported {
        why: "there is no event mode (hasEventMode = false)",
    };
    enter_event_mode() as ENTER_EVENT_MODE;
    enter_step_mode() as ENTER_STEP_MODE;
    evaluate_discrete_states() as EVALUATE_DISCRETE_STATES;
    update_discrete_states(*mut Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Float64) as UPDATE_DISCRETE_STATES;
}

absent! {
    CallError::NotSupported {
        why: "outputs have no derivatives (maxOutputDerivativeOrder = 0)",
    };
    get_output_derivatives(*const Fmi3ValueReference, usize, *const Fmi3Int32, *mut Fmi3Float64, usize) as GET_OUTPUT_DERIVATIVES;
}

// Of the other two interfaces.
absent! {
    CallError::CoSimulationOnly;
    enter_continuous_time_mode() as ENTER_CONTINUOUS_TIME_MODE;
    completed_integrator_step(Fmi3Boolean, *mut Fmi3Boolean, *mut Fmi3Boolean) as COMPLETED_INTEGRATOR_STEP;
    set_time(Fmi3Float64) as SET_TIME;
    set_continuous_states(*const Fmi3Float64, usize) as SET_CONTINUOUS_STATES;
    get_continuous_state_derivatives(*mut Fmi3Float64, usize) as GET_CONTINUOUS_STATE_DERIVATIVES;
    get_event_indicators(*mut Fmi3Float64, usize) as GET_EVENT_INDICATORS;
    get_continuous_states(*mut Fmi3Float64, usize) as GET_CONTINUOUS_STATES;
    get_nominals_of_continuous_states(*mut Fmi3Float64, usize) as GET_NOMINALS_OF_CONTINUOUS_STATES;
    get_number_of_event_indicators(*mut usize) as GET_NUMBER_OF_EVENT_INDICATORS;
    get_number_of_continuous_states(*mut usize) as GET_NUMBER_OF_CONTINUOUS_STATES;
    activate_model_partition(Fmi3ValueReference, Fmi3Float64) as ACTIVATE_MODEL_PARTITION;
}
