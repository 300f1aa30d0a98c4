//! The FMI 3.0 twin of an archive: the same library, missions and licences under another description.

use std::path::{Path, PathBuf};

use super::Files;

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

/// The files of a twin, from those of the FMI 2.0 archive.
pub(super) fn files(twin_of: &Files, description: Vec<u8>) -> Files {
    let mut files = Files::new();
    for (path, contents) in twin_of {
        let places = match path.strip_prefix("binaries/").and_then(|path| path.split_once('/')) {
            Some((platform, library)) => platforms(platform)
                .iter()
                .map(|platform| format!("binaries/{platform}/{library}"))
                .collect(),
            None => vec![path.clone()],
        };
        files.extend(places.into_iter().map(|place| (place, contents.clone())));
    }
    files.insert("modelDescription.xml".to_owned(), description);
    if let Some(page) = files.get_mut("documentation/index.html") {
        let text = String::from_utf8_lossy(page).replacen(
            "FMI 2.0 co-simulation",
            "FMI 3.0 co-simulation, elements of arrays listed one by one",
            1,
        );
        *page = text.into_bytes();
    }
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

/// What FMI 3.0 calls a platform of FMI 2.0; a library for more than one processor has a place for each.
fn platforms(of: &str) -> Vec<&str> {
    match of {
        "linux64" => vec!["x86_64-linux"],
        "linux32" => vec!["x86-linux"],
        "win64" => vec!["x86_64-windows"],
        "win32" => vec!["x86-windows"],
        "darwin64" => vec!["aarch64-darwin", "x86_64-darwin"],
        // FMI 2.0 has no names of its own for the others.
        other => vec![other],
    }
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
            (
                "documentation/index.html".to_owned(),
                b"<p>FMI 2.0 co-simulation, version 1</p>".to_vec(),
            ),
            ("modelDescription.xml".to_owned(), b"two".to_vec()),
            ("resources/missions/a.toml".to_owned(), b"a".to_vec()),
        ]);
        let twin = files(&archive, b"three".to_vec());
        let expected = [
            ("binaries/aarch64-darwin/m.dylib", "apple"),
            ("binaries/aarch64-linux/m.so", "small penguin"),
            ("binaries/x86_64-darwin/m.dylib", "apple"),
            ("binaries/x86_64-linux/m.so", "penguin"),
            (
                "documentation/index.html",
                "<p>FMI 3.0 co-simulation, elements of arrays listed one by one, version 1</p>",
            ),
            ("modelDescription.xml", "three"),
            ("resources/missions/a.toml", "a"),
        ];
        let expected = expected.map(|(path, contents)| (path.to_owned(), contents.as_bytes().to_vec()));
        assert_eq!(twin, Files::from(expected));
    }
}
