//! What reaches the host's logger, and what does not.

use std::process::Command;

use fmi2_export::abi::Fmi2Status;

use crate::host::{Host, Message, vr};
use crate::probe::{FAILS_IN_STEP, FAILS_TO_INITIALISE, PANICS_IN_DROP, PANICS_IN_GET, PANICS_IN_STEP, WARNS};

use Fmi2Status::{Error, Fatal, Ok as Fine, Warning};

/// Categories of the messages of one initialization and one step.
fn run(host: &Host) -> Vec<String> {
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.set_integer(&[vr("behaviour")], &[WARNS]), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Warning);
    assert_eq!(host.do_step(0.0, 1.0), Error);
    host.messages().into_iter().map(|m| m.category).collect()
}

#[test]
fn categories_choose_among_messages_and_without_logging_there_are_none() {
    const ALL: [&str; 4] = ["logEvents", "logStatusWarning", "logAll", "logStatusError"];
    let host = Host::with_logging(false);
    assert_eq!(run(&host), [""; 0]);
    for (on, categories, expected) in [
        (1, &[][..], &ALL[..]),
        (1, &[c"logAll"], &ALL),
        (1, &[c"logEvents"], &["logEvents"]),
        (1, &[c"logStatusError"], &["logStatusError"]),
        (
            1,
            &[c"logStatusError", c"logEvents", c"logStatusWarning"],
            &["logEvents", "logStatusWarning", "logStatusError"],
        ),
        (0, &[], &[]),
        (0, &[c"logAll"], &[]),
        (1, &[], &ALL),
    ] {
        assert_eq!(host.set_debug_logging(on, categories), Fine);
        // the settings outlive the reset in `run`
        assert_eq!(run(&host), expected, "{on} {categories:?}");
    }
}

/// Warnings, refusals, failures, panics, overlapping calls, handles of others: the status says it, and the logger is left alone.
#[test]
fn silence_is_kept_whatever_goes_wrong() {
    for behaviour in [
        WARNS,
        FAILS_TO_INITIALISE,
        FAILS_IN_STEP,
        PANICS_IN_STEP,
        PANICS_IN_GET,
        PANICS_IN_DROP,
    ] {
        let host = Host::with_logging(false);
        host.set_integer(&[vr("behaviour")], &[behaviour]);
        host.enter_initialization_mode();
        host.exit_initialization_mode();
        host.do_step(0.0, 1.0);
        host.do_step(7.0, -1.0);
        let _ = host.get_string(&[vr("echo")]);
        host.set_real(&[9999], &[f64::NAN]);
        host.enter_event_mode();
        host.set_debug_logging(0, &[c"logWeather"]);
        host.set_fmu_state(std::ptr::null_mut());
        assert_eq!(host.free(), [], "behaviour {behaviour}");
    }
}

/// Says to a process of this test that it is the one which panics.
const PANICS: &str = "FMI2_EXPORT_TEST_PANICS";

/// The panic hook of the process, too: it prints nothing of a panic that is caught at the boundary, and all others as ever.
#[test]
fn a_panic_that_is_caught_is_not_printed() {
    if std::env::var_os(PANICS).is_some() {
        let host = Host::with_logging(false);
        host.set_integer(&[vr("behaviour")], &[PANICS_IN_STEP]);
        host.enter_initialization_mode();
        host.exit_initialization_mode();
        assert_eq!(host.do_step(0.0, 1.0), Fatal);
        let loud = || {
            let _ = std::panic::catch_unwind(|| panic!("of this thread"));
        };
        loud();
        std::thread::spawn(|| panic!("of another thread")).join().unwrap_err();
        return;
    }
    let own = std::env::current_exe().unwrap();
    let name = "logging::a_panic_that_is_caught_is_not_printed";
    let done = Command::new(own)
        .args([name, "--exact", "--nocapture"])
        .env(PANICS, "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(!said.contains("seized"), "{said}");
    assert!(
        said.contains("of this thread") && said.contains("of another thread"),
        "{said}"
    );
}

#[test]
fn logging_on_at_instantiation_counts() {
    assert_eq!(run(&Host::with_logging(true)).len(), 4);
}

#[test]
fn a_message_is_a_format_without_conversions_under_the_instance_name() {
    let host = Host::with_logging(true);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(
        host.messages(),
        [Message {
            instance: "probe 1".to_owned(),
            status: Fine,
            category: "logEvents".to_owned(),
            text: "initialised 100 %% at 0 s".to_owned(),
        }]
    );
}

#[test]
fn an_unknown_category_is_told_and_the_others_are_taken() {
    let host = Host::new();
    assert_eq!(host.set_debug_logging(1, &[c"logAll"]), Fine);
    assert_eq!(host.set_debug_logging(1, &[c"logWeather"]), Warning);
    let all = Host::new();
    assert_eq!(all.set_debug_logging(1, &[c"logAll"]), Fine);
    host.messages();
    assert_eq!(run(&host), run(&all), "nothing has changed");
    let host = Host::new();
    assert_eq!(
        host.set_debug_logging(1, &[c"logStatusWarning", c"logWeather"]),
        Warning
    );
    assert_eq!(
        host.reason(Warning),
        "fmi2SetDebugLogging: unknown log category 'logWeather', known are: logStatusWarning, \
         logStatusDiscard, logStatusError, logStatusFatal, logEvents, logAll"
    );
    assert_eq!(run(&host), ["logStatusWarning"]);
}
