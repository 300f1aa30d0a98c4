//! Which output reaches which input, and what cannot be connected.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;

use common::{Journal, Mock};
use cosim::{BaseType, Causality, CosimError, SlaveId, System, Value};

/// A slave with the ports `(name, type, causality)`.
fn slave(system: &mut System, name: &str, ports: &[(&str, BaseType, Causality)]) -> SlaveId {
    let mock = Mock::new(name, &Journal::default());
    ports
        .iter()
        .fold(mock, |mock, (port, kind, causality)| {
            mock.port(port, *kind, *causality, 0.0)
        })
        .add_to(system)
}

use BaseType::{Boolean, Enumeration, Integer, Real};
use Causality::{Input, Local, Output, Parameter};

#[test]
fn equal_names_connect_and_the_rest_is_reported() {
    let mut system = System::new();
    slave(
        &mut system,
        "truth",
        &[
            ("range", Real, Output),
            ("valid", Boolean, Output),
            ("force", Real, Input),
        ],
    );
    let nav = [
        ("range", Real, Input),
        ("valid", Boolean, Input),
        ("bias", Real, Input),
        ("est", Real, Output),
    ];
    slave(&mut system, "a", &nav);
    slave(&mut system, "b", &nav);
    assert_eq!(system.connect_by_name().unwrap(), 4);
    assert_eq!(
        system.connect_by_name().unwrap(),
        0,
        "again, there is nothing left to connect"
    );
    let open: Vec<_> = system.unconnected_inputs().iter().map(ToString::to_string).collect();
    assert_eq!(open, ["truth.force", "a.bias", "b.bias"]);
}

#[test]
fn only_outputs_and_inputs_take_part() {
    let mut system = System::new();
    slave(&mut system, "a", &[("x", Real, Local), ("p", Real, Parameter)]);
    slave(&mut system, "b", &[("x", Real, Input), ("p", Real, Output)]);
    assert_eq!(system.connect_by_name().unwrap(), 0);
}

#[test]
fn types_must_agree() {
    for (output, input) in [
        (Integer, Enumeration),
        (Enumeration, Integer),
        (Boolean, Integer),
        (Real, Integer),
    ] {
        let mut system = System::new();
        let a = slave(&mut system, "a", &[("mode", output, Output), ("fine", Real, Output)]);
        let b = slave(&mut system, "b", &[("fine", Real, Input), ("mode", input, Input)]);
        for error in [
            system.connect_by_name().unwrap_err(),
            system.connect(a, "mode", b, "mode").unwrap_err(),
        ] {
            assert!(matches!(error, CosimError::TypeMismatch { .. }));
            assert_eq!(
                error.to_string(),
                format!("cannot connect a.mode ({output}) to b.mode ({input}): types differ")
            );
        }
        assert_eq!(
            system.unconnected_inputs().len(),
            2,
            "a failed wiring leaves nothing behind"
        );
    }
}

#[test]
fn one_input_has_one_source() {
    let mut system = System::new();
    let a = slave(&mut system, "a", &[("x", Real, Output), ("other", Real, Output)]);
    let b = slave(&mut system, "b", &[("x", Real, Output)]);
    let c = slave(&mut system, "c", &[("x", Real, Input)]);
    let error = system.connect_by_name().unwrap_err();
    assert_eq!(
        error.to_string(),
        "input c.x is fed by both a.x and b.x: keep one of them"
    );

    // Said explicitly, there is no doubt left.
    system.connect(a, "other", c, "x").unwrap();
    system.connect(a, "other", c, "x").unwrap();
    assert_eq!(system.connect_by_name().unwrap(), 0);
    let error = system.connect(b, "x", c, "x").unwrap_err();
    assert_eq!(
        error.to_string(),
        "input c.x is fed by both a.other and b.x: keep one of them"
    );
}

#[test]
fn aliases_stand_in_for_names() {
    let mut system = System::new();
    slave(&mut system, "truth", &[("lidar.range", Real, Output)]);
    let foreign = slave(&mut system, "foreign", &[("distance", Real, Input)]);
    assert_eq!(system.connect_by_name().unwrap(), 0);
    system.alias(foreign, "distance", "lidar.range").unwrap();
    assert_eq!(system.connect_by_name().unwrap(), 1);
    // Both names are understood.
    assert_eq!(system.port(foreign, "distance"), system.port(foreign, "lidar.range"));
    let mut probe = system.probe(foreign).unwrap();
    assert!(probe.reals(&["distance", "lidar.range"]).is_ok());
}

#[test]
fn mistaken_names_and_roles_are_explained() {
    let mut system = System::new();
    let a = slave(&mut system, "a", &[("range", Real, Output), ("q", Integer, Parameter)]);
    let b = slave(&mut system, "b", &[("range", Real, Input)]);

    let error = system.connect(a, "rnage", b, "range").unwrap_err();
    assert_eq!(
        error.to_string(),
        r#"slave "a" has no variable "rnage"; did you mean "range"?"#
    );
    assert!(matches!(
        system.probe(b).unwrap().real("temperature").unwrap_err(),
        CosimError::UnknownVariable { suggestion: None, .. }
    ));
    assert!(matches!(
        system.alias(b, "nothing", "x").unwrap_err(),
        CosimError::UnknownVariable { .. }
    ));

    let error = system.connect(a, "q", b, "range").unwrap_err();
    assert_eq!(error.to_string(), "a.q has causality parameter, but output is needed");
    let error = system.connect(a, "range", a, "range").unwrap_err();
    assert_eq!(error.to_string(), "a.range has causality output, but input is needed");

    let error = system.set_start(a, "q", Value::Real(1.0)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.q is of type Integer, but the value 1.0 is of type Real"
    );
    assert!(matches!(
        system.set_start(a, "p", Value::Integer(1)).unwrap_err(),
        CosimError::UnknownVariable { .. }
    ));

    let twin = Mock::new("a", &Journal::default());
    assert!(matches!(system.add(Box::new(twin)).unwrap_err(), CosimError::DuplicateSlave { name } if name == "a"));
    let double = Mock::new("d", &Journal::default()).input("x").input("x");
    let error = system.add(Box::new(double)).unwrap_err();
    assert_eq!(error.to_string(), r#"slave "d" has two variables named "x""#);

    let error = system.alias(a, "q", "range").unwrap_err();
    assert_eq!(error.to_string(), r#"slave "a" has two variables named "range""#);
    assert!(system.alias(a, "range", "range").is_ok(), "its own name is no conflict");

    let mut small = System::new();
    slave(&mut small, "only", &[]);
    let error = small.connect(b, "x", b, "x").unwrap_err();
    assert!(
        matches!(error, CosimError::UnknownSlave { index: 1, count: 1 }),
        "{error}"
    );
}
