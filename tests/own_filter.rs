//! Filters of other people's making, as docs/your-filter.md shows them: from C and from Python, in units of their own.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{harness, harness_ok, read_csv, root, skipped, virtual_environment};
use ssp::{Component, Connection, Connector, Element, End, Kind, Package, System, SystemStructure};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const C: &str = "examples/06_own_filter_in_c";

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Whether the C example can be packed here.
fn has_tools(test: &str) -> bool {
    let runs = |program: &str| Command::new(program).arg("--version").output().is_ok();
    for (program, package) in [("cc", "gcc"), ("python3", "python3")] {
        if !runs(program) {
            skipped(test, package);
            return false;
        }
    }
    true
}

/// Packs the C example after changes to its source and description.
fn pack_c(folder: &Path, changes: &[(&str, &str, &str)]) -> PathBuf {
    for file in ["build.sh", "direct_inversion.c", "modelDescription.xml"] {
        let mut contents = std::fs::read_to_string(root().join(C).join(file)).unwrap();
        for (of, old, new) in changes {
            if *of == file {
                assert!(contents.contains(old), "{file}: {old}");
                contents = contents.replace(old, new);
            }
        }
        std::fs::write(folder.join(file), contents).unwrap();
    }
    let packed = folder.join("direct_inversion.fmu");
    let output = Command::new("bash")
        .arg(folder.join("build.sh"))
        .arg(&packed)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    packed
}

/// RMSE columns of the filter `mine` in each run of a short study.
fn errors(out: &Path, filter: &Path, more: &[&str]) -> Vec<f64> {
    let mine = format!("mine={}", text(filter));
    let line = [
        "compare",
        "--filters",
        "snc",
        "--nav",
        &mine,
        "--runs",
        "2",
        "--duration",
        "1500",
        "--out",
        text(out),
    ];
    harness_ok(&[&line[..], more].concat());
    let rows = read_csv(&out.join("runs.csv"));
    let mine: Vec<_> = rows.iter().filter(|row| row["filter"] == "mine").collect();
    assert_eq!(mine.len(), 2);
    let number = |row: &std::collections::HashMap<String, String>, column: &str| row[column].parse::<f64>().unwrap();
    mine.iter()
        .flat_map(|row| [number(row, "pos_rmse_m"), number(row, "vel_rmse_m_s")])
        .collect()
}

#[test]
fn a_filter_in_kilometres_and_degrees_gives_the_same_numbers() {
    if !has_tools("units") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let sub = |name: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir(&path).unwrap();
        path
    };
    let si = errors(&folder.path().join("out-si"), &pack_c(&sub("si"), &[]), &[]);
    let description = "modelDescription.xml";
    let changes = [
        (
            "direct_inversion.c",
            "tan(f->real[AZIMUTH])",
            "tan(M_PI / 180 * f->real[AZIMUTH])",
        ),
        (
            "direct_inversion.c",
            "tan(f->real[ELEVATION])",
            "tan(M_PI / 180 * f->real[ELEVATION])",
        ),
        (description, "unit=\"m\"", "unit=\"km\""),
        (description, "unit=\"m/s\"", "unit=\"km/s\""),
        (description, "unit=\"rad\"", "unit=\"deg\""),
        (
            description,
            "<Unit name=\"m\"><BaseUnit m=\"1\"/>",
            "<Unit name=\"km\"><BaseUnit m=\"1\" factor=\"1000\"/>",
        ),
        (
            description,
            "<Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-1\"/>",
            "<Unit name=\"km/s\"><BaseUnit m=\"1\" s=\"-1\" factor=\"1000\"/>",
        ),
        (
            description,
            "<Unit name=\"rad\"><BaseUnit rad=\"1\"/>",
            "<Unit name=\"deg\"><BaseUnit rad=\"1\" factor=\"0.017453292519943295\"/>",
        ),
    ];
    let other = errors(&folder.path().join("out-other"), &pack_c(&sub("other"), &changes), &[]);
    for (si, other) in si.iter().zip(&other) {
        // Rounding of 1e-16 in 1 km; a velocity differences two of them over 1 s.
        assert!((si / other - 1.0).abs() < 1e-9, "{si} {other}");
    }

    let wrong = [(
        description,
        "lidar.range\" valueReference=\"1\" causality=\"input\" variability=\"continuous\"><Real unit=\"m\"",
        "lidar.range\" valueReference=\"1\" causality=\"input\" variability=\"continuous\"><Real unit=\"s\"",
    )];
    let mine = format!("mine={}", text(&pack_c(&sub("wrong"), &wrong)));
    let refused = harness(&[
        "compare",
        "--filters",
        "snc",
        "--nav",
        &mine,
        "--out",
        text(&folder.path().join("none")),
    ]);
    let told = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{told}");
    for part in ["fmu-truth.lidar.range", "'m'", "mine.lidar.range", "'s'"] {
        assert!(told.contains(part), "{told}");
    }
}

#[test]
fn names_of_ones_own_are_read_from_a_file() {
    if !has_tools("map-file") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let theirs = [
        ("modelDescription.xml", "est.r_tc_n", "x_hat"),
        ("modelDescription.xml", "lidar.range", "rho"),
    ];
    let packed = pack_c(folder.path(), &theirs);
    let names = folder.path().join("names.toml");
    std::fs::write(&names, "[mine]\nx_hat = \"est.r_tc_n\"\nrho = \"lidar.range\"\n").unwrap();
    let mapped = errors(&folder.path().join("mapped"), &packed, &["--map-file", text(&names)]);
    // Two LiDAR sigmas of 0.08 m and 0.04 deg at some km: metres, not the kilometres of a filter that sees nothing.
    assert!(mapped[0] > 0.05 && mapped[0] < 20.0, "{mapped:?}");
}

/// The same stranger in a system inside a system structure: connections and connectors of the systems say what its names stand for.
#[test]
fn a_system_structure_says_what_names_stand_for() {
    if !has_tools("ssp") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let theirs = [
        ("modelDescription.xml", "est.r_tc_n", "x_hat"),
        ("modelDescription.xml", "est.v_tc_n", "v_hat"),
        ("modelDescription.xml", "lidar.range", "rho"),
    ];
    let packed = pack_c(folder.path(), &theirs);
    let names = folder.path().join("names.toml");
    let table = "[mine]\nx_hat = \"est.r_tc_n\"\nv_hat = \"est.v_tc_n\"\nrho = \"lidar.range\"\n";
    std::fs::write(&names, table).unwrap();
    let mapped = errors(&folder.path().join("mapped"), &packed, &["--map-file", text(&names)]);

    let connector = |name: &str, kind| Connector {
        name: name.to_owned(),
        kind,
        data: None,
    };
    let mut structure = SystemStructure::new("theirs");
    let mut world = Component::new("world", "resources/world.fmu");
    let mut filter = Component::new("filter", "resources/filter.fmu");
    let mut guest = System {
        name: "guest".to_owned(),
        ..System::default()
    };
    let top = &mut structure.system;
    let matrix = (1..=3).flat_map(|i| (1..=3).map(move |j| format!("dcm_bc_n[{i},{j}]")));
    let others = [
        "sample_count",
        "sample_time",
        "lidar.valid",
        "lidar.range",
        "lidar.azimuth",
        "lidar.elevation",
    ];
    for name in others.into_iter().map(str::to_owned).chain(matrix) {
        let own = if name == "lidar.range" { "rho" } else { &name };
        world.connectors.push(connector(&name, Kind::Output));
        guest.connectors.push(connector(own, Kind::Input));
        filter.connectors.push(connector(own, Kind::Input));
        top.connections
            .push(Connection::new(End::of("world", &name), End::of("guest", own)));
        guest
            .connections
            .push(Connection::new(End::system(own), End::of("filter", own)));
    }
    for (own, shared) in [("x_hat", "est.r_tc_n"), ("v_hat", "est.v_tc_n")] {
        for i in 1..=3 {
            let (own, shared) = (format!("{own}[{i}]"), format!("{shared}[{i}]"));
            filter.connectors.push(connector(&own, Kind::Output));
            guest.connectors.push(connector(&own, Kind::Output));
            top.connectors.push(connector(&shared, Kind::Output));
            guest
                .connections
                .push(Connection::new(End::of("filter", &own), End::system(&own)));
            top.connections
                .push(Connection::new(End::of("guest", &own), End::system(&shared)));
        }
    }
    guest.add(filter);
    top.add(world);
    top.elements.push(Element::System(guest));
    let files = std::collections::BTreeMap::from([
        (
            "resources/world.fmu".to_owned(),
            std::fs::read(common::fmu("fmu-truth")).unwrap(),
        ),
        ("resources/filter.fmu".to_owned(), std::fs::read(&packed).unwrap()),
    ]);
    let ssp = folder.path().join("theirs.ssp");
    std::fs::write(&ssp, Package::bytes(&structure, &files).unwrap()).unwrap();

    let out = folder.path().join("told");
    harness_ok(&[
        "compare",
        "--ssp",
        text(&ssp),
        "--runs",
        "2",
        "--duration",
        "1500",
        "--out",
        text(&out),
    ]);
    let rows = read_csv(&out.join("runs.csv"));
    let found: Vec<f64> = rows
        .iter()
        .filter(|row| row["filter"] == "guest_filter")
        .flat_map(|row| ["pos_rmse_m", "vel_rmse_m_s"].map(|column| row[column].parse().unwrap()))
        .collect();
    assert_eq!(found, mapped);
}

/// PythonFMU in an environment of its own; `None` without Python. Tests of this program run side by side, and one alone makes it.
fn python_fmu() -> Option<&'static Path> {
    static MADE: OnceLock<Option<PathBuf>> = OnceLock::new();
    MADE.get_or_init(make_python_fmu).as_deref()
}

fn make_python_fmu() -> Option<PathBuf> {
    let environment = root().join("target/pythonfmu");
    let program = environment.join("bin/pythonfmu");
    if program.is_file() {
        return Some(program);
    }
    virtual_environment(&environment, &["pythonfmu==0.7.0"])?;
    Some(program)
}

/// Packs a source by PythonFMU; false, and said, where there is no Python.
///
/// * `beside`: files that it needs.
fn pack_python(test: &str, source: &str, beside: &[&str], folder: &Path) -> bool {
    let Some(build) = python_fmu() else {
        skipped(test, "python3-venv");
        return false;
    };
    let output = Command::new(build)
        .args(["build", "--file", source, "--dest"])
        .arg(folder)
        .args(beside)
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    true
}

/// Whether the `python3` on the path has a library that can be loaded.
fn has_library(test: &str) -> bool {
    let probe = "import sysconfig as s; exit(not s.get_config_var('Py_ENABLE_SHARED'))";
    let shared = Command::new("python3").args(["-c", probe]).status().unwrap().success();
    if !shared {
        skipped(test, "libpython3-dev");
    }
    shared
}

#[test]
fn guidance_on_a_filters_estimates_gives_each_filter_its_own_world() {
    let folder = tempfile::tempdir().unwrap();
    let source = "examples/05_closed_loop/guidance.py";
    let beside = ["examples/05_closed_loop/pulse.py"];
    if !pack_python("closed loop", source, &beside, folder.path()) || !has_library("closed loop") {
        return;
    }
    let guide = format!("guide={}", text(&folder.path().join("Guidance.fmu")));
    let rows = |name: &str, filters: &str, driver: &[&str]| {
        let out = folder.path().join(name);
        let line = [
            "compare",
            "--filters",
            filters,
            "--runs",
            "1",
            "--duration",
            "1500",
            "--out",
            text(&out),
        ];
        harness_ok(&[&line[..], driver].concat());
        let rows = read_csv(&out.join("runs.csv"));
        let snc = rows.into_iter().find(|row| row["filter"] == "snc").unwrap();
        (snc["failed"].clone(), snc["pos_rmse_m"].clone(), out)
    };
    let driver = ["--drive", &guide, "--preload", "python"];
    let both = rows("both", "snc,fixed_q", &driver);
    let alone = rows("alone", "snc", &driver);
    let undriven = rows("undriven", "snc", &[]);
    assert_eq!(
        (&both.0, &both.1),
        (&"0".to_owned(), &alone.1),
        "what another filter does is nothing to snc"
    );
    assert_ne!(both.1, undriven.1, "the guidance does something");
    for file in ["manifest.json", "report.html"] {
        let contents = std::fs::read_to_string(both.2.join(file)).unwrap();
        assert!(contents.contains("paired by seed alone"), "{file}");
    }
}

#[test]
fn a_filter_in_python_does_what_the_one_in_c_does() {
    let folder = tempfile::tempdir().unwrap();
    let source = "examples/04_own_filter_in_python/direct_inversion.py";
    if !has_tools("python") || !pack_python("python", source, &[], folder.path()) {
        return;
    }
    let toy = folder.path().join("Toy.fmu");
    let mine = format!("mine={}", text(&toy));
    let line = [
        "compare",
        "--filters",
        "snc",
        "--nav",
        &mine,
        "--out",
        text(folder.path()),
    ];
    let refused = harness(&line);
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(2) && told.contains("--preload python"),
        "{told}"
    );
    if !has_library("python") {
        return;
    }
    let python = errors(&folder.path().join("python"), &toy, &["--preload", "python"]);
    let c = errors(&folder.path().join("c"), &pack_c(folder.path(), &[]), &[]);
    for (python, c) in python.iter().zip(&c) {
        assert!((python / c - 1.0).abs() < 1e-9, "{python} {c}");
    }

    // One of these runs again, with what the study was made with; and a search with it taking part.
    let study = folder.path().join("python");
    let replayed = folder.path().join("replay.csv");
    let one = ["replay", text(&study), "--run", "1", "--filter", "mine"];
    harness_ok(&[&one[..], &["--out", text(&replayed)]].concat());
    let squares = |row: std::collections::HashMap<String, String>| -> f64 {
        let error = ["r", "t", "n"].map(|axis| row[&format!("err_pos_{axis}_m")].parse::<f64>().unwrap());
        error.iter().map(|e| e * e).sum()
    };
    let scored = read_csv(&replayed)
        .into_iter()
        .filter(|row| row["t_s"].parse::<f64>().unwrap() >= 300.0);
    let scored: Vec<f64> = scored.map(squares).collect();
    let rmse = (scored.iter().sum::<f64>() / scored.len() as f64).sqrt();
    assert!((rmse / python[2] - 1.0).abs() < 1e-9, "{rmse} {}", python[2]);
    let tuned = folder.path().join("tuned");
    let search = [
        "tune",
        "--filters",
        "snc",
        "--nav",
        &mine,
        "--evaluations",
        "1",
        "--runs",
        "1",
    ];
    let judged = ["--judge-runs", "1", "--preload", "python", "--out", text(&tuned)];
    harness_ok(&[&search[..], &judged].concat());
    let best = read_csv(&tuned.join("best.csv"));
    assert!(best.iter().any(|row| row["filter"] == "mine"), "{best:?}");
}
