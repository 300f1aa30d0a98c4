//! Names of the functions of the standard, by what they are for.

use fmi2_abi::symbols;

/// Functions of one purpose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Group {
    /// The flag in the description that offers them; nothing for what every FMU has.
    pub(crate) flag: Option<&'static str>,
    pub(crate) names: &'static [&'static str],
}

const STATES: Group = Group {
    flag: Some("canGetAndSetFMUstate"),
    names: &[
        symbols::GET_FMU_STATE.name,
        symbols::SET_FMU_STATE.name,
        symbols::FREE_FMU_STATE.name,
    ],
};
const SERIALIZATION: Group = Group {
    flag: Some("canSerializeFMUstate"),
    names: &[
        symbols::SERIALIZED_FMU_STATE_SIZE.name,
        symbols::SERIALIZE_FMU_STATE.name,
        symbols::DE_SERIALIZE_FMU_STATE.name,
    ],
};
const DERIVATIVES: Group = Group {
    flag: Some("providesDirectionalDerivative"),
    names: &[symbols::GET_DIRECTIONAL_DERIVATIVE.name],
};
const COMMON: Group = Group {
    flag: None,
    names: &[
        symbols::GET_TYPES_PLATFORM.name,
        symbols::GET_VERSION.name,
        symbols::SET_DEBUG_LOGGING.name,
        symbols::INSTANTIATE.name,
        symbols::FREE_INSTANCE.name,
        symbols::SETUP_EXPERIMENT.name,
        symbols::ENTER_INITIALIZATION_MODE.name,
        symbols::EXIT_INITIALIZATION_MODE.name,
        symbols::TERMINATE.name,
        symbols::RESET.name,
        symbols::GET_REAL.name,
        symbols::GET_INTEGER.name,
        symbols::GET_BOOLEAN.name,
        symbols::GET_STRING.name,
        symbols::SET_REAL.name,
        symbols::SET_INTEGER.name,
        symbols::SET_BOOLEAN.name,
        symbols::SET_STRING.name,
    ],
};

/// Of a co-simulation FMU.
pub(crate) const CO_SIMULATION: &[Group] = &[
    COMMON,
    Group {
        flag: None,
        names: &[
            symbols::DO_STEP.name,
            symbols::CANCEL_STEP.name,
            symbols::GET_STATUS.name,
            symbols::GET_REAL_STATUS.name,
            symbols::GET_INTEGER_STATUS.name,
            symbols::GET_BOOLEAN_STATUS.name,
            symbols::GET_STRING_STATUS.name,
        ],
    },
    Group {
        flag: Some("canInterpolateInputs"),
        names: &[symbols::SET_REAL_INPUT_DERIVATIVES.name],
    },
    Group {
        flag: Some("maxOutputDerivativeOrder"),
        names: &[symbols::GET_REAL_OUTPUT_DERIVATIVES.name],
    },
    STATES,
    SERIALIZATION,
    DERIVATIVES,
];

/// Of a model-exchange FMU.
pub(crate) const MODEL_EXCHANGE: &[Group] = &[
    COMMON,
    Group {
        flag: None,
        names: &[
            symbols::ENTER_EVENT_MODE.name,
            symbols::NEW_DISCRETE_STATES.name,
            symbols::ENTER_CONTINUOUS_TIME_MODE.name,
            symbols::COMPLETED_INTEGRATOR_STEP.name,
            symbols::SET_TIME.name,
            symbols::SET_CONTINUOUS_STATES.name,
            symbols::GET_DERIVATIVES.name,
            symbols::GET_EVENT_INDICATORS.name,
            symbols::GET_CONTINUOUS_STATES.name,
            symbols::GET_NOMINALS_OF_CONTINUOUS_STATES.name,
        ],
    },
    STATES,
    SERIALIZATION,
    DERIVATIVES,
];
