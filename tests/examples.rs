//! The examples do what their first lines say.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{harness_ok, program, read_csv, root, skipped};
use std::path::{Path, PathBuf};
use std::process::Command;
use trade_harness::pack;

/// Runs an example's script with few runs, on the program and the FMUs of the tests.
fn script(example: &str, out: &Path) -> String {
    // Builds and packs.
    harness_ok(&["list"]);
    let output = Command::new("bash")
        .arg(root().join("examples").join(example).join("run.sh"))
        .env("HARNESS", program())
        .env("HARNESS_FLAGS", "--no-build --quiet")
        .env("FMUS", pack::default_folder(root()))
        .env("RUNS", "2")
        .env("QUICK", "1")
        .env("OUT", out)
        .output()
        .unwrap();
    let (shown, error) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{example}: {shown}{error}");
    shown.into_owned()
}

#[test]
fn a_first_study_has_a_row_for_each_filter() {
    let folder = tempfile::tempdir().unwrap();
    script("01_first_study", folder.path());
    let rows = read_csv(&folder.path().join("summary.csv"));
    let filters: Vec<&str> = rows.iter().map(|r| r["filter"].as_str()).collect();
    assert_eq!(filters, ["snc", "fixed_q@small", "milton"]);
    assert!(rows.iter().all(|r| r["failed"] == "0" && r["diverged"] == "0"));
}

#[test]
fn a_mission_of_ones_own_is_checked_and_studied() {
    let folder = tempfile::tempdir().unwrap();
    let shown = script("03_own_mission", folder.path());
    assert!(
        shown.contains("station_flyaround") && shown.contains("fine enough"),
        "{shown}"
    );
    let rows = read_csv(&folder.path().join("summary.csv"));
    assert!(
        rows.iter()
            .all(|r| r["scenario"] == "station_flyaround" && r["failed"] == "0")
    );
}

/// Guidance and life support in Python, with FMPy as the master and in a study; the script fails where the loop does not hold its point.
#[test]
fn a_closed_loop_of_four_fmus_holds_its_point() {
    let folder = tempfile::tempdir().unwrap();
    let shown = script("05_closed_loop", folder.path());
    if let Some(lacking) = shown.lines().find(|line| line.starts_with("SKIPPED")) {
        skipped("closed loop", lacking.rsplit(' ').next().unwrap());
        return;
    }
    let flights: Vec<&str> = shown.lines().filter(|line| line.starts_with("| `snc`")).collect();
    let [flight] = flights[..] else {
        panic!("{shown}");
    };
    let cells: Vec<f64> = flight.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    // Step, farthest from the reference, the same in the last hour, delta-v.
    let [step, farthest, late, delta_v] = cells[..] else {
        panic!("{shown}");
    };
    assert!(
        (step - 1.0).abs() < 1e-9 && farthest < 1.0 && late <= farthest,
        "{shown}"
    );
    // A quintic from 14 m to 8 m in 1200 s takes 15/8 of the mean speed, up and down; vents and noise are more.
    assert!(delta_v > 2.0 * 1.875 * 5.5 / 1200.0 && delta_v < 1.0, "{shown}");
    let rows = read_csv(&folder.path().join("study/summary.csv"));
    assert!(
        rows.iter()
            .all(|r| r["filter"] == "snc" && r["failed"] == "0" && r["diverged"] == "0")
    );
    let python = root().join("target/closed_loop/venv/bin/python");
    let arguments = [root().join("examples/05_closed_loop"), folder.path().to_owned()];
    let shown = python_script(&python, "by_ssp.py", &arguments).unwrap();
    assert!(shown.contains("46 of 46 cycles"), "{shown}");
}

/// Runs a script of `tests/examples`; what it printed, or nothing without this Python.
fn python_script(python: &Path, name: &str, arguments: &[PathBuf]) -> Option<String> {
    let ran = Command::new(python)
        .arg(root().join("tests/examples").join(name))
        .args(arguments)
        // Nothing is left beside the example.
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output();
    let output = ran.ok()?;
    let (shown, error) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{name}: {shown}{error}");
    Some(shown.into_owned())
}

/// Whether a master adds its steps up or multiplies them, no cycle of the thrusters is missed or planned twice.
#[test]
fn guidance_plans_every_cycle_once() {
    let example = root().join("examples/05_closed_loop");
    match python_script(Path::new("python3"), "cycles.py", &[example]) {
        Some(shown) => assert_eq!(shown.lines().count(), 12, "{shown}"),
        None => skipped("cycles of guidance", "python3"),
    }
}
