//! Which elements and attributes there may be, as a table.

use super::lexical::Kind;

/// An element of the schema.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: &'static str,
    pub(crate) attributes: &'static [Attribute],
    pub(crate) children: &'static [Child],
    /// Its content is anybody's.
    pub(crate) open: bool,
    /// What kind of child it must have one of, if any.
    pub(crate) one_of: Option<&'static str>,
}

/// An attribute of an element.
#[derive(Debug)]
pub(crate) struct Attribute {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) required: bool,
}

/// An element that may stand inside another.
#[derive(Debug)]
pub(crate) struct Child {
    pub(crate) element: &'static Element,
    /// Children of a lower rank come first.
    pub(crate) rank: u8,
    pub(crate) required: bool,
    pub(crate) many: bool,
}

const fn element(name: &'static str, attributes: &'static [Attribute], children: &'static [Child]) -> Element {
    Element {
        name,
        attributes,
        children,
        open: false,
        one_of: None,
    }
}

const fn must(name: &'static str, kind: Kind) -> Attribute {
    Attribute {
        name,
        kind,
        required: true,
    }
}

const fn may(name: &'static str, kind: Kind) -> Attribute {
    Attribute {
        name,
        kind,
        required: false,
    }
}

const fn once(rank: u8, element: &'static Element) -> Child {
    Child {
        element,
        rank,
        required: false,
        many: false,
    }
}

const fn needed(rank: u8, element: &'static Element) -> Child {
    Child {
        required: true,
        ..once(rank, element)
    }
}

const fn any_number(rank: u8, element: &'static Element) -> Child {
    Child {
        many: true,
        ..once(rank, element)
    }
}

const fn at_least_one(rank: u8, element: &'static Element) -> Child {
    Child {
        required: true,
        many: true,
        ..once(rank, element)
    }
}

use Kind::{Boolean, DateTime, Double, Int, ListOf, OneOf, Text, Unsigned, UnsignedList};

/// What an unknown may depend on a known by.
const KINDS: Kind = ListOf(&["dependent", "constant", "fixed", "tunable", "discrete"]);

static FILE: Element = element("File", &[must("name", Text)], &[]);
static SOURCE_FILES: Element = element("SourceFiles", &[], &[at_least_one(0, &FILE)]);
static MODEL_EXCHANGE: Element = element(
    "ModelExchange",
    &[
        must("modelIdentifier", Text),
        may("needsExecutionTool", Boolean),
        may("completedIntegratorStepNotNeeded", Boolean),
        may("canBeInstantiatedOnlyOncePerProcess", Boolean),
        may("canNotUseMemoryManagementFunctions", Boolean),
        may("canGetAndSetFMUstate", Boolean),
        may("canSerializeFMUstate", Boolean),
        may("providesDirectionalDerivative", Boolean),
    ],
    &[once(0, &SOURCE_FILES)],
);
static CO_SIMULATION: Element = element(
    "CoSimulation",
    &[
        must("modelIdentifier", Text),
        may("needsExecutionTool", Boolean),
        may("canHandleVariableCommunicationStepSize", Boolean),
        may("canInterpolateInputs", Boolean),
        may("maxOutputDerivativeOrder", Unsigned),
        may("canRunAsynchronuously", Boolean),
        may("canBeInstantiatedOnlyOncePerProcess", Boolean),
        may("canNotUseMemoryManagementFunctions", Boolean),
        may("canGetAndSetFMUstate", Boolean),
        may("canSerializeFMUstate", Boolean),
        may("providesDirectionalDerivative", Boolean),
    ],
    &[once(0, &SOURCE_FILES)],
);
static BASE_UNIT: Element = element(
    "BaseUnit",
    &[
        may("kg", Int),
        may("m", Int),
        may("s", Int),
        may("A", Int),
        may("K", Int),
        may("mol", Int),
        may("cd", Int),
        may("rad", Int),
        may("factor", Double),
        may("offset", Double),
    ],
    &[],
);
static DISPLAY_UNIT: Element = element(
    "DisplayUnit",
    &[must("name", Text), may("factor", Double), may("offset", Double)],
    &[],
);
static UNIT: Element = element(
    "Unit",
    &[must("name", Text)],
    &[once(0, &BASE_UNIT), any_number(1, &DISPLAY_UNIT)],
);
static UNIT_DEFINITIONS: Element = element("UnitDefinitions", &[], &[at_least_one(0, &UNIT)]);
static ITEM: Element = element(
    "Item",
    &[must("name", Text), must("value", Int), may("description", Text)],
    &[],
);
static REAL_TYPE: Element = element(
    "Real",
    &[
        may("quantity", Text),
        may("unit", Text),
        may("displayUnit", Text),
        may("relativeQuantity", Boolean),
        may("min", Double),
        may("max", Double),
        may("nominal", Double),
        may("unbounded", Boolean),
    ],
    &[],
);
static INTEGER_TYPE: Element = element(
    "Integer",
    &[may("quantity", Text), may("min", Int), may("max", Int)],
    &[],
);
static BOOLEAN_TYPE: Element = element("Boolean", &[], &[]);
static STRING_TYPE: Element = element("String", &[], &[]);
static ENUMERATION_TYPE: Element = element("Enumeration", &[may("quantity", Text)], &[at_least_one(0, &ITEM)]);
static SIMPLE_TYPE: Element = Element {
    one_of: Some("Real, Integer, Boolean, String or Enumeration"),
    ..element(
        "SimpleType",
        &[must("name", Text), may("description", Text)],
        &[
            once(0, &REAL_TYPE),
            once(0, &INTEGER_TYPE),
            once(0, &BOOLEAN_TYPE),
            once(0, &STRING_TYPE),
            once(0, &ENUMERATION_TYPE),
        ],
    )
};
static TYPE_DEFINITIONS: Element = element("TypeDefinitions", &[], &[at_least_one(0, &SIMPLE_TYPE)]);
static CATEGORY: Element = element("Category", &[must("name", Text), may("description", Text)], &[]);
static LOG_CATEGORIES: Element = element("LogCategories", &[], &[at_least_one(0, &CATEGORY)]);
static DEFAULT_EXPERIMENT: Element = element(
    "DefaultExperiment",
    &[
        may("startTime", Double),
        may("stopTime", Double),
        may("tolerance", Double),
        may("stepSize", Double),
    ],
    &[],
);
static TOOL: Element = Element {
    open: true,
    ..element("Tool", &[must("name", Text)], &[])
};
static VENDOR_ANNOTATIONS: Element = element("VendorAnnotations", &[], &[at_least_one(0, &TOOL)]);
static ANNOTATIONS: Element = element("Annotations", &[], &[at_least_one(0, &TOOL)]);
static REAL: Element = element(
    "Real",
    &[
        may("declaredType", Text),
        may("quantity", Text),
        may("unit", Text),
        may("displayUnit", Text),
        may("relativeQuantity", Boolean),
        may("min", Double),
        may("max", Double),
        may("nominal", Double),
        may("unbounded", Boolean),
        may("start", Double),
        may("derivative", Unsigned),
        may("reinit", Boolean),
    ],
    &[],
);
static INTEGER: Element = element(
    "Integer",
    &[
        may("declaredType", Text),
        may("quantity", Text),
        may("min", Int),
        may("max", Int),
        may("start", Int),
    ],
    &[],
);
static BOOLEAN: Element = element("Boolean", &[may("declaredType", Text), may("start", Boolean)], &[]);
static STRING: Element = element("String", &[may("declaredType", Text), may("start", Text)], &[]);
static ENUMERATION: Element = element(
    "Enumeration",
    &[
        must("declaredType", Text),
        may("quantity", Text),
        may("min", Int),
        may("max", Int),
        may("start", Int),
    ],
    &[],
);
static SCALAR_VARIABLE: Element = Element {
    one_of: Some("Real, Integer, Boolean, String or Enumeration"),
    ..element(
        "ScalarVariable",
        &[
            must("name", Text),
            must("valueReference", Unsigned),
            may("description", Text),
            may(
                "causality",
                OneOf(&[
                    "parameter",
                    "calculatedParameter",
                    "input",
                    "output",
                    "local",
                    "independent",
                ]),
            ),
            may(
                "variability",
                OneOf(&["constant", "fixed", "tunable", "discrete", "continuous"]),
            ),
            may("initial", OneOf(&["exact", "approx", "calculated"])),
            may("canHandleMultipleSetPerTimeInstant", Boolean),
        ],
        &[
            once(0, &REAL),
            once(0, &INTEGER),
            once(0, &BOOLEAN),
            once(0, &STRING),
            once(0, &ENUMERATION),
            once(1, &ANNOTATIONS),
        ],
    )
};
static MODEL_VARIABLES: Element = element("ModelVariables", &[], &[at_least_one(0, &SCALAR_VARIABLE)]);
static UNKNOWN: Element = element(
    "Unknown",
    &[
        must("index", Unsigned),
        may("dependencies", UnsignedList),
        may("dependenciesKind", KINDS),
    ],
    &[],
);
static OUTPUTS: Element = element("Outputs", &[], &[at_least_one(0, &UNKNOWN)]);
static DERIVATIVES: Element = element("Derivatives", &[], &[at_least_one(0, &UNKNOWN)]);
static INITIAL_UNKNOWNS: Element = element("InitialUnknowns", &[], &[at_least_one(0, &UNKNOWN)]);
static MODEL_STRUCTURE: Element = element(
    "ModelStructure",
    &[],
    &[once(0, &OUTPUTS), once(1, &DERIVATIVES), once(2, &INITIAL_UNKNOWNS)],
);

/// The root.
pub(crate) static DESCRIPTION: Element = element(
    "fmiModelDescription",
    &[
        must("fmiVersion", Text),
        must("modelName", Text),
        must("guid", Text),
        may("description", Text),
        may("author", Text),
        may("version", Text),
        may("copyright", Text),
        may("license", Text),
        may("generationTool", Text),
        may("generationDateAndTime", DateTime),
        may("variableNamingConvention", OneOf(&["flat", "structured"])),
        may("numberOfEventIndicators", Unsigned),
    ],
    &[
        once(0, &MODEL_EXCHANGE),
        once(0, &CO_SIMULATION),
        once(1, &UNIT_DEFINITIONS),
        once(2, &TYPE_DEFINITIONS),
        once(3, &LOG_CATEGORIES),
        once(4, &DEFAULT_EXPERIMENT),
        once(5, &VENDOR_ANNOTATIONS),
        needed(6, &MODEL_VARIABLES),
        needed(7, &MODEL_STRUCTURE),
    ],
);
