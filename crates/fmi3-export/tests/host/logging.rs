//! What reaches the host's logger, and what does not.

use fmi3_export::abi::Fmi3Status;

use crate::host::{Host, Message, vr};
use crate::probe::WARNS;

use Fmi3Status::{Error, Ok as Fine, Warning};

/// Categories of the messages of one initialization, one step with a warning, and one that is refused.
fn run(host: &Host) -> Vec<String> {
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.set_int64(&[vr("behaviour")], &[WARNS.into()]), Fine);
    assert_eq!(host.enter(), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Warning);
    assert_eq!(host.do_step(0.0, 1.0), Error);
    host.messages().into_iter().map(|m| m.category).collect()
}

#[test]
fn categories_choose_among_messages_and_without_logging_there_are_none() {
    let host = Host::with_logging(false);
    assert_eq!(run(&host), [""; 0]);
    for (on, categories, expected) in [
        (
            1,
            &[][..],
            &["logEvents", "logStatusWarning", "logAll", "logStatusError"][..],
        ),
        (1, &[c"logEvents"], &["logEvents"]),
        (1, &[c"logStatusError"], &["logStatusError"]),
        (0, &[c"logAll"], &[]),
    ] {
        assert_eq!(host.set_debug_logging(on, categories), Fine);
        // the settings outlive the reset in `run`
        assert_eq!(run(&host), expected, "{on} {categories:?}");
    }
    assert_eq!(run(&Host::with_logging(true)).len(), 4);
}

/// In FMI 3.0 a message is a text: nothing in it is doubled for `printf`.
#[test]
fn a_message_is_a_text() {
    let host = Host::with_logging(true);
    assert_eq!(host.enter(), Fine);
    assert_eq!(
        host.messages(),
        [Message {
            status: Fine,
            category: "logEvents".to_owned(),
            text: "initialised 100 % at 0 s".to_owned(),
        }]
    );
}

#[test]
fn an_unknown_category_is_told_and_the_others_are_taken() {
    let host = Host::new();
    assert_eq!(
        host.set_debug_logging(1, &[c"logStatusWarning", c"logWeather"]),
        Warning
    );
    assert!(
        host.reason(Warning)
            .starts_with("fmi3SetDebugLogging: unknown log category 'logWeather'")
    );
    assert_eq!(run(&host), ["logStatusWarning"]);
}
