//! Which function may be called when: the co-simulation state machine of FMI 2.0.3, section 4.2.4, as a table.

use fmi_model::Phase;

use crate::error::CallError;

use Phase::{Failed, Initialization, Instantiated, StepComplete, Terminated};

/// A function of the standard and the phases in which it may be called.
#[derive(Debug)]
pub(crate) struct Function {
    /// Its name in C.
    pub(crate) name: &'static str,
    allowed: &'static [Phase],
}

const fn function(name: &'static str, allowed: &'static [Phase]) -> Function {
    Function { name, allowed }
}

impl Function {
    /// Refuses a call in the wrong phase.
    pub(crate) fn check(&self, phase: Phase) -> Result<(), CallError> {
        if self.allowed.contains(&phase) {
            return Ok(());
        }
        let allowed: Vec<_> = self.allowed.iter().map(Phase::to_string).collect();
        Err(CallError::CallOrder {
            phase,
            allowed: allowed.join(", "),
        })
    }
}

/// Any phase but fatal, in which nothing is answered.
const ALIVE: &[Phase] = &[Instantiated, Initialization, StepComplete, Failed, Terminated];
const SET: &[Phase] = &[Instantiated, Initialization, StepComplete];
const GET: &[Phase] = &[Initialization, StepComplete, Failed, Terminated];
const AFTER_STEPS: &[Phase] = &[StepComplete, Failed, Terminated];

pub(crate) const INSTANTIATE: Function = function("fmi2Instantiate", &[]);
pub(crate) const FREE_INSTANCE: Function = function("fmi2FreeInstance", ALIVE);
pub(crate) const SET_DEBUG_LOGGING: Function = function("fmi2SetDebugLogging", ALIVE);
pub(crate) const SETUP_EXPERIMENT: Function = function("fmi2SetupExperiment", &[Instantiated]);
pub(crate) const ENTER_INITIALIZATION_MODE: Function = function("fmi2EnterInitializationMode", &[Instantiated]);
pub(crate) const EXIT_INITIALIZATION_MODE: Function = function("fmi2ExitInitializationMode", &[Initialization]);
pub(crate) const TERMINATE: Function = function("fmi2Terminate", &[StepComplete]);
pub(crate) const RESET: Function = function("fmi2Reset", ALIVE);

pub(crate) const GET_REAL: Function = function("fmi2GetReal", GET);
pub(crate) const GET_INTEGER: Function = function("fmi2GetInteger", GET);
pub(crate) const GET_BOOLEAN: Function = function("fmi2GetBoolean", GET);
pub(crate) const GET_STRING: Function = function("fmi2GetString", GET);
pub(crate) const SET_REAL: Function = function("fmi2SetReal", SET);
pub(crate) const SET_INTEGER: Function = function("fmi2SetInteger", SET);
pub(crate) const SET_BOOLEAN: Function = function("fmi2SetBoolean", SET);
pub(crate) const SET_STRING: Function = function("fmi2SetString", SET);

pub(crate) const GET_FMU_STATE: Function = function("fmi2GetFMUstate", ALIVE);
pub(crate) const SET_FMU_STATE: Function = function("fmi2SetFMUstate", ALIVE);
pub(crate) const FREE_FMU_STATE: Function = function("fmi2FreeFMUstate", ALIVE);
pub(crate) const SERIALIZED_FMU_STATE_SIZE: Function = function("fmi2SerializedFMUstateSize", ALIVE);
pub(crate) const SERIALIZE_FMU_STATE: Function = function("fmi2SerializeFMUstate", ALIVE);
pub(crate) const DE_SERIALIZE_FMU_STATE: Function = function("fmi2DeSerializeFMUstate", ALIVE);

pub(crate) const DO_STEP: Function = function("fmi2DoStep", &[StepComplete]);
pub(crate) const GET_STATUS: Function = function("fmi2GetStatus", AFTER_STEPS);
pub(crate) const GET_REAL_STATUS: Function = function("fmi2GetRealStatus", AFTER_STEPS);
pub(crate) const GET_INTEGER_STATUS: Function = function("fmi2GetIntegerStatus", AFTER_STEPS);
pub(crate) const GET_BOOLEAN_STATUS: Function = function("fmi2GetBooleanStatus", AFTER_STEPS);
pub(crate) const GET_STRING_STATUS: Function = function("fmi2GetStringStatus", AFTER_STEPS);

// What this FMU cannot do has no phase of its own: the reason is the same in all of them.
pub(crate) const CANCEL_STEP: Function = function("fmi2CancelStep", ALIVE);
pub(crate) const SET_REAL_INPUT_DERIVATIVES: Function = function("fmi2SetRealInputDerivatives", ALIVE);
pub(crate) const GET_REAL_OUTPUT_DERIVATIVES: Function = function("fmi2GetRealOutputDerivatives", ALIVE);
pub(crate) const GET_DIRECTIONAL_DERIVATIVE: Function = function("fmi2GetDirectionalDerivative", ALIVE);
pub(crate) const ENTER_EVENT_MODE: Function = function("fmi2EnterEventMode", ALIVE);
pub(crate) const NEW_DISCRETE_STATES: Function = function("fmi2NewDiscreteStates", ALIVE);
pub(crate) const ENTER_CONTINUOUS_TIME_MODE: Function = function("fmi2EnterContinuousTimeMode", ALIVE);
pub(crate) const COMPLETED_INTEGRATOR_STEP: Function = function("fmi2CompletedIntegratorStep", ALIVE);
pub(crate) const SET_TIME: Function = function("fmi2SetTime", ALIVE);
pub(crate) const SET_CONTINUOUS_STATES: Function = function("fmi2SetContinuousStates", ALIVE);
pub(crate) const GET_DERIVATIVES: Function = function("fmi2GetDerivatives", ALIVE);
pub(crate) const GET_EVENT_INDICATORS: Function = function("fmi2GetEventIndicators", ALIVE);
pub(crate) const GET_CONTINUOUS_STATES: Function = function("fmi2GetContinuousStates", ALIVE);
pub(crate) const GET_NOMINALS_OF_CONTINUOUS_STATES: Function = function("fmi2GetNominalsOfContinuousStates", ALIVE);
