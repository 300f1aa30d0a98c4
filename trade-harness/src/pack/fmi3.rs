//! The FMI 3.0 twin of an archive: the same library, missions and licences under another description.

use std::path::{Path, PathBuf};

use super::Files;
use super::platforms::RunsOn;

/// The attribute that ties the description of a twin to its library.
pub(super) const IDENTIFIER: &str = "instantiationToken";

/// The committed description of a twin.
pub(super) fn description(workspace: &Path, name: &str) -> PathBuf {
    let folder = workspace.join("modelDescription").join(name);
    folder.join("fmi3/modelDescription.xml")
}

/// Folder of the twins of the archives in a folder.
pub fn folder(of: &Path) -> PathBuf {
    of.join("fmi3")
}

/// The files of a twin, from those of the FMI 2.0 archive: a library that runs on several processors has a place for each.
///
/// * `platforms`: what its libraries run on.
pub(super) fn files(twin_of: &Files, platforms: &[RunsOn], description: Vec<u8>) -> Files {
    let mut files = Files::new();
    for (path, contents) in twin_of {
        let Some((folder, library)) = path.strip_prefix("binaries/").and_then(|path| path.split_once('/')) else {
            files.insert(path.clone(), contents.clone());
            continue;
        };
        for platform in platforms.iter().filter(|platform| platform.fmi2 == folder) {
            files.insert(format!("binaries/{}/{library}", platform.fmi3), contents.clone());
        }
    }
    files.insert("modelDescription.xml".to_owned(), description);
    files
}

/// What a twin is drawn as: its terminals and its icon.
pub(super) fn drawn(terminals: String, svg: Vec<u8>, png: Vec<u8>) -> Files {
    let files = [
        ("terminalsAndIcons.xml", terminals.into_bytes()),
        ("icon.svg", svg),
        ("icon.png", png),
    ];
    files
        .map(|(file, contents)| (format!("terminalsAndIcons/{file}"), contents))
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twin_has_the_library_of_its_archive_under_another_description() {
        let archive = Files::from([
            ("binaries/darwin64/m.dylib".to_owned(), b"apple".to_vec()),
            ("binaries/aarch64-linux/m.so".to_owned(), b"small penguin".to_vec()),
            ("binaries/linux64/m.so".to_owned(), b"penguin".to_vec()),
            ("modelDescription.xml".to_owned(), b"two".to_vec()),
            ("resources/missions/a.toml".to_owned(), b"a".to_vec()),
        ]);
        let built = [
            ("darwin64", "aarch64-darwin"),
            ("darwin64", "x86_64-darwin"),
            ("aarch64-linux", "aarch64-linux"),
            ("linux64", "x86_64-linux"),
        ];
        let built = built.map(|(fmi2, fmi3)| RunsOn {
            fmi2,
            fmi3,
            target: None,
        });
        let twin = files(&archive, &built, b"three".to_vec());
        let native = files(&archive, &built[1..], b"three".to_vec());
        assert!(
            !native.contains_key("binaries/aarch64-darwin/m.dylib"),
            "built for one processor"
        );
        let expected = [
            ("binaries/aarch64-darwin/m.dylib", "apple"),
            ("binaries/aarch64-linux/m.so", "small penguin"),
            ("binaries/x86_64-darwin/m.dylib", "apple"),
            ("binaries/x86_64-linux/m.so", "penguin"),
            ("modelDescription.xml", "three"),
            ("resources/missions/a.toml", "a"),
        ];
        let expected = expected.map(|(path, contents)| (path.to_owned(), contents.as_bytes().to_vec()));
        assert_eq!(twin, Files::from(expected));
    }
}
