//! Defects of the library, each compiled into a good FMU: the rule that it breaks is named, with the function or variable.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use common::{compiled, found_running, found_within, good, lines, names, pack, running, score, serious};
use fmi2_check::{check, rules};

/// Switch of the source, rule, element.
const DEFECTS: &[(&str, &str, &str)] = &[
    ("NO_GET_STATUS", "archive.export", "fmi2GetStatus"),
    ("NO_VERSION", "archive.export", "fmi2GetVersion"),
    (
        "NO_DIRECTIONAL",
        "archive.export-optional",
        "fmi2GetDirectionalDerivative",
    ),
    ("VERSION_OFF", "binary.version", "fmi2GetVersion"),
    ("PLATFORM_OFF", "binary.platform", "fmi2GetTypesPlatform"),
    ("UNRESOLVED", "binary.load", "good.so"),
    ("INSTANTIATE_NULL", "binary.instantiate", "fmi2Instantiate"),
    ("ANY_GUID", "binary.guid", "fmi2Instantiate"),
    ("INIT_ERROR", "binary.call", "fmi2EnterInitializationMode"),
    ("DISCARDS", "binary.call", "fmi2DoStep"),
    ("GET_ERROR", "binary.call", "fmi2GetReal"),
    ("TERMINATE_ERROR", "binary.call", "fmi2Terminate"),
    ("RESET_ERROR", "binary.call", "fmi2Reset"),
    ("LOGGING_REFUSED", "binary.call", "fmi2SetDebugLogging"),
    ("STATUS_OFF", "binary.status", "fmi2DoStep"),
    ("ABORTS", "binary.crash", "fmi2EnterInitializationMode"),
    ("CRASHES", "binary.crash", "fmi2DoStep"),
    ("EXITS", "binary.crash", "fmi2DoStep"),
    ("HANGS", "binary.hang", "fmi2DoStep"),
    ("START_OFF", "binary.start", "gain"),
    ("STRING_NULL", "binary.string", "said"),
    ("BOOLEAN_OFF", "binary.boolean", "full"),
    ("NOT_FINITE", "binary.finite", "y"),
    ("OUT_OF_RANGE", "binary.range", "y"),
    ("NO_ITEM", "binary.item", "phase"),
    ("REMEMBERS", "binary.repeat", "n"),
    ("RESET_FORGETS", "binary.reset", "z"),
    ("RESET_KEEPS_INPUT", "binary.reset", "y"),
    ("STATE_FORGETS", "binary.state", "n"),
    ("STATE_ERROR", "binary.state", "fmi2SetFMUstate"),
    ("STATE_STAYS", "binary.state-free", "fmi2FreeFMUstate"),
    ("SERIALIZES_POINTER", "binary.serialize", "z"),
    ("DESERIALIZE_ERROR", "binary.serialize", "fmi2DeSerializeFMUstate"),
    ("ONLY_ONE", "binary.two", "fmi2Instantiate"),
    ("SHARES_FRESH", "binary.two", "n"),
    ("ANY_ORDER", "binary.order", "fmi2DoStep"),
    ("ANY_ORDER", "binary.order", "fmi2ExitInitializationMode"),
    ("ANY_ORDER", "binary.order", "fmi2SetupExperiment"),
    ("ANY_ORDER", "binary.order", "fmi2Terminate"),
    ("ANY_STEP", "binary.order", "fmi2DoStep"),
    ("ANY_REFERENCE", "binary.reference", "fmi2GetReal"),
    ("ANY_REFERENCE", "binary.reference", "fmi2SetReal"),
    ("TABLE_UNCHECKED", "binary.reference", "fmi2GetReal"),
    ("NAN_STEP_HANGS", "binary.misuse-crash", "fmi2DoStep"),
    ("CONSTANT_SETTABLE", "binary.constant-set", "pi"),
    ("FIXED_SETTABLE", "binary.fixed-set", "gain"),
    ("OUTPUT_SETTABLE", "binary.output-set", "y"),
    ("ANY_NUMBER", "binary.nan", "u[1]"),
    ("FREE_NULL_CRASHES", "binary.free-null", "fmi2FreeInstance"),
    ("LOGGER_UNCHECKED", "binary.logger-null", "fmi2Instantiate"),
    ("HOST_MEMORY", "binary.memory-null", "fmi2Instantiate"),
    ("CHATTY", "binary.silent", "fmi2CallbackLogger"),
    ("CATEGORY_OFF", "binary.category", "fmi2CallbackLogger"),
    ("HIDDEN_INPUT", "binary.dependency", "z"),
    ("HIDDEN_KNOWN", "binary.initial-dependency", "z"),
    ("MOVES_FOLDER", "binary.folder", "fmi2Instantiate"),
    ("SETS_LOCALE", "binary.locale", "fmi2Instantiate"),
    ("SETS_SIGNAL", "binary.signals", "fmi2Instantiate"),
    ("ROUNDS_DOWN", "binary.floating-point", "fmi2DoStep"),
    ("PRINTS", "binary.stdout", "fmi2DoStep"),
];

/// Limit to trials of what hangs.
const HANGS: Duration = Duration::from_secs(3);

/// What an FMU says of its failure is part of what is told.
#[test]
fn the_last_words_of_an_fmu_are_told() {
    let Some(library) = compiled(&["INSTANTIATE_NULL"]) else {
        return;
    };
    let findings = found_running(&good(&library));
    let told = lines(&findings);
    assert!(
        told.contains("it returned NULL; it logged: no room for a tank"),
        "{told}"
    );
}

/// FMI 2.0.4, 4.2.2 and 4.2.4 bind the master: an FMU that takes what it should not be told, or never comes back from it, has broken
/// nothing; and the whole limit is not spent on waiting.
#[test]
fn duties_of_the_master_are_advice() {
    let switches = [
        "ANY_ORDER",
        "ANY_STEP",
        "FIXED_SETTABLE",
        "OUTPUT_SETTABLE",
        "ANY_NUMBER",
        "NAN_STEP_HANGS",
    ];
    let Some(library) = compiled(&switches) else { return };
    let mut patient = running();
    patient.limit = Duration::from_secs(60);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("good.fmu");
    pack(&good(&library), &path);
    let findings = check(&path, Some(&patient)).unwrap();
    assert_eq!(serious(&findings), 0, "{}", lines(&findings));
    let rules: BTreeSet<&str> = findings.0.iter().map(|f| f.rule.id).collect();
    let expected = [
        "binary.fixed-set",
        "binary.misuse-crash",
        "binary.nan",
        "binary.order",
        "binary.output-set",
    ];
    assert_eq!(rules.into_iter().collect::<Vec<_>>(), expected);
    let hung = findings.0.iter().find(|f| f.rule.id == "binary.misuse-crash").unwrap();
    let (_, seconds) = hung.what.split_once("did not come back within ").unwrap();
    let seconds: f64 = seconds.trim_end_matches(" s").parse().unwrap();
    assert!((5.0..30.0).contains(&seconds), "{}", hung.what);
}

/// Of the rules of a library at work, each is broken by some defect here; one only says that it cannot be run.
#[test]
fn every_rule_of_the_library_is_tried() {
    let tried: BTreeSet<&str> = DEFECTS.iter().map(|(_, rule, _)| *rule).collect();
    let left = rules::all()
        .map(|rule| rule.id)
        .filter(|id| id.starts_with("binary.") && !tried.contains(id));
    assert_eq!(left.collect::<Vec<_>>(), ["binary.skipped"]);
}

#[test]
fn the_good_fmu_has_nothing_that_is_found() {
    let Some(library) = compiled(&[]) else { return };
    let findings = found_running(&good(&library));
    assert!(findings.0.is_empty(), "{}", lines(&findings));
}

#[test]
fn every_defect_of_the_library_is_named() {
    if compiled(&[]).is_none() {
        return;
    }
    let (next, missed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((switch, rule, element)) = DEFECTS.get(next.fetch_add(1, Ordering::Relaxed)) {
                    // What hangs is waited for to the end.
                    let limit = if switch.ends_with("HANGS") {
                        HANGS
                    } else {
                        running().limit
                    };
                    let findings = found_within(&good(&compiled(&[switch]).unwrap()), limit);
                    if !names(&findings, rule, element) {
                        let text = format!("{switch}: no {rule} of {element}\n{}", lines(&findings));
                        missed.lock().unwrap().push(text);
                    }
                }
            });
        }
    });
    let missed = missed.into_inner().unwrap();
    score("library", DEFECTS.len(), &missed);
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
