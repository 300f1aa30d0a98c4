//! Defects of the description, each put into a good FMU: the rule that it breaks is named, with the element.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use std::collections::BTreeSet;

use common::{edited, found_in, good, library, lines, names, score, serious};
use fmi2_check::rules;

/// What is replaced in the description, by what, the rule and the element that have to be named.
type Edit = (&'static str, &'static str, &'static str, &'static str);

const XML: &[Edit] = &[
    (
        "encoding=\"UTF-8\"",
        "encoding=\"ISO-8859-1\"",
        "xml.encoding",
        "modelDescription.xml",
    ),
    (
        "</ModelStructure>",
        "</ModelStructures>",
        "xml.well-formed",
        "modelDescription.xml",
    ),
    (
        "<Category name=\"logAll\"/>",
        "<Category name=\"logAll\" name=\"b\"/>",
        "xml.well-formed",
        "modelDescription.xml",
    ),
    (
        "fmiModelDescription",
        "modelDescription",
        "xml.root",
        "modelDescription",
    ),
    (
        "<SourceFiles>",
        "<Extra/><SourceFiles>",
        "xml.element",
        "CoSimulation/Extra",
    ),
    ("<File name=\"good.c\"/>", "<File name=\"./good.c\"/>", "nothing", ""),
    (" encoding=\"UTF-8\"", "", "nothing", ""),
    (
        "<DefaultExperiment startTime=\"0\" stopTime=\"2\" tolerance=\"1e-6\" stepSize=\"0.1\"/>",
        "",
        "nothing",
        "",
    ),
    (
        "<LogCategories>\n    <Category name=\"logAll\"/>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n  \
         <DefaultExperiment startTime=\"0\" stopTime=\"2\" tolerance=\"1e-6\" stepSize=\"0.1\"/>",
        "<DefaultExperiment startTime=\"0\" stopTime=\"2\" tolerance=\"1e-6\" stepSize=\"0.1\"/>\n  <LogCategories>\
         <Category name=\"logAll\"/></LogCategories>",
        "xml.order",
        "LogCategories",
    ),
    (
        "<UnitDefinitions>",
        "<UnitDefinitions/><UnitDefinitions>",
        "xml.repeated",
        "UnitDefinitions[2]",
    ),
    ("<Integer/>", "<Integer/><Real/>", "xml.repeated", "n"),
    ("<Integer/>", "", "xml.missing", "n"),
    (
        "<UnitDefinitions>",
        "<UnitDefinitions/><UnitDefinitions>",
        "xml.missing",
        "UnitDefinitions[1]",
    ),
    (
        "description=\"a tank\"",
        "descripton=\"a tank\"",
        "xml.attribute",
        "fmiModelDescription",
    ),
    (
        "<Boolean start=\"true\"/>",
        "<Boolean start=\"true\" min=\"0\"/>",
        "xml.attribute",
        "enabled",
    ),
    (
        "modelName=\"good\" ",
        "",
        "xml.attribute-missing",
        "fmiModelDescription",
    ),
    (
        "<Item name=\"low\" value=\"1\"/>",
        "<Item name=\"low\"/>",
        "xml.attribute-missing",
        "TypeDefinitions/SimpleType[@name='Mode']/Enumeration/Item[@name='low']",
    ),
    ("start=\"2\"", "start=\"2,0\"", "xml.value", "gain"),
    ("<Integer start=\"0\"/>", "<Integer start=\"0.5\"/>", "xml.value", "k"),
    ("start=\"true\"", "start=\"yes\"", "xml.value", "enabled"),
    (
        "generationDateAndTime=\"2026-01-31T12:00:00Z\"",
        "generationDateAndTime=\"31.1.2026\"",
        "xml.value",
        "fmiModelDescription",
    ),
    (
        "Convention=\"structured\"",
        "Convention=\"nested\"",
        "xml.value",
        "fmiModelDescription",
    ),
    (
        "m=\"1\" s=\"-1\"",
        "m=\"1\" s=\"-0.5\"",
        "xml.value",
        "UnitDefinitions/Unit[@name='m/s']/BaseUnit",
    ),
    ("causality=\"independent\"", "causality=\"time\"", "xml.value", "time"),
    (
        "canGetAndSetFMUstate=\"true\"",
        "canGetAndSetFMUstate=\"True\"",
        "xml.value",
        "CoSimulation",
    ),
    (
        "dependenciesKind=\"fixed constant\"",
        "dependenciesKind=\"fixed nothing\"",
        "xml.value",
        "ModelStructure/Outputs/Unknown[1]",
    ),
    ("<Outputs>", "<Outputs>all", "xml.text", "ModelStructure/Outputs"),
    (
        "fmiVersion=\"2.0\"",
        "fmiVersion=\"3.0\"",
        "description.version",
        "fmiModelDescription",
    ),
    (
        "CoSimulation",
        "Cosimulation",
        "description.interface",
        "fmiModelDescription",
    ),
    (
        "modelIdentifier=\"good\"",
        "modelIdentifier=\"good-1\"",
        "description.identifier",
        "CoSimulation",
    ),
    (
        "modelName=\"good\"",
        "modelName=\"\"",
        "description.name",
        "fmiModelDescription",
    ),
    (
        "guid=\"{6f0f1d0c-8f5b-4d9e-9a51-0c2f3f1d7a10}\"",
        "guid=\"\"",
        "description.guid",
        "fmiModelDescription",
    ),
    ("T12:00:00Z", "T12:00:00", "description.date", "fmiModelDescription"),
    (
        "generationTool=\"by hand\" ",
        "",
        "description.tool",
        "fmiModelDescription",
    ),
    (
        "guid=",
        "numberOfEventIndicators=\"3\" guid=",
        "description.events",
        "fmiModelDescription",
    ),
    (
        "canGetAndSetFMUstate=\"true\" ",
        "",
        "description.serialize",
        "CoSimulation",
    ),
    (
        "<Unit name=\"s\">",
        "<Unit name=\"m\">",
        "unit.duplicate",
        "UnitDefinitions/Unit[@name='m']",
    ),
    (
        "factor=\"1000\"/>",
        "factor=\"1000\"/><DisplayUnit name=\"mm\"/>",
        "unit.display-duplicate",
        "UnitDefinitions/Unit[@name='m']/DisplayUnit[@name='mm']",
    ),
    (
        "factor=\"1000\"",
        "factor=\"0\"",
        "unit.factor",
        "UnitDefinitions/Unit[@name='m']/DisplayUnit[@name='mm']",
    ),
    (
        "<Unit name=\"s\"><BaseUnit s=\"1\"/></Unit>",
        "<Unit name=\"s\"/>",
        "unit.base",
        "UnitDefinitions/Unit[@name='s']",
    ),
    ("<Real unit=\"s\"/>", "<Real unit=\"h\"/>", "unit.unknown", "time"),
    (
        "unit=\"m\" displayUnit=\"mm\"",
        "unit=\"ft\"",
        "unit.unknown",
        "TypeDefinitions/SimpleType[@name='Length']",
    ),
    (
        "displayUnit=\"m\"",
        "displayUnit=\"km\"",
        "unit.display-unknown",
        "level",
    ),
    (
        "<Real unit=\"m\" displayUnit=\"m\"/>",
        "<Real displayUnit=\"m\"/>",
        "unit.display-alone",
        "level",
    ),
    (
        "<SimpleType name=\"Count\">",
        "<SimpleType name=\"Mode\">",
        "type.duplicate",
        "TypeDefinitions/SimpleType[@name='Mode']",
    ),
    (
        "\"Count\"",
        "\"n\"",
        "type.shadow",
        "TypeDefinitions/SimpleType[@name='n']",
    ),
    (
        "<Item name=\"high\"",
        "<Item name=\"low\"",
        "type.item-name",
        "TypeDefinitions/SimpleType[@name='Mode']/Enumeration/Item[@name='low']",
    ),
    (
        "name=\"high\" value=\"2\"",
        "name=\"high\" value=\"1\"",
        "type.item-value",
        "TypeDefinitions/SimpleType[@name='Mode']/Enumeration/Item[@name='high']",
    ),
    ("min=\"0\" max=\"10\"", "min=\"20\" max=\"10\"", "range.empty", "gain"),
    (
        "<Integer min=\"0\" max=\"1000\"/>",
        "<Integer min=\"1001\" max=\"1000\"/>",
        "range.empty",
        "TypeDefinitions/SimpleType[@name='Count']",
    ),
    (
        "nominal=\"1\"",
        "nominal=\"0\"",
        "range.nominal",
        "TypeDefinitions/SimpleType[@name='Length']",
    ),
    (
        "<Category name=\"logStatusError\"/>",
        "<Category name=\"logAll\"/>",
        "log.duplicate",
        "LogCategories/Category[@name='logAll']",
    ),
    (
        "stopTime=\"2\"",
        "stopTime=\"0\"",
        "experiment.stop",
        "DefaultExperiment",
    ),
    (
        "stepSize=\"0.1\"",
        "stepSize=\"-0.1\"",
        "experiment.step",
        "DefaultExperiment",
    ),
    (
        "tolerance=\"1e-6\"",
        "tolerance=\"0\"",
        "experiment.tolerance",
        "DefaultExperiment",
    ),
    (
        "</VendorAnnotations>",
        "<Tool name=\"nobody\"/></VendorAnnotations>",
        "annotation.duplicate",
        "VendorAnnotations/Tool[@name='nobody']",
    ),
    (
        "<Integer/>",
        "<Integer/><Annotations><Tool name=\"a\"/><Tool name=\"a\"/></Annotations>",
        "annotation.duplicate",
        "n/Tool[@name='a']",
    ),
    ("name=\"u[2]\"", "name=\"u[1]\"", "variable.duplicate", "u[1]"),
    (
        "name=\"n\"",
        "name=\"\"",
        "variable.name",
        "ModelVariables/ScalarVariable[16]",
    ),
    (
        "name=\"double_gain\"",
        "name=\"double gain\"",
        "variable.structured",
        "double gain",
    ),
    ("name=\"z\"", "name=\"a..z\"", "variable.structured", "a..z"),
    (
        "causality=\"parameter\" variability=\"tunable\"",
        "causality=\"parameter\" variability=\"discrete\"",
        "variable.combination",
        "limit",
    ),
    (
        "name=\"n\" valueReference=\"3\" causality=\"output\" variability=\"discrete\"",
        "name=\"n\" valueReference=\"3\" causality=\"output\" variability=\"continuous\"",
        "variable.continuous",
        "n",
    ),
    (
        "name=\"n\" valueReference=\"3\" causality=\"output\" variability=\"discrete\"",
        "name=\"n\" valueReference=\"3\" causality=\"output\"",
        "variable.continuous-default",
        "n",
    ),
    (
        "initial=\"exact\"><Real min",
        "initial=\"calculated\"><Real min",
        "variable.initial",
        "gain",
    ),
    (
        "<ScalarVariable name=\"u[1]\"",
        "<ScalarVariable initial=\"exact\" name=\"u[1]\"",
        "variable.initial",
        "u[1]",
    ),
    (
        "<String start=\"tank\"/>",
        "<String/>",
        "variable.start-missing",
        "label",
    ),
    ("<Integer start=\"0\"/>", "<Integer/>", "variable.start-missing", "k"),
    (
        "<Real declaredType=\"Length\" start=\"1\"/>",
        "<Real declaredType=\"Length\"/>",
        "variable.start-missing",
        "x",
    ),
    (
        "variability=\"fixed\"><Real/>",
        "variability=\"fixed\"><Real start=\"4\"/>",
        "variable.start-forbidden",
        "double_gain",
    ),
    (
        "<Real unit=\"s\"/>",
        "<Real unit=\"s\" start=\"0\"/>",
        "variable.start-forbidden",
        "time",
    ),
    ("start=\"2\"", "start=\"20\"", "variable.start-range", "gain"),
    (
        "declaredType=\"Count\" start=\"3\"",
        "declaredType=\"Count\" start=\"-3\"",
        "variable.start-range",
        "count0",
    ),
    (
        "declaredType=\"Mode\" start=\"1\"",
        "declaredType=\"Mode\" start=\"3\"",
        "variable.start-item",
        "mode",
    ),
    (
        "<Integer declaredType=\"Count\"",
        "<Integer declaredType=\"Number\"",
        "variable.type-unknown",
        "count0",
    ),
    (
        "<Integer declaredType=\"Count\"",
        "<Integer declaredType=\"Length\"",
        "variable.type-kind",
        "count0",
    ),
    (
        "causality=\"local\" variability=\"constant\"><Real start=\"3.141592653589793\"/>",
        "causality=\"independent\" variability=\"continuous\"><Real/>",
        "variable.independent",
        "pi",
    ),
    ("derivative=\"8\"", "derivative=\"99\"", "variable.derivative", "der(x)"),
    ("derivative=\"8\"", "derivative=\"16\"", "variable.derivative", "der(x)"),
    (
        "name=\"der(x)\" valueReference=\"8\" causality=\"local\" variability=\"continuous\"",
        "name=\"der(x)\" valueReference=\"8\" causality=\"local\" variability=\"discrete\"",
        "variable.derivative-kind",
        "der(x)",
    ),
    (
        "causality=\"output\" variability=\"continuous\"><Real declaredType=\"Length\"/></ScalarVariable>\n    <ScalarVariable name=\"z\"",
        "causality=\"output\" variability=\"continuous\"><Real declaredType=\"Length\" reinit=\"true\"/></ScalarVariable>\n    <ScalarVariable name=\"z\"",
        "variable.reinit",
        "y",
    ),
    (
        "<ScalarVariable name=\"z\"",
        "<ScalarVariable canHandleMultipleSetPerTimeInstant=\"true\" name=\"z\"",
        "variable.multiple-set",
        "z",
    ),
    (
        "name=\"u[2]\" valueReference=\"6\"",
        "name=\"u[2]\" valueReference=\"5\"",
        "variable.alias-settable",
        "u[2]",
    ),
    (
        "<Real unit=\"m\" displayUnit=\"m\"/>",
        "<Real unit=\"m\" start=\"1\"/>",
        "variable.alias-start",
        "level",
    ),
    (
        "name=\"pi\" valueReference=\"4\"",
        "name=\"pi\" valueReference=\"3\"",
        "variable.alias-constant",
        "double_gain",
    ),
    (
        "<Real unit=\"m\" displayUnit=\"m\"/>",
        "<Real unit=\"s\"/>",
        "variable.alias-unit",
        "level",
    ),
    (
        "<Real unit=\"m\" displayUnit=\"m\"/>",
        "<Real/>",
        "variable.alias-unit",
        "level",
    ),
    ("name=\"u[2]\"", "name=\"u[3]\"", "variable.array", "u"),
    ("name=\"u[2]\"", "name=\"u[2,1]\"", "variable.array", "u"),
    (
        "<Unknown index=\"21\" dependencies=\"\"/>",
        "<Unknown index=\"99\" dependencies=\"\"/>",
        "structure.index",
        "ModelStructure/Outputs/Unknown[6]",
    ),
    (
        "<Unknown index=\"12\" dependencies=\"8\"/>\n      <Unknown index=\"16\" dependencies=\"15\"/>",
        "<Unknown index=\"12\" dependencies=\"8\"/><Unknown index=\"12\" dependencies=\"8\"/>\n      <Unknown index=\"16\" dependencies=\"15\"/>",
        "structure.repeated",
        "z",
    ),
    (
        "<Unknown index=\"21\" dependencies=\"\"/>",
        "",
        "structure.output-missing",
        "said",
    ),
    (
        "<Unknown index=\"21\" dependencies=\"\"/>",
        "<Unknown index=\"20\"/><Unknown index=\"21\" dependencies=\"\"/>",
        "structure.output-extra",
        "label",
    ),
    ("derivative=\"8\"", "", "structure.derivative-extra", "der(x)"),
    (
        "<Unknown index=\"4\" dependencies=\"2\" dependenciesKind=\"dependent\"/>",
        "",
        "structure.initial-missing",
        "double_gain",
    ),
    (
        "<Unknown index=\"4\" dependencies=\"2\" dependenciesKind=\"dependent\"/>",
        "<Unknown index=\"2\"/><Unknown index=\"4\" dependencies=\"2\"/>",
        "structure.initial-extra",
        "gain",
    ),
    (
        "<Unknown index=\"4\" dependencies=\"2\" dependenciesKind=\"dependent\"/>\n      <Unknown index=\"9\" dependencies=\"7 8 18\"/>",
        "<Unknown index=\"9\" dependencies=\"7 8 18\"/><Unknown index=\"4\" dependencies=\"2\"/>",
        "structure.initial-order",
        "ModelStructure/InitialUnknowns/Unknown[2]",
    ),
    (
        "dependenciesKind=\"dependent\"",
        "dependenciesKind=\"fixed\"",
        "structure.initial-kind",
        "ModelStructure/InitialUnknowns/Unknown[1]",
    ),
    (
        "dependencies=\"7 8 18\"",
        "dependencies=\"7 8 81\"",
        "structure.dependency",
        "ModelStructure/InitialUnknowns/Unknown[2]",
    ),
    (
        "dependencies=\"7 8 18\"",
        "dependencies=\"7 8 8\"",
        "structure.dependency-repeated",
        "ModelStructure/InitialUnknowns/Unknown[2]",
    ),
    (
        "dependencies=\"7 8 18\"",
        "dependencies=\"8 7 18\"",
        "structure.dependency-order",
        "ModelStructure/InitialUnknowns/Unknown[2]",
    ),
    (
        "dependencies=\"7 8 18\"",
        "dependencies=\"7 8 11\"",
        "structure.dependency-known",
        "ModelStructure/InitialUnknowns/Unknown[2]",
    ),
    (
        "dependenciesKind=\"fixed constant\"",
        "dependenciesKind=\"fixed\"",
        "structure.kinds",
        "ModelStructure/Outputs/Unknown[1]",
    ),
    (
        "<Unknown index=\"16\" dependencies=\"15\"/>",
        "<Unknown index=\"16\" dependencies=\"15\" dependenciesKind=\"discrete\"/>",
        "structure.kind-real",
        "ModelStructure/Outputs/Unknown[3]",
    ),
    // Of InitialUnknowns, too.
    (
        "dependencies=\"13 15\"",
        "dependencies=\"13 15\" dependenciesKind=\"dependent constant\"",
        "structure.kind-real",
        "ModelStructure/InitialUnknowns/Unknown[5]",
    ),
    (
        "<Unknown index=\"16\" dependencies=\"15\"/>",
        "<Unknown index=\"16\" dependencies=\"15\" dependenciesKind=\"dependent\"/>",
        "nothing",
        "",
    ),
    (
        "<Unknown index=\"12\" dependencies=\"8\"/>\n      <Unknown index=\"16\"",
        "<Unknown index=\"12\" dependencies=\"8 15\" dependenciesKind=\"constant tunable\"/>\n      <Unknown index=\"16\"",
        "structure.kind-known",
        "ModelStructure/Outputs/Unknown[2]",
    ),
    (
        "dependencies=\"6 8\" dependenciesKind",
        "dependenciesKind",
        "structure.kinds-alone",
        "ModelStructure/Outputs/Unknown[1]",
    ),
];

/// Several replacements, the rule and the element.
type Edits = (&'static [(&'static str, &'static str)], &'static str, &'static str);

const TWICE: &[Edits] = &[
    (
        &[
            EXCHANGED,
            (
                "<Derivatives>\n      <Unknown index=\"9\" dependencies=\"7 8\"/>\n    </Derivatives>",
                "",
            ),
        ],
        "structure.derivative-missing",
        "der(x)",
    ),
    // A second state, which is an output, and whose derivative is local.
    (
        &[
            EXCHANGED,
            (
                "name=\"pi\" valueReference=\"4\" causality=\"local\" variability=\"constant\"><Real start=\"3.141592653589793\"/>",
                "name=\"pi\" valueReference=\"4\" causality=\"local\" variability=\"continuous\"><Real derivative=\"11\"/>",
            ),
        ],
        "structure.derivative-missing",
        "pi",
    ),
    (
        &[(
            "name=\"level\" valueReference=\"7\" causality=\"local\" variability=\"continuous\"><Real unit=\"m\" displayUnit=\"m\"/>",
            "name=\"level\" valueReference=\"4\" causality=\"local\" variability=\"constant\"><Real start=\"3\"/>",
        )],
        "variable.alias-constant",
        "level",
    ),
];

const EXCHANGED: (&str, &str) = (
    "<CoSimulation modelIdentifier",
    "<ModelExchange modelIdentifier=\"good\"/><CoSimulation modelIdentifier",
);

/// FMI 2.0.4, 2.2.7: inputs and outputs may be derivatives of each other; and one state has one derivative that is listed, whatever
/// else has its value.
#[test]
fn what_is_no_derivative_of_a_state_need_not_be_listed() {
    let Some(library) = library() else { return };
    let input = "name=\"u[2]\" valueReference=\"6\" causality=\"input\" variability=\"continuous\"><Real unit=\"m\"";
    let y = "causality=\"output\" variability=\"continuous\"><Real declaredType=\"Length\"/></ScalarVariable>\n    <ScalarVariable name=\"z\"";
    let z = "name=\"z\" valueReference=\"10\" causality=\"output\" variability=\"continuous\"><Real declaredType=\"Length\"/>";
    let derived = |text: &str, of: &str| text.replacen("<Real ", &format!("<Real derivative=\"{of}\" "), 1);
    let alias = "name=\"z\" valueReference=\"8\" causality=\"output\" variability=\"continuous\"><Real unit=\"m/s\" derivative=\"10\"/>";
    for (from, to) in [
        // An input of an input, an output of an output and of an input, an alias of the derivative with an alias of its state.
        (input, derived(input, "6")),
        (y, derived(y, "12")),
        (y, derived(y, "6")),
        (z, alias.to_owned()),
    ] {
        let mut files = good(&library);
        files[0].1 = edited(&[EXCHANGED, (from, &to)]);
        let findings = found_in(&files);
        let told = findings.0.iter().filter(|f| !f.rule.id.starts_with("archive."));
        assert_eq!(
            told.map(|f| f.rule.id).collect::<Vec<_>>(),
            [""; 0],
            "{to}\n{}",
            lines(&findings)
        );
    }
}

#[test]
fn every_defect_of_the_description_is_named() {
    let Some(library) = library() else { return };
    let (mut tried, mut missed) = (0, Vec::new());
    let once = XML
        .iter()
        .map(|(from, to, rule, element)| (vec![(*from, *to)], *rule, *element));
    for (edits, rule, element) in once.chain(
        TWICE
            .iter()
            .map(|(edits, rule, element)| (edits.to_vec(), *rule, *element)),
    ) {
        let mut files = good(&library);
        files[0].1 = edited(&edits);
        let findings = found_in(&files);
        // What the standard leaves to the author.
        if rule == "nothing" {
            assert_eq!(serious(&findings), 0, "{}", lines(&findings));
            continue;
        }
        tried += 1;
        if !names(&findings, rule, element) {
            missed.push(format!("{edits:?}: no {rule} of {element}\n{}", lines(&findings)));
        }
    }
    score("description", tried, &missed);
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// Of the rules of a description, each is broken by some defect here.
#[test]
fn every_rule_of_the_description_is_tried() {
    let mut tried: BTreeSet<&str> = XML.iter().map(|edit| edit.2).collect();
    tried.extend(TWICE.iter().map(|edit| edit.1));
    let mut left = rules::all().map(|rule| rule.id).filter(|id| !tried.contains(id));
    assert_eq!(
        left.find(|id| !id.starts_with("archive.") && !id.starts_with("binary.")),
        None
    );
}
