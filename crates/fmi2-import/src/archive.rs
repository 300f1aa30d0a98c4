//! The zip archive: checked once when it is opened, unpacked when the library is wanted.

use std::collections::{BTreeSet, HashSet};
use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use zip::ZipArchive;
use zip::result::ZipError;

use crate::ImportError;
use crate::limits::{self, Budget, Stopped};
use crate::platform::PLATFORM;

const DESCRIPTION: &str = "modelDescription.xml";

/// An opened archive whose entries all stay inside their folder.
#[derive(Debug)]
pub(crate) struct Archive {
    path: PathBuf,
    /// Its size, bytes.
    size: u64,
    zip: ZipArchive<BufReader<File>>,
}

impl Archive {
    /// Opens `path` and refuses entries that point outside the archive, stand twice in it or share their bytes.
    pub(crate) fn open(path: &Path) -> Result<Self, ImportError> {
        let read = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => ImportError::NotFound { path: path.to_owned() },
            _ => ImportError::Read {
                path: path.to_owned(),
                source,
            },
        };
        let file = File::open(path).map_err(read)?;
        let facts = file.metadata().map_err(read)?;
        if facts.is_dir() {
            return Err(read(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let zip = ZipArchive::new(BufReader::new(file)).map_err(|e| not_an_archive(path, &e))?;
        let mut archive = Self {
            path: path.to_owned(),
            size: facts.len(),
            zip,
        };
        archive.check_directory()?;
        archive.check_entries()?;
        Ok(archive)
    }

    /// Refuses what readers could take for different archives, or for more than it is.
    fn check_directory(&mut self) -> Result<(), ImportError> {
        let shared = self
            .zip
            .has_overlapping_files()
            .map_err(|e| not_an_archive(&self.path, &e))?;
        let reason = if self.zip.len() > limits::ENTRIES {
            format!(
                "it has {} entries, at most {} are read",
                self.zip.len(),
                limits::ENTRIES
            )
        } else if self.zip.has_duplicate_names() {
            "two entries have one name".to_owned()
        } else if shared {
            "two entries share their bytes, as in a zip bomb".to_owned()
        } else {
            return Ok(());
        };
        Err(ImportError::NotAnArchive {
            path: self.path.clone(),
            reason,
        })
    }

    fn check_entries(&mut self) -> Result<(), ImportError> {
        let mut files = HashSet::new();
        for i in 0..self.zip.len() {
            let entry = self.zip.by_index_raw(i).map_err(|e| not_an_archive(&self.path, &e))?;
            let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
            let reason = match inside(&name) {
                _ if entry.is_symlink() => "is a symbolic link",
                None => "points outside the archive",
                Some(path) if needed(&path) && !path.iter().all(writable) => {
                    "cannot be written, since file names of this system hold none of <>:\"|?*, end in no dot or blank and are no device"
                }
                Some(ref path) if !entry.is_dir() && !files.insert(as_the_system_sees(path)) => {
                    "would be unpacked over another entry"
                }
                Some(_) => continue,
            };
            let entry = name;
            return Err(ImportError::UnsafeEntry {
                path: self.path.clone(),
                entry,
                reason,
            });
        }
        Ok(())
    }

    /// The bytes of modelDescription.xml.
    pub(crate) fn description(&mut self) -> Result<Vec<u8>, ImportError> {
        let entry = match self.zip.by_name(DESCRIPTION) {
            Err(ZipError::FileNotFound) => {
                return Err(ImportError::NoModelDescription {
                    path: self.path.clone(),
                });
            }
            other => other.map_err(|e| not_an_archive(&self.path, &e))?,
        };
        let mut bytes = Vec::new();
        // The limit counts real bytes, since the size that an archive declares may be a lie.
        entry
            .take(limits::DESCRIPTION + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| damaged(&self.path, DESCRIPTION, &e))?;
        if bytes.len() as u64 > limits::DESCRIPTION {
            return Err(ImportError::TooLarge {
                path: self.path.clone(),
                what: DESCRIPTION.to_owned(),
                limit_bytes: limits::DESCRIPTION,
            });
        }
        Ok(bytes)
    }

    /// Names of the folders under `binaries/` that hold a file, sorted.
    pub(crate) fn platforms(&self) -> Vec<String> {
        let mut found = BTreeSet::new();
        for name in self.zip.file_names().flatten() {
            if let Some((platform, file)) = name.strip_prefix("binaries/").and_then(|rest| rest.split_once('/'))
                && !file.is_empty()
            {
                found.insert(platform.to_owned());
            }
        }
        found.into_iter().collect()
    }

    /// Whether there is an entry of exactly this name.
    pub(crate) fn contains(&self, entry: &str) -> bool {
        self.zip.file_names().flatten().any(|name| name == entry)
    }

    /// Unpacks what a running FMU may look at into a new temporary folder: all but sources, documentation and the
    /// libraries of other platforms. A `resources` folder always exists afterwards.
    pub(crate) fn unpack(&mut self) -> Result<TempDir, ImportError> {
        let failed = |path: &Path, target: &Path, source| ImportError::Unpack {
            path: path.to_owned(),
            target: target.to_owned(),
            source,
        };
        let folder = tempfile::Builder::new()
            .prefix("fmu-")
            .tempdir()
            .map_err(|e| failed(&self.path, &std::env::temp_dir(), e))?;
        let resources = folder.path().join("resources");
        fs::create_dir_all(&resources).map_err(|e| failed(&self.path, &resources, e))?;

        let mut budget = Budget::of(self.size);
        for i in 0..self.zip.len() {
            let entry = self.zip.by_index(i).map_err(|e| not_an_archive(&self.path, &e))?;
            // `check_entries` has refused archives where this is None.
            let Some(name) = inside(&String::from_utf8_lossy(entry.name_raw())) else {
                continue;
            };
            if !needed(&name) {
                continue;
            }
            let target = folder.path().join(&name);
            if entry.is_dir() {
                fs::create_dir_all(&target).map_err(|e| failed(&self.path, &target, e))?;
                continue;
            }
            if let Some(parent) = target.parent() {
                fs::create_dir_all(parent).map_err(|e| failed(&self.path, parent, e))?;
            }
            let mut file = File::create(&target).map_err(|e| failed(&self.path, &target, e))?;
            budget.copy(entry, &mut file).map_err(|stopped| match stopped {
                Stopped::Read(error) => damaged(&self.path, &name.display().to_string(), &error),
                Stopped::Write(error) => failed(&self.path, &target, error),
                Stopped::Full => ImportError::TooLarge {
                    path: self.path.clone(),
                    what: "the unpacked FMU".to_owned(),
                    limit_bytes: budget.limit(),
                },
            })?;
        }
        Ok(folder)
    }
}

/// The path of an entry below the folder that it is unpacked to; `None` if it leads out of it.
///
/// Both slashes separate, since some tools write the wrong one. Colons and other characters that some systems refuse stay.
fn inside(name: &str) -> Option<PathBuf> {
    let mut path = PathBuf::new();
    let absolute = name.starts_with(['/', '\\']) || (name.get(1..3) == Some(":\\") || name.get(1..3) == Some(":/"));
    if absolute || name.contains('\0') {
        return None;
    }
    for part in name.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => {
                if !path.pop() {
                    return None;
                }
            }
            // A drive of Windows would make a path of its own.
            _ if cfg!(windows) && path.as_os_str().is_empty() && part.contains(':') => return None,
            _ => path.push(part),
        }
    }
    Some(path)
}

/// Whether the system can have a file of this name.
#[cfg(not(windows))]
fn writable(_part: &std::ffi::OsStr) -> bool {
    true
}

#[cfg(windows)]
fn writable(part: &std::ffi::OsStr) -> bool {
    const DEVICES: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];
    let part = part.to_string_lossy();
    let stem = part
        .split('.')
        .next()
        .unwrap_or_default()
        .trim_end()
        .to_ascii_uppercase();
    let numbered = |name: &str| {
        let number = stem.strip_prefix(name);
        number.is_some_and(|n| n.len() == 1 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    !part.contains(|c: char| c.is_control() || "<>:\"|?*".contains(c))
        && !part.ends_with(['.', ' '])
        && !DEVICES.contains(&stem.as_str())
        && !numbered("COM")
        && !numbered("LPT")
}

/// A path by which the system tells files apart.
fn as_the_system_sees(path: &Path) -> PathBuf {
    if cfg!(any(windows, target_os = "macos")) {
        return path.to_string_lossy().to_lowercase().into();
    }
    path.to_owned()
}

fn needed(entry: &Path) -> bool {
    if entry.starts_with("binaries") {
        return entry.starts_with(Path::new("binaries").join(PLATFORM));
    }
    !entry.starts_with("sources") && !entry.starts_with("documentation")
}

fn not_an_archive(path: &Path, error: &ZipError) -> ImportError {
    ImportError::NotAnArchive {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

fn damaged(path: &Path, entry: &str, error: &io::Error) -> ImportError {
    ImportError::NotAnArchive {
        path: path.to_owned(),
        reason: format!("entry {entry}: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_inside_or_are_refused() {
        for (name, path) in [
            ("resources/level.txt", Some("resources/level.txt")),
            ("resources\\level.txt", Some("resources/level.txt")),
            ("./a//b/", Some("a/b")),
            ("a/../b", Some("b")),
            ("resources/12:30:00.csv", Some("resources/12:30:00.csv")),
            ("../a", None),
            ("a/../../b", None),
            ("a\\..\\..\\b", None),
            ("/etc/passwd", None),
            ("\\\\host\\share", None),
            ("C:/a", None),
            ("C:\\a", None),
            ("a\0b", None),
            ("..", None),
            ("./", Some("")),
            ("a/..", Some("")),
        ] {
            assert_eq!(inside(name).as_deref(), path.map(Path::new), "{name:?}");
        }
        #[cfg(not(windows))]
        assert_eq!(inside("a:b"), Some("a:b".into()));
    }

    #[cfg(windows)]
    #[test]
    fn names_that_windows_cannot_have_are_told() {
        for name in ["a:b", "a?", "a.", "a ", "nul", "COM1.txt", "a\u{1}"] {
            assert!(!writable(name.as_ref()), "{name:?}");
        }
        assert!(["a b", "console", "a.b"].iter().all(|name| writable(name.as_ref())));
    }
}
