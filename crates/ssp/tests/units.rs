//! Conversions of units, and transformations on top of them: expected numbers are worked by hand.

#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

mod common;

use common::{component, inline, linear, read_folder, real, structure, wire};
use ssp::{BaseUnit, Flat, NamedUnit, Value, flatten};

/// A unit of length of so many metres.
fn length(name: &str, metres: f64) -> NamedUnit {
    NamedUnit {
        name: name.to_owned(),
        base: Some(BaseUnit {
            exponents: [0, 1, 0, 0, 0, 0, 0, 0],
            factor: metres,
            offset: 0.0,
        }),
    }
}

const UNITS: &str = "<s:Units><Unit name=\"m\"><BaseUnit m=\"1\"/></Unit>\
     <Unit name=\"km\"><BaseUnit m=\"1\" factor=\"1000\"/></Unit><Unit name=\"s\"><BaseUnit s=\"1\"/></Unit></s:Units>";

fn read_with_units(inside: &str) -> Flat {
    let text = structure(inside, UNITS);
    flatten(read_folder(&[("SystemStructure.ssd", &text)]).unwrap().structure()).unwrap()
}

/// Units are converted first, unless that is suppressed, then comes the transformation: what 1 km comes to is worked by hand.
#[test]
fn transformations_come_on_top_of_conversions_of_units() {
    let (km, m) = (length("km", 1000.0), length("m", 1.0));
    let bare = |name: &str, kind: &str| format!("<s:Connector name=\"{name}\" kind=\"{kind}\"><Real/></s:Connector>");
    let quiet = |wire: String| wire.replace("<s:Connection ", "<s:Connection suppressUnitConversion=\"true\" ");
    let direct = |wire: String| {
        let text = format!(
            "<s:Elements>{}{}</s:Elements><s:Connections>{wire}</s:Connections>",
            component("world", &bare("y", "output"), ""),
            component("filter", &bare("z", "input"), ""),
        );
        read_with_units(&text).connections.remove(0).way
    };
    let to = "filter.z";
    for (wire, expected) in [
        (wire("world.y", to, ""), 1000.0),
        (wire("world.y", to, &linear(2.0, 5.0)), 2005.0),
        (quiet(wire("world.y", to, &linear(2.0, 5.0))), 7.0),
        (quiet(wire("world.y", to, &linear(1000.0, 0.0))), 1000.0),
        (quiet(wire("world.y", to, "")), 1.0),
    ] {
        let got = direct(wire.clone()).linear(Some(&km), Some(&m)).unwrap().apply(1.0);
        assert!((got - expected).abs() < 1e-9, "{wire}: {got}");
    }
    // Without units there is nothing to convert.
    let plain = direct(wire("world.y", to, &linear(2.0, 5.0)));
    assert!((plain.linear(None, Some(&m)).unwrap().apply(1.0) - 7.0).abs() < 1e-12);
    let s = NamedUnit {
        name: "s".to_owned(),
        base: None,
    };
    assert!(
        plain
            .linear(Some(&km), Some(&s))
            .unwrap_err()
            .to_string()
            .contains("'km' cannot be converted to 's'")
    );

    // Through a system, from km to km; by its connector in m: 2 * 1000 + 1 there, hence 2.001 km. A connector that says no unit has
    // that of the filter inside, hence 2 * 1 + 1.
    for (connector, expected) in [(real("in", "input"), 2.001), (bare("in", "input"), 3.0)] {
        let inner = format!(
            "<s:System name=\"sub\"><s:Connectors>{connector}</s:Connectors><s:Elements>{}</s:Elements><s:Connections>{}</s:Connections></s:System>",
            component("filter", &bare("z", "input"), ""),
            wire("in", "filter.z", ""),
        );
        let text = format!(
            "<s:Elements>{}{inner}</s:Elements><s:Connections>{}</s:Connections>",
            component("world", &bare("y", "output"), ""),
            wire("world.y", "sub.in", &linear(2.0, 1.0)),
        );
        let way = read_with_units(&text).connections.remove(0).way;
        let got = way.linear(Some(&km), Some(&km)).unwrap().apply(1.0);
        assert!((got - expected).abs() < 1e-12, "{connector}: {got}");
    }
}

/// 5 km for a parameter in m, by hand, through a mapping and through a connector of the system.
#[test]
fn values_are_converted_before_they_are_transformed() {
    let m = length("m", 1.0);
    let given = "<ssv:Parameter name=\"reach\"><ssv:Real value=\"5\" unit=\"km\"/></ssv:Parameter>";
    let mapping = |target: &str, attributes: &str, inside: &str| {
        format!(
            "<s:ParameterMapping><ssm:ParameterMapping version=\"1.0\"><ssm:MappingEntry source=\"reach\" target=\"{target}\" \
             {attributes}>{inside}</ssm:MappingEntry></ssm:ParameterMapping></s:ParameterMapping>"
        )
    };
    let quiet = "suppressUnitConversion=\"1\"";
    for (attributes, inside, expected) in [
        ("", String::new(), 5000.0),
        (quiet, String::new(), 5.0),
        ("suppressUnitConversion=\"false\"", linear(2.0, 100.0), 10100.0),
        (quiet, linear(2.0, 100.0), 110.0),
    ] {
        let binding = inline(given, &mapping("k", attributes, &inside));
        let text = format!("<s:Elements>{}</s:Elements>", component("a", "", &binding));
        let flat = read_with_units(&text);
        let taken = flat.components[0].parameters[0].in_unit(Some(&m)).unwrap();
        assert_eq!(
            taken,
            Value::Real(expected, Some("m".to_owned())),
            "{attributes} {inside}"
        );
    }
    // 5 km, plus 100 in the connector's m, halved.
    let binding = inline(given, &mapping("far", "", &linear(1.0, 100.0)));
    let text = format!(
        "<s:Connectors>{}</s:Connectors>{binding}<s:Elements>{}</s:Elements><s:Connections>{}</s:Connections>",
        real("far", "parameter"),
        component("a", &real("k", "parameter"), ""),
        wire("far", "a.k", &linear(0.5, 0.0)),
    );
    let flat = read_with_units(&text);
    let taken = flat.components[0].parameters[0].in_unit(Some(&m)).unwrap();
    assert_eq!(taken, Value::Real(2550.0, Some("m".to_owned())));
}
