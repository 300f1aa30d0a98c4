//! Which function may be called when: the co-simulation state machine of FMI 3.0, sections 2.3 and 4.2, as a table.

use fmi_export::{ALIVE, Function};
use fmi_model::Phase;

use Phase::{Initialization, Instantiated, StepComplete};

const SET: &[Phase] = &[Instantiated, Initialization, StepComplete];

macro_rules! functions {
    ($($name:ident = $c_name:literal in $phases:expr;)*) => {
        $(pub(crate) const $name: Function = Function::new($c_name, $phases);)*
    };
}

functions! {
    INSTANTIATE_CO_SIMULATION = "fmi3InstantiateCoSimulation" in &[];
    INSTANTIATE_MODEL_EXCHANGE = "fmi3InstantiateModelExchange" in &[];
    INSTANTIATE_SCHEDULED_EXECUTION = "fmi3InstantiateScheduledExecution" in &[];
    FREE_INSTANCE = "fmi3FreeInstance" in ALIVE;
    SET_DEBUG_LOGGING = "fmi3SetDebugLogging" in ALIVE;
    ENTER_INITIALIZATION_MODE = "fmi3EnterInitializationMode" in &[Instantiated];
    EXIT_INITIALIZATION_MODE = "fmi3ExitInitializationMode" in &[Initialization];
    TERMINATE = "fmi3Terminate" in &[StepComplete];
    RESET = "fmi3Reset" in ALIVE;
    DO_STEP = "fmi3DoStep" in &[StepComplete];

    GET_FMU_STATE = "fmi3GetFMUState" in ALIVE;
    SET_FMU_STATE = "fmi3SetFMUState" in ALIVE;
    FREE_FMU_STATE = "fmi3FreeFMUState" in ALIVE;
    SERIALIZED_FMU_STATE_SIZE = "fmi3SerializedFMUStateSize" in ALIVE;
    SERIALIZE_FMU_STATE = "fmi3SerializeFMUState" in ALIVE;
    DESERIALIZE_FMU_STATE = "fmi3DeserializeFMUState" in ALIVE;

    // Start values can be read from the beginning.
    GET_FLOAT32 = "fmi3GetFloat32" in ALIVE;
    GET_FLOAT64 = "fmi3GetFloat64" in ALIVE;
    GET_INT8 = "fmi3GetInt8" in ALIVE;
    GET_UINT8 = "fmi3GetUInt8" in ALIVE;
    GET_INT16 = "fmi3GetInt16" in ALIVE;
    GET_UINT16 = "fmi3GetUInt16" in ALIVE;
    GET_INT32 = "fmi3GetInt32" in ALIVE;
    GET_UINT32 = "fmi3GetUInt32" in ALIVE;
    GET_INT64 = "fmi3GetInt64" in ALIVE;
    GET_UINT64 = "fmi3GetUInt64" in ALIVE;
    GET_BOOLEAN = "fmi3GetBoolean" in ALIVE;
    GET_STRING = "fmi3GetString" in ALIVE;
    GET_BINARY = "fmi3GetBinary" in ALIVE;
    GET_CLOCK = "fmi3GetClock" in ALIVE;
    SET_FLOAT32 = "fmi3SetFloat32" in SET;
    SET_FLOAT64 = "fmi3SetFloat64" in SET;
    SET_INT8 = "fmi3SetInt8" in SET;
    SET_UINT8 = "fmi3SetUInt8" in SET;
    SET_INT16 = "fmi3SetInt16" in SET;
    SET_UINT16 = "fmi3SetUInt16" in SET;
    SET_INT32 = "fmi3SetInt32" in SET;
    SET_UINT32 = "fmi3SetUInt32" in SET;
    SET_INT64 = "fmi3SetInt64" in SET;
    SET_UINT64 = "fmi3SetUInt64" in SET;
    SET_BOOLEAN = "fmi3SetBoolean" in SET;
    SET_STRING = "fmi3SetString" in SET;
    SET_BINARY = "fmi3SetBinary" in SET;
    SET_CLOCK = "fmi3SetClock" in SET;

    // What this FMU cannot do has no phase of its own: the reason is the same in all of them.
    GET_NUMBER_OF_VARIABLE_DEPENDENCIES = "fmi3GetNumberOfVariableDependencies" in ALIVE;
    GET_VARIABLE_DEPENDENCIES = "fmi3GetVariableDependencies" in ALIVE;
    GET_DIRECTIONAL_DERIVATIVE = "fmi3GetDirectionalDerivative" in ALIVE;
    GET_ADJOINT_DERIVATIVE = "fmi3GetAdjointDerivative" in ALIVE;
    ENTER_CONFIGURATION_MODE = "fmi3EnterConfigurationMode" in ALIVE;
    EXIT_CONFIGURATION_MODE = "fmi3ExitConfigurationMode" in ALIVE;
    GET_INTERVAL_DECIMAL = "fmi3GetIntervalDecimal" in ALIVE;
    GET_INTERVAL_FRACTION = "fmi3GetIntervalFraction" in ALIVE;
    GET_SHIFT_DECIMAL = "fmi3GetShiftDecimal" in ALIVE;
    GET_SHIFT_FRACTION = "fmi3GetShiftFraction" in ALIVE;
    SET_INTERVAL_DECIMAL = "fmi3SetIntervalDecimal" in ALIVE;
    SET_INTERVAL_FRACTION = "fmi3SetIntervalFraction" in ALIVE;
    SET_SHIFT_DECIMAL = "fmi3SetShiftDecimal" in ALIVE;
    SET_SHIFT_FRACTION = "fmi3SetShiftFraction" in ALIVE;
    ENTER_EVENT_MODE = "fmi3EnterEventMode" in ALIVE;
    ENTER_STEP_MODE = "fmi3EnterStepMode" in ALIVE;
    EVALUATE_DISCRETE_STATES = "fmi3EvaluateDiscreteStates" in ALIVE;
    UPDATE_DISCRETE_STATES = "fmi3UpdateDiscreteStates" in ALIVE;
    GET_OUTPUT_DERIVATIVES = "fmi3GetOutputDerivatives" in ALIVE;
    ENTER_CONTINUOUS_TIME_MODE = "fmi3EnterContinuousTimeMode" in ALIVE;
    COMPLETED_INTEGRATOR_STEP = "fmi3CompletedIntegratorStep" in ALIVE;
    SET_TIME = "fmi3SetTime" in ALIVE;
    SET_CONTINUOUS_STATES = "fmi3SetContinuousStates" in ALIVE;
    GET_CONTINUOUS_STATE_DERIVATIVES = "fmi3GetContinuousStateDerivatives" in ALIVE;
    GET_EVENT_INDICATORS = "fmi3GetEventIndicators" in ALIVE;
    GET_CONTINUOUS_STATES = "fmi3GetContinuousStates" in ALIVE;
    GET_NOMINALS_OF_CONTINUOUS_STATES = "fmi3GetNominalsOfContinuousStates" in ALIVE;
    GET_NUMBER_OF_EVENT_INDICATORS = "fmi3GetNumberOfEventIndicators" in ALIVE;
    GET_NUMBER_OF_CONTINUOUS_STATES = "fmi3GetNumberOfContinuousStates" in ALIVE;
    ACTIVATE_MODEL_PARTITION = "fmi3ActivateModelPartition" in ALIVE;
}
