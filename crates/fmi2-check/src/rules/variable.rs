//! Variables.

use crate::rule::rules;

rules! {
    DUPLICATE = "variable.duplicate", Error, "2.2.7", "variables have different names", "rename one of them";
    NAME = "variable.name", Error, "2.2.7", "a variable has a name without line breaks", "name the variable";
    STRUCTURED = "variable.structured", Error, "2.2.9", "with variableNamingConvention structured, names follow its grammar", "quote the odd part as 'a b', or declare the convention flat";
    COMBINATION = "variable.combination", Error, "2.2.7", "causality and variability fit together", "choose a variability that the causality allows";
    CONTINUOUS = "variable.continuous", Error, "2.2.7", "only Real variables are continuous", "declare it discrete";
    CONTINUOUS_DEFAULT = "variable.continuous-default", Warning, "2.2.7", "a variable that is not Real says its variability, since the default is continuous", "write variability=\"discrete\"";
    INITIAL = "variable.initial", Error, "2.2.7", "initial is one that causality and variability allow", "leave initial out, or choose an allowed one";
    START_MISSING = "variable.start-missing", Error, "2.2.7", "inputs, parameters and what has initial exact or approx have a start value", "add start";
    START_FORBIDDEN = "variable.start-forbidden", Error, "2.2.7", "what is calculated, and the independent variable, has no start value", "take start away";
    START_RANGE = "variable.start-range", Error, "2.2.7", "a start value lies within min and max", "mend start or the bounds";
    START_ITEM = "variable.start-item", Error, "2.2.7", "the start value of an enumeration is one of its items", "write the value of an item";
    TYPE_UNKNOWN = "variable.type-unknown", Error, "2.2.7", "declaredType is defined in TypeDefinitions", "define the type";
    TYPE_KIND = "variable.type-kind", Error, "2.2.7", "declaredType is a type of the variable's own kind", "choose a type of this kind";
    INDEPENDENT = "variable.independent", Error, "2.2.7", "at most one variable is independent, and it is Real", "keep one";
    DERIVATIVE = "variable.derivative", Error, "2.2.7", "derivative is the index of another continuous Real variable", "mend the index; it counts from 1";
    DERIVATIVE_KIND = "variable.derivative-kind", Error, "2.2.7", "a derivative is continuous", "take derivative away, or make the variable continuous";
    REINIT = "variable.reinit", Error, "2.2.7", "reinit is for continuous states", "take reinit away";
    MULTIPLE_SET = "variable.multiple-set", Warning, "2.2.7", "canHandleMultipleSetPerTimeInstant is for inputs", "take it away";
    ALIAS_SETTABLE = "variable.alias-settable", Error, "2.2.7", "of variables with one value reference, at most one can be set", "give them references of their own";
    ALIAS_START = "variable.alias-start", Error, "2.2.7", "of variables with one value reference, at most one has a start value, unless they are constants", "keep one start value";
    ALIAS_CONSTANT = "variable.alias-constant", Error, "2.2.7", "a constant shares its value reference with constants of the same value only", "give it a reference of its own";
    ALIAS_UNIT = "variable.alias-unit", Error, "2.2.7", "variables with one value reference have one unit, or all of them none", "give them the same unit, or references of their own";
    ARRAY = "variable.array", Note, "2.2.9", "an array has all its elements, with one number of indices", "add the missing elements, or rename the odd one";
}
