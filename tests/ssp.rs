//! System structures end to end: the one that `pack` writes, and studies of it.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod common;

use common::{c_library, fmu, harness, harness_ok, read_csv, repacked, results};
use interface::mission::EMBEDDED;
use interface::ports::{PORTS, Role, Shape};
use ssp::{Component, Connection, Connector, DataType, Element, End, Kind, Package, Value, flatten};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

fn packed() -> PathBuf {
    fmu("fmu-nav").with_file_name("relative-navigation.ssp")
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn component<'a>(package: &'a Package, name: &str) -> &'a Component {
    let elements = package.structure().system.elements.iter();
    let mut components = elements.filter_map(|element| match element {
        Element::Component(component) => Some(component),
        Element::System(_) => None,
    });
    components.find(|component| component.name == name).unwrap()
}

/// A study of one filter that takes no time.
const SHORT: [&str; 8] = [
    "compare",
    "--filters",
    "snc",
    "--runs",
    "1",
    "--duration",
    "400",
    "--force",
];

/// What is connected is what the table of ports says that truth offers and a filter reads, with its types and units.
#[test]
fn every_sensor_of_the_interface_is_connected() {
    let package = Package::open(&packed()).unwrap();
    let mut wanted = BTreeMap::new();
    for port in PORTS
        .iter()
        .filter(|port| matches!(port.role, Role::Sensor | Role::Untold))
    {
        let names: Vec<String> = match port.shape {
            Shape::Scalar => vec![port.name.to_owned()],
            Shape::Vector(n) => (1..=n).map(|i| format!("{}[{i}]", port.name)).collect(),
            Shape::Matrix(rows, columns) => (1..=rows)
                .flat_map(|i| (1..=columns).map(move |j| format!("{}[{i},{j}]", port.name)))
                .collect(),
        };
        for (element, name) in names.into_iter().enumerate() {
            wanted.insert(name, port.unit(element));
        }
    }
    let flat = flatten(package.structure()).unwrap();
    let connected: BTreeSet<&str> = flat.connections.iter().map(|c| c.to.1.as_str()).collect();
    assert_eq!(connected, wanted.keys().map(String::as_str).collect::<BTreeSet<_>>());
    assert!(
        flat.connections
            .iter()
            .all(|c| c.from.1 == c.to.1 && c.from.0 == 0 && c.to.0 == 1)
    );
    for name in ["truth", "nav"] {
        for connector in &component(&package, name).connectors {
            let (Some(unit), Some(DataType::Real { unit: said })) = (wanted.get(&connector.name), &connector.data)
            else {
                continue;
            };
            assert_eq!(said.as_deref().unwrap_or_default(), *unit, "{name}.{}", connector.name);
        }
    }
    // FMPy cannot do with an input that is not connected, nor libcosim with an enumeration.
    let inputs = component(&package, "nav").connectors.iter().filter(|c| c.kind.takes());
    assert_eq!(inputs.count(), connected.len());
    assert!(component(&package, "truth").connectors.iter().all(|c| !c.kind.takes()));
    let offered: Vec<&str> = component(&package, "nav")
        .connectors
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    for name in ["est.r_tc_n[1]", "pred.r_tc_n[3]", "status_index"] {
        assert!(offered.contains(&name), "{name}");
    }
}

/// The archive holds both FMUs as they are, and values for every mission that comes with the project.
#[test]
fn every_mission_has_its_values_and_the_fmus_are_as_they_are() {
    let bytes = std::fs::read(packed()).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    assert_eq!(archive.by_index(0).unwrap().name().unwrap(), "SystemStructure.ssd");
    let mut contents = |name: &str| {
        let mut bytes = Vec::new();
        archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
        bytes
    };
    for name in ["fmu-truth", "fmu-nav"] {
        assert_eq!(
            contents(&format!("resources/{name}.fmu")),
            std::fs::read(fmu(name)).unwrap()
        );
    }
    let readme = String::from_utf8(contents("documentation/README.txt")).unwrap();
    for entry in EMBEDDED {
        for element in ["truth", "nav"] {
            let name = format!("resources/{}_{element}.ssv", entry.name);
            let values = String::from_utf8(contents(&name)).unwrap();
            let (of_scenario, by_name) = (
                values.contains("\"scenario_index\""),
                values.contains("\"mission_file\""),
            );
            assert_eq!((of_scenario, by_name), (entry.scenario, !entry.scenario), "{name}");
            assert!(
                !values.contains("ssv:Enumeration") && !values.contains("ssv:Boolean"),
                "{name}"
            );
            assert!(readme.contains(&name), "{name}");
        }
    }
    let package = Package::open(&packed()).unwrap();
    let bound = &component(&package, "nav").bindings;
    let of = |name: &str| {
        bound[0]
            .values
            .parameters
            .iter()
            .find(|p| p.name == name)
            .map(|p| p.value.clone())
    };
    assert_eq!((bound.len(), of("scenario_index")), (1, Some(Value::Integer(1))));
    let experiment = package.structure().experiment.unwrap();
    let mission = EMBEDDED[0].mission().unwrap();
    assert_eq!(experiment.stop_time, Some(mission.time.duration_s));
    // Read and written again it says the same.
    assert_eq!(
        package.structure().to_xml().into_bytes(),
        contents("SystemStructure.ssd")
    );
}

/// A study of the structure is the study of its filter in its mission, byte for byte.
#[test]
fn a_study_of_the_packed_structure_is_that_of_its_filter() {
    let folder = tempfile::tempdir().unwrap();
    let (told, plain) = (folder.path().join("told"), folder.path().join("plain"));
    let ssp = packed();
    harness_ok(&["compare", "--ssp", text(&ssp), "--runs", "2", "--out", text(&told)]);
    harness_ok(&["compare", "--filters", "hybrid", "--runs", "2", "--out", text(&plain)]);
    // Its FMUs are where a repeat finds them.
    harness_ok(&["rerun", text(&told), "--out", text(&folder.path().join("again"))]);
    let (told, plain) = (results(&told), results(&plain));
    for name in ["summary.csv", "runs.csv", "phases.csv"] {
        assert!(!told[name].is_empty());
        assert_eq!(told[name], plain[name], "{name}");
    }
}

/// Options go before what the structure says, and another mission is two words in a folder of the same contents.
#[test]
fn another_mission_is_bound_by_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("structure");
    let changed = unpacked(&place).replace("resources/leo_venting_", "resources/formation_");
    std::fs::write(place.join("SystemStructure.ssd"), changed).unwrap();
    let (told, plain) = (folder.path().join("told"), folder.path().join("plain"));
    let short = ["--runs", "1", "--duration", "600", "--filters", "snc"];
    harness_ok(&[&["compare", "--ssp", text(&place), "--out", text(&told)], &short[..]].concat());
    harness_ok(
        &[
            &["compare", "--scenario", "formation", "--out", text(&plain)],
            &short[..],
        ]
        .concat(),
    );
    // The length that the structure suggests is that of the other mission, and the option goes before it.
    assert_eq!(results(&told)["summary.csv"], results(&plain)["summary.csv"]);
}

/// Packs the driver with names of its own for what it commands; `None` without a C compiler.
fn driver(folder: &Path, [push, kick, kicks]: [&str; 3]) -> Option<PathBuf> {
    let source = include_str!("ssp/push.c");
    let library = c_library(folder, "push", source, &[], "a driver in a structure")?;
    let output = |name: &str, reference: usize, kind: &str| {
        format!(
            "<ScalarVariable name=\"{name}\" valueReference=\"{reference}\" causality=\"output\" variability=\"discrete\">\
             <{kind}/></ScalarVariable>"
        )
    };
    let vectors = [push, kick].into_iter().enumerate();
    let elements = vectors.flat_map(|(place, name)| (0..3).map(move |i| (format!("{name}[{}]", i + 1), 3 * place + i)));
    let variables: String = elements
        .map(|(name, reference)| output(&name, reference, "Real"))
        .collect();
    let description = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><fmiModelDescription fmiVersion=\"2.0\" modelName=\"push\" guid=\"push\">\
         <CoSimulation modelIdentifier=\"push\" canHandleVariableCommunicationStepSize=\"true\"/><ModelVariables>{variables}{}\
         </ModelVariables><ModelStructure/></fmiModelDescription>",
        output(kicks, 0, "Integer")
    );
    let path = folder.join(format!("{push}.fmu"));
    let mut archive = zip::ZipWriter::new(File::create(&path).unwrap());
    let binary = format!("binaries/{}/push.so", fmi2_import::PLATFORM);
    let library = std::fs::read(library).unwrap();
    for (name, bytes) in [
        ("modelDescription.xml", description.as_bytes()),
        (binary.as_str(), &library),
    ] {
        archive
            .start_file(name, zip::write::SimpleFileOptions::default())
            .unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap();
    Some(path)
}

/// What commands the chaser, and tells the filter so: the packed structure with a driver, each connection a pair of ends.
fn with_driver(folder: &Path, driver: &Path, connections: &[[&str; 2]]) -> PathBuf {
    let mut structure = Package::open(&packed()).unwrap().structure().clone();
    let connector = |name: &str, kind| Connector {
        name: name.to_owned(),
        kind,
        data: None,
    };
    let mut component = Component::new("push", "resources/push.fmu");
    for [from, to] in connections {
        let (element, input) = to.split_once('.').unwrap();
        for other in &mut structure.system.elements {
            let Element::Component(other) = other else { continue };
            if other.name == element && other.connectors.iter().all(|c| c.name != input) {
                other.connectors.push(connector(input, Kind::Input));
            }
        }
        if component.connectors.iter().all(|c| c.name != *from) {
            component.connectors.push(connector(from, Kind::Output));
        }
        // What fed the input before feeds it no more.
        structure
            .system
            .connections
            .retain(|c| c.end != End::of(element, input));
        let connection = Connection::new(End::of("push", from), End::of(element, input));
        structure.system.connections.push(connection);
    }
    structure.system.add(component);
    let mut files = BTreeMap::from([("resources/push.fmu".to_owned(), std::fs::read(driver).unwrap())]);
    for name in ["fmu-truth", "fmu-nav"] {
        files.insert(format!("resources/{name}.fmu"), std::fs::read(fmu(name)).unwrap());
    }
    let path = folder.join("driven.ssp");
    std::fs::write(&path, Package::bytes(&structure, &files).unwrap()).unwrap();
    path
}

/// A driver tells world and filter what it commands, under names of its own or of ours, as one of `--drive` does; other
/// connections between them are refused.
#[test]
fn a_driver_tells_the_filter_what_it_commands() {
    const OURS: [&str; 3] = ["a_cmd_c_n", "impulse_c_n", "impulse_count"];
    const THEIRS: [&str; 3] = ["thrust", "kick", "kicks"];
    let folder = tempfile::tempdir().unwrap();
    let (Some(ours), Some(theirs)) = (driver(folder.path(), OURS), driver(folder.path(), THEIRS)) else {
        return;
    };
    let run = |how: &[&str]| {
        let out = folder.path().join("out");
        harness_ok(&[&SHORT[..], &["--out", text(&out)], how].concat());
        let row = read_csv(&out.join("runs.csv")).remove(0);
        assert_eq!((&*row["filter"], &*row["failed"]), ("snc", "0"));
        ["pos_rmse_m", "vel_rmse_m_s", "acc_rmse_m_s2", "nis"].map(|name| row[name].clone())
    };
    let wires = |names: [&str; 3], elements: &[&str]| {
        let wire = |from: &str, to: &str| {
            elements
                .iter()
                .map(|e| [from.to_owned(), format!("{e}.{to}")])
                .collect::<Vec<_>>()
        };
        let mut all = wire(names[2], OURS[2]);
        for (own, shared) in names.into_iter().zip(OURS).take(2) {
            for i in 1..=3 {
                all.extend(wire(&format!("{own}[{i}]"), &format!("{shared}[{i}]")));
            }
        }
        all
    };
    let structure = |driver: &Path, wires: &[[String; 2]]| {
        let wires: Vec<_> = wires.iter().map(|wire| wire.each_ref().map(String::as_str)).collect();
        with_driver(folder.path(), driver, &wires)
    };
    let both: &[&str] = &["truth", "nav"];
    let expected = run(&["--drive", &format!("push={}", text(&ours))]);
    assert_ne!(expected, run(&[]), "what the driver does shows");
    for (driver, names) in [(&ours, OURS), (&theirs, THEIRS)] {
        let ssp = structure(driver, &wires(names, both));
        assert_eq!(run(&["--ssp", text(&ssp)]), expected, "{names:?}");
    }

    let refused = |ssp: &Path| {
        let out = folder.path().join("refused");
        let refused = harness(&["compare", "--ssp", text(ssp), "--runs", "1", "--out", text(&out)]);
        assert_eq!(refused.status.code(), Some(2));
        String::from_utf8_lossy(&refused.stderr).into_owned()
    };
    let told = refused(&structure(&ours, &wires(OURS, &["truth"])));
    assert!(
        told.contains("'nav.a_cmd_c_n[1]': nothing feeds it, and a study would, from push.a_cmd_c_n[1]"),
        "{told}"
    );
    let range = ["thrust[1]", "nav.lidar.range"].map(str::to_owned);
    let alone = [["kick[1]", "truth.impulse_c_n[1]"].map(str::to_owned), range.clone()];
    let told = refused(&structure(&theirs, &alone));
    let says = "connection from push.thrust[1] to nav.lidar.range: in a study a driver tells a filter no more than the commands";
    assert!(told.contains(says), "{told}");
    let mut twice = wires(THEIRS, both);
    twice.push(range);
    let told = refused(&structure(&theirs, &twice));
    assert!(told.contains("component 'nav'"), "{told}");
    assert!(told.contains("would both stand for a_cmd_c_n[1]"), "{told}");
}

/// The packed structure in a folder, to be changed by hand; its text is returned.
fn unpacked(folder: &Path) -> String {
    let mut archive = zip::ZipArchive::new(std::fs::File::open(packed()).unwrap()).unwrap();
    archive.extract(folder).unwrap();
    std::fs::read_to_string(folder.join("SystemStructure.ssd")).unwrap()
}

/// Of a filter that reads the range in km: a bare connection converts it, and so does a factor that stands for the conversion. On top
/// of it, or without either, the range would be another one.
#[test]
fn a_factor_is_a_conversion_only_where_units_are_not_converted() {
    let folder = tempfile::tempdir().unwrap();
    let whole = unpacked(folder.path());
    let nav = folder.path().join("resources/fmu-nav.fmu");
    repacked(&fmu("fmu-nav"), &nav, |name, bytes| {
        Some(match name {
            "modelDescription.xml" => {
                let xml = String::from_utf8(bytes).unwrap();
                let metre = "<Unit name=\"m\">";
                let kilometre = "<Unit name=\"km\"><BaseUnit m=\"1\" factor=\"1000\"/></Unit>";
                let (before, after) = xml.split_once("name=\"lidar.range\"").unwrap();
                format!(
                    "{before}name=\"lidar.range\"{}",
                    after.replacen("unit=\"m\"", "unit=\"km\"", 1)
                )
                .replacen(metre, &format!("{kilometre}{metre}"), 1)
                .into_bytes()
            }
            _ => bytes,
        })
    });
    let range = whole
        .lines()
        .find(|line| line.contains("startConnector=\"lidar.range\""))
        .unwrap();
    // What its connector says of the unit is left to the FMU.
    let (before, after) = whole.split_once("name=\"lidar.range\" kind=\"input\">").unwrap();
    let whole = format!(
        "{before}name=\"lidar.range\" kind=\"input\">{}",
        after.replacen(" unit=\"m\"", "", 1)
    );
    let run = |how: &str, inside: &str| {
        let line = range.replace("/>", &format!(" {how}>{inside}</ssd:Connection>"));
        std::fs::write(folder.path().join("SystemStructure.ssd"), whole.replace(range, &line)).unwrap();
        let out = folder.path().join("out");
        let ended = harness(&[&SHORT[..], &["--ssp", text(folder.path()), "--out", text(&out)]].concat());
        match ended.status.code() {
            Some(0) => {
                assert_ne!(read_csv(&out.join("runs.csv"))[0]["pos_rmse_m"], "");
                Ok(results(&out)["runs.csv"].clone())
            }
            _ => Err(String::from_utf8_lossy(&ended.stderr).into_owned()),
        }
    };
    let (quiet, milli) = (
        "suppressUnitConversion=\"true\"",
        "<ssc:LinearTransformation factor=\"0.001\"/>",
    );
    let bare = run("", "").unwrap();
    assert_eq!(run(quiet, milli).unwrap(), bare);
    for (how, inside, says) in [
        ("", milli, "factor 0.000001 and offset 0"),
        (quiet, "", "factor 1 and offset 0"),
        (
            "",
            "<ssc:LinearTransformation offset=\"1\"/>",
            "factor 0.001 and offset 1",
        ),
    ] {
        let told = run(how, inside).unwrap_err();
        assert!(
            told.contains("connection from truth.lidar.range to nav.lidar.range: "),
            "{told}"
        );
        assert!(told.contains(says), "{says}: {told}");
    }
}

/// A value of a mapping is the one that `--set` would say, worked by hand.
#[test]
fn mapped_values_are_converted_unless_that_is_suppressed() {
    let folder = tempfile::tempdir().unwrap();
    let whole = unpacked(folder.path());
    let out = folder.path().join("out");
    let plain = |sigma: &str| {
        let set = format!("fmu-truth.lidar.sigma_range={sigma}");
        harness_ok(&[&SHORT[..], &["--out", text(&out), "--set", &set]].concat());
        results(&out)["runs.csv"].clone()
    };
    let mapped = |value: &str, how: &str, inside: &str| {
        let binding = format!(
            "<ssd:ParameterBinding><ssd:ParameterValues><ssv:ParameterSet version=\"1.0\" name=\"s\"><ssv:Parameters>\
             <ssv:Parameter name=\"sigma\"><ssv:Real value=\"{value}\" unit=\"km\"/></ssv:Parameter></ssv:Parameters><ssv:Units>\
             <ssc:Unit name=\"km\"><ssc:BaseUnit m=\"1\" factor=\"1000\"/></ssc:Unit></ssv:Units></ssv:ParameterSet>\
             </ssd:ParameterValues><ssd:ParameterMapping><ssm:ParameterMapping version=\"1.0\">\
             <ssm:MappingEntry source=\"sigma\" target=\"lidar.sigma_range\" {how}>{inside}</ssm:MappingEntry>\
             </ssm:ParameterMapping></ssd:ParameterMapping></ssd:ParameterBinding>"
        );
        let first = "<ssd:ParameterBinding source=\"resources/leo_venting_truth.ssv\"/>";
        assert!(whole.contains(first));
        let changed = whole.replace(first, &format!("{first}{binding}"));
        std::fs::write(folder.path().join("SystemStructure.ssd"), changed).unwrap();
        harness_ok(&[&SHORT[..], &["--out", text(&out), "--ssp", text(folder.path())]].concat());
        results(&out)["runs.csv"].clone()
    };
    let (quarter, half) = (plain("0.25"), plain("0.5"));
    assert_ne!(quarter, half);
    // 0.5 m; 0.5 as it stands; 0.125 m and 0.125 m more.
    assert_eq!(mapped("0.0005", "", ""), half);
    assert_eq!(mapped("0.5", "suppressUnitConversion=\"true\"", ""), half);
    let more = "<ssc:LinearTransformation offset=\"0.125\"/>";
    assert_eq!(mapped("0.000125", "", more), quarter);
}

/// What no study can represent is an error that names the element.
#[test]
fn what_a_study_cannot_represent_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let whole = unpacked(folder.path());
    let structure = folder.path().join("SystemStructure.ssd");
    let line = |part: &str| {
        let found = whole.lines().find(|line| line.contains(part)).unwrap();
        found.trim().to_owned()
    };
    let range = line("startConnector=\"lidar.range\"");
    let back = "<ssd:Connection startElement=\"nav\" startConnector=\"est.r_tc_n[1]\" endElement=\"truth\" endConnector=\"a_cmd_c_n[1]\"/>";
    let input = "<ssd:Connector name=\"a_cmd_c_n[1]\" kind=\"input\"><ssc:Real unit=\"m/s2\"/></ssd:Connector>";
    let first = line("<ssd:Connector name=\"sample_time\" kind=\"output\">");
    let scaled = range.replace("/>", "><ssc:LinearTransformation factor=\"1000\"/></ssd:Connection>");
    let top = line("<ssd:System ");
    let offered = "<ssd:Connectors><ssd:Connector name=\"est.r_tc_n[1]\" kind=\"output\"><ssc:Real unit=\"m\"/></ssd:Connector></ssd:Connectors>";
    let doubled = "<ssd:Connection startElement=\"nav\" startConnector=\"est.r_tc_n[1]\" endConnector=\"est.r_tc_n[1]\">\
                   <ssc:LinearTransformation factor=\"2\"/></ssd:Connection>";
    let late = whole.replace("startTime=\"0.0\"", "startTime=\"5.0\"");
    let cases = [
        (whole.replace(&range, ""), "input 'nav.lidar.range': nothing feeds it"),
        (
            whole.replace(&range, &scaled),
            "connection from truth.lidar.range to nav.lidar.range: factor 1000",
        ),
        (
            whole
                .replace(&range, &format!("{range}{back}"))
                .replacen(&first, &format!("{input}{first}"), 1),
            "a filter acts on the world through a driver alone",
        ),
        (
            whole.replace("fmu-truth.fmu", "fmu-nav.fmu"),
            "is of kind output, and the variable is of causality input",
        ),
        (
            whole.replace("source=\"resources/fmu-nav.fmu\"", "source=\"resources/none.fmu\""),
            "component 'nav' names 'resources/none.fmu'",
        ),
        (
            whole.replace("name=\"lidar.range\"", "name=\"lidar.rang\""),
            "lidar.range",
        ),
        (
            whole
                .replace(&top, &format!("{top}{offered}"))
                .replace(&range, &format!("{range}{doubled}")),
            "connector 'est.r_tc_n[1]' of the system: factor 2",
        ),
        (late, "startTime is 5"),
    ];
    for (changed, says) in cases {
        assert_ne!(changed, whole, "{says}");
        std::fs::write(&structure, changed).unwrap();
        let out = folder.path().join("out");
        let refused = harness(&[
            "compare",
            "--ssp",
            text(folder.path()),
            "--runs",
            "1",
            "--out",
            text(&out),
        ]);
        let told = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{says}: {told}");
        assert!(told.contains(says), "{says}: {told}");
    }
}
