//! What the end-to-end tests share: the packed FMUs, the harness's program, and a way to say that a test was skipped.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

pub mod fmi;

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use trade_harness::pack;

/// The workspace.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Path of `fmu-truth` or `fmu-nav`, built and packed once for each test binary.
pub fn fmu(name: &str) -> PathBuf {
    pack::fmu_path(packed(), name)
}

/// Path of its FMI 3.0 twin.
pub fn twin(name: &str) -> PathBuf {
    pack::fmu_path(&pack::fmi3::folder(packed()), name)
}

/// Folder of the FMUs.
fn packed() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = pack::default_folder(root());
        pack::pack(root(), &folder, None, true).unwrap();
        folder
    })
}

/// The harness's program, built once for each test binary, wherever cargo builds.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        fmu("fmu-nav");
        let built = Command::new(env!("CARGO"))
            .args([
                "build",
                "--release",
                "--quiet",
                "--package",
                "trade-harness",
                "--message-format",
                "json",
            ])
            .current_dir(root())
            .output()
            .unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let text = String::from_utf8(built.stdout).unwrap();
        let artifacts = text
            .lines()
            .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
        let mut programs = artifacts.filter_map(|a| a["executable"].as_str().map(PathBuf::from));
        programs.next_back().unwrap()
    })
}

/// A call of it, on FMUs that are packed already.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(program());
    command.args(arguments).current_dir(root());
    let first = arguments.first().copied();
    // What answers at once, or says all that it does, has no progress.
    if !matches!(first, Some("list" | "inspect" | "check")) {
        command.arg("--quiet");
    }
    // A merge and a rerun take the FMUs that their study was made with, a report, a list, an inspection and a check none; packing builds.
    if !matches!(
        first,
        Some("merge" | "report" | "list" | "rerun" | "inspect" | "check" | "pack")
    ) {
        command.arg("--no-build");
    }
    command
}

/// Runs it.
pub fn harness(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

/// The results of a study without what may differ on repeat: `timing.csv` and `environment` in the manifest.
pub fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut kept = BTreeMap::new();
    for (path, mut bytes) in files(folder) {
        let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
        if name == "manifest.json" {
            let mut manifest: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
            assert!(manifest.as_object_mut().unwrap().remove("environment").is_some());
            bytes = serde_json::to_vec(&manifest).unwrap();
        }
        if name != "timing.csv" {
            kept.insert(name, bytes);
        }
    }
    kept
}

/// Every file of a folder with its contents.
pub fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        if entry.path().is_dir() {
            found.extend(files(&entry.path()));
        } else {
            found.insert(entry.path(), std::fs::read(entry.path()).unwrap());
        }
    }
    found
}

/// Like [`harness`], for a call that must succeed; returns what it printed.
pub fn harness_ok(arguments: &[&str]) -> String {
    let output = harness(arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

/// Makes a virtual environment anew and installs packages into it; its Python, or `None` without one to make it with.
///
/// * `packages`: as pip takes them.
pub fn virtual_environment(environment: &Path, packages: &[&str]) -> Option<PathBuf> {
    let made = Command::new("python3")
        .args(["-m", "venv", "--clear"])
        .arg(environment)
        .output();
    if !made.is_ok_and(|output| output.status.success()) {
        return None;
    }
    let python = environment.join("bin/python");
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let output = Command::new(&python).args(pip).args(packages).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(python)
}

/// A shared library from C in a folder, by the compiler that `CC` names; `None`, said to be skipped, without one.
///
/// * `name`: of the library, without an extension; `more`: further arguments.
pub fn c_library(folder: &Path, name: &str, source: &str, more: &[&str], test: &str) -> Option<PathBuf> {
    let (file, library) = (folder.join(format!("{name}.c")), folder.join(format!("{name}.so")));
    std::fs::write(&file, source).unwrap();
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let built = Command::new(compiler)
        .args(["-shared", "-fPIC", "-Wall", "-Werror", "-o"])
        .args([&library, &file])
        .args(more)
        .output();
    let Ok(built) = built else {
        skipped(test, "gcc");
        return None;
    };
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    Some(library)
}

/// The same call by a shell, after what that is told first.
pub fn in_shell(before: &str, call: &Command) -> Command {
    let words = std::iter::once(call.get_program()).chain(call.get_args());
    let quoted: Vec<String> = words.map(|word| format!("'{}'", word.to_str().unwrap())).collect();
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("{before}; exec {}", quoted.join(" "))])
        .current_dir(root());
    shell
}

/// Says on the terminal, past the test runner's capture, that a test could not run and what it lacks.
pub fn skipped(test: &str, package: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED {test}: needs the system package {package}");
}

/// Copies a `.fmu` file entry by entry; `edit` gives each entry's new contents, or `None` to leave it out.
pub fn repacked(from: &Path, to: &Path, edit: impl Fn(&str, Vec<u8>) -> Option<Vec<u8>>) {
    let mut old = zip::ZipArchive::new(std::fs::File::open(from).unwrap()).unwrap();
    let mut new = zip::ZipWriter::new(std::fs::File::create(to).unwrap());
    for index in 0..old.len() {
        let mut entry = old.by_index(index).unwrap();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        let name = entry.name().unwrap().into_owned();
        if let Some(bytes) = edit(&name, bytes) {
            new.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
            new.write_all(&bytes).unwrap();
        }
    }
    new.finish().unwrap();
}

/// A CSV file as rows of columns by name.
pub fn read_csv(path: &Path) -> Vec<std::collections::HashMap<String, String>> {
    csv::Reader::from_path(path)
        .unwrap()
        .deserialize()
        .map(Result::unwrap)
        .collect()
}
