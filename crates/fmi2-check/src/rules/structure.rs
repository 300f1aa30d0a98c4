//! ModelStructure.

use crate::rule::rules;

rules! {
    INDEX = "structure.index", Error, "2.2.8", "an index is that of a variable, counted from 1", "mend the index";
    REPEATED = "structure.repeated", Error, "2.2.8", "a list names a variable once", "keep one of them";
    OUTPUT_MISSING = "structure.output-missing", Error, "2.2.8", "Outputs lists every output", "add an Unknown for the output";
    OUTPUT_EXTRA = "structure.output-extra", Error, "2.2.8", "Outputs lists outputs only", "take it off the list, or make it an output";
    DERIVATIVE_MISSING = "structure.derivative-missing", Warning, "2.2.8", "Derivatives lists the derivative of every state of a model-exchange FMU", "add an Unknown for it, unless what it belongs to is no state";
    DERIVATIVE_EXTRA = "structure.derivative-extra", Error, "2.2.8", "Derivatives lists variables with the attribute derivative", "take it off the list, or say whose derivative it is";
    INITIAL_MISSING = "structure.initial-missing", Error, "2.2.8", "InitialUnknowns lists outputs, states and derivatives that are not exact, and calculated parameters", "add an Unknown for it";
    INITIAL_EXTRA = "structure.initial-extra", Error, "2.2.8", "InitialUnknowns lists nothing else", "take it off the list";
    INITIAL_ORDER = "structure.initial-order", Error, "2.2.8", "InitialUnknowns is in the order of the variables", "sort by index";
    INITIAL_KIND = "structure.initial-kind", Error, "2.2.8", "kinds of dependencies in InitialUnknowns are dependent or constant", "write dependent";
    DEPENDENCY = "structure.dependency", Error, "2.2.8", "a dependency is the index of a variable", "mend the index";
    DEPENDENCY_REPEATED = "structure.dependency-repeated", Error, "2.2.8", "a dependency is listed once", "keep one of them";
    DEPENDENCY_ORDER = "structure.dependency-order", Note, "2.2.8", "dependencies are in ascending order", "sort them";
    DEPENDENCY_KNOWN = "structure.dependency-known", Warning, "2.2.8", "dependencies are knowns: inputs, states and the independent variable, in InitialUnknowns also what has initial exact", "take it off the list";
    KINDS = "structure.kinds", Error, "2.2.8", "dependenciesKind has as many entries as dependencies", "write one kind for each dependency";
    KIND_REAL = "structure.kind-real", Error, "2.2.8", "dependencies of an unknown that is not Real are of the kind dependent", "write dependent";
    KIND_KNOWN = "structure.kind-known", Warning, "2.2.8", "dependencies on a known that is not Real are of the kind dependent", "write dependent: only a Real known can have a factor";
    KINDS_ALONE = "structure.kinds-alone", Error, "2.2.8", "dependenciesKind goes with dependencies", "add dependencies";
}
