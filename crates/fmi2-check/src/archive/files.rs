//! The files of the archive: which there are, and which there have to be.

use std::collections::BTreeSet;

use super::Archive;
use super::library::{self, Machine};
use crate::finding::Findings;
use crate::rules::archive as rules;
use crate::xml::tree::Node;

/// What the standard puts at the root.
const ROOT: [&str; 8] = [
    "modelDescription.xml",
    "model.png",
    "binaries",
    "documentation",
    "extra",
    "resources",
    "sources",
    "terminalsAndIcons",
];

pub(super) fn check(archive: &mut Archive, interfaces: &[&Node], findings: &mut Findings) {
    let roots: BTreeSet<&str> = archive
        .names()
        .iter()
        .map(|name| name.split('/').next().unwrap_or(name))
        .collect();
    for other in roots.iter().filter(|root| !ROOT.contains(root) && !root.contains('\\')) {
        findings.add(&rules::UNKNOWN, *other, "the standard knows no such file or folder");
    }
    let has = |root| roots.contains(root);
    if !has("binaries") && !has("sources") {
        let what = "there are neither binaries nor sources";
        findings.add(&rules::IMPLEMENTATION, "binaries", what);
    }
    documents(archive, findings);
    sources(archive, interfaces, findings);
    libraries(archive, interfaces, findings);
    if let Some(bytes) = archive.read("model.png")
        && !(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.get(12..16) == Some(b"IHDR"))
    {
        findings.add(&rules::ICON, "model.png", "it does not begin as a PNG does");
    }
    terminals(archive, findings);
}

fn documents(archive: &Archive, findings: &mut Findings) {
    let any = |folder| archive.in_folder(folder).next().is_some();
    if any("documentation/") && !archive.contains("documentation/index.html") {
        findings.add(&rules::DOCUMENTATION, "documentation/index.html", "there is none");
    }
    let entries = ["txt", "html"].map(|suffix| format!("documentation/licenses/license.{suffix}"));
    if any("documentation/licenses/") && !entries.iter().any(|name| archive.contains(name)) {
        findings.add(&rules::LICENCE, &entries[0], "there is none");
    }
}

fn sources(archive: &Archive, interfaces: &[&Node], findings: &mut Findings) {
    let mut listed = false;
    for interface in interfaces {
        for file in interface.inside("SourceFiles", "File") {
            listed = true;
            // Some tools write `./` first, which is the folder itself.
            let steps = file.get("name").into_iter().flat_map(|name| name.split('/'));
            let steps: Vec<&str> = steps.filter(|step| !["", "."].contains(step)).collect();
            let name = format!("sources/{}", steps.join("/"));
            if !steps.is_empty() && !archive.contains(&name) {
                let what = format!("it is listed in SourceFiles of {}, and not there", interface.name);
                findings.at(file.line, &rules::SOURCE, name, what);
            }
        }
    }
    if !listed && archive.in_folder("sources/").next().is_some() {
        let what = "there are sources, and no SourceFiles";
        findings.add(&rules::SOURCE_UNLISTED, "sources", what);
    }
}

fn libraries(archive: &mut Archive, interfaces: &[&Node], findings: &mut Findings) {
    let platforms: BTreeSet<String> = archive
        .in_folder("binaries/")
        .filter_map(|file| file.split_once('/'))
        .map(|(platform, _)| platform.to_owned())
        .collect();
    for platform in platforms {
        let folder = format!("binaries/{platform}");
        let machine = Machine::of_platform(&platform);
        if machine.is_none() {
            let what = "the standard has no platform of this name";
            findings.add(&rules::PLATFORM, &folder, what);
        }
        let mut looked_at: BTreeSet<String> = BTreeSet::new();
        for interface in interfaces {
            let Some(identifier) = interface.get("modelIdentifier") else {
                continue;
            };
            let suffixes = machine.map_or(&["so", "dll", "dylib"][..], |machine| machine.suffixes());
            let candidates: Vec<String> = suffixes
                .iter()
                .map(|suffix| format!("{folder}/{identifier}.{suffix}"))
                .collect();
            match candidates.iter().find(|name| archive.contains(name)) {
                Some(name) => {
                    // Both interfaces may be in one library.
                    if let Some(bytes) = archive.read(name) {
                        library::check(
                            &bytes,
                            name,
                            machine,
                            interface,
                            looked_at.insert(name.clone()),
                            findings,
                        );
                    }
                }
                // A folder of which nothing is known may hold anything.
                None if machine.is_some() => {
                    let what = format!("there is no library of {} {identifier}", interface.name);
                    findings.add(&rules::LIBRARY, &candidates[0], what);
                }
                None => (),
            }
        }
    }
}

fn terminals(archive: &mut Archive, findings: &mut Findings) {
    const FILE: &str = "terminalsAndIcons/terminalsAndIcons.xml";
    if archive.in_folder("terminalsAndIcons/").next().is_none() {
        return;
    }
    let Some(bytes) = archive.read(FILE) else {
        findings.add(&rules::TERMINALS, FILE, "there is none");
        return;
    };
    let text = String::from_utf8_lossy(&bytes);
    let mut reader = quick_xml::Reader::from_str(&text);
    let mut root = None;
    loop {
        match reader.read_event() {
            Ok(quick_xml::events::Event::Eof) => break,
            Ok(quick_xml::events::Event::Start(tag) | quick_xml::events::Event::Empty(tag)) => {
                root.get_or_insert_with(|| tag.name().as_ref().to_owned());
            }
            Ok(_) => (),
            Err(error) => {
                findings.add(&rules::TERMINALS, FILE, error.to_string());
                return;
            }
        }
    }
    if root.as_deref() != Some("fmiTerminalsAndIcons") {
        let what = format!("its root is {}", root.unwrap_or_else(|| "missing".to_owned()));
        findings.add(&rules::TERMINALS, FILE, what);
    }
}
