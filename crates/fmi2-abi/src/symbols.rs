//! The functions that an FMU exports: the name of each with its type, so that whoever looks one up cannot take it for another.

use std::marker::PhantomData;

use crate::functions as f;

/// A function of the standard: its name, and its type `F`.
#[derive(Debug)]
pub struct Symbol<F> {
    /// Name in the library.
    pub name: &'static str,
    of: PhantomData<F>,
}

macro_rules! symbols {
    ($($symbol:ident: $type:ident = $name:literal;)*) => {
        $(
            #[doc = concat!("`", $name, "`.")]
            pub const $symbol: Symbol<f::$type> = Symbol { name: $name, of: PhantomData };
        )*
    };
}

symbols! {
    GET_TYPES_PLATFORM: GetTypesPlatform = "fmi2GetTypesPlatform";
    GET_VERSION: GetVersion = "fmi2GetVersion";
    SET_DEBUG_LOGGING: SetDebugLogging = "fmi2SetDebugLogging";
    INSTANTIATE: Instantiate = "fmi2Instantiate";
    FREE_INSTANCE: FreeInstance = "fmi2FreeInstance";
    SETUP_EXPERIMENT: SetupExperiment = "fmi2SetupExperiment";
    ENTER_INITIALIZATION_MODE: EnterInitializationMode = "fmi2EnterInitializationMode";
    EXIT_INITIALIZATION_MODE: ExitInitializationMode = "fmi2ExitInitializationMode";
    TERMINATE: Terminate = "fmi2Terminate";
    RESET: Reset = "fmi2Reset";
    GET_REAL: GetReal = "fmi2GetReal";
    GET_INTEGER: GetInteger = "fmi2GetInteger";
    GET_BOOLEAN: GetBoolean = "fmi2GetBoolean";
    GET_STRING: GetString = "fmi2GetString";
    SET_REAL: SetReal = "fmi2SetReal";
    SET_INTEGER: SetInteger = "fmi2SetInteger";
    SET_BOOLEAN: SetBoolean = "fmi2SetBoolean";
    SET_STRING: SetString = "fmi2SetString";
    GET_FMU_STATE: GetFmuState = "fmi2GetFMUstate";
    SET_FMU_STATE: SetFmuState = "fmi2SetFMUstate";
    FREE_FMU_STATE: FreeFmuState = "fmi2FreeFMUstate";
    SERIALIZED_FMU_STATE_SIZE: SerializedFmuStateSize = "fmi2SerializedFMUstateSize";
    SERIALIZE_FMU_STATE: SerializeFmuState = "fmi2SerializeFMUstate";
    DE_SERIALIZE_FMU_STATE: DeSerializeFmuState = "fmi2DeSerializeFMUstate";
    GET_DIRECTIONAL_DERIVATIVE: GetDirectionalDerivative = "fmi2GetDirectionalDerivative";
    SET_REAL_INPUT_DERIVATIVES: SetRealInputDerivatives = "fmi2SetRealInputDerivatives";
    GET_REAL_OUTPUT_DERIVATIVES: GetRealOutputDerivatives = "fmi2GetRealOutputDerivatives";
    DO_STEP: DoStep = "fmi2DoStep";
    CANCEL_STEP: CancelStep = "fmi2CancelStep";
    GET_STATUS: GetStatus = "fmi2GetStatus";
    GET_REAL_STATUS: GetRealStatus = "fmi2GetRealStatus";
    GET_INTEGER_STATUS: GetIntegerStatus = "fmi2GetIntegerStatus";
    GET_BOOLEAN_STATUS: GetBooleanStatus = "fmi2GetBooleanStatus";
    GET_STRING_STATUS: GetStringStatus = "fmi2GetStringStatus";
    ENTER_EVENT_MODE: EnterEventMode = "fmi2EnterEventMode";
    NEW_DISCRETE_STATES: NewDiscreteStates = "fmi2NewDiscreteStates";
    ENTER_CONTINUOUS_TIME_MODE: EnterContinuousTimeMode = "fmi2EnterContinuousTimeMode";
    COMPLETED_INTEGRATOR_STEP: CompletedIntegratorStep = "fmi2CompletedIntegratorStep";
    SET_TIME: SetTime = "fmi2SetTime";
    SET_CONTINUOUS_STATES: SetContinuousStates = "fmi2SetContinuousStates";
    GET_DERIVATIVES: GetDerivatives = "fmi2GetDerivatives";
    GET_EVENT_INDICATORS: GetEventIndicators = "fmi2GetEventIndicators";
    GET_CONTINUOUS_STATES: GetContinuousStates = "fmi2GetContinuousStates";
    GET_NOMINALS_OF_CONTINUOUS_STATES: GetNominalsOfContinuousStates = "fmi2GetNominalsOfContinuousStates";
}
