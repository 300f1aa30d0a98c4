//! The zip archive: checked once when it is opened, unpacked when the library is wanted.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use zip::ZipArchive;
use zip::result::ZipError;

use crate::ImportError;
use crate::platform::PLATFORM;

const DESCRIPTION: &str = "modelDescription.xml";

/// Largest modelDescription.xml, bytes.
const DESCRIPTION_LIMIT: u64 = 64 << 20;

/// Most bytes that an FMU may unpack to.
const UNPACK_LIMIT: u64 = 4 << 30;

/// An opened archive whose entries all stay inside their folder.
#[derive(Debug)]
pub(crate) struct Archive {
    path: PathBuf,
    zip: ZipArchive<BufReader<File>>,
}

impl Archive {
    /// Opens `path` and refuses entries that point outside the archive.
    pub(crate) fn open(path: &Path) -> Result<Self, ImportError> {
        let read = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => ImportError::NotFound { path: path.to_owned() },
            _ => ImportError::Read {
                path: path.to_owned(),
                source,
            },
        };
        let file = File::open(path).map_err(read)?;
        if file.metadata().map_err(read)?.is_dir() {
            return Err(read(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let zip = ZipArchive::new(BufReader::new(file)).map_err(|e| not_an_archive(path, &e))?;
        let mut archive = Self {
            path: path.to_owned(),
            zip,
        };
        archive.check_entries()?;
        Ok(archive)
    }

    fn check_entries(&mut self) -> Result<(), ImportError> {
        for i in 0..self.zip.len() {
            let entry = self.zip.by_index_raw(i).map_err(|e| not_an_archive(&self.path, &e))?;
            let reason = if entry.enclosed_name().is_none() {
                "points outside the archive"
            } else if entry.is_symlink() {
                "is a symbolic link"
            } else {
                continue;
            };
            let entry = String::from_utf8_lossy(entry.name_raw()).into_owned();
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
            .take(DESCRIPTION_LIMIT + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| not_an_archive(&self.path, &ZipError::Io(e)))?;
        if bytes.len() as u64 > DESCRIPTION_LIMIT {
            return Err(ImportError::TooLarge {
                path: self.path.clone(),
                what: DESCRIPTION.to_owned(),
                limit_bytes: DESCRIPTION_LIMIT,
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

        let mut left = UNPACK_LIMIT;
        for i in 0..self.zip.len() {
            let entry = self.zip.by_index(i).map_err(|e| not_an_archive(&self.path, &e))?;
            // `check_entries` has refused archives where this is None.
            let Some(name) = entry.enclosed_name() else { continue };
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
            let written = io::copy(&mut entry.take(left + 1), &mut file).map_err(|e| failed(&self.path, &target, e))?;
            left = left.checked_sub(written).ok_or_else(|| ImportError::TooLarge {
                path: self.path.clone(),
                what: "the unpacked FMU".to_owned(),
                limit_bytes: UNPACK_LIMIT,
            })?;
        }
        Ok(folder)
    }
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
