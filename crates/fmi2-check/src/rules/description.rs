//! What the model description says of the whole: versions, capabilities, units, types, the default experiment.

use crate::rule::rules;

rules! {
    VERSION = "description.version", Error, "2.2.1", "fmiVersion is 2.0", "write fmiVersion=\"2.0\"; check FMUs of other versions with other tools";
    INTERFACE = "description.interface", Error, "2.2.1", "there is ModelExchange or CoSimulation", "add the interface that the library implements";
    IDENTIFIER = "description.identifier", Error, "2.2.1", "modelIdentifier is a C identifier", "use letters, digits and underscores, and begin with no digit";
    NAME = "description.name", Warning, "2.2.1", "modelName is not empty", "name the model";
    GUID = "description.guid", Warning, "2.2.1", "guid is not empty", "make a GUID from everything that the library and the description depend on";
    DATE = "description.date", Note, "2.2.1", "generationDateAndTime is in UTC, marked by Z", "write it as 2026-01-31T12:00:00Z";
    TOOL = "description.tool", Note, "2.2.1", "generationTool says what made the FMU", "name the tool and its version";
    EVENTS = "description.events", Note, "2.2.1", "numberOfEventIndicators is for model exchange", "leave it out of an FMU for co-simulation only";
    SERIALIZE = "description.serialize", Error, "4.3.1", "canSerializeFMUstate goes with canGetAndSetFMUstate", "set canGetAndSetFMUstate too, or neither";
    UNIT = "unit.duplicate", Error, "2.2.2", "units have different names", "keep one of them";
    DISPLAY_UNIT = "unit.display-duplicate", Error, "2.2.2", "display units of one unit have different names", "keep one of them";
    FACTOR = "unit.factor", Error, "2.2.2", "factors of units are finite and not zero", "write the factor to the SI unit";
    BASE = "unit.base", Note, "2.2.2", "a unit that SI exponents can express says its BaseUnit", "add BaseUnit, so that tools can convert and compare";
    UNIT_UNKNOWN = "unit.unknown", Error, "2.2.2", "a unit in use is defined in UnitDefinitions", "define the unit";
    DISPLAY_UNKNOWN = "unit.display-unknown", Error, "2.2.3", "a display unit in use is defined for the unit", "add the DisplayUnit to the unit";
    DISPLAY_ALONE = "unit.display-alone", Error, "2.2.3", "a display unit goes with a unit", "add the unit";
    TYPE = "type.duplicate", Error, "2.2.3", "types have different names", "keep one of them";
    TYPE_SHADOW = "type.shadow", Error, "2.2.3", "no type has the name of a variable", "rename the type";
    ITEM_NAME = "type.item-name", Error, "2.2.3", "items of an enumeration have different names", "rename one of them";
    ITEM_VALUE = "type.item-value", Error, "2.2.3", "items of an enumeration have different values", "number them anew";
    RANGE = "range.empty", Error, "2.2.3", "min is not above max", "exchange or mend the bounds";
    NOMINAL = "range.nominal", Warning, "2.2.3", "nominal is above zero", "write the usual size of the variable";
    LOG = "log.duplicate", Error, "2.2.4", "log categories have different names", "keep one of them";
    EXPERIMENT_STOP = "experiment.stop", Error, "2.2.5", "the default stop time lies after the start time", "mend startTime or stopTime";
    EXPERIMENT_STEP = "experiment.step", Error, "2.2.5", "the default step size is above zero", "mend stepSize";
    EXPERIMENT_TOLERANCE = "experiment.tolerance", Error, "2.2.5", "the default tolerance is above zero", "mend tolerance";
    ANNOTATION = "annotation.duplicate", Error, "2.2.6", "vendor annotations have different tool names", "join what one tool has to say";
}
