//! The examples do what their first lines say.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{harness_ok, read_csv, root};
use std::path::Path;
use std::process::Command;

/// Runs an example's script with few runs, on the program and the FMUs of the tests.
fn script(example: &str, out: &Path) -> String {
    // Builds and packs.
    harness_ok(&["list"]);
    let output = Command::new("bash")
        .arg(root().join("examples").join(example).join("run.sh"))
        .env("HARNESS", root().join("target/release/trade-harness"))
        .env("HARNESS_FLAGS", "--no-build --quiet")
        .env("RUNS", "2")
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
