//! Archives: written and read again.

use ssp::{
    BaseUnit, Binding, Component, Connection, Connector, DataType, Element, End, Experiment, Kind, Linear,
    MappingEntry, Other, Package, Parameter, ParameterSet, SystemStructure, Unit, Value,
};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read};

fn other(attribute: &str, value: &str) -> Other {
    Other {
        name: "Binary".to_owned(),
        attributes: vec![(attribute.to_owned(), value.to_owned())],
    }
}

fn set(name: &str) -> ParameterSet {
    let parameter = |name: &str, value| Parameter {
        name: name.to_owned(),
        description: Some("a < b & \"c\"\n'd'".to_owned()),
        value,
    };
    ParameterSet {
        name: name.to_owned(),
        description: None,
        parameters: vec![
            parameter("q", Value::Real(0.1 + 0.2, Some("m2/s5".to_owned()))),
            parameter("tiny", Value::Real(5e-324, None)),
            parameter("n", Value::Integer(i32::MIN)),
            parameter("on", Value::Boolean(false)),
            parameter("file", Value::String("  two  blanks\tand a tab".to_owned())),
            parameter("mode", Value::Enumeration("slow".to_owned())),
            parameter("blob", Value::Other(other("value", "00ff"))),
        ],
        units: vec![Unit {
            name: "m2/s5".to_owned(),
            base: BaseUnit {
                exponents: [0, 2, -5, 0, 0, 0, 0, 0],
                factor: 1.0,
                offset: 0.0,
            },
        }],
    }
}

/// Everything that there is a place for.
fn whole() -> SystemStructure {
    let real = |unit: Option<&str>| DataType::Real {
        unit: unit.map(str::to_owned),
    };
    let mut structure = SystemStructure::new("whole");
    structure.description = Some("all of it".to_owned());
    structure.generation_tool = Some("a test".to_owned());
    structure.units = set("").units;
    structure.experiment = Some(Experiment {
        start_time: Some(0.0),
        stop_time: Some(5680.0),
        step_size: Some(0.25),
    });
    let mut world = Component::new("world", "resources/world.fmu")
        .with(Connector::new("y[1,2]", Kind::Output, real(Some("m2/s5"))))
        .with(Connector::new("n", Kind::Output, DataType::Integer))
        .with(Connector::new(
            "log",
            Kind::Output,
            DataType::Other(other("mime-type", "text/plain")),
        ))
        .with(Connector::new("c", Kind::CalculatedParameter, real(None)));
    world.bindings.push(Binding::file("resources/world.ssv", set("there")));
    let mut filter = Component::new("filter", "resources/filter.fmu")
        .with(Connector::new("z", Kind::Input, real(None)))
        .with(Connector::new("on", Kind::Input, DataType::Boolean))
        .with(Connector::new("name", Kind::Parameter, DataType::String))
        .with(Connector::new(
            "mode",
            Kind::Parameter,
            DataType::Enumeration("Mode".to_owned()),
        ));
    filter.connectors.push(Connector {
        name: "any".to_owned(),
        kind: Kind::Input,
        data: None,
    });
    filter.bindings.push(Binding {
        source: None,
        prefix: "p.".to_owned(),
        values: set("here"),
        mapping: Some(vec![MappingEntry {
            source: "p.q".to_owned(),
            target: "k".to_owned(),
            transformation: Some(Linear {
                factor: 1e-3,
                offset: -0.5,
            }),
            suppress_unit_conversion: true,
        }]),
    });
    let mut inner = ssp::System {
        name: "inner".to_owned(),
        connectors: vec![Connector::new("in", Kind::Input, real(None))],
        ..ssp::System::default()
    };
    inner.add(filter);
    inner
        .connections
        .push(Connection::new(End::system("in"), End::of("filter", "z")));
    structure.system.add(world);
    structure.system.elements.push(Element::System(inner));
    structure.system.connections.push(Connection {
        transformation: Some(Linear {
            factor: 57.0,
            offset: 0.0,
        }),
        suppress_unit_conversion: true,
        ..Connection::new(End::of("world", "y[1,2]"), End::of("inner", "in"))
    });
    structure
}

#[test]
fn what_is_written_is_what_is_read() {
    let structure = whole();
    let files = BTreeMap::from([
        ("resources/world.fmu".to_owned(), b"PK\x03\x04 as it is".to_vec()),
        ("resources/filter.fmu".to_owned(), vec![7; 3000]),
    ]);
    let bytes = Package::bytes(&structure, &files).unwrap();
    assert_eq!(bytes, Package::bytes(&structure, &files).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.ssp");
    fs::write(&path, &bytes).unwrap();
    let mut package = Package::open(&path).unwrap();
    assert_eq!(*package.structure(), structure);
    for (name, contents) in &files {
        assert_eq!(package.source("a test", name).unwrap(), *contents);
    }
    let missing = package.source("a test", "resources/none.fmu").unwrap_err().to_string();
    assert!(missing.contains("a test names 'resources/none.fmu'"), "{missing}");

    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let names: Vec<String> = zip.file_names().map(|name| name.unwrap().into_owned()).collect();
    assert_eq!(
        names,
        [
            "SystemStructure.ssd",
            "resources/world.ssv",
            "resources/filter.fmu",
            "resources/world.fmu"
        ]
    );
    let stored = zip.by_name("resources/world.fmu").unwrap().compression();
    assert_eq!(stored, zip::CompressionMethod::Stored);

    // The same from a folder, and from the file in it.
    for name in names {
        let mut contents = Vec::new();
        zip.by_name(&name).unwrap().read_to_end(&mut contents).unwrap();
        let place = folder.path().join("unpacked").join(&name);
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        fs::write(place, contents).unwrap();
    }
    let unpacked = folder.path().join("unpacked");
    assert_eq!(*Package::open(&unpacked).unwrap().structure(), structure);
    assert_eq!(
        *Package::open(&unpacked.join("SystemStructure.ssd"))
            .unwrap()
            .structure(),
        structure
    );
}

#[test]
fn one_file_holds_one_set_of_values() {
    let mut structure = whole();
    let mut other = Component::new("other", "resources/world.fmu");
    other
        .bindings
        .push(Binding::file("resources/world.ssv", set("another")));
    structure.system.add(other);
    let error = Package::bytes(&structure, &BTreeMap::new()).unwrap_err().to_string();
    assert!(
        error.contains("'resources/world.ssv'") && error.contains("twice"),
        "{error}"
    );
}

#[test]
fn a_cut_archive_is_no_archive() {
    let bytes = Package::bytes(&whole(), &BTreeMap::new()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.ssp");
    for length in (0..bytes.len()).step_by(37) {
        fs::write(&path, &bytes[..length]).unwrap();
        let error = Package::open(&path).unwrap_err().to_string();
        assert!(error.contains("cut.ssp"), "{error}");
    }
}

#[test]
fn an_archive_without_a_structure_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let error = Package::open(folder.path()).unwrap_err().to_string();
    assert!(error.contains("it has no SystemStructure.ssd"), "{error}");
}
