//! What `--json` says of studies, and that what is listed without FMUs is what the built ones say.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{fmu, harness, harness_ok, read_csv};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The one document that a call prints.
fn document(line: &[&str]) -> Value {
    serde_json::from_str(&harness_ok(&[line, &["--json"]].concat())).unwrap()
}

#[test]
fn a_study_and_its_merged_parts_are_told_as_documents_of_what_is_in_the_files() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let line = |out, shard: &'static [&'static str]| {
        let line = [
            "compare",
            "--filters",
            "snc,fixed_q",
            "--runs",
            "2",
            "--duration",
            "400",
            "--out",
            out,
        ];
        [&line[..], shard].concat()
    };
    let told = document(&line(text(&whole), &[]));
    assert_eq!(told["verdict"], "done");
    assert_eq!(told["folder"], text(&whole));
    for file in told["files"].as_array().unwrap() {
        assert!(whole.join(file.as_str().unwrap()).exists(), "{file}");
    }
    let rows = told["studies"][0]["filters"].as_array().unwrap();
    let table = read_csv(&whole.join("summary.csv"));
    assert_eq!((rows.len(), table.len()), (2, 2));
    for (row, line) in rows.iter().zip(&table) {
        assert_eq!(row["filter"], line["filter"]);
        let error: f64 = line["pos_rmse_m"].parse().unwrap();
        assert_eq!(row["pos_rmse_m"], error);
    }

    for shard in [&["--shard", "1/2"][..], &["--shard", "2/2"]] {
        assert_eq!(document(&line(text(&parts), shard))["verdict"], "done");
    }
    let merged = document(&["merge", text(&parts)]);
    for what in ["verdict", "studies", "requirements", "calibration"] {
        assert_eq!(merged[what], told[what], "{what}");
    }
}

#[test]
fn a_missed_requirement_is_in_the_document_and_in_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let line = [
        "compare",
        "--filters",
        "snc",
        "--runs",
        "2",
        "--duration",
        "400",
        "--json",
        "--out",
        text(&out),
    ];
    let ended = harness(&[&line[..], &["--require", "metric = \"pos_rmse_m\", at_most = 1e-9"]].concat());
    assert_eq!(ended.status.code(), Some(1), "{ended:?}");
    let told: Value = serde_json::from_slice(&ended.stdout).unwrap();
    assert_eq!(told["verdict"], "bounds_missed", "{told}");
    assert_eq!(told["requirements"].as_array().map(Vec::len), Some(1), "{told}");

    // Nothing is run again, and the requirement is missed still.
    let require = ["--resume", "--require", "metric = \"pos_rmse_m\", at_most = 1e-9"];
    let again = harness(&[&line[..], &require].concat());
    assert_eq!(again.status.code(), Some(1), "{again:?}");
    let told: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(told["verdict"], "bounds_missed", "{told}");
}

/// Start values, units, meanings and presets come from the program; the FMUs are what is flown.
#[test]
fn what_is_listed_is_what_the_built_fmus_say_of_themselves() {
    let all = document(&["list", "parameters"]);
    for name in ["fmu-truth", "fmu-nav"] {
        let built = document(&["inspect", text(&fmu(name))]);
        assert!(
            built["parameters"].as_array().is_some_and(|all| all.len() > 10),
            "{name}"
        );
        assert_eq!(all[name], built["parameters"], "{name}");
    }
    let opened = fmi2_import::Fmu::open(fmu("fmu-nav")).unwrap();
    let built = study::filters_of(opened.description()).unwrap();
    let listed = document(&["list", "presets"]);
    let listed: BTreeSet<(String, String, String)> = listed["presets"]
        .as_array()
        .unwrap()
        .iter()
        .map(|preset| {
            let text = |key: &str| preset[key].as_str().unwrap().to_owned();
            (text("filter"), text("name"), text("about"))
        })
        .collect();
    let built = built.presets.iter();
    let built: BTreeSet<_> = built
        .map(|p| (p.filter.clone(), p.name.clone(), p.about.clone()))
        .collect();
    assert_eq!(listed, built);
}
