//! Values between slaves, and into samples, in the units that each of them says.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panic, too")]

mod common;

use std::ops::ControlFlow;

use common::{Journal, Mock};
use cosim::{BaseUnit, CosimError, RunOptions, StepContext, System, Unit};

/// A unit of m and rad.
fn unit(name: &str, [m, rad]: [i32; 2], factor: f64, offset: f64) -> Unit {
    let exponents = [0, m, 0, 0, 0, 0, 0, rad];
    Unit {
        name: name.to_owned(),
        base: Some(BaseUnit {
            exponents,
            factor,
            offset,
        }),
        display: Vec::new(),
    }
}

/// What a filter's input is set to when a truth's output of 250 is connected to it, and what is read of either.
fn passed(output: Option<&Unit>, input: Option<&Unit>) -> Result<[f64; 3], CosimError> {
    let mut system = System::new();
    let mut from = Mock::new("truth", &Journal::default()).output("x", 250.0);
    let mut to = Mock::new("nav", &Journal::default()).input("x").output("seen", 0.0);
    if let Some(unit) = output {
        from = from.unit(unit);
    }
    if let Some(unit) = input {
        to = Mock::new("nav", &Journal::default())
            .input("x")
            .unit(unit)
            .output("seen", 0.0);
    }
    let truth = from.add_to(&mut system);
    let nav = to
        .feedthrough(|values, _, _| {
            let x = values["x"];
            values.insert("seen".to_owned(), x);
        })
        .add_to(&mut system);
    system.connect_by_name()?;
    let (mut first, mut second) = (system.probe(truth)?, system.probe(nav)?);
    let (sent, seen, own) = (first.real("x")?, second.real("seen")?, second.real("x")?);
    let (mut first, mut second) = (first.sample(), second.sample());
    let mut read = [0.0; 3];
    let options = RunOptions {
        stop: 2.0,
        step: 1.0,
        ..RunOptions::default()
    };
    let report = system.run(&options, |context: &mut StepContext<'_>| {
        context.read(&mut first).unwrap();
        context.read(&mut second).unwrap();
        read = [second.get(seen), first.get(sent), second.get(own)];
        ControlFlow::<()>::Continue(())
    })?;
    assert_eq!(report.steps, 2);
    Ok(read)
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    for (f, e) in found.into_iter().zip(expected) {
        assert!((f - e).abs() <= 1e-12 * e.abs(), "{found:?} instead of {expected:?}");
    }
}

#[test]
fn values_arrive_in_the_unit_of_the_input_and_are_read_in_si() {
    let (metre, kilometre) = (unit("m", [1, 0], 1.0, 0.0), unit("km", [1, 0], 1e3, 0.0));
    near(passed(Some(&metre), Some(&kilometre)).unwrap(), [0.25, 250.0, 250.0]);
    near(passed(Some(&kilometre), Some(&metre)).unwrap(), [250e3, 250e3, 250e3]);
    near(
        passed(Some(&kilometre), Some(&kilometre)).unwrap(),
        [250.0, 250e3, 250e3],
    );
    let (radian, degree) = (
        unit("rad", [0, 1], 1.0, 0.0),
        unit("deg", [0, 1], 1f64.to_radians(), 0.0),
    );
    near(
        passed(Some(&degree), Some(&radian)).unwrap(),
        [4.363_323_129_985_824; 3],
    );
    // 250 of a length that counts from 10 m in steps of 2 m is 510 m: 51 of one that counts in steps of 10 m.
    let (from_ten, of_ten) = (unit("a", [1, 0], 2.0, 10.0), unit("b", [1, 0], 10.0, 0.0));
    near(passed(Some(&from_ten), Some(&of_ten)).unwrap(), [51.0, 510.0, 510.0]);
}

#[test]
fn what_says_no_unit_is_connected_as_it_comes() {
    let kilometre = unit("km", [1, 0], 1e3, 0.0);
    near(passed(Some(&kilometre), None).unwrap(), [250.0, 250e3, 250.0]);
    near(passed(None, Some(&kilometre)).unwrap(), [250.0, 250.0, 250e3]);
    near(passed(None, None).unwrap(), [250.0; 3]);
}

#[test]
fn different_kinds_are_refused_with_both_units() {
    let (metre, degree) = (unit("m", [1, 0], 1.0, 0.0), unit("deg", [0, 1], 1f64.to_radians(), 0.0));
    let error = passed(Some(&metre), Some(&degree)).unwrap_err();
    assert!(matches!(error, CosimError::UnitMismatch { .. }), "{error}");
    let text = error.to_string();
    for part in ["truth.x", "'m'", "nav.x", "'deg'"] {
        assert!(text.contains(part), "{text}");
    }
}
