//! The house's own rules: what we build on, and who may know whom.

#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What cargo says of every package.
fn packages() -> Vec<serde_json::Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--manifest-path"])
        .arg(root().join("Cargo.toml"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    metadata["packages"].as_array().unwrap().clone()
}

#[test]
fn every_dependency_has_a_licence_that_deny_toml_allows() {
    let text = std::fs::read_to_string(root().join("deny.toml")).unwrap();
    let rules: toml::Table = text.parse().unwrap();
    let allowed: Vec<&str> = rules["licenses"]["allow"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| l.as_str().unwrap())
        .collect();
    for package in packages() {
        let stated = package["license"].as_str().unwrap_or_default();
        let expression = spdx::Expression::parse_mode(stated, spdx::ParseMode::LAX)
            .unwrap_or_else(|e| panic!("{}: licence {stated:?}: {e}", package["name"]));
        let fits = expression.evaluate(|required| allowed.contains(&required.to_string().as_str()));
        assert!(
            fits,
            "{}: licence {stated:?} is not allowed by deny.toml",
            package["name"]
        );
    }
}

#[test]
fn no_dependency_asks_for_a_newer_rust_than_we_say() {
    let number = |version: &str| -> Vec<u32> {
        let mut parts: Vec<u32> = version.split('.').map(|p| p.parse().unwrap_or(0)).collect();
        parts.resize(3, 0);
        parts
    };
    let all = packages();
    let ours = all.iter().find(|p| p["name"] == "relative-navigation-trades").unwrap();
    let ours = number(ours["rust_version"].as_str().unwrap());
    for package in &all {
        if let Some(asked) = package["rust_version"].as_str() {
            assert!(number(asked) <= ours, "{} asks for Rust {asked}", package["name"]);
        }
    }
}

/// Every crate that is ours, with its folder.
fn our_crates() -> Vec<(String, PathBuf)> {
    packages()
        .iter()
        .filter(|p| p["source"].is_null())
        .map(|p| {
            let manifest = PathBuf::from(p["manifest_path"].as_str().unwrap());
            (
                p["name"].as_str().unwrap().to_owned(),
                manifest.parent().unwrap().to_owned(),
            )
        })
        .collect()
}

/// The source files of a crate by module path, without their tests.
fn modules(folder: &Path) -> BTreeMap<Vec<String>, String> {
    fn visit(folder: &Path, path: &[String], found: &mut BTreeMap<Vec<String>, String>) {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let file = entry.path();
            let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
            if file.is_dir() {
                visit(&file, &[path, std::slice::from_ref(&stem)].concat(), found);
            } else if file.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&file).unwrap();
                let code = text
                    .split("#[cfg(test)]\nmod tests")
                    .next()
                    .unwrap_or_default()
                    .to_owned();
                let module = match stem.as_str() {
                    "mod" | "lib" | "main" => path.to_vec(),
                    _ => [path, std::slice::from_ref(&stem)].concat(),
                };
                found.entry(module).or_default().push_str(&code);
            }
        }
    }
    let mut found = BTreeMap::new();
    visit(&folder.join("src"), &[], &mut found);
    found
}

/// Paths that a text uses from its own crate, as they are written after `crate`, `super` and `self`.
fn used(module: &[String], code: &str) -> Vec<Vec<String>> {
    let code: String = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    let mut paths = Vec::new();
    for (at, _) in code.match_indices("::") {
        let before: String = code[..at]
            .chars()
            .rev()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect();
        let word: String = before.chars().rev().collect();
        let outer = code[..at - word.len()].ends_with("::");
        let mut base = match word.as_str() {
            "crate" if !outer => Vec::new(),
            "super" if !outer => module[..module.len().saturating_sub(1)].to_vec(),
            _ => continue,
        };
        let mut rest = &code[at + 2..];
        while let Some(further) = rest.strip_prefix("super::") {
            base.pop();
            rest = further;
        }
        expand(&base, rest, &mut paths);
    }
    paths
}

/// Every path of a use tree that begins with `base`.
fn expand(base: &[String], rest: &str, paths: &mut Vec<Vec<String>>) {
    let rest = rest.trim_start();
    if let Some(group) = rest.strip_prefix('{') {
        let (mut depth, mut begin) = (0, 0);
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => {
                    expand(base, &group[begin..at], paths);
                    return;
                }
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    expand(base, &group[begin..at], paths);
                    begin = at + 1;
                }
                _ => (),
            }
        }
        return;
    }
    let word: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    if word.is_empty() {
        return;
    }
    let path = [base, std::slice::from_ref(&word)].concat();
    match rest[word.len()..].strip_prefix("::") {
        Some(further) => expand(&path, further, paths),
        None => paths.push(path),
    }
}

/// What each name that a module passes on really is: `pub use child::Name` and its like.
fn passed_on(modules: &BTreeMap<Vec<String>, String>) -> BTreeMap<Vec<String>, Vec<String>> {
    let mut known = BTreeMap::new();
    for (module, code) in modules {
        for part in code
            .split("pub use ")
            .chain(code.split("pub(crate) use "))
            .chain(code.split("pub(super) use "))
            .skip(1)
        {
            let tree = part.split(';').next().unwrap_or_default();
            let mut paths = Vec::new();
            let (base, tree) = match tree.strip_prefix("crate::") {
                Some(tree) => (Vec::new(), tree),
                None => (module.clone(), tree.strip_prefix("self::").unwrap_or(tree)),
            };
            expand(&base, tree, &mut paths);
            for path in paths {
                if let Some(name) = path.last() {
                    known.insert([module.as_slice(), std::slice::from_ref(name)].concat(), path);
                }
            }
        }
    }
    known
}

/// Which modules each module of a crate takes something from; a parent that only lists and passes on its children does not
/// count as taking from them.
fn imports(modules: &BTreeMap<Vec<String>, String>) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let passed = passed_on(modules);
    let mut edges: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = BTreeMap::new();
    for (module, code) in modules {
        for mut path in used(module, code) {
            // Follow what is passed on to where it stands.
            for _ in 0..8 {
                let next = (1..=path.len()).rev().find_map(|n| {
                    let real = passed.get(&path[..n])?;
                    Some([real.as_slice(), &path[n..]].concat())
                });
                match next {
                    Some(next) if next != path => path = next,
                    _ => break,
                }
            }
            let owner = (0..=path.len())
                .rev()
                .map(|n| &path[..n])
                .find(|p| modules.contains_key(*p));
            if let Some(owner) = owner.filter(|owner| *owner != module.as_slice()) {
                edges.entry(module.clone()).or_default().insert(owner.to_vec());
            }
        }
    }
    edges
}

#[test]
fn no_two_modules_import_each_other() {
    let mut circles = Vec::new();
    for (name, folder) in our_crates() {
        let modules = modules(&folder);
        let edges = imports(&modules);
        // A module is on a circle when it can be reached from itself.
        for start in edges.keys() {
            let mut seen = BTreeSet::new();
            let mut open: Vec<&Vec<String>> = edges[start].iter().collect();
            while let Some(next) = open.pop() {
                if seen.insert(next) {
                    open.extend(edges.get(next).into_iter().flatten());
                }
            }
            if seen.contains(start) {
                circles.push(format!("{name}::{}", start.join("::")));
            }
        }
    }
    assert!(circles.is_empty(), "modules on a circle: {circles:#?}");
}

#[test]
fn arrows_between_crates_go_one_way() {
    // (who, whom it may know among ours)
    let allowed: &[(&str, &[&str])] = &[
        ("interface", &[]),
        ("build-identity", &[]),
        ("elementary", &[]),
        ("numerics", &["elementary"]),
        ("astro", &["numerics"]),
        ("sensors", &["interface", "numerics", "astro"]),
        ("truth", &["interface", "numerics", "astro", "sensors"]),
        ("filters", &["interface", "numerics", "astro", "sensors"]),
        ("stats", &["numerics"]),
        ("html-report", &["stats"]),
        ("ssp", &[]),
        ("fmi-model", &[]),
        ("fmi2-abi", &[]),
        ("fmi3-abi", &[]),
        ("fmi-export", &["fmi-model"]),
        ("fmi2-export", &["fmi-model", "fmi-export", "fmi2-abi"]),
        ("fmi3-export", &["fmi-model", "fmi-export", "fmi3-abi"]),
        ("fmi2-import", &["fmi2-abi"]),
        ("fmi2-check", &["fmi2-abi", "fmi2-import"]),
        ("cosim", &["fmi2-import"]),
        (
            "study",
            &["interface", "numerics", "astro", "stats", "fmi2-import", "cosim"],
        ),
        // Readers of files and what they make, fed from tests and fuzz targets; known by nobody.
        (
            "hostile-files",
            &[
                "interface",
                "truth",
                "filters",
                "fmi-model",
                "fmi2-import",
                "fmi2-check",
                "ssp",
                "study",
            ],
        ),
        (
            "trade-harness",
            &[
                "interface",
                "numerics",
                "astro",
                "stats",
                "fmi2-import",
                "fmi2-check",
                "cosim",
                "study",
                "html-report",
                "ssp",
            ],
        ),
        (
            "fmu-truth",
            &["interface", "astro", "truth", "fmi2-export", "fmi3-export"],
        ),
        (
            "fmu-nav",
            &["interface", "astro", "filters", "fmi2-export", "fmi3-export"],
        ),
    ];
    let all = packages();
    let names: BTreeSet<&str> = all
        .iter()
        .filter(|p| p["source"].is_null())
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    for package in all.iter().filter(|p| p["source"].is_null()) {
        let name = package["name"].as_str().unwrap();
        for page in ["README.md", "docs/ARCHITECTURE.md"] {
            let text = std::fs::read_to_string(root().join(page)).unwrap();
            // Exporters of both versions share a word there.
            let told = text.contains(name) || (name.ends_with("-export") && text.contains("fmi2-, fmi3-export"));
            assert!(told || name == "relative-navigation-trades", "{page} leaves {name} out");
        }
        let Some((_, may)) = allowed.iter().find(|(who, _)| *who == name) else {
            assert_eq!(name, "relative-navigation-trades", "say whom {name} may know");
            continue;
        };
        for dependency in package["dependencies"].as_array().unwrap() {
            let other = dependency["name"].as_str().unwrap();
            let ours = names.contains(other) && dependency["kind"].is_null();
            assert!(!ours || may.contains(&other), "{name} must not know {other}");
        }
    }
}

/// The crates of this workspace that an FMU's GUID is made from, against those that cargo resolves for its library.
#[test]
fn the_guid_of_an_fmu_is_made_from_every_crate_in_it() {
    let all = packages();
    let ours = |name: &str| all.iter().find(|p| p["source"].is_null() && p["name"] == name);
    for fmu in ["fmu-truth", "fmu-nav"] {
        let mut wanted = BTreeSet::new();
        let mut open = vec![fmu.to_owned()];
        while let Some(name) = open.pop() {
            for dependency in ours(&name).unwrap()["dependencies"].as_array().unwrap() {
                let other = dependency["name"].as_str().unwrap();
                if dependency["kind"] != "dev" && ours(other).is_some() && !wanted.contains(other) {
                    open.push(other.to_owned());
                }
            }
            wanted.insert(name);
        }
        let inputs = build_identity::Inputs::of(root(), fmu).unwrap();
        let found: BTreeSet<String> = inputs
            .crates()
            .map(|folder| folder.file_name().unwrap().to_string_lossy().into_owned())
            .collect();
        assert_eq!(found, wanted, "{fmu}");
    }
}
