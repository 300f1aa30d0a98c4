//! What an FMU tells of itself beside its variables: date, picture, documentation, licences, reference results.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper is a failed test"
)]

mod common;

use common::{command, fmu, root, twin};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const NAMES: [&str; 2] = ["fmu-truth", "fmu-nav"];

/// Every file of an archive, in its order.
fn files(fmu: &Path) -> Vec<(String, Vec<u8>)> {
    let mut zip = zip::ZipArchive::new(std::fs::File::open(fmu).unwrap()).unwrap();
    (0..zip.len())
        .map(|index| {
            let mut entry = zip.by_index(index).unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            (entry.name().unwrap().into_owned(), bytes)
        })
        .collect()
}

/// The same by name.
fn by_name(fmu: &Path) -> BTreeMap<String, Vec<u8>> {
    files(fmu).into_iter().collect()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Both FMUs and their twins.
fn all() -> Vec<PathBuf> {
    NAMES.into_iter().flat_map(|name| [fmu(name), twin(name)]).collect()
}

fn attribute(xml: &str, name: &str) -> Option<String> {
    let (_, rest) = xml.split_once(&format!(" {name}=\""))?;
    rest.split('"').next().map(str::to_owned)
}

/// Packs into a folder, at the date of a number of seconds; any other is taken out of the environment.
fn packed_at(folder: &Path, seconds: Option<&str>) -> Output {
    let mut pack = command(&["pack", "--out", folder.to_str().unwrap()]);
    match seconds {
        Some(seconds) => pack.env("SOURCE_DATE_EPOCH", seconds),
        None => pack.env_remove("SOURCE_DATE_EPOCH"),
    };
    pack.output().unwrap()
}

#[test]
fn the_description_comes_first_and_dates_change_nothing_but_the_date() {
    let folder = tempfile::tempdir().unwrap();
    let [commit, moon] = ["commit", "moon"].map(|name| folder.path().join(name));
    let output = packed_at(&commit, None);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // The first step on the Moon.
    assert!(packed_at(&moon, Some("-14159040")).status.success());
    for place in ["fmu-truth.fmu", "fmu-nav.fmu", "fmi3/fmu-truth.fmu", "fmi3/fmu-nav.fmu"] {
        let [here, there] = [&commit, &moon].map(|folder| files(&folder.join(place)));
        assert_eq!(here[0].0, "modelDescription.xml");
        assert_eq!(here[1..], there[1..], "{place}");
        let [here, there] = [here, there].map(|files| text(&files[0].1));
        let then = "\n  generationDateAndTime=\"1969-07-21T02:56:00Z\"";
        assert_eq!(there.matches(then).count(), 1, "{place}");
        let without = |xml: &str| {
            let lines = xml.lines().filter(|line| !line.contains("generationDateAndTime="));
            lines.map(|line| format!("{line}\n")).collect::<String>()
        };
        assert_eq!(without(&here), without(&there), "{place}");
        // Beside a repository there is the date of its commit, in git's own words; without one there is none.
        let mut git = Command::new("git");
        git.arg("-C").arg(root());
        git.args(["log", "-1", "--date=format-local:%Y-%m-%dT%H:%M:%SZ", "--format=%cd"]);
        let told = git.env("TZ", "UTC").output().ok();
        let told = told.filter(|output| root().join(".git").exists() && output.status.success());
        let expected = told.map(|output| text(&output.stdout).trim().to_owned());
        assert_eq!(attribute(&here, "generationDateAndTime"), expected, "{place}");
    }
    // What was packed at another date is the same FMU to a library: it starts.
    let fmu = fmi2_import::Fmu::open(moon.join("fmu-truth.fmu")).unwrap();
    fmu.instantiate("dated", false).unwrap();
    let wrong = packed_at(&moon, Some("yesterday"));
    assert_eq!(wrong.status.code(), Some(2));
    let told = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert!(
        told.contains("SOURCE_DATE_EPOCH") && told.contains("yesterday"),
        "{told}"
    );
}

#[test]
fn every_fmu_has_a_picture() {
    let size = |png: &[u8]| {
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
        [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().unwrap()))
    };
    for name in NAMES {
        let two = by_name(&fmu(name));
        let [width, height] = size(&two["model.png"]);
        assert!(width == height && width >= 100, "{name}: {width} x {height}");
        let three = by_name(&twin(name));
        assert_eq!(three["terminalsAndIcons/icon.png"], two["model.png"]);
        assert!(text(&three["terminalsAndIcons/icon.svg"]).starts_with("<svg "));
        assert!(!three.contains_key("model.png") && !two.keys().any(|file| file.starts_with("terminals")));
    }
}

/// The page opens offline: what it shows and leads to is in the archive, and nothing runs.
#[test]
fn the_documentation_is_whole() {
    for path in all() {
        let files = by_name(&path);
        let page = text(&files["documentation/index.html"]);
        let links = page.split("href=\"").chain(page.split("src=\"")).skip(1);
        let mut found = 0;
        for link in links.filter(|part| !part.starts_with("<!DOCTYPE")) {
            let link = link.split('"').next().unwrap();
            assert!(
                files.contains_key(&format!("documentation/{link}")),
                "{link} in {}",
                path.display()
            );
            found += 1;
        }
        assert!(found >= 5, "{found} links in {}", path.display());
        assert!(!page.contains("<script") && !page.contains("http://") && !page.contains("https://"));
        for heading in ["What it is", "Sources", "Files", "Inputs", "Outputs"] {
            assert_eq!(page.matches(&format!("<h2>{heading}</h2>")).count(), 1, "{heading}");
        }
    }
}

#[test]
fn the_documentation_says_what_every_filter_does() {
    let files = by_name(&fmu("fmu-nav"));
    let page = text(&files["documentation/index.html"]);
    let (_, laws) = page.split_once("<h2>Laws</h2>").unwrap();
    let (laws, _) = laws.split_once("</table>").unwrap();
    let fmu = fmi2_import::Fmu::open(fmu("fmu-nav")).unwrap();
    let filters = fmu.description().items("filter");
    assert!(filters.len() > 10);
    for filter in filters {
        assert!(
            laws.contains(&format!("<code>{}</code>", filter.name)),
            "{}",
            filter.name
        );
    }
}

/// Name and version of what `dependencies.csv` lists, with its texts and where it is from.
fn listed(files: &BTreeMap<String, Vec<u8>>) -> BTreeMap<(String, String), (String, Vec<String>)> {
    let table = &files["documentation/licenses/dependencies.csv"];
    csv::Reader::from_reader(table.as_slice())
        .deserialize::<[String; 5]>()
        .map(|row| {
            let [name, version, licence, origin, texts] = row.unwrap();
            spdx::Expression::parse(&licence).unwrap_or_else(|e| panic!("{name}: {licence:?}: {e}"));
            (
                (name, version),
                (origin, texts.split_whitespace().map(str::to_owned).collect()),
            )
        })
        .collect()
}

/// Every package that the lock file says may be behind one of ours, whatever the platform, the features and when it is used.
fn locked(name: &str) -> BTreeSet<(String, String)> {
    let lock: toml::Table = std::fs::read_to_string(root().join("Cargo.lock"))
        .unwrap()
        .parse()
        .unwrap();
    let packages: Vec<(&str, &str, Vec<&str>)> = (lock["package"].as_array().unwrap().iter())
        .map(|package| {
            let needs = package.get("dependencies").and_then(|list| list.as_array());
            (
                package["name"].as_str().unwrap(),
                package["version"].as_str().unwrap(),
                needs.into_iter().flatten().map(|need| need.as_str().unwrap()).collect(),
            )
        })
        .collect();
    let mut found = BTreeSet::new();
    let mut open = vec![name];
    while let Some(next) = open.pop() {
        // A name alone, or one with the version where there are several.
        let mut words = next.split(' ');
        let (name, version) = (words.next().unwrap(), words.next());
        for (of, at, needs) in &packages {
            let fits = *of == name && version.is_none_or(|version| version == *at);
            if fits && found.insert(((*of).to_owned(), (*at).to_owned())) {
                open.extend(needs);
            }
        }
    }
    found
}

/// Packages whose files the messages of a library's panics name, as `name-version/src/`.
fn seen(library: &[u8]) -> BTreeSet<(String, String)> {
    let text = String::from_utf8_lossy(library);
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices("/src/") {
        let before = &text[..at];
        let folder = before.rsplit(['/', '\0']).next().unwrap_or_default();
        let digit = |c: char| c.is_ascii_digit();
        let place = folder
            .match_indices('-')
            .find(|(place, _)| folder[place + 1..].starts_with(digit));
        if let Some((place, _)) = place {
            let (name, version) = (&folder[..place], &folder[place + 1..]);
            if version.matches('.').count() >= 2
                && version.chars().all(|c| c.is_ascii_alphanumeric() || ".+-".contains(c))
            {
                found.insert((name.to_owned(), version.to_owned()));
            }
        }
    }
    found
}

#[test]
fn everything_that_is_linked_in_is_listed_with_its_licence() {
    for name in NAMES {
        let files = by_name(&fmu(name));
        let mut listed = listed(&files);
        let std = listed.keys().find(|(name, _)| name == "std").cloned().unwrap();
        assert_eq!(listed.remove(&std).unwrap().0, "toolchain");
        let locked = locked(name);
        for (key, (origin, texts)) in &listed {
            assert!(locked.contains(key), "{key:?} is not behind {name}");
            assert!(!texts.is_empty(), "{key:?} has no text");
            for text in texts {
                assert!(files.contains_key(&format!("documentation/licenses/{text}")), "{text}");
            }
            assert_eq!(origin == "workspace", texts == &["LICENSE"], "{key:?}");
        }
        let library = files.iter().find(|(file, _)| file.starts_with("binaries/")).unwrap().1;
        let seen: BTreeSet<_> = seen(library).into_iter().filter(|key| locked.contains(key)).collect();
        assert!(seen.len() >= 5, "{seen:?}");
        for key in &seen {
            assert!(
                listed.contains_key(key),
                "{key:?} is in the library of {name} and not in its list"
            );
        }
        // What must be there by what the crates themselves say.
        for needed in ["nalgebra", "libm", "serde", name] {
            assert!(listed.keys().any(|(name, _)| name == needed), "{needed}");
        }
        assert_eq!(listed.keys().any(|(name, _)| name == "clarabel"), name == "fmu-nav");
    }
}

#[test]
fn the_bill_of_materials_is_the_list() {
    for path in all() {
        let files = by_name(&path);
        let bill: serde_json::Value = serde_json::from_slice(&files["documentation/sbom.json"]).unwrap();
        assert_eq!([&bill["bomFormat"], &bill["specVersion"]], ["CycloneDX", "1.5"]);
        let own = &bill["metadata"]["component"];
        let components = bill["components"].as_array().unwrap().iter().chain([own]);
        let names = components.map(|c| {
            let text = |key: &str| c[key].as_str().unwrap().to_owned();
            (text("name"), text("version"))
        });
        let names: BTreeSet<_> = names.collect();
        assert_eq!(names, listed(&files).into_keys().collect::<BTreeSet<_>>());
    }
}

#[test]
fn nothing_tells_where_it_was_packed() {
    let home = std::env::var("HOME").unwrap_or_else(|_| "/root".to_owned());
    for path in all() {
        for (file, bytes) in files(&path) {
            if file.starts_with("documentation/") || file.ends_with(".xml") {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                for place in [root().to_str().unwrap(), home.as_str(), ".cargo/registry"] {
                    assert!(
                        !text.contains(&format!("{place}/")),
                        "{place} in {file} of {}",
                        path.display()
                    );
                }
            }
        }
    }
}

#[test]
fn cross_check_files_lie_beside_and_are_those_inside() {
    for (name, expected) in [("fmu-truth", 2), ("fmu-nav", 3)] {
        let path = fmu(name);
        let inside = by_name(&path);
        let folder = path.parent().unwrap().join("cross-check").join(name);
        let beside: Vec<_> = common::files(&folder).into_iter().collect();
        assert_eq!(beside.len(), expected, "{name}");
        for (file, bytes) in beside {
            let file = file.file_name().unwrap().to_str().unwrap().to_owned();
            assert!(file.starts_with(name), "{file}");
            assert!(inside[&format!("documentation/reference/{file}")] == bytes, "{file}");
            // The rules' own limit.
            assert!(bytes.len() < 1_000_000, "{file}");
        }
    }
}
