//! A machine that lets a study down: a disk that fills at any write, a folder that takes nothing, a clock that goes back, little stack, few
//! files, other languages.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "how many cases were tried is shown with --nocapture")]

mod common;

use common::{c_library, command, in_shell, results};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const STUDY: [&str; 11] = [
    "compare",
    "--scenario",
    "formation",
    "--filters",
    "snc,fixed_q",
    "--runs",
    "3",
    "--duration",
    "120",
    "--jobs",
    "2",
];

type Results = BTreeMap<String, Vec<u8>>;

/// What it is, what a shell does before the study, and what the study's environment is.
type Case = (&'static str, &'static str, Vec<(&'static str, String)>);

/// Most writes at which a disk is full.
const PLACES: u64 = 30;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The study into a folder, its temporary files in another.
fn study(out: &Path, temporary: &Path, more: &[&str]) -> Command {
    std::fs::create_dir_all(temporary).unwrap();
    let mut command = command(&[&STUDY[..], more, &["--out", text(out)]].concat());
    command.env("TMPDIR", temporary);
    command
}

/// The library that stands between a program and its machine; `None` without a C compiler.
fn machine(folder: &Path) -> Option<PathBuf> {
    let source = include_str!("nasty/machine.c");
    c_library(folder, "machine", source, &["-ldl"], "a machine that lets a study down")
}

/// Names of files that nobody wants, in a folder and below.
fn torn(folder: &Path) -> Vec<PathBuf> {
    let all = common::files(folder).into_keys();
    all.filter(|path| path.extension().is_some_and(|e| e == "tmp"))
        .collect()
}

fn entries(folder: &Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

#[test]
fn a_disk_that_fills_at_any_write_loses_nothing_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let Some(machine) = machine(folder.path()) else { return };
    let count = at("count");
    let whole = study(&at("whole"), &at("tmp"), &[])
        .env("LD_PRELOAD", &machine)
        .env("WRITES_TO", &count)
        .output()
        .unwrap();
    assert!(whole.status.success(), "{}", said(&whole));
    let expected = results(&at("whole"));
    let writes: u64 = std::fs::read_to_string(&count).unwrap().parse().unwrap();
    assert!(writes > PLACES, "{writes}");
    let (out, temporary) = (at("full"), at("tmp-full"));
    let (mut failed, mut places) = (0, 0);
    for place in 0..PLACES {
        // From the first write to the last.
        let full_from = place * (writes - 1) / (PLACES - 1);
        let _ = std::fs::remove_dir_all(&out);
        let output = study(&out, &temporary, &[])
            .env("LD_PRELOAD", &machine)
            .env("DISK_FULL_FROM", full_from.to_string())
            .output()
            .unwrap();
        let told = said(&output);
        places += 1;
        assert_eq!(
            entries(&temporary),
            0,
            "at write {full_from}: temporary files are left; {told}"
        );
        if out.exists() {
            assert_eq!(torn(&out), [] as [PathBuf; 0], "at write {full_from}");
        }
        if output.status.success() {
            // The last that is written, without which the results are whole; or there were fewer writes than before.
            let got = results(&out);
            let differ = differing(&got, &expected);
            let page = differ == ["report.html"] && told.contains("there is no report.html");
            assert!(
                page || differ.is_empty(),
                "at write {full_from} of {writes}: {differ:?} differ; {told}"
            );
            assert!(
                full_from + 10 > writes,
                "at write {full_from} of {writes} the study took no notice"
            );
            continue;
        }
        failed += 1;
        assert_eq!(output.status.code(), Some(2), "at write {full_from}: {told}");
        assert!(told.contains("No space left on device"), "at write {full_from}: {told}");
        let again = study(&out, &temporary, &["--resume"]).output().unwrap();
        assert!(again.status.success(), "after write {full_from}: {}", said(&again));
        assert!(results(&out) == expected, "after write {full_from} the bytes differ");
    }
    println!("{places} of {writes} writes: {failed} refused with a reason, all made good");
    assert!(failed > PLACES - 5);
}

/// Little stack, few open files, other languages and times, a clock that goes back: the same bytes, in this process and in workers.
#[test]
fn what_the_machine_is_like_changes_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let whole = study(&at("whole"), &at("tmp"), &[]).output().unwrap();
    assert!(whole.status.success(), "{}", said(&whole));
    let expected = results(&at("whole"));
    let mut cases: Vec<Case> = vec![
        ("1 MiB of stack", "ulimit -s 1024", vec![]),
        ("200 open files", "ulimit -n 200", vec![]),
        ("no core, little of everything", "ulimit -c 0; ulimit -n 64", vec![]),
        (
            "another language",
            ":",
            vec![("LC_ALL", "de_DE.UTF-8".to_owned()), ("LANG", "tr_TR.UTF-8".to_owned())],
        ),
        ("another time zone", ":", vec![("TZ", "Asia/Kathmandu".to_owned())]),
        ("no home", "unset HOME", vec![]),
    ];
    let machine = machine(folder.path());
    if let Some(machine) = &machine {
        let back = vec![("LD_PRELOAD", text(machine).to_owned()), ("CLOCK_BACK", "1".to_owned())];
        cases.push(("a clock that goes back", ":", back));
    }
    for (case, before, environment) in &cases {
        for isolated in [&[][..], &["--isolate"]] {
            let out = at("other");
            let _ = std::fs::remove_dir_all(&out);
            let output = in_shell(before, &study(&out, &at("tmp"), isolated))
                .env("TMPDIR", at("tmp"))
                .envs(environment.iter().map(|(name, value)| (name, value)))
                .output()
                .unwrap();
            assert!(output.status.success(), "{case} {isolated:?}: {}", said(&output));
            let got = results(&out);
            let named: Vec<&String> = expected
                .keys()
                .filter(|name| expected.get(*name) != got.get(*name))
                .collect();
            // The plan says whether its runs are made apart.
            let named: Vec<&&String> = named.iter().filter(|name| !says_how(name)).collect();
            assert!(named.is_empty(), "{case} {isolated:?}: {named:?} differ");
            assert_eq!(entries(&at("tmp")), 0, "{case} {isolated:?}: temporary files are left");
        }
    }
}

/// Names of files that are not the same.
fn differing<'a>(got: &'a Results, expected: &'a Results) -> Vec<&'a String> {
    let names = got
        .keys()
        .chain(expected.keys().filter(|name| !got.contains_key(*name)));
    names.filter(|name| got.get(*name) != expected.get(*name)).collect()
}

/// Whether a file of results says how a study was made, and not what it found.
fn says_how(name: &str) -> bool {
    ["study.toml", "manifest.json", "report.html"].contains(&name)
}

#[test]
fn a_folder_that_takes_nothing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for place in ["/proc/results", "/dev/null/results", "/sys/results"] {
        let output = study(Path::new(place), &at("tmp"), &[]).output().unwrap();
        let told = said(&output);
        assert!(output.status.code() == Some(2) && told.contains(place), "{told}");
        assert_eq!(entries(&at("tmp")), 0, "{place}: temporary files are left");
    }
}
