//! Which function may be called when: the co-simulation state machine of FMI 2.0.3, section 4.2.4, as a table.

use fmi_export::{ALIVE, Function};
use fmi_model::Phase;

use Phase::{Failed, Initialization, Instantiated, StepComplete, Terminated};

const SET: &[Phase] = &[Instantiated, Initialization, StepComplete];
const GET: &[Phase] = &[Initialization, StepComplete, Failed, Terminated];
const AFTER_STEPS: &[Phase] = &[StepComplete, Failed, Terminated];

pub(crate) const INSTANTIATE: Function = Function::new("fmi2Instantiate", &[]);
pub(crate) const FREE_INSTANCE: Function = Function::new("fmi2FreeInstance", ALIVE);
pub(crate) const SET_DEBUG_LOGGING: Function = Function::new("fmi2SetDebugLogging", ALIVE);
pub(crate) const SETUP_EXPERIMENT: Function = Function::new("fmi2SetupExperiment", &[Instantiated]);
pub(crate) const ENTER_INITIALIZATION_MODE: Function = Function::new("fmi2EnterInitializationMode", &[Instantiated]);
pub(crate) const EXIT_INITIALIZATION_MODE: Function = Function::new("fmi2ExitInitializationMode", &[Initialization]);
pub(crate) const TERMINATE: Function = Function::new("fmi2Terminate", &[StepComplete]);
pub(crate) const RESET: Function = Function::new("fmi2Reset", ALIVE);

pub(crate) const GET_REAL: Function = Function::new("fmi2GetReal", GET);
pub(crate) const GET_INTEGER: Function = Function::new("fmi2GetInteger", GET);
pub(crate) const GET_BOOLEAN: Function = Function::new("fmi2GetBoolean", GET);
pub(crate) const GET_STRING: Function = Function::new("fmi2GetString", GET);
pub(crate) const SET_REAL: Function = Function::new("fmi2SetReal", SET);
pub(crate) const SET_INTEGER: Function = Function::new("fmi2SetInteger", SET);
pub(crate) const SET_BOOLEAN: Function = Function::new("fmi2SetBoolean", SET);
pub(crate) const SET_STRING: Function = Function::new("fmi2SetString", SET);

pub(crate) const GET_FMU_STATE: Function = Function::new("fmi2GetFMUstate", ALIVE);
pub(crate) const SET_FMU_STATE: Function = Function::new("fmi2SetFMUstate", ALIVE);
pub(crate) const FREE_FMU_STATE: Function = Function::new("fmi2FreeFMUstate", ALIVE);
pub(crate) const SERIALIZED_FMU_STATE_SIZE: Function = Function::new("fmi2SerializedFMUstateSize", ALIVE);
pub(crate) const SERIALIZE_FMU_STATE: Function = Function::new("fmi2SerializeFMUstate", ALIVE);
pub(crate) const DE_SERIALIZE_FMU_STATE: Function = Function::new("fmi2DeSerializeFMUstate", ALIVE);

pub(crate) const DO_STEP: Function = Function::new("fmi2DoStep", &[StepComplete]);
pub(crate) const GET_STATUS: Function = Function::new("fmi2GetStatus", AFTER_STEPS);
pub(crate) const GET_REAL_STATUS: Function = Function::new("fmi2GetRealStatus", AFTER_STEPS);
pub(crate) const GET_INTEGER_STATUS: Function = Function::new("fmi2GetIntegerStatus", AFTER_STEPS);
pub(crate) const GET_BOOLEAN_STATUS: Function = Function::new("fmi2GetBooleanStatus", AFTER_STEPS);
pub(crate) const GET_STRING_STATUS: Function = Function::new("fmi2GetStringStatus", AFTER_STEPS);

// What this FMU cannot do has no phase of its own: the reason is the same in all of them.
pub(crate) const CANCEL_STEP: Function = Function::new("fmi2CancelStep", ALIVE);
pub(crate) const SET_REAL_INPUT_DERIVATIVES: Function = Function::new("fmi2SetRealInputDerivatives", ALIVE);
pub(crate) const GET_REAL_OUTPUT_DERIVATIVES: Function = Function::new("fmi2GetRealOutputDerivatives", ALIVE);
pub(crate) const GET_DIRECTIONAL_DERIVATIVE: Function = Function::new("fmi2GetDirectionalDerivative", ALIVE);
pub(crate) const ENTER_EVENT_MODE: Function = Function::new("fmi2EnterEventMode", ALIVE);
pub(crate) const NEW_DISCRETE_STATES: Function = Function::new("fmi2NewDiscreteStates", ALIVE);
pub(crate) const ENTER_CONTINUOUS_TIME_MODE: Function = Function::new("fmi2EnterContinuousTimeMode", ALIVE);
pub(crate) const COMPLETED_INTEGRATOR_STEP: Function = Function::new("fmi2CompletedIntegratorStep", ALIVE);
pub(crate) const SET_TIME: Function = Function::new("fmi2SetTime", ALIVE);
pub(crate) const SET_CONTINUOUS_STATES: Function = Function::new("fmi2SetContinuousStates", ALIVE);
pub(crate) const GET_DERIVATIVES: Function = Function::new("fmi2GetDerivatives", ALIVE);
pub(crate) const GET_EVENT_INDICATORS: Function = Function::new("fmi2GetEventIndicators", ALIVE);
pub(crate) const GET_CONTINUOUS_STATES: Function = Function::new("fmi2GetContinuousStates", ALIVE);
pub(crate) const GET_NOMINALS_OF_CONTINUOUS_STATES: Function =
    Function::new("fmi2GetNominalsOfContinuousStates", ALIVE);
