//! What is linked into an FMU: every crate with its version, its licence and the texts that its package has of it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::json;

use super::platforms::RunsOn;
use super::{Files, read};
use crate::HarnessError;

/// Folder of a package from a registry by its name and version.
pub(super) type Sources = BTreeMap<(String, String), PathBuf>;

/// Where the licences stand in an FMU.
const FOLDER: &str = "documentation/licenses";

/// Something that is linked in.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Linked {
    name: String,
    version: String,
    /// SPDX expression.
    licence: String,
    origin: Origin,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Origin {
    Workspace,
    Registry,
    Toolchain,
}

/// The package that one of cargo's JSON messages tells of, if it is from a registry.
pub(super) fn source_of(line: &str) -> Option<((String, String), PathBuf)> {
    let message: serde_json::Value = serde_json::from_str(line).ok()?;
    if message["reason"] != "compiler-artifact" {
        return None;
    }
    let id = message["package_id"].as_str()?;
    let (name, version) = id.strip_prefix("registry+")?.split_once('#')?.1.split_once('@')?;
    let folder = Path::new(message["manifest_path"].as_str()?).parent()?;
    Some(((name.to_owned(), version.to_owned()), folder.to_owned()))
}

/// Licences, list and bill of materials of one of our FMUs.
///
/// * `platforms`: those that it has libraries for.
/// * `sources`: where the packages are.
///
/// # Errors
/// [`HarnessError::NoCargo`], [`HarnessError::Linked`], and those of reading.
pub(super) fn files(
    workspace: &Path,
    name: &str,
    platforms: &[RunsOn],
    sources: &Sources,
) -> Result<Files, HarnessError> {
    let mut linked = crates(workspace, name, platforms)?;
    linked.insert(Linked {
        name: "std".to_owned(),
        version: toolchain(),
        licence: "MIT OR Apache-2.0".to_owned(),
        origin: Origin::Toolchain,
    });
    let own = texts(workspace)?;
    let mut files = Files::new();
    let mut rows = String::from("name,version,licence,origin,texts\n");
    // Packages repeat the same few texts; each stands once, where it was first found.
    let mut known: BTreeMap<Vec<u8>, String> = (own.iter()).map(|(file, text)| (text.clone(), file.clone())).collect();
    for crate_ in &linked {
        let key = (crate_.name.clone(), crate_.version.clone());
        let found = match (crate_.origin, sources.get(&key)) {
            (Origin::Workspace, _) => own.clone(),
            (_, Some(folder)) => texts(folder)?,
            (_, None) => Files::new(),
        };
        let mut places = Vec::new();
        for (file, text) in found {
            let place = format!("texts/{}-{}/{file}", crate_.name, crate_.version);
            let place = known.entry(text.clone()).or_insert_with(|| {
                files.insert(format!("{FOLDER}/{place}"), text);
                place
            });
            places.push(place.clone());
        }
        let origin = match crate_.origin {
            Origin::Workspace => "workspace",
            Origin::Registry => "registry",
            Origin::Toolchain => "toolchain",
        };
        let cells = [
            &crate_.name,
            &crate_.version,
            &crate_.licence,
            origin,
            &places.join(" "),
        ];
        rows.push_str(&(cells.join(",") + "\n"));
    }
    files.insert(format!("{FOLDER}/dependencies.csv"), rows.into_bytes());
    files.insert(format!("{FOLDER}/license.txt"), entry(&own).into_bytes());
    files.extend(own.into_iter().map(|(file, text)| (format!("{FOLDER}/{file}"), text)));
    files.insert("documentation/sbom.json".to_owned(), sbom(name, &linked)?);
    Ok(files)
}

/// The entry page that the standard asks for.
fn entry(own: &Files) -> String {
    let mut text = format!("Licence: {}\n", env!("CARGO_PKG_LICENSE"));
    if !own.is_empty() {
        let names: Vec<&str> = own.keys().map(String::as_str).collect();
        text.push_str(&format!("Full texts: {}\n", names.join(", ")));
    }
    text.push_str(
        "\nWhat others wrote is linked in under licences of its own: dependencies.csv has each crate with its version, the SPDX \
         expression of\nits licence and its texts below texts/. The Rust standard library (std) is part of the compiler that built this \
         FMU and has\nits notices there. The same list for machines is ../sbom.json (CycloneDX).\n",
    );
    text
}

/// The licence texts in a folder by file name.
fn texts(folder: &Path) -> Result<Files, HarnessError> {
    const BEGIN: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "UNLICENSE", "NOTICE"];
    let entries = fs::read_dir(folder).map_err(|source| HarnessError::Read {
        path: folder.to_owned(),
        source,
    })?;
    let mut found = Files::new();
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let upper = name.to_uppercase();
        if BEGIN.iter().any(|begin| upper.starts_with(begin)) && entry.path().is_file() {
            found.insert(name, read(&entry.path())?);
        }
    }
    Ok(found)
}

/// Every crate that is linked into one of ours; not those that only run while it is compiled.
fn crates(workspace: &Path, name: &str, platforms: &[RunsOn]) -> Result<BTreeSet<Linked>, HarnessError> {
    let program = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut cargo = Command::new(&program);
    cargo.args(["tree", "--quiet", "--prefix", "none", "--edges", "normal,no-proc-macro"]);
    cargo.args(["--format", "{p}\t{l}", "--package", name, "--manifest-path"]);
    cargo.arg(workspace.join("Cargo.toml"));
    for target in platforms.iter().filter_map(|platform| platform.target) {
        cargo.args(["--target", target]);
    }
    let output = cargo.stdin(Stdio::null()).output();
    let output = output.map_err(|source| HarnessError::NoCargo { program, source })?;
    if output.status.success() {
        let text = String::from_utf8_lossy(&output.stdout);
        Ok(text.lines().filter_map(listed).collect())
    } else {
        Err(HarnessError::Linked {
            name: name.to_owned(),
            told: String::from_utf8_lossy(&output.stderr).trim().to_owned(),
        })
    }
}

/// A line of cargo's tree: name, version with a `v`, the folder of one of ours in brackets; a tab; the licence.
fn listed(line: &str) -> Option<Linked> {
    let (package, licence) = line.split_once('\t')?;
    let mut words = package.split(' ');
    let (name, version) = (words.next()?, words.next()?.strip_prefix('v')?);
    let local = words.next().is_some_and(|word| word.starts_with('('));
    Some(Linked {
        name: name.to_owned(),
        version: version.to_owned(),
        // Said so before there were expressions; and a crate whose own crates were listed before has a star behind it.
        licence: licence.trim_end_matches(" (*)").replace('/', " OR "),
        origin: if local { Origin::Workspace } else { Origin::Registry },
    })
}

/// Version of the compiler, whose standard library is linked in; empty if it does not say.
fn toolchain() -> String {
    let program = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(program).arg("--version").stdin(Stdio::null()).output();
    let text = output
        .map(|o| String::from_utf8_lossy(&o.stdout).into_owned())
        .unwrap_or_default();
    text.split(' ').nth(1).unwrap_or_default().to_owned()
}

/// The list as CycloneDX has it, without date and serial number, so that equal lists are equal bytes.
fn sbom(name: &str, linked: &BTreeSet<Linked>) -> Result<Vec<u8>, HarnessError> {
    let component = |l: &Linked, kind: &str| {
        let mut component = json!({
            "type": kind,
            "bom-ref": format!("{}@{}", l.name, l.version),
            "name": l.name,
            "version": l.version,
            "licenses": [{ "expression": l.licence }],
        });
        if l.origin == Origin::Registry {
            // A plus is a blank in a package URL unless it is escaped.
            component["purl"] = json!(format!("pkg:cargo/{}@{}", l.name, l.version.replace('+', "%2B")));
        }
        component
    };
    let own = |l: &&Linked| l.name == name && l.origin == Origin::Workspace;
    let bill = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": linked.iter().find(own).map(|l| component(l, "application")) },
        "components": linked.iter().filter(|l| !own(l)).map(|l| component(l, "library")).collect::<Vec<_>>(),
    });
    Ok(serde_json::to_vec_pretty(&bill)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_cargos_tree_are_understood_and_show_no_folder() {
        let of = |line| listed(line).unwrap();
        let two = of("toml v1.2.2+spec-1.1.0\tMIT/Apache-2.0 (*)");
        assert_eq!((two.name.as_str(), two.version.as_str()), ("toml", "1.2.2+spec-1.1.0"));
        assert_eq!(
            (two.licence.as_str(), two.origin),
            ("MIT OR Apache-2.0", Origin::Registry)
        );
        let ours = of("astro v0.1.0 (/home/me/w/crates/astro)\tMIT");
        assert_eq!(ours.origin, Origin::Workspace);
        assert!(!format!("{ours:?}").contains("home"));
        assert_eq!(listed(""), None);
    }

    #[test]
    fn packages_are_found_in_cargos_messages() {
        let line = |id: &str| {
            format!(
                r#"{{"reason":"compiler-artifact","package_id":"{id}","manifest_path":"/r/libm-0.2.16/Cargo.toml"}}"#
            )
        };
        let found = source_of(&line("registry+https://index#libm@0.2.16")).unwrap();
        assert_eq!(
            found,
            (
                ("libm".to_owned(), "0.2.16".to_owned()),
                PathBuf::from("/r/libm-0.2.16")
            )
        );
        assert_eq!(source_of(&line("path+file:///w/fmu-nav#0.1.0")), None);
    }

    #[test]
    fn licences_name_their_files() {
        let dir = tempfile::tempdir().unwrap();
        for (file, text) in [
            ("LICENSE-MIT", "as is"),
            ("COPYING", "or not"),
            ("README.md", "no licence"),
        ] {
            fs::write(dir.path().join(file), text).unwrap();
        }
        let found = texts(dir.path()).unwrap();
        assert_eq!(found.keys().collect::<Vec<_>>(), ["COPYING", "LICENSE-MIT"]);
        let entry = entry(&found);
        assert!(
            entry.contains(env!("CARGO_PKG_LICENSE")) && entry.contains("COPYING, LICENSE-MIT"),
            "{entry}"
        );
    }
}
