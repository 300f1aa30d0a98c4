//! Names of the functions of the standard, by what they are for.

/// Functions of one purpose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Group {
    /// The flag in the description that offers them; nothing for what every FMU has.
    pub(crate) flag: Option<&'static str>,
    pub(crate) names: &'static [&'static str],
}

const STATES: Group = Group {
    flag: Some("canGetAndSetFMUstate"),
    names: &["fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate"],
};
const SERIALIZATION: Group = Group {
    flag: Some("canSerializeFMUstate"),
    names: &[
        "fmi2SerializedFMUstateSize",
        "fmi2SerializeFMUstate",
        "fmi2DeSerializeFMUstate",
    ],
};
const DERIVATIVES: Group = Group {
    flag: Some("providesDirectionalDerivative"),
    names: &["fmi2GetDirectionalDerivative"],
};
const COMMON: Group = Group {
    flag: None,
    names: &[
        "fmi2GetTypesPlatform",
        "fmi2GetVersion",
        "fmi2SetDebugLogging",
        "fmi2Instantiate",
        "fmi2FreeInstance",
        "fmi2SetupExperiment",
        "fmi2EnterInitializationMode",
        "fmi2ExitInitializationMode",
        "fmi2Terminate",
        "fmi2Reset",
        "fmi2GetReal",
        "fmi2GetInteger",
        "fmi2GetBoolean",
        "fmi2GetString",
        "fmi2SetReal",
        "fmi2SetInteger",
        "fmi2SetBoolean",
        "fmi2SetString",
    ],
};

/// Of a co-simulation FMU.
pub(crate) const CO_SIMULATION: &[Group] = &[
    COMMON,
    Group {
        flag: None,
        names: &[
            "fmi2DoStep",
            "fmi2CancelStep",
            "fmi2GetStatus",
            "fmi2GetRealStatus",
            "fmi2GetIntegerStatus",
            "fmi2GetBooleanStatus",
            "fmi2GetStringStatus",
        ],
    },
    Group {
        flag: Some("canInterpolateInputs"),
        names: &["fmi2SetRealInputDerivatives"],
    },
    Group {
        flag: Some("maxOutputDerivativeOrder"),
        names: &["fmi2GetRealOutputDerivatives"],
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
            "fmi2EnterEventMode",
            "fmi2NewDiscreteStates",
            "fmi2EnterContinuousTimeMode",
            "fmi2CompletedIntegratorStep",
            "fmi2SetTime",
            "fmi2SetContinuousStates",
            "fmi2GetDerivatives",
            "fmi2GetEventIndicators",
            "fmi2GetContinuousStates",
            "fmi2GetNominalsOfContinuousStates",
        ],
    },
    STATES,
    SERIALIZATION,
    DERIVATIVES,
];
