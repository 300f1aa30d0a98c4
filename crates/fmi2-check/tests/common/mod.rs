//! A good FMU, and ways to spoil it.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use std::collections::BTreeSet;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

use expect_test::expect_file;
use fmi2_check::{Finding, Findings, Running, Severity, check};

pub const DESCRIPTION: &str = include_str!("../good/modelDescription.xml");
pub const SOURCE: &str = include_str!("../good/good.c");
/// The library in the archive.
pub const LIBRARY: &str = "binaries/linux64/good.so";

/// Files of an archive in their order.
pub type Files = Vec<(String, Vec<u8>)>;

/// The good FMU around a library.
pub fn good(library: &[u8]) -> Files {
    let png = [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], &[0; 17]].concat();
    [
        ("modelDescription.xml", DESCRIPTION.as_bytes()),
        (LIBRARY, library),
        ("documentation/index.html", b"<html></html>"),
        ("documentation/licenses/license.txt", b"MIT"),
        ("model.png", &png),
        ("resources/data.txt", b"1 2 3"),
        ("sources/good.c", SOURCE.as_bytes()),
        (
            "terminalsAndIcons/terminalsAndIcons.xml",
            b"<?xml version=\"1.0\"?><fmiTerminalsAndIcons fmiVersion=\"2.0\"/>",
        ),
    ]
    .map(|(name, bytes)| (name.to_owned(), bytes.to_vec()))
    .to_vec()
}

/// Packs files.
pub fn pack(files: &Files, path: &Path) {
    let mut zip = zip::ZipWriter::new(File::create(path).unwrap());
    for (name, bytes) in files {
        zip.start_file(name.as_str(), zip::write::SimpleFileOptions::default())
            .unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap();
}

/// What is found in files, without running anything.
pub fn found_in(files: &Files) -> Findings {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("good.fmu");
    pack(files, &path);
    check(&path, None).unwrap()
}

/// Compiles the good FMU with a switch; nothing without a compiler, which is told once.
pub fn compiled(switches: &[&str]) -> Option<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let (source, library) = (folder.path().join("good.c"), folder.path().join("good.so"));
    std::fs::write(&source, SOURCE).unwrap();
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let ran = Command::new(compiler)
        .args(["-shared", "-fPIC", "-O1", "-o"])
        .args([&library, &source])
        .arg("-lm")
        .args(switches.iter().map(|switch| format!("-D{switch}")))
        .output();
    let Ok(done) = ran else {
        static TOLD: OnceLock<()> = OnceLock::new();
        TOLD.get_or_init(|| {
            let _ = writeln!(std::io::stderr(), "SKIPPED fmi2-check: needs the system package gcc");
        });
        return None;
    };
    assert!(
        done.status.success(),
        "{switches:?}: {}",
        String::from_utf8_lossy(&done.stderr)
    );
    Some(std::fs::read(library).unwrap())
}

/// The program of this crate makes the trials.
pub fn running() -> Running {
    Running {
        program: Box::new(|| {
            let mut program = Command::new(PathBuf::from(env!("CARGO_BIN_EXE_fmi2-check")));
            program.arg("--trial");
            program
        }),
        // On a machine with much else to do, a trial of nothing but good calls may be kept waiting.
        limit: Duration::from_secs(20),
        with_tool: false,
    }
}

/// What is found in files whose library is run.
pub fn found_running(files: &Files) -> Findings {
    found_within(files, running().limit)
}

/// The same, with this limit to each trial.
pub fn found_within(files: &Files, limit: Duration) -> Findings {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("good.fmu");
    pack(files, &path);
    let running = Running { limit, ..running() };
    check(&path, Some(&running)).unwrap()
}

/// Whether a rule is broken by an element.
pub fn names(findings: &Findings, rule: &str, element: &str) -> bool {
    findings.0.iter().any(|f| f.rule.id == rule && f.element == element)
}

/// For messages.
pub fn lines(findings: &Findings) -> String {
    let line = |f: &Finding| format!("  {} {}: {} ({:?})\n", f.rule.id, f.element, f.what, f.line);
    findings.0.iter().map(line).collect()
}

/// Those that are more than advice.
pub fn serious(findings: &Findings) -> usize {
    findings.count(Severity::Error) + findings.count(Severity::Warning)
}

/// The library to pack; nothing where it cannot be one for linux64.
pub fn library() -> Option<Vec<u8>> {
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return compiled(&[]);
    }
    let _ = writeln!(
        std::io::stderr(),
        "SKIPPED fmi2-check: its FMU is made for linux64 alone"
    );
    None
}

/// The description with replacements; each text must be there, or nothing would be tried.
pub fn edited(edits: &[(&str, &str)]) -> Vec<u8> {
    let mut text = DESCRIPTION.to_owned();
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text.into_bytes()
}

/// Prints, past the test runner's capture, how many defects were named, and holds the row of `docs/check.md` to it.
pub fn score(what: &str, tried: usize, missed: &[String]) {
    let named = tried - missed.len();
    let _ = writeln!(std::io::stderr(), "mutation score of the {what}: {named} of {tried}");
    // Which ones were missed is better told than that the document is another.
    if !missed.is_empty() {
        return;
    }
    let text = std::fs::read_to_string(CHECK_MD).unwrap();
    let scores = scores(&text);
    let begins = format!("| {what} |");
    let others = scores.lines().skip(2).filter(|row| !row.starts_with(&begins));
    let row = format!("{begins} {named} | {tried} |");
    let rows: BTreeSet<&str> = others.chain([row.as_str()]).collect();
    let table = rows.iter().fold(
        "| defects of the | named | tried |\n|---|---|---|\n".to_owned(),
        |table, row| table + row + "\n",
    );
    expect_file![CHECK_MD].assert_eq(&text.replace(&marked(scores), &marked(&table)));
}

const CHECK_MD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/check.md");
/// Around what [`score`] writes.
const MARKS: (&str, &str) = ("<!-- mutation scores: begin -->\n", "<!-- mutation scores: end -->");

fn marked(scores: &str) -> String {
    format!("{}{scores}{}", MARKS.0, MARKS.1)
}

fn scores(text: &str) -> &str {
    let begun = text.split_once(MARKS.0).map(|(_, rest)| rest);
    begun.and_then(|rest| rest.split_once(MARKS.1)).unwrap().0
}

/// Holds `docs/check.md` to what the rules render, but for the scores.
pub fn documented(rendered: &str) {
    let text = std::fs::read_to_string(CHECK_MD).unwrap();
    expect_file![CHECK_MD].assert_eq(&rendered.replace(&marked(""), &marked(scores(&text))));
}
