//! What programs and shells see of the command line: documents, exit codes, completions. Needs no FMU.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use std::io;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn harness() -> Command {
    Command::new(env!("CARGO_BIN_EXE_trade-harness"))
}

fn output(line: &[&str]) -> Output {
    harness().args(line).output().unwrap()
}

fn document(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

#[test]
fn errors_are_documents_with_the_same_exit_code() {
    for (line, says) in [
        (&["inspect", "nowhere.fmu"][..], "nowhere.fmu"),
        (&["report", "nowhere"], "nowhere"),
        (&["list", "filters", "miltn"], "did you mean 'milton'"),
        (&["compare", "--runs", "0"], "--runs"),
        (&["frobnicate"], "frobnicate"),
    ] {
        let text = output(line);
        assert!(text.stdout.is_empty(), "{line:?}: {text:?}");
        let told = output(&[&["--json"], line].concat());
        let value = document(&told);
        assert!(
            value["error"].as_str().is_some_and(|e| e.contains(says)),
            "{line:?}: {value}"
        );
        assert!(value["causes"].is_array(), "{line:?}: {value}");
        assert_eq!((told.status.code(), text.status.code()), (Some(2), Some(2)), "{line:?}");
    }
}

#[test]
fn what_is_listed_is_one_document() {
    for line in [&["list"][..], &["list", "filters"], &["list", "missions"], &["columns"]] {
        let told = output(&[line, &["--json"]].concat());
        assert!(told.status.success() && told.stderr.is_empty(), "{line:?}: {told:?}");
        assert_eq!(document(&told)["verdict"], "done", "{line:?}");
    }
}

/// Where there is no terminal, a line has room in the narrowest one that is usual.
#[test]
fn what_is_listed_fits_eighty_columns() {
    let kinds = [
        "missions",
        "filters",
        "presets",
        "parameters",
        "ports",
        "distributions",
        "metrics",
        "milton",
        "formation",
    ];
    for line in kinds.map(|kind| vec!["list", kind]).into_iter().chain([vec!["list"]]) {
        let told = output(&line);
        assert!(told.status.success(), "{line:?}: {told:?}");
        let text = String::from_utf8(told.stdout).unwrap();
        let widest = text.lines().max_by_key(|line| line.chars().count()).unwrap();
        assert!(widest.chars().count() <= 80, "{line:?}: {widest}");
    }
}

#[test]
fn a_name_alone_lists_what_it_names() {
    for (name, whole) in [
        ("milton", ["list", "filters", "milton"]),
        ("formation", ["list", "missions", "formation"]),
    ] {
        assert_eq!(output(&["list", name]).stdout, output(&whole).stdout, "{name}");
    }
    let told = String::from_utf8(output(&["list", "miltno"]).stderr).unwrap();
    assert!(told.contains("did you mean 'milton'"), "{told}");
    let told = String::from_utf8(output(&["mission", "check", "formatoin"]).stderr).unwrap();
    assert!(told.contains("did you mean `formation`"), "{told}");
}

#[test]
fn help_is_no_error_where_documents_are_asked_for() {
    let told = output(&["--json", "compare", "--help"]);
    assert!(told.status.success(), "{told:?}");
    assert!(String::from_utf8_lossy(&told.stdout).contains("Usage:"));
}

#[test]
fn every_shell_learns_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = String::from_utf8(output(&["completions", shell]).stdout).unwrap();
        for command in [
            "compare",
            "merge",
            "report",
            "tune",
            "replay",
            "reproduce",
            "inspect",
            "mission",
            "list",
        ] {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
}

#[test]
fn a_reader_who_has_seen_enough_is_no_error() {
    for line in [
        &["completions", "bash"][..],
        &["list", "parameters"],
        &["columns"],
        &["list", "--json"],
    ] {
        let (reader, writer) = io::pipe().unwrap();
        drop(reader);
        let ended = harness()
            .args(line)
            .stdout(writer)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert!(ended.status.success(), "{line:?}: {ended:?}");
        assert!(ended.stderr.is_empty(), "{line:?}: {ended:?}");
    }
}
