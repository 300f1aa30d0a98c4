//! Structures written by hand: what is read from them, and what is said of those that are wrong.

#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

mod common;

use common::{component, inline, linear, read, read_folder, real, set, structure, value, wire};
use ssp::{Flat, Linear, Package, Value, flatten};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn shown(flat: &Flat) -> Vec<String> {
    let name = |(place, connector): &(usize, String)| format!("{}.{connector}", flat.components[*place].name);
    let connections = flat.connections.iter();
    connections
        .map(|c| {
            let Linear { factor, offset } = c.way.linear(None, None).unwrap();
            format!("{} -> {} *{factor} +{offset}", name(&c.from), name(&c.to))
        })
        .collect()
}

/// World -> (system: port -> filter) -> guide, with a factor on each way: what arrives is worked by hand.
#[test]
fn nested_systems_are_taken_apart_and_transformations_follow_each_other() {
    let inner = format!(
        "<s:System name=\"sub\"><s:Connectors>{}{}</s:Connectors><s:Elements>{}</s:Elements><s:Connections>{}{}</s:Connections></s:System>",
        real("in", "input"),
        real("out", "output"),
        component("filter", &format!("{}{}", real("z", "input"), real("x", "output")), ""),
        wire("in", "filter.z", &linear(2.0, 1.0)),
        // Ends have no order.
        wire("out", "filter.x", ""),
    );
    let text = format!(
        "<s:Elements>{}{inner}{}</s:Elements><s:Connections>{}{}</s:Connections>",
        component("world", &real("y", "output"), ""),
        component("guide", &real("x", "input"), ""),
        wire("world.y", "sub.in", &linear(1000.0, 5.0)),
        wire("sub.out", "guide.x", ""),
    );
    let flat = read(&text).unwrap();
    let names: Vec<&str> = flat.components.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["world", "sub.filter", "guide"]);
    // 2 (1000 y + 5) + 1
    let expected = ["world.y -> sub.filter.z *2000 +11", "sub.filter.x -> guide.x *1 +0"];
    assert_eq!(shown(&flat), expected);
}

#[test]
fn connectors_of_the_system_lead_to_those_of_components() {
    let text = format!(
        "<s:Connectors>{}{}</s:Connectors><s:Elements>{}</s:Elements><s:Connections>{}{}</s:Connections>",
        real("push", "input"),
        real("est", "output"),
        component("a", &format!("{}{}", real("u", "input"), real("y", "output")), ""),
        wire("push", "a.u", ""),
        wire("a.y", "est", &linear(3.0, 0.0)),
    );
    let flat = read(&text).unwrap();
    assert_eq!(
        (flat.inputs[0].name.as_str(), &flat.inputs[0].at),
        ("push", &(0, "u".to_owned()))
    );
    assert_eq!(
        (flat.outputs[0].name.as_str(), &flat.outputs[0].at),
        ("est", &(0, "y".to_owned()))
    );
    assert_eq!(
        flat.outputs[0].way.linear(None, None).unwrap(),
        Linear {
            factor: 3.0,
            offset: 0.0
        }
    );
    assert!(flat.connections.is_empty());
}

/// Outer systems go before inner ones, later bindings before earlier ones; a parameter connector hands its value on.
#[test]
fn values_reach_components_from_every_level() {
    let own = inline(&format!("{}{}", value("k", "1"), value("q", "1")), "");
    let sub = format!(
        "<s:System name=\"sub\"><s:Connectors>{}</s:Connectors>{}<s:Elements>{}</s:Elements><s:Connections>{}</s:Connections></s:System>",
        real("gain", "parameter"),
        inline(&format!("{}{}", value("a.k", "2"), value("gain", "3")), ""),
        component("a", &real("g", "parameter"), &own),
        wire("gain", "a.g", &linear(10.0, 0.5)),
    );
    let text = format!(
        "{}<s:Elements>{sub}</s:Elements>",
        inline(&value("sub.a.deep.k", "4"), "")
    );
    let flat = read(&text).unwrap();
    let parameters = &flat.components[0].parameters;
    let taken = parameters.iter().map(|p| (p.name.as_str(), p.in_unit(None).unwrap()));
    let number = |x: f64| Value::Real(x, None);
    let (one, two, four, gain) = (number(1.0), number(2.0), number(4.0), number(30.5));
    assert_eq!(
        taken.collect::<Vec<_>>(),
        [("q", one), ("k", two), ("deep.k", four), ("g", gain)]
    );
}

#[test]
fn values_come_from_files_through_prefixes_and_mappings() {
    let mapping = "<ssm:ParameterMapping version=\"1.0\" xmlns:ssm=\"http://ssp-standard.org/SSP1/SystemStructureParameterMapping\" \
         xmlns:ssc=\"http://ssp-standard.org/SSP1/SystemStructureCommon\">\
         <ssm:MappingEntry source=\"p.mass\" target=\"m\"><ssc:LinearTransformation factor=\"1000\"/></ssm:MappingEntry>\
         </ssm:ParameterMapping>";
    let ssv = "<v:ParameterSet version=\"1.0\" name=\"f\" xmlns:v=\"http://ssp-standard.org/SSP1/SystemStructureParameterValues\" \
         xmlns:c=\"http://ssp-standard.org/SSP1/SystemStructureCommon\"><v:Parameters>\
         <v:Parameter name=\"mass\"><v:Real value=\"1.5\" unit=\"t\"/></v:Parameter>\
         <v:Parameter name=\"n\"><v:Integer value=\"-3\"/></v:Parameter>\
         <v:Parameter name=\"on\"><v:Boolean value=\"1\"/></v:Parameter>\
         <v:Parameter name=\"file\"><v:String value=\"a &amp; b\"/></v:Parameter>\
         <v:Parameter name=\"mode\"><v:Enumeration value=\"slow\"/></v:Parameter>\
         </v:Parameters><v:Units><c:Unit name=\"t\"><c:BaseUnit kg=\"1\" factor=\"1000\"/></c:Unit></v:Units></v:ParameterSet>";
    let bindings = "<s:ParameterBindings>\
         <s:ParameterBinding source=\"resources/a%20b.ssv\"/>\
         <s:ParameterBinding source=\"./resources/a%20b.ssv\" prefix=\"p.\"><s:ParameterMapping source=\"resources/m.ssm\"/></s:ParameterBinding>\
         </s:ParameterBindings>";
    let text = format!("<s:Elements>{}</s:Elements>", component("a", "", bindings));
    let files = [
        ("SystemStructure.ssd", structure(&text, "")),
        ("resources/a b.ssv", ssv.to_owned()),
        ("resources/m.ssm", mapping.to_owned()),
    ];
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let flat = flatten(read_folder(&files).unwrap().structure()).unwrap();
    let got: Vec<(&str, Value)> = flat.components[0]
        .parameters
        .iter()
        .map(|p| (p.name.as_str(), p.value.clone()))
        .collect();
    let expected = [
        ("mass", Value::Real(1.5, Some("t".to_owned()))),
        ("n", Value::Integer(-3)),
        ("on", Value::Boolean(true)),
        ("file", Value::String("a & b".to_owned())),
        ("mode", Value::Enumeration("slow".to_owned())),
        ("m", Value::Real(1.5, Some("t".to_owned()))),
    ];
    assert_eq!(got, expected);
    // A thousand times 1.5 t.
    let mapped = &flat.components[0].parameters[5];
    assert_eq!(mapped.in_unit(None).unwrap(), Value::Real(1500.0, None));
    assert!((flat.components[0].parameters[0].base.unwrap().factor - 1000.0).abs() < f64::EPSILON);
}

/// Each of these is wrong in one way, which is named with its element.
#[test]
fn what_is_wrong_is_named() {
    let y = real("y", "output");
    let u = real("u", "input");
    let both = |more: &str| {
        let (a, b) = (
            component("a", &format!("{y}{u}"), ""),
            component("b", &format!("{y}{u}"), ""),
        );
        format!("<s:Elements>{a}{b}</s:Elements><s:Connections>{more}</s:Connections>")
    };
    let one = |connectors: &str, more: &str| format!("<s:Elements>{}</s:Elements>", component("a", connectors, more));
    let mapped = |attributes: &str| {
        let entry = "<ssm:ParameterMapping version=\"1.0\"><ssm:MappingEntry source=\"k\" target=\"k\"/></ssm:ParameterMapping>";
        let mapping = format!("<s:ParameterMapping {attributes}>{entry}</s:ParameterMapping>");
        inline(&value("k", "1"), &mapping)
    };
    let bytes = "<s:Connector name=\"given\" kind=\"output\"><Binary/></s:Connector><s:Connector name=\"taken\" kind=\"input\"/>";
    let blob = "<ssv:Parameter name=\"blob\"><ssv:Binary value=\"00ff\"/></ssv:Parameter>";
    let looped = format!(
        "<s:Elements><s:System name=\"sub\"><s:Connectors>{}{}</s:Connectors><s:Connections>{}</s:Connections></s:System></s:Elements>\
         <s:Connections>{}</s:Connections>",
        real("i", "input"),
        real("o", "output"),
        wire("i", "o", ""),
        wire("sub.o", "sub.i", ""),
    );
    let types = format!(
        "<s:Elements>{}{}</s:Elements><s:Connections>{}</s:Connections>",
        component("a", &y, ""),
        component(
            "b",
            "<s:Connector name=\"u\" kind=\"input\"><Integer/></s:Connector>",
            ""
        ),
        wire("a.y", "b.u", ""),
    );
    let whole = "<s:Connector name=\"n\" kind=\"output\"><Integer/></s:Connector><s:Connector name=\"m\" kind=\"input\"><Integer/></s:Connector>";
    let transformed = format!(
        "{}<s:Connections>{}</s:Connections>",
        one(whole, ""),
        wire("a.n", "a.m", &linear(2.0, 0.0))
    );
    for (text, says) in [
        (both(&wire("a.y", "c.u", "")), "no element 'c'; there are a, b"),
        (both(&wire("a.y", "b.w", "")), "element 'b' has no connector 'w'"),
        (both(&wire("a.y", "w", "")), "the system has no connector 'w'"),
        (
            both(&wire("a.y", "b.y", "")),
            "connection from a.y to b.y: both ends give values",
        ),
        (both(&wire("a.u", "b.u", "")), "both ends take values"),
        (
            both(&format!("{}{}", wire("a.y", "b.u", ""), wire("b.y", "b.u", ""))),
            "fed twice, by a.y and by b.y",
        ),
        (
            both("<s:Connection startElement=\"a\" endElement=\"b\" endConnector=\"u\"/>"),
            "has no attribute 'startConnector'",
        ),
        (
            both(&wire("a.y", "b.u", "<IntegerMappingTransformation/>")),
            "only ssc:LinearTransformation",
        ),
        (
            both(&wire("a.y", "b.u", "<LinearTransformation factor=\"two\"/>")),
            "factor='two' is not a number",
        ),
        (
            both(
                "<s:Connection startElement=\"a\" startConnector=\"y\" endElement=\"b\" endConnector=\"u\" suppressUnitConversion=\"yes\"/>",
            ),
            "suppressUnitConversion='yes' is not true or false",
        ),
        (
            one("", &mapped("sourceBase=\"component\" source=\"m.ssm\"")),
            "ssd:ParameterMapping: sourceBase 'component' is not read",
        ),
        (
            one("", &mapped("type=\"text/csv\"")),
            "ssd:ParameterMapping: type 'text/csv' is not read; give application/x-ssp-parameter-mapping",
        ),
        (looped, "is fed by itself"),
        (types, "the types differ: Real and Integer"),
        (transformed, "only values of type Real"),
        (one(&format!("{y}{y}"), ""), "ssd:Connector 'y': a second connector"),
        (
            one("<s:Connector name=\"y\" kind=\"inout\"/>", ""),
            "kind 'inout' is not read; give input, output",
        ),
        (
            format!(
                "{}<s:Connections>{}</s:Connections>",
                one(bytes, ""),
                wire("a.given", "a.taken", "")
            ),
            "connection from a.given to a.taken: type Binary of a.given is not read",
        ),
        (
            one("", &inline(blob, "")),
            "binding 'given' of component 'a': 'blob' is of type Binary, which is not read",
        ),
        (
            one("<s:Connector kind=\"input\"/>", ""),
            "ssd:Connector: has no attribute 'name'",
        ),
        (one("", &inline(&value("k", "one"), "")), "value='one' is not a number"),
        (
            one(
                "",
                &inline(
                    "<ssv:Parameter name=\"k\"><ssv:Integer value=\"1.5\"/></ssv:Parameter>",
                    "",
                ),
            ),
            "value='1.5' is not a number",
        ),
        (
            one(
                "",
                &inline(
                    "<ssv:Parameter name=\"k\"><ssv:Boolean value=\"yes\"/></ssv:Parameter>",
                    "",
                ),
            ),
            "not true or false",
        ),
        (
            one("", &inline("<ssv:Parameter name=\"k\"/>", "")),
            "ssv:Parameter 'k': has no value",
        ),
        (
            one("", &inline(&format!("{}{}", value("k", "1"), value("k", "2")), "")),
            "a second value",
        ),
        (
            one(
                "",
                &inline(
                    &value("k", "1"),
                    "<s:ParameterMapping><ssm:ParameterMapping version=\"1.0\"><ssm:MappingEntry source=\"j\" target=\"k\"/></ssm:ParameterMapping></s:ParameterMapping>",
                ),
            ),
            "names 'j', which is no value of it; there are k",
        ),
        (
            one(
                "",
                &inline(
                    "<ssv:Parameter name=\"k\"><ssv:Integer value=\"1\"/></ssv:Parameter>",
                    "<s:ParameterMapping><ssm:ParameterMapping version=\"1.0\"><ssm:MappingEntry source=\"k\" target=\"k\"><LinearTransformation factor=\"2\"/></ssm:MappingEntry></ssm:ParameterMapping></s:ParameterMapping>",
                ),
            ),
            "'k' is Integer and cannot be transformed",
        ),
        (
            one(
                "",
                "<s:ParameterBindings><s:ParameterBinding source=\"resources/none.ssv\"/></s:ParameterBindings>",
            ),
            "the parameter binding of ssd:Component 'a' names 'resources/none.ssv'",
        ),
        (
            one(
                "",
                "<s:ParameterBindings><s:ParameterBinding source=\"../up.ssv\"/></s:ParameterBindings>",
            ),
            "does not lead into the SSP",
        ),
        (
            one(
                "",
                "<s:ParameterBindings><s:ParameterBinding source=\"https://x/y.ssv\"/></s:ParameterBindings>",
            ),
            "another scheme",
        ),
        (
            one("", "<s:ParameterBindings><s:ParameterBinding/></s:ParameterBindings>"),
            "give either source or ssd:ParameterValues",
        ),
        (
            format!("{}{}", inline(&value("b.k", "1"), ""), one("", "")),
            "begins with no element of it; there are a",
        ),
        (
            "<s:Elements><s:Component name=\"a\"/></s:Elements>".to_owned(),
            "ssd:Component 'a': has no attribute 'source'",
        ),
        (
            "<s:Elements><s:SignalDictionaryReference name=\"d\" dictionary=\"e\"/></s:Elements>".to_owned(),
            "only ssd:Component and ssd:System",
        ),
        (
            format!("<s:Elements>{0}{0}</s:Elements>", component("a", "", "")),
            "a second element of this name",
        ),
        ("<s:Elements>".to_owned(), "SystemStructure.ssd:"),
    ] {
        let error = read(&text).map(|flat| shown(&flat)).unwrap_err().to_string();
        assert!(error.contains(says), "{says}\n{error}\n{text}");
    }
}

/// What nothing leads to is no reason to refuse the rest.
#[test]
fn parts_that_are_not_needed_are_passed_by() {
    let bytes = "<s:Connector name=\"log\" kind=\"output\"><Binary mime-type=\"text/plain\"/></s:Connector>";
    let blob = "<ssv:Parameter name=\"blob\"><ssv:Binary value=\"00ff\"/></ssv:Parameter>";
    let mapping = "<s:ParameterMapping><ssm:ParameterMapping version=\"1.0\"><ssm:MappingEntry source=\"k\" target=\"k\"/>\
         </ssm:ParameterMapping></s:ParameterMapping>";
    let binding = inline(&format!("{blob}{}", value("k", "2")), mapping);
    let text = format!(
        "<s:Elements>{}{}</s:Elements><s:Connections>{}</s:Connections><s:SignalDictionaries>\
         <s:SignalDictionary name=\"d\"/></s:SignalDictionaries>",
        component("a", &format!("{}{bytes}", real("y", "output")), &binding),
        component("b", &real("u", "input"), ""),
        wire("a.y", "b.u", ""),
    );
    let flat = read(&text).unwrap();
    assert_eq!(shown(&flat), ["a.y -> b.u *1 +0"]);
    assert_eq!(flat.components[0].parameters.len(), 1);
    assert_eq!(
        flat.components[0].parameters[0].in_unit(None).unwrap(),
        Value::Real(2.0, None)
    );
}

/// References as RFC 3986 has them: what leads back into the SSP is read, and what leads out is refused.
#[test]
fn steps_up_stay_inside() {
    let ssv = set(&value("k", "1")).replace(
        "<ssv:ParameterSet",
        "<ssv:ParameterSet xmlns:ssv=\"http://ssp-standard.org/SSP1/SystemStructureParameterValues\"",
    );
    for (source, found) in [
        ("resources/x.ssv", true),
        ("./resources/../resources/x.ssv", true),
        ("a/b/../../resources/./x.ssv", true),
        ("resources//x.ssv", true),
        ("%72esources/%2E%2E/resources/x.ssv", true),
        ("../x.ssv", false),
        ("resources/../../x.ssv", false),
        ("resources/%2e%2e/%2e%2e/x.ssv", false),
        ("/resources/x.ssv", false),
        ("resources/..", false),
        ("./", false),
    ] {
        let binding = format!("<s:ParameterBindings><s:ParameterBinding source=\"{source}\"/></s:ParameterBindings>");
        let text = structure(
            &format!("<s:Elements>{}</s:Elements>", component("a", "", &binding)),
            "",
        );
        let package = read_folder(&[("SystemStructure.ssd", &text), ("resources/x.ssv", &ssv)]);
        match package {
            Ok(package) => {
                assert!(found, "{source}");
                // What is written again has the file under its name.
                let folder = tempfile::tempdir().unwrap();
                let path = folder.path().join("again.ssp");
                fs::write(&path, Package::bytes(package.structure(), &BTreeMap::new()).unwrap()).unwrap();
                assert_eq!(
                    Package::open(&path).unwrap().structure(),
                    package.structure(),
                    "{source}"
                );
            }
            Err(error) => {
                assert!(!found, "{source}: {error}");
                assert!(
                    error.to_string().contains("does not lead into the SSP"),
                    "{source}: {error}"
                );
            }
        }
    }
}

#[test]
fn messages_have_file_and_line() {
    let text = structure("<s:Elements>\n<s:Component/>\n</s:Elements>", "");
    let error = read_folder(&[("SystemStructure.ssd", &text)]).unwrap_err().to_string();
    let line = 1 + text.lines().position(|line| line == "<s:Component/>").unwrap();
    assert!(
        error.starts_with(&format!("SystemStructure.ssd:{line}: ssd:Component: ")),
        "{error}"
    );
    let other = structure("", "").replace("version=\"1.0\" name", "version=\"2.0\" name");
    let error = read_folder(&[("SystemStructure.ssd", &other)]).unwrap_err().to_string();
    assert!(error.contains("version '2.0' is not read; give 1.0"), "{error}");
    let foreign = structure("", "").replace("SSP1/SystemStructureDescription", "SSP9/SystemStructureDescription");
    let error = read_folder(&[("SystemStructure.ssd", &foreign)])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("is not ssd:SystemStructureDescription of SSP 1.0"),
        "{error}"
    );
    assert!(Package::open(Path::new("/no/such.ssp")).is_err());
}

/// Whatever is cut off: an error or a structure, and no panic.
#[test]
fn truncated_structures_are_refused() {
    let inner = component("a", &real("y", "output"), &inline(&value("k", "1"), ""));
    let text = structure(
        &format!("<s:Elements>{inner}</s:Elements>"),
        "<s:DefaultExperiment startTime=\"0\" stopTime=\"9.5\"/>",
    );
    assert_eq!(
        read_folder(&[("SystemStructure.ssd", &text)])
            .unwrap()
            .structure()
            .experiment
            .unwrap()
            .stop_time,
        Some(9.5)
    );
    let end = text.trim_end().len();
    for length in 0..end {
        assert!(
            read_folder(&[("SystemStructure.ssd", &text[..length])]).is_err(),
            "{length} of {end}"
        );
    }
}
