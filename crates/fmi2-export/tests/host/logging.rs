//! What reaches the host's logger, and what does not.

use fmi2_export::abi::Fmi2Status;

use crate::host::{Host, Message, vr};
use crate::probe::WARNS;

use Fmi2Status::{Error, Ok as Fine, Warning};

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
fn categories_choose_among_debug_messages_and_status_messages_always_come() {
    let status = ["logStatusWarning", "logStatusError"];
    let host = Host::new();
    assert_eq!(run(&host), status);
    for (on, categories, expected) in [
        (
            1,
            &[][..],
            &["logEvents", "logStatusWarning", "logAll", "logStatusError"][..],
        ),
        (
            1,
            &[c"logAll"],
            &["logEvents", "logStatusWarning", "logAll", "logStatusError"],
        ),
        (1, &[c"logEvents"], &["logEvents", "logStatusWarning", "logStatusError"]),
        (1, &[c"logStatusError"], &status),
        (0, &[c"logAll"], &status),
    ] {
        assert_eq!(host.set_debug_logging(on, categories), Fine);
        // the settings outlive the reset in `run`
        assert_eq!(run(&host), expected, "{on} {categories:?}");
    }
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
fn an_unknown_category_changes_nothing() {
    let host = Host::new();
    assert_eq!(host.set_debug_logging(1, &[c"logEvents", c"logWeather"]), Error);
    assert_eq!(
        host.reason(Error),
        "fmi2SetDebugLogging: unknown log category 'logWeather', known are: logStatusWarning, \
         logStatusDiscard, logStatusError, logStatusFatal, logEvents, logAll"
    );
    assert_eq!(run(&host).len(), 2);
}
