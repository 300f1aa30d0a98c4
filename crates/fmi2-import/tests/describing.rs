//! What a description says, and the values that texts stand for.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;

use common::Workshop;
use fmi2_import::{BaseType, Causality, Fmu, ImportError, Initial, ModelDescription, Value, Variability, suggest};

const XML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<!-- written by hand -->
<fmiModelDescription fmiVersion="2.0" modelName="nav &amp; more" guid="{g}" version="1.2" description="d &lt; e"
    author="someone" copyright="c" license="MIT" generationTool="a pen" generationDateAndTime="2020-01-01T00:00:00Z"
    variableNamingConvention="structured" numberOfEventIndicators="0">
  <ModelExchange modelIdentifier="nav_me"/>
  <CoSimulation modelIdentifier="nav" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="1"
      maxOutputDerivativeOrder="2"><SourceFiles><File name="a.c"/></SourceFiles></CoSimulation>
  <UnitDefinitions>
    <Unit name="m/s2"><BaseUnit m="1" s="-2"/></Unit>
    <Unit name="rad"><BaseUnit rad="1"/><DisplayUnit name="deg" factor="57.29577951308232"/></Unit>
    <Unit name="m/s^2.5"/>
  </UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Angle"><Real quantity="Angle" unit="rad" displayUnit="deg" min="-4" max="4"/></SimpleType>
    <SimpleType name="Small"><Integer min="0" max="3"/></SimpleType>
    <SimpleType name="Mode"><Enumeration>
      <Item name="printed" value="1" description="as printed"/><Item name="consistent" value="2"/>
    </Enumeration></SimpleType>
  </TypeDefinitions>
  <LogCategories><Category name="logEvents" description="what happens"/></LogCategories>
  <DefaultExperiment startTime="0" stopTime="5680" stepSize="1"/>
  <VendorAnnotations>
    <Tool name="another"><Presets kind="other"><Preset/><Tool name="inner">&lt;</Tool></Presets><x:y xmlns:x="urn:x">text</x:y></Tool>
    <Tool name="a &amp; b">
    <Filters>
      <Set/>
    </Filters></Tool>
    <Tool name="silent"/>
    <Tool name="another"><Again/></Tool>
  </VendorAnnotations>
  <ModelVariables>
    <ScalarVariable name="gate" valueReference="7" description="a bound" causality="parameter" variability="fixed" initial="exact">
      <Real start="1e-4" unit="m/s2" min="0"/></ScalarVariable>
    <ScalarVariable name="angle" valueReference="8" causality="input"><Real declaredType="Angle" max="1" start="0"/></ScalarVariable>
    <ScalarVariable name="milton.residuals" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="Mode" start="1"/></ScalarVariable>
    <ScalarVariable name="milton.m_b" valueReference="1" causality="parameter" variability="tunable"><Integer declaredType="Small" start="2"/></ScalarVariable>
    <ScalarVariable name="milton.whiten" valueReference="0" causality="parameter" variability="fixed"><Boolean start="false"/></ScalarVariable>
    <ScalarVariable name="label" valueReference="0" causality="parameter" variability="fixed"><String start="a b"/></ScalarVariable>
    <ScalarVariable name="v[1]" valueReference="21" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="v[2]" valueReference="20" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="p[1,1]" valueReference="30"><Real/><Annotations><Tool name="z"/></Annotations></ScalarVariable>
    <ScalarVariable name="p[1,2]" valueReference="31"><Real/></ScalarVariable>
    <ScalarVariable name="p[2,1]" valueReference="32"><Real/></ScalarVariable>
    <ScalarVariable name="p[2,2]" valueReference="33"><Real/></ScalarVariable>
    <ScalarVariable name="count[1]" valueReference="5" causality="output" variability="discrete"><Integer/></ScalarVariable>
    <ScalarVariable name="time" valueReference="40" causality="independent"><Real/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="7"/></Outputs></ModelStructure>
</fmiModelDescription>
"#;

fn describe(xml: &str) -> Result<ModelDescription, ImportError> {
    let shop = Workshop::new();
    let fmu = Fmu::open(shop.zip("nav.fmu", &[("modelDescription.xml", xml.as_bytes())]))?;
    Ok(fmu.description().clone())
}

fn nav() -> ModelDescription {
    describe(XML).unwrap()
}

#[test]
fn everything_a_master_needs_is_read() {
    let nav = nav();
    assert_eq!((nav.model_name.as_str(), nav.guid.as_str()), ("nav & more", "{g}"));
    assert_eq!(nav.description.as_deref(), Some("d < e"));
    assert_eq!(nav.license.as_deref(), Some("MIT"));
    let slave = &nav.co_simulation;
    assert_eq!(
        (slave.model_identifier.as_str(), slave.max_output_derivative_order),
        ("nav", 2)
    );
    assert!(slave.can_handle_variable_communication_step_size && slave.can_get_and_set_fmu_state);
    assert!(!slave.can_serialize_fmu_state && !slave.can_be_instantiated_only_once_per_process);
    assert_eq!(nav.default_experiment.stop_time, Some(5680.0));
    assert_eq!(nav.default_experiment.tolerance, None);
    assert_eq!(nav.log_categories[0].name, "logEvents");

    assert_eq!(nav.units[0].base.unwrap().exponents, [0, 1, -2, 0, 0, 0, 0, 0]);
    assert_eq!(nav.units[1].display[0].name, "deg");
    assert_eq!(nav.units[2].base, None);
    let items: Vec<_> = nav.enumerations[0]
        .items
        .iter()
        .map(|i| (i.name.as_str(), i.value))
        .collect();
    assert_eq!(items, [("printed", 1), ("consistent", 2)]);

    let gate = nav.variable("gate").unwrap();
    assert_eq!(
        (gate.value_reference, gate.description.as_deref()),
        (7, Some("a bound"))
    );
    assert_eq!(
        (gate.causality, gate.variability),
        (Causality::Parameter, Variability::Fixed)
    );
    assert_eq!(
        (gate.initial, gate.unit(), gate.start()),
        (Some(Initial::Exact), Some("m/s2"), Some(Value::Real(1e-4)))
    );
    // Absent attributes have the standard's defaults.
    let p = nav.variable("p[1,1]").unwrap();
    assert_eq!(
        (p.causality, p.variability, p.initial),
        (Causality::Local, Variability::Continuous, None)
    );
    assert_eq!(nav.variable("time").unwrap().causality, Causality::Independent);
    assert_eq!(
        nav.variable("label").unwrap().start(),
        Some(Value::String("a b".to_owned()))
    );
}

#[test]
fn declared_types_fill_in_what_a_variable_leaves_out() {
    let nav = nav();
    let angle = nav.variable("angle").unwrap();
    assert_eq!((angle.unit(), angle.display_unit()), (Some("rad"), Some("deg")));
    // The type allows -4..4, the variable itself no more than 1.
    assert!(
        angle.parse_value("-3.9").is_ok() && angle.parse_value("1.1").is_err() && angle.parse_value("-4.1").is_err()
    );
}

#[test]
fn annotations_are_handed_over_as_they_stand() {
    let nav = nav();
    let tools: Vec<_> = nav.vendor_annotations.iter().map(|a| a.tool.as_str()).collect();
    assert_eq!(tools, ["another", "a & b", "silent", "another"]);
    let others: Vec<_> = nav.annotations("another").collect();
    let first =
        r#"<Presets kind="other"><Preset/><Tool name="inner">&lt;</Tool></Presets><x:y xmlns:x="urn:x">text</x:y>"#;
    assert_eq!(others, [first, "<Again/>"]);
    assert_eq!(
        nav.annotations("a & b").collect::<Vec<_>>(),
        ["<Filters>\n      <Set/>\n    </Filters>"]
    );
    assert_eq!(nav.annotations("silent").collect::<Vec<_>>(), [""]);
    assert_eq!(
        nav.annotations("z").count(),
        0,
        "an annotation of a variable is none of the FMU"
    );
}

#[test]
fn items_are_those_of_an_enumeration() {
    let nav = nav();
    let names: Vec<_> = nav
        .items("milton.residuals")
        .iter()
        .map(|item| item.name.as_str())
        .collect();
    assert_eq!(names, ["printed", "consistent"]);
    assert!(nav.items("gate").is_empty() && nav.items("no such").is_empty());
}

#[test]
fn vectors_and_matrices_are_found_in_reading_order() {
    let nav = nav();
    assert_eq!(nav.find_vector("v", 2).unwrap(), [21, 20]);
    assert_eq!(nav.find_matrix("p", 2, 2).unwrap(), [30, 31, 32, 33]);
    let error = nav.find_vector("v", 3).unwrap_err();
    assert!(
        matches!(&error, ImportError::UnknownVariable { name, .. } if name == "v[3]"),
        "{error}"
    );
    let error = nav.find_vector("count", 1).unwrap_err();
    assert!(
        matches!(
            &error,
            ImportError::WrongType {
                found: BaseType::Integer,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn values_are_read_by_the_type_of_their_variable() {
    let nav = nav();
    for (variable, text, value) in [
        ("gate", " 2.5e-3 ", Value::Real(2.5e-3)),
        ("gate", "0", Value::Real(0.0)),
        ("milton.m_b", "3", Value::Integer(3)),
        ("milton.residuals", "consistent", Value::Integer(2)),
        ("milton.residuals", "1", Value::Integer(1)),
        ("milton.whiten", "true", Value::Boolean(true)),
        ("milton.whiten", "0", Value::Boolean(false)),
        ("label", " as it is ", Value::String(" as it is ".to_owned())),
    ] {
        let variable = nav.variable(variable).unwrap();
        let read = variable.parse_value(text).unwrap();
        assert_eq!(read, value);
        assert!(read.fits(variable.base_type()));
        assert_eq!(
            variable.parse_value(&variable.format_value(&read)).unwrap(),
            value,
            "there and back"
        );
    }
    let residuals = nav.variable("milton.residuals").unwrap();
    assert_eq!(residuals.format_value(&Value::Integer(2)), "consistent");
}

#[test]
fn bad_values_say_what_would_do() {
    let nav = nav();
    for (variable, text, hint) in [
        ("gate", "small", "a number"),
        ("gate", "", "a number"),
        ("gate", "NaN", "finite"),
        ("gate", "inf", "finite"),
        ("gate", "-1e-9", "the minimum is 0 m/s2"),
        ("milton.m_b", "2.5", "whole number"),
        ("milton.m_b", "4", "the maximum is 3"),
        ("milton.m_b", "3000000000", "32 bits"),
        ("milton.residuals", "Consistent", "printed (1), consistent (2)"),
        ("milton.residuals", "3", "printed (1), consistent (2)"),
        ("milton.whiten", "yes", "true, false, 1 or 0"),
    ] {
        let error = nav.variable(variable).unwrap().parse_value(text).unwrap_err();
        assert!(matches!(error, ImportError::BadValue { .. }), "{error}");
        let said = error.to_string();
        assert!(said.contains(variable) && said.contains(hint), "{said}");
    }
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    let nav = nav();
    for (wrong, near) in [
        ("milton.mb", Some("milton.m_b")),
        ("gaet", Some("gate")),
        ("v[3]", Some("v[1]")),
    ] {
        match nav.variable(wrong).unwrap_err() {
            ImportError::UnknownVariable { suggestion, .. } => assert_eq!(suggestion.as_deref(), near, "{wrong}"),
            other => panic!("{other}"),
        }
    }
    assert_eq!(suggest("temperature", ["gate", "label"]), None, "too far off to help");
}

/// The same description in the encodings that tools write, each byte put down by hand.
#[test]
fn a_description_is_read_in_the_encoding_it_declares() {
    let xml = |encoding: &str| {
        format!(
            "<?xml version='1.0'{encoding}?>\n<fmiModelDescription fmiVersion='2.0' modelName='Beh\u{e4}lter' guid='g'>\
             <CoSimulation modelIdentifier='m'/><ModelVariables/></fmiModelDescription>"
        )
    };
    let read = |bytes: &[u8]| ModelDescription::parse(bytes, "m.xml".as_ref());
    let narrow = |text: &str, euro: u8| -> Vec<u8> {
        let byte = |c| match c {
            '\u{e4}' => 0xe4,
            '\u{20ac}' => euro,
            c => u8::try_from(c).unwrap(),
        };
        text.chars().map(byte).collect()
    };
    let wide = |text: &str, unit: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(unit).collect::<Vec<u8>>();
    let marked = |mark: &[u8], bytes: Vec<u8>| [mark.to_vec(), bytes].concat();
    let utf16 = xml(" encoding='UTF-16'");
    for (what, bytes) in [
        ("UTF-8, not said", xml("").into_bytes()),
        ("UTF-8", xml(" encoding = \"utf-8\" standalone='yes'").into_bytes()),
        ("UTF-8 with mark", marked(&[0xef, 0xbb, 0xbf], xml("").into_bytes())),
        ("UTF-8, said to be UTF-16", utf16.clone().into_bytes()),
        ("Latin 1", narrow(&xml(" encoding='ISO-8859-1'"), 0)),
        ("Windows", narrow(&xml(" encoding='windows-1252'"), 0x80)),
        ("UTF-16 LE", marked(&[0xff, 0xfe], wide(&utf16, u16::to_le_bytes))),
        ("UTF-16 BE", marked(&[0xfe, 0xff], wide(&utf16, u16::to_be_bytes))),
        ("UTF-16 LE without mark", wide(&utf16, u16::to_le_bytes)),
        ("UTF-16 BE without mark", wide(&utf16, u16::to_be_bytes)),
    ] {
        assert_eq!(read(&bytes).unwrap().model_name, "Beh\u{e4}lter", "{what}");
    }
    // Only one of the two has a euro.
    let euro = xml(" encoding='windows-1252'").replace("Beh\u{e4}lter", "\u{20ac}");
    assert_eq!(read(&narrow(&euro, 0x80)).unwrap().model_name, "\u{20ac}");

    for (bytes, reason) in [
        (narrow(&xml(""), 0), "line 2, column 53: not UTF-8"),
        (
            xml(" encoding='EBCDIC-9'").into_bytes(),
            "the encoding \"EBCDIC-9\" is not known",
        ),
        (marked(&[0xff, 0xfe], vec![0x00, 0xd8]), "the bytes are not UTF-16LE"),
        (vec![], "line 1"),
    ] {
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    // Where something is wrong is told in the text, whatever the bytes were.
    let wrong = utf16.replace("guid='g'", "");
    let error = read(&marked(&[0xff, 0xfe], wide(&wrong, u16::to_le_bytes)))
        .unwrap_err()
        .to_string();
    assert!(error.contains("line 2") && error.contains("guid"), "{error}");
}
