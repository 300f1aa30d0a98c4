//! Defects of the archive, each put into a good FMU: the rule that it breaks is named, with the file.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use std::collections::BTreeSet;

use common::{Files, LIBRARY, edited, found_in, good, library, lines, names, score, serious};
use fmi2_check::rules;

/// Adds a file.
fn with(name: &'static str, bytes: &'static [u8]) -> impl Fn(&mut Files) {
    move |files| files.push((name.to_owned(), bytes.to_vec()))
}

/// Takes files away whose names begin so.
fn without(begin: &'static str) -> impl Fn(&mut Files) {
    move |files| files.retain(|(name, _)| !name.starts_with(begin))
}

/// Renames a file.
fn renamed(from: &'static str, to: &'static str) -> impl Fn(&mut Files) {
    move |files| {
        for (name, _) in files.iter_mut().filter(|(name, _)| name == from) {
            to.clone_into(name);
        }
    }
}

/// Writes other bytes.
fn rewritten(name: &'static str, bytes: &'static [u8]) -> impl Fn(&mut Files) {
    move |files| {
        for (_, old) in files.iter_mut().filter(|(n, _)| n == name) {
            *old = bytes.to_vec();
        }
    }
}

type Change = Box<dyn Fn(&mut Files)>;

fn archives() -> Vec<(Change, &'static str, &'static str)> {
    let mut all: Vec<(Change, &str, &str)> = Vec::new();
    let mut add = |change: Change, rule, element| all.push((change, rule, element));
    add(
        Box::new(without("modelDescription.xml")),
        "archive.description",
        "modelDescription.xml",
    );
    add(
        Box::new(renamed("modelDescription.xml", "good/modelDescription.xml")),
        "archive.description",
        "modelDescription.xml",
    );
    add(
        Box::new(|files: &mut Files| files.rotate_left(1)),
        "archive.first",
        "modelDescription.xml",
    );
    add(Box::new(with("../evil.txt", b"")), "archive.path", "../evil.txt");
    add(Box::new(with("/etc/evil.txt", b"")), "archive.path", "/etc/evil.txt");
    add(Box::new(with("C:/evil.txt", b"")), "archive.path", "C:/evil.txt");
    add(
        Box::new(with("resources\\more.txt", b"")),
        "archive.backslash",
        "resources\\more.txt",
    );
    add(
        Box::new(with("resources/DATA.txt", b"")),
        "archive.duplicate",
        "resources/DATA.txt",
    );
    add(
        Box::new(with("resources/gr\u{f6}\u{df}e.txt", b"")),
        "archive.name",
        "resources/gr\u{f6}\u{df}e.txt",
    );
    add(Box::new(with("notes.txt", b"")), "archive.unknown", "notes.txt");
    let neither = |files: &mut Files| files.retain(|(n, _)| !n.starts_with("binaries/") && !n.starts_with("sources/"));
    add(Box::new(neither), "archive.implementation", "binaries");
    add(
        Box::new(with("binaries/linux/good.so", b"")),
        "archive.platform",
        "binaries/linux",
    );
    add(
        Box::new(renamed(LIBRARY, "binaries/linux64/libgood.so")),
        "archive.binary",
        LIBRARY,
    );
    add(
        Box::new(renamed(LIBRARY, "binaries/linux64/good.dll")),
        "archive.binary",
        LIBRARY,
    );
    add(Box::new(rewritten(LIBRARY, b"#!/bin/sh\n")), "archive.machine", LIBRARY);
    add(Box::new(without("sources/")), "archive.source", "sources/good.c");
    add(Box::new(rewritten("model.png", b"GIF89a")), "archive.icon", "model.png");
    add(
        Box::new(without("documentation/index.html")),
        "archive.documentation",
        "documentation/index.html",
    );
    add(
        Box::new(renamed(
            "documentation/licenses/license.txt",
            "documentation/licenses/MIT.txt",
        )),
        "archive.licence",
        "documentation/licenses/license.txt",
    );
    for other in [
        "binaries/win64/good.dll",
        "binaries/darwin64/good.dylib",
        "binaries/linux32/good.so",
    ] {
        let copied = move |files: &mut Files| {
            let library = files.iter().find(|(name, _)| name == LIBRARY).unwrap().1.clone();
            files.push((other.to_owned(), library));
        };
        add(Box::new(copied), "archive.machine", other);
    }
    let terminals = "terminalsAndIcons/terminalsAndIcons.xml";
    add(
        Box::new(rewritten(terminals, b"<a></b>")),
        "archive.terminals",
        terminals,
    );
    add(
        Box::new(rewritten(terminals, b"<icons/>")),
        "archive.terminals",
        terminals,
    );
    add(
        Box::new(renamed(terminals, "terminalsAndIcons/icon.png")),
        "archive.terminals",
        terminals,
    );
    all
}

#[test]
fn the_good_files_have_nothing_that_is_found() {
    let Some(library) = library() else { return };
    let findings = found_in(&good(&library));
    assert!(findings.0.is_empty(), "{}", lines(&findings));
}

#[test]
fn every_defect_of_the_archive_is_named() {
    let Some(library) = library() else { return };
    let mut missed = Vec::new();
    let all = archives();
    for (change, rule, element) in &all {
        let mut files = good(&library);
        change(&mut files);
        let findings = found_in(&files);
        if !names(&findings, rule, element) {
            missed.push(format!("no {rule} of {element}\n{}", lines(&findings)));
        }
    }
    score("archive", all.len(), &missed);
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// What the packer of these tests does not write: bytes are changed in the finished archive.
#[test]
fn archives_that_no_packer_writes_are_seen_through() {
    let Some(library) = library() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("good.fmu");
    let mut files = good(&library);
    files.push(("resources/dbta.txt".to_owned(), b"other".to_vec()));
    common::pack(&files, &path);
    let whole = std::fs::read(&path).unwrap();
    let tried = |bytes: Vec<u8>, rule: &str, element: &str| {
        std::fs::write(&path, bytes).unwrap();
        let findings = fmi2_check::check(&path, None).unwrap();
        assert!(names(&findings, rule, element), "{rule}\n{}", lines(&findings));
    };
    let mut twice = whole.clone();
    for at in 0..twice.len() - 4 {
        if twice[at..].starts_with(b"dbta") {
            twice[at..at + 4].copy_from_slice(b"data");
        }
    }
    tried(twice, "archive.duplicate", "resources/data.txt");
    // The method of the last entry's record in the directory, behind signature, versions and flags.
    let mut method = whole.clone();
    let record = (0..method.len() - 4)
        .rev()
        .find(|at| method[*at..].starts_with(b"PK\x01\x02"))
        .unwrap();
    method[record + 10..record + 12].copy_from_slice(&12_u16.to_le_bytes());
    tried(method, "archive.compression", "resources/dbta.txt");
    let mut linked = whole.clone();
    linked[record + 5] = 3;
    linked[record + 38..record + 42].copy_from_slice(&(0o120_777_u32 << 16).to_le_bytes());
    tried(linked, "archive.link", "resources/dbta.txt");
    let mut sum = whole.clone();
    sum[record + 16] ^= 0xff;
    tried(sum, "archive.entry", "resources/dbta.txt");
}

/// Of the rules of an archive, each is broken by some defect here, or in `binary.rs` where it takes another library.
#[test]
fn every_rule_of_the_archive_is_tried() {
    let mut tried: BTreeSet<&str> = archives().iter().map(|(_, rule, _)| *rule).collect();
    tried.extend(["archive.compression", "archive.link", "archive.entry"]);
    tried.extend(["archive.export", "archive.export-optional", "archive.source-unlisted"]);
    let mut left = rules::all().map(|rule| rule.id).filter(|id| !tried.contains(id));
    assert_eq!(left.find(|id| id.starts_with("archive.")), None);
}

#[test]
fn sources_without_a_list_are_advised_to_have_one() {
    let Some(library) = library() else { return };
    let mut files = good(&library);
    files[0].1 = edited(&[("<SourceFiles>\n      <File name=\"good.c\"/>\n    </SourceFiles>", "")]);
    let findings = found_in(&files);
    assert!(
        names(&findings, "archive.source-unlisted", "sources"),
        "{}",
        lines(&findings)
    );
    assert_eq!(serious(&findings), 0);
}

/// Of a model-exchange FMU the files are checked, with the functions that it has to have.
#[test]
fn model_exchange_has_functions_of_its_own() {
    let Some(library) = library() else { return };
    let mut files = good(&library);
    files[0].1 = edited(&[
        ("CoSimulation", "ModelExchange"),
        (" canHandleVariableCommunicationStepSize=\"true\"", ""),
    ]);
    let findings = common::found_running(&files);
    for function in ["fmi2SetTime", "fmi2GetDerivatives", "fmi2NewDiscreteStates"] {
        assert!(names(&findings, "archive.export", function), "{}", lines(&findings));
    }
    assert!(!names(&findings, "archive.export", "fmi2Reset"), "{}", lines(&findings));
    assert!(names(&findings, "binary.skipped", "binaries"), "{}", lines(&findings));
}

#[test]
fn what_is_no_archive_is_an_error_and_no_finding() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("text.fmu");
    std::fs::write(&path, "text").unwrap();
    let told = |path: &std::path::Path| fmi2_check::check(path, None).unwrap_err().to_string();
    assert!(told(&path).contains("no zip archive"), "{}", told(&path));
    assert!(told(&folder.path().join("none.fmu")).contains("cannot read"));
    assert!(told(folder.path()).contains("cannot read"));
}
