//! The library at work, in a process of its own.

use crate::rule::rules;

rules! {
    SKIPPED = "binary.skipped", Note, "2.3", "the library can be run here", "check it where it can be run, too";
    LOAD = "binary.load", Error, "2.3", "the library loads by itself", "link statically, or put what it needs beside it with a relative search path";
    VERSION = "binary.version", Error, "2.1.4", "fmi2GetVersion answers 2.0, before anything else", "compile against the headers of FMI 2.0";
    PLATFORM = "binary.platform", Error, "2.1.4", "fmi2GetTypesPlatform answers default, before anything else", "compile against the standard's own fmi2TypesPlatform.h";
    CRASH = "binary.crash", Error, "2.1.3", "no call ends the process", "return fmi2Error or fmi2Fatal instead";
    HANG = "binary.hang", Error, "2.1.3", "every call comes back", "bound every loop; return fmi2Discard or fmi2Error instead";
    INSTANTIATE = "binary.instantiate", Error, "2.1.5", "fmi2Instantiate makes an instance", "log the reason when it cannot";
    GUID = "binary.guid", Warning, "2.1.5", "fmi2Instantiate refuses another guid than the description's", "compare the guid, and return NULL";
    CALL = "binary.call", Error, "4.2.4", "calls in the right order succeed, from start values and the default experiment", "mend the model, or give start values with which it runs";
    STATUS = "binary.status", Error, "2.1.3", "a status is one of the six of the standard", "return a fmi2Status";
    START = "binary.start", Error, "2.2.7", "start values are those of the description", "take both from one table";
    STRING = "binary.string", Error, "2.1.7", "fmi2GetString answers with strings", "return \"\" instead of NULL";
    BOOLEAN = "binary.boolean", Warning, "2.1.2", "a Boolean is 0 or 1", "return fmi2True or fmi2False";
    FINITE = "binary.finite", Warning, "2.1.7", "outputs are finite from start values on", "start from values with a meaning, or report what is unknown by a Boolean";
    RANGE = "binary.range", Warning, "2.2.7", "outputs lie within their min and max", "mend the bounds or the model";
    ITEM = "binary.item", Error, "2.2.7", "outputs of an enumeration are among its items", "add the item, or mend the model";
    REPEAT = "binary.repeat", Warning, "4.2.4", "equal inputs give equal outputs in a second instance", "draw random numbers from a seed that is a parameter";
    RESET = "binary.reset", Error, "2.1.6", "after fmi2Reset an instance is as new", "give every variable its start value again, the hidden ones too";
    STATE = "binary.state", Error, "2.1.8", "after fmi2SetFMUstate an instance goes on as it did from there", "put everything into the state that the next step reads";
    STATE_FREE = "binary.state-free", Error, "2.1.8", "fmi2FreeFMUstate takes a state and sets it to NULL, and ignores NULL", "write NULL to the handle";
    SERIALIZE = "binary.serialize", Error, "2.1.8", "a state goes through bytes into another process", "write values, no pointers";
    TWO = "binary.two", Error, "4.3.1", "two instances do not touch each other, unless canBeInstantiatedOnlyOncePerProcess", "keep everything in the instance; no static variables";
    ORDER = "binary.order", Note, "4.2.4", "calls out of order are refused", "keep the state of the calling sequence, and return fmi2Error";
    REFERENCE = "binary.reference", Warning, "2.1.2", "value references that do not exist are refused", "check references, and return fmi2Error";
    CONSTANT_SET = "binary.constant-set", Warning, "2.1.2", "a constant cannot be set", "return fmi2Error";
    FIXED_SET = "binary.fixed-set", Note, "4.2.4", "a fixed parameter cannot be set after initialization", "return fmi2Error, or declare it tunable";
    OUTPUT_SET = "binary.output-set", Note, "4.2.4", "an output cannot be set during stepping", "return fmi2Error";
    NOT_A_NUMBER = "binary.nan", Note, "2.1.7", "an input refuses what is no number", "return fmi2Error or fmi2Discard, so that the fault is found where it comes from";
    MISUSE_CRASH = "binary.misuse-crash", Note, "2.1.3", "no wrong call ends the process or hangs", "check arguments and order before anything else";
    FREE_NULL = "binary.free-null", Error, "2.1.5", "fmi2FreeInstance ignores NULL", "return at once";
    LOGGER_NULL = "binary.logger-null", Note, "2.1.5", "a logger that is NULL is not called", "check it before each message";
    MEMORY_NULL = "binary.memory-null", Warning, "2.1.5", "with canNotUseMemoryManagementFunctions, memory functions that are NULL are not called", "use the C library's own, or do not set the flag";
    SILENT = "binary.silent", Warning, "2.1.5", "with loggingOn false nothing is logged but failures", "look at loggingOn before each message";
    CATEGORY = "binary.category", Warning, "2.2.4", "categories of messages are those of LogCategories", "declare the category";
    DEPENDENCY = "binary.dependency", Error, "2.2.8", "an output moves with no input but those that Outputs declares, between steps", "declare the dependency";
    INITIAL_DEPENDENCY = "binary.initial-dependency", Error, "2.2.8", "an unknown moves with no known but those that InitialUnknowns declares, during initialization", "declare the dependency";
    FOLDER = "binary.folder", Warning, "2.1.5", "the working directory stays what it was", "open files by their whole path, from fmuResourceLocation";
    LOCALE = "binary.locale", Warning, "2.1.5", "the locale stays what it was", "format numbers without setlocale, or with uselocale for the thread";
    FLOATING_POINT = "binary.floating-point", Warning, "2.1.5", "rounding and treatment of subnormal numbers stay what they were", "put the mode back before each return; mind -ffast-math";
    SIGNALS = "binary.signals", Warning, "2.1.5", "signal handlers stay what they were", "leave signals to the master";
    STDOUT = "binary.stdout", Note, "2.1.5", "nothing is printed on standard output", "log through the logger";
}
