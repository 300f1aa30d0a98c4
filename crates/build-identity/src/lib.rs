//! The GUID of an FMU, from everything that its library is built from. For the build scripts of the FMU crates, so that it is
//! there before the library is linked.
//!
//! It knows sources, not binaries: equal sources give equal GUIDs in any folder and on any platform.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use uuid::Uuid;

/// Folders of a crate that never go into its library.
const LEFT_OUT: [&str; 4] = ["benches", "examples", "target", "tests"];

/// What an FMU is built from.
#[derive(Debug, Clone)]
pub struct Inputs {
    workspace: PathBuf,
    crates: BTreeSet<PathBuf>,
    /// Files and folders relative to the workspace, crates aside.
    others: Vec<PathBuf>,
}

impl Inputs {
    /// Inputs of the FMU crate in folder `name` of a workspace: itself, the crates of the workspace that it depends on, lock
    /// file, workspace manifest, missions and committed model descriptions.
    ///
    /// # Errors
    /// A manifest that cannot be read.
    pub fn of(workspace: &Path, name: &str) -> io::Result<Self> {
        let mut crates = BTreeSet::new();
        let mut open = vec![PathBuf::from(name)];
        while let Some(folder) = open.pop() {
            let manifest =
                fs::read_to_string(workspace.join(&folder).join("Cargo.toml")).map_err(|e| at(&folder, &e))?;
            let ours = dependencies(&manifest).map(|d| Path::new("crates").join(d));
            open.extend(ours.filter(|d| workspace.join(d).is_dir() && !crates.contains(d)));
            crates.insert(folder);
        }
        let descriptions = Path::new("modelDescription").join(name);
        Ok(Self {
            workspace: workspace.to_owned(),
            crates,
            others: vec![
                "Cargo.lock".into(),
                "Cargo.toml".into(),
                "missions".into(),
                descriptions,
            ],
        })
    }

    /// Folders of the crates, relative to the workspace.
    pub fn crates(&self) -> impl Iterator<Item = &Path> {
        self.crates.iter().map(PathBuf::as_path)
    }

    /// Every file and folder that is looked at, for `cargo:rerun-if-changed`.
    pub fn watched(&self) -> impl Iterator<Item = PathBuf> {
        self.crates.iter().chain(&self.others).map(|p| self.workspace.join(p))
    }

    /// The GUID with these cargo features: a name-based UUID of every file's path in the workspace and contents.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn guid(&self, features: &BTreeSet<String>) -> io::Result<Uuid> {
        let mut files = BTreeSet::new();
        for path in self.crates.iter().chain(&self.others) {
            collect(&self.workspace, path, &mut files)?;
        }
        let mut name = Vec::new();
        for feature in features {
            push(&mut name, feature.as_bytes());
        }
        for file in files {
            let contents = fs::read(self.workspace.join(&file)).map_err(|e| at(&file, &e))?;
            // The same separator on every platform.
            let parts: Vec<_> = file.iter().map(|part| part.to_string_lossy()).collect();
            push(&mut name, parts.join("/").as_bytes());
            push(&mut name, &contents);
        }
        Ok(Uuid::new_v5(&Uuid::NAMESPACE_OID, &name))
    }
}

/// Puts the length before the bytes, so that no two lists of parts look alike.
fn push(name: &mut Vec<u8>, part: &[u8]) {
    name.extend((part.len() as u64).to_le_bytes());
    name.extend(part);
}

fn at(path: &Path, source: &io::Error) -> io::Error {
    io::Error::new(source.kind(), format!("{}: {source}", path.display()))
}

/// The files of a file or folder, relative to the workspace.
fn collect(workspace: &Path, path: &Path, files: &mut BTreeSet<PathBuf>) -> io::Result<()> {
    let full = workspace.join(path);
    if !full.is_dir() {
        files.insert(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(&full).map_err(|e| at(path, &e))? {
        let name = entry?.file_name();
        if !LEFT_OUT.iter().any(|folder| name == *folder) {
            collect(workspace, &path.join(name), files)?;
        }
    }
    Ok(())
}

/// Names in the dependency tables of a manifest, tests' own aside.
fn dependencies(manifest: &str) -> impl Iterator<Item = &str> {
    let mut inside = false;
    manifest.lines().filter_map(move |line| {
        if line.starts_with('[') {
            inside = matches!(line.trim(), "[dependencies]" | "[build-dependencies]");
            return None;
        }
        let name = line.split(['.', '=', ' ']).next()?;
        (inside && !name.is_empty() && !name.starts_with('#')).then_some(name)
    })
}

/// What the build script of an FMU does: tells cargo its GUID, as `FMU_GUID`, the name of its library, and what to watch.
///
/// * `folder`: of the FMU's crate, in the workspace; `name`: of that crate.
///
/// # Errors
/// A source that cannot be read.
#[allow(clippy::print_stdout, reason = "how a build script talks to cargo")]
pub fn tell_cargo(folder: &Path, name: &str) -> io::Result<()> {
    let inputs = Inputs::of(&folder.join(".."), name)?;
    let features: BTreeSet<String> = std::env::vars()
        .filter_map(|(key, _)| key.strip_prefix("CARGO_FEATURE_").map(str::to_owned))
        .collect();
    println!("cargo:rustc-env=FMU_GUID={}", inputs.guid(&features)?);
    if std::env::var("CARGO_CFG_TARGET_VENDOR").is_ok_and(|vendor| vendor == "apple") {
        // A library of macOS has its name inside, which is otherwise the path that it was built at.
        let name = name.replace('-', "_");
        println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/{name}.dylib");
    }
    for path in inputs.watched() {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace with an FMU that depends on `a`, `a` on `b`, nothing on `c`.
    fn workspace() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write(
            "fmu/Cargo.toml",
            "[dependencies]\na.workspace = true\nserde.workspace = true\n[dev-dependencies]\nc.workspace = true\n",
        );
        write("fmu/src/lib.rs", "line\n");
        write("crates/a/Cargo.toml", "[dependencies]\nb = { workspace = true }\n");
        write("crates/a/src/lib.rs", "line\n");
        write("crates/a/tests/a.rs", "line\n");
        write("crates/b/Cargo.toml", "");
        write("crates/b/src/deep/b.rs", "line\n");
        write("crates/c/Cargo.toml", "");
        write("missions/m.toml", "line\n");
        write("modelDescription/fmu/modelDescription.xml", "line\n");
        write("Cargo.toml", "");
        write("Cargo.lock", "line\n");
        folder
    }

    fn guid(workspace: &Path) -> Uuid {
        Inputs::of(workspace, "fmu").unwrap().guid(&BTreeSet::new()).unwrap()
    }

    #[test]
    fn equal_sources_in_two_folders_have_one_guid() {
        let (one, other) = (workspace(), workspace());
        assert_ne!(one.path(), other.path());
        assert_eq!(guid(one.path()), guid(other.path()));
    }

    #[test]
    fn one_changed_line_of_any_input_makes_another_guid_and_nothing_else_does() {
        let folder = workspace();
        let before = guid(folder.path());
        for path in [
            "fmu/src/lib.rs",
            "crates/a/src/lib.rs",
            "crates/b/src/deep/b.rs",
            "missions/m.toml",
            "modelDescription/fmu/modelDescription.xml",
            "Cargo.lock",
        ] {
            let path = folder.path().join(path);
            fs::write(&path, "another line\n").unwrap();
            assert_ne!(guid(folder.path()), before, "{}", path.display());
            fs::write(&path, "line\n").unwrap();
            assert_eq!(guid(folder.path()), before, "{}", path.display());
        }
        for path in ["crates/a/tests/a.rs", "crates/c/Cargo.toml"] {
            fs::write(folder.path().join(path), "another line\n").unwrap();
            assert_eq!(guid(folder.path()), before, "{path}");
        }
    }

    #[test]
    fn a_feature_makes_another_guid() {
        let folder = workspace();
        let inputs = Inputs::of(folder.path(), "fmu").unwrap();
        assert_ne!(
            inputs.guid(&BTreeSet::from(["x".to_owned()])).unwrap(),
            guid(folder.path())
        );
    }
}
