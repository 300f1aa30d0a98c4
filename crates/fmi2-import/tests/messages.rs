//! What FMUs say, in all the ways they say it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail by panic, too")]

mod common;

use common::{Workshop, tank_description};
use fmi2_import::{Fmi2Status, Fmu, Instance, LogMessage, Status};

/// A talker; `None` without a C compiler, with which its arguments could not be formatted either.
fn talker(shop: &Workshop) -> Option<Fmu> {
    let library = shop.compile_source("talker.c", &[])?;
    Some(Fmu::open(shop.fmu("talker.fmu", &tank_description(""), &library)).unwrap())
}

/// What one step says.
fn said(instance: &mut Instance, message: i32) -> LogMessage {
    instance.set_integer(&[0], &[message]).unwrap();
    let _ = instance.do_step(0.0, 1.0).unwrap();
    let mut messages = instance.messages();
    assert_eq!(messages.len(), 1, "{messages:?}");
    messages.remove(0)
}

#[test]
fn arguments_are_filled_in_and_variables_named() {
    let shop = Workshop::new();
    let Some(fmu) = talker(&shop) else { return };
    let mut instance = fmu.instantiate("t1", false).unwrap();
    for (message, text) in [
        (10, "range is beyond 17 m, by 0.12 at 1.2e+04"),
        (11, ""),
        (12, "no category"),
        (13, "Beh\u{e4}lter 3"),
        (14, "50% of it"),
        (15, "level exceeds inflow, item #4"),
        (17, "writes %n"),
        (20, ""),
        (21, "long 1099511627776 18446744073709551615 (nil)"),
    ] {
        assert_eq!(said(&mut instance, message).text, text, "{message}");
    }
    let long = said(&mut instance, 16).text;
    assert_eq!((long.len(), &long[2999..]), (3002, "7|x"));
    assert_eq!(said(&mut instance, 12).category, "");
    assert_eq!(said(&mut instance, 20).status, Status::Unknown(77));
    assert_eq!(said(&mut instance, 10).status, Status::Known(Fmi2Status::Warning));
    // What would write to memory has not.
    let mut steps = [0];
    said(&mut instance, 17);
    instance.get_integer(&[1], &mut steps).unwrap();
    assert_eq!(steps, [5]);
    // Without an environment there is nobody to hear it.
    instance.set_integer(&[0], &[19]).unwrap();
    let _ = instance.do_step(0.0, 1.0).unwrap();
    assert_eq!(instance.messages(), []);
}

#[test]
fn the_same_warning_in_every_step_is_one_with_a_count() {
    let shop = Workshop::new();
    let Some(fmu) = talker(&shop) else { return };
    let mut instance = fmu.instantiate("t1", false).unwrap();
    for k in 0..5680 {
        instance.set_integer(&[0], &[if k == 2000 { 15 } else { 18 }]).unwrap();
        let _ = instance.do_step(0.25 * f64::from(k), 0.25).unwrap();
    }
    let messages: Vec<String> = instance.messages().iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "fmi2Warning [talk] level 0.5 m is low at 0 s (x 5679)",
            "fmi2Warning [talk] level exceeds inflow, item #4"
        ]
    );
    assert_eq!(instance.messages(), []);
}
