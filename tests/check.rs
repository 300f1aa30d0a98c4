//! `trade-harness check`: nothing is found in our FMUs, and what is found elsewhere is told to people, programs and shells.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{fmu, harness, repacked};
use serde_json::Value;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn document(line: &[&str]) -> (Option<i32>, Value) {
    let ended = harness(&[line, &["--json"]].concat());
    (ended.status.code(), serde_json::from_slice(&ended.stdout).unwrap())
}

#[test]
fn our_fmus_keep_to_the_standard() {
    let (truth, nav) = (fmu("fmu-truth"), fmu("fmu-nav"));
    let (code, told) = document(&["check", text(&truth), text(&nav)]);
    let files = told["files"].as_array().unwrap();
    assert_eq!(files.len(), 2);
    for file in files {
        assert_eq!((&file["errors"], &file["warnings"]), (&0.into(), &0.into()), "{file:#}");
        // The library was run.
        let rules: Vec<&str> = file["findings"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(|f| f["rule"].as_str())
            .collect();
        assert!(!rules.contains(&"binary.skipped"), "{file:#}");
    }
    assert_eq!((code, &told["verdict"]), (Some(0), &"done".into()));
}

#[test]
fn what_is_found_is_told_with_rule_element_line_and_advice() {
    let folder = tempfile::tempdir().unwrap();
    let spoilt = folder.path().join("spoilt.fmu");
    repacked(&fmu("fmu-nav"), &spoilt, |name, bytes| {
        Some(match name {
            "modelDescription.xml" => {
                let xml = String::from_utf8(bytes).unwrap();
                xml.replacen("causality=\"input\"", "causality=\"entry\"", 1)
                    .into_bytes()
            }
            _ => bytes,
        })
    });
    let (code, told) = document(&["check", "--no-run", text(&spoilt)]);
    assert_eq!(
        (code, &told["verdict"]),
        (Some(1), &"standard_broken".into()),
        "{told:#}"
    );
    let findings = told["files"][0]["findings"].as_array().unwrap();
    let found = findings.iter().find(|f| f["rule"] == "xml.value").unwrap();
    assert_eq!(
        (&found["severity"], &found["section"]),
        (&"error".into(), &"2.2".into())
    );
    assert!(found["what"].as_str().unwrap().contains("entry"), "{found:#}");
    assert!(found["line"].as_u64().is_some_and(|line| line > 1), "{found:#}");
    assert!(found["advice"].as_str().is_some_and(|advice| !advice.is_empty()));

    let ended = harness(&["check", "--no-run", text(&spoilt)]);
    assert_eq!(ended.status.code(), Some(1));
    let shown = String::from_utf8(ended.stdout).unwrap();
    assert!(
        shown.contains("xml.value") && shown.contains("FMI 2.0.4, 2.2"),
        "{shown}"
    );
    let wide = shown
        .lines()
        .find(|line| line.chars().count() > 80 && !line.contains(text(folder.path())));
    assert_eq!(wide, None);
}

#[test]
fn what_cannot_be_read_and_what_is_asked_wrongly_end_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("text.fmu");
    std::fs::write(&file, "text").unwrap();
    for line in [
        &["check", text(&file)][..],
        &["check", "none.fmu"],
        &["check"],
        &["check", "--limit", "0", "x.fmu"],
    ] {
        let ended = harness(line);
        assert_eq!(ended.status.code(), Some(2), "{line:?}: {ended:?}");
        assert!(!ended.stderr.is_empty());
    }
}

#[test]
fn rules_are_listed_with_their_sections() {
    let (code, told) = document(&["check", "--rules"]);
    let rules = told["rules"].as_array().unwrap();
    assert_eq!(code, Some(0));
    assert!(rules.len() > 100, "{}", rules.len());
    let shown = String::from_utf8(harness(&["check", "--rules"]).stdout).unwrap();
    for rule in rules {
        assert!(shown.contains(rule["rule"].as_str().unwrap()), "{rule}");
        assert!(rule["section"].as_str().unwrap().starts_with(['2', '4']), "{rule}");
    }
    assert!(shown.lines().all(|line| line.chars().count() <= 80));
}
