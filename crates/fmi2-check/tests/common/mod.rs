//! A good FMU, and ways to spoil it.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

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
        limit: Duration::from_secs(3),
        with_tool: false,
    }
}

/// What is found in files whose library is run.
pub fn found_running(files: &Files) -> Findings {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("good.fmu");
    pack(files, &path);
    check(&path, Some(&running())).unwrap()
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

/// Prints, past the test runner's capture, how many defects were named.
pub fn score(what: &str, tried: usize, missed: &[String]) {
    let named = tried - missed.len();
    let _ = writeln!(std::io::stderr(), "mutation score of the {what}: {named} of {tried}");
}
