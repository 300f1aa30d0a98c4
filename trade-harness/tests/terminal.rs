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
fn options_of_a_finished_study_ask_for_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("replay.csv");
    for (own, instead) in [
        (&["--filter", "milton"][..], "--filters"),
        (&["--case", "strong"], "--set"),
        (&["--other-files"], "as they are"),
    ] {
        // An option that is not for a run of a study must not hide that the folder is missing.
        for beside in [&[][..], &["--seed", "3"], &["--filters", "snc"]] {
            let line = [&["replay", "--out", out.to_str().unwrap()], own, beside].concat();
            let ended = output(&line);
            let told = String::from_utf8_lossy(&ended.stderr);
            assert_eq!(ended.status.code(), Some(2), "{line:?}: {told}");
            for says in [own[0], "replay DIR", instead] {
                assert!(told.contains(says), "{line:?}: {told}");
            }
            assert!(!out.exists(), "{line:?}");
        }
    }
}

#[test]
fn options_of_a_run_of_its_own_are_refused_beside_a_study() {
    for option in [
        &["--filters", "snc"][..],
        &["--seed", "3"],
        &["--drive", "push=p.fmu"],
        &["--allow-truth"],
        &["--map", "mine.y=est.r_tc_n"],
        &["--map-file", "names.toml"],
        &["--tuned", "tuned.json"],
    ] {
        let ended = output(&[&["replay", "nowhere"], option].concat());
        let told = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(2), "{option:?}: {told}");
        assert!(
            told.contains(option[0]) && told.contains("cannot be used with"),
            "{option:?}: {told}"
        );
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
