//! The zip archive: what it holds, and whether it is packed as the standard says.

mod directory;
mod files;
mod library;

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use fmi2_import::limits::{self, Budget, Stopped};
use zip::{CompressionMethod, ZipArchive};

use crate::error::CheckError;
use crate::finding::Findings;
use crate::rules::archive as rules;
use crate::xml::tree::Node;

/// Where the description stands.
pub(crate) const DESCRIPTION: &str = "modelDescription.xml";

/// Largest file that is looked into, bytes; a library may be as large.
const FILE_LIMIT: u64 = 1 << 30;

/// An opened archive.
#[derive(Debug)]
pub(crate) struct Archive {
    path: PathBuf,
    /// Its size, bytes.
    size: u64,
    zip: ZipArchive<BufReader<File>>,
    /// Names of all entries that are files, in the order of the archive, as they are written.
    names: Vec<String>,
    /// Whether all of them may be unpacked.
    safe: bool,
}

impl Archive {
    /// Opens a file and checks how it is packed.
    ///
    /// # Errors
    /// [`CheckError::Read`], [`CheckError::NotAnArchive`].
    pub(crate) fn open(path: &Path, findings: &mut Findings) -> Result<Self, CheckError> {
        let read = |source| CheckError::Read {
            path: path.to_owned(),
            source,
        };
        let mut file = File::open(path).map_err(read)?;
        let facts = file.metadata().map_err(read)?;
        if facts.is_dir() {
            return Err(read(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let directory = directory::names(&mut file).map_err(read)?;
        let zip = ZipArchive::new(BufReader::new(file)).map_err(|error| CheckError::NotAnArchive {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
        let mut archive = Self {
            path: path.to_owned(),
            size: facts.len(),
            zip,
            names: Vec::new(),
            safe: true,
        };
        archive.entries(findings);
        let names = directory.unwrap_or_else(|| archive.names.clone());
        archive.safe &= !archive.zip.has_duplicate_names();
        directory::check(&names, findings);
        if archive.contains(DESCRIPTION) {
            if names.first().is_some_and(|first| first != DESCRIPTION) {
                let what = format!("the first entry is {}", names[0]);
                findings.add(&rules::FIRST, DESCRIPTION, what);
            }
        } else {
            let inside = archive
                .names
                .iter()
                .find(|name| name.ends_with(&format!("/{DESCRIPTION}")));
            let what = inside.map_or("there is none".to_owned(), |name| format!("there is none but {name}"));
            findings.add(&rules::DESCRIPTION, DESCRIPTION, what);
        }
        Ok(archive)
    }

    /// Finds what is wrong with an entry, or with all of them, and that nothing is unpacked therefore.
    fn broken(&mut self, findings: &mut Findings, entry: impl Into<String>, what: impl Into<String>) {
        findings.add(&rules::ENTRY, entry, what);
        self.safe = false;
    }

    fn entries(&mut self, findings: &mut Findings) {
        if self.zip.len() > limits::ENTRIES {
            let what = format!("there are {}, more than {}", self.zip.len(), limits::ENTRIES);
            return self.broken(findings, "all entries", what);
        }
        match self.zip.has_overlapping_files() {
            Ok(false) => (),
            Ok(true) => {
                let what = "two of them share their bytes, as in a zip bomb";
                return self.broken(findings, "all entries", what);
            }
            Err(error) => return self.broken(findings, "all entries", error.to_string()),
        }
        for place in 0..self.zip.len() {
            let entry = match self.zip.by_index_raw(place) {
                Ok(entry) => entry,
                Err(error) => {
                    findings.add(&rules::ENTRY, format!("entry {}", place + 1), error.to_string());
                    self.safe = false;
                    continue;
                }
            };
            let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
            let plain = name.replace('\\', "/");
            let drive = plain.as_bytes().get(1) == Some(&b':');
            if plain.starts_with('/') || drive || plain.split('/').any(|part| part == "..") {
                findings.add(&rules::PATH, &name, "it points outside the archive");
                self.safe = false;
            }
            if name.contains('\\') {
                findings.add(&rules::BACKSLASH, &name, "there is a backslash in its name");
            }
            if !name.is_ascii() {
                findings.add(&rules::NAME, &name, "its name is not ASCII");
            }
            if entry.is_symlink() {
                findings.add(&rules::LINK, &name, "it is a symbolic link");
                self.safe = false;
            }
            let method = entry.compression();
            if !matches!(method, CompressionMethod::Stored | CompressionMethod::Deflated) {
                findings.add(&rules::COMPRESSION, &name, format!("it is packed with {method}"));
            }
            if !name.ends_with('/') {
                self.names.push(name);
            }
        }
        // Reading to the end proves lengths and check sums.
        let mut budget = Budget::of(self.size);
        for name in self.names.clone() {
            let copied = match self.zip.by_name(&name) {
                Ok(entry) => budget.copy(entry, &mut io::sink()),
                Err(error) => Err(Stopped::Read(error.into())),
            };
            match copied {
                Ok(()) => (),
                Err(Stopped::Full) => {
                    let what = format!("the archive unpacks to more than {} bytes", budget.limit());
                    return self.broken(findings, name, what);
                }
                Err(Stopped::Read(error) | Stopped::Write(error)) => self.broken(findings, name, error.to_string()),
            }
        }
    }

    /// Checks the files against what the description says of them.
    ///
    /// * `interfaces`: the elements ModelExchange and CoSimulation.
    pub(crate) fn files(&mut self, interfaces: &[&Node], findings: &mut Findings) {
        files::check(self, interfaces, findings);
    }

    /// Names of all files.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    pub(crate) fn contains(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// Names of files in a folder, which ends in a slash, without the folder.
    fn in_folder<'a>(&'a self, folder: &'a str) -> impl Iterator<Item = &'a str> {
        self.names.iter().filter_map(move |name| name.strip_prefix(folder))
    }

    /// Contents of a file; nothing where it cannot be read, which has been found when it was opened, or is too large.
    pub(crate) fn read(&mut self, name: &str) -> Option<Vec<u8>> {
        self.read_limited(name, FILE_LIMIT)
    }

    /// The description; one that is too large is a finding.
    pub(crate) fn description(&mut self, findings: &mut Findings) -> Option<Vec<u8>> {
        let bytes = self.read_limited(DESCRIPTION, limits::DESCRIPTION);
        let declared = self.zip.by_name(DESCRIPTION).map(|entry| entry.size());
        if bytes.is_none() && declared.is_ok_and(|size| size > limits::DESCRIPTION) {
            let what = format!(
                "it is larger than {} bytes, and nothing in it was checked",
                limits::DESCRIPTION
            );
            self.broken(findings, DESCRIPTION, what);
        }
        bytes
    }

    fn read_limited(&mut self, name: &str, limit: u64) -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        let entry = self.zip.by_name(name).ok()?;
        entry.take(limit + 1).read_to_end(&mut bytes).ok()?;
        (bytes.len() as u64 <= limit).then_some(bytes)
    }

    /// Unpacks what a library may look at into a folder; not where an entry is not to be trusted.
    ///
    /// * returns: whether it was done.
    ///
    /// # Errors
    /// [`CheckError::Unpack`].
    pub(crate) fn unpack(&mut self, folder: &Path) -> Result<bool, CheckError> {
        if !self.safe {
            return Ok(false);
        }
        let path = self.path.clone();
        let failed = |target: &Path, source| CheckError::Unpack {
            path: path.clone(),
            target: target.to_owned(),
            source,
        };
        let mut budget = Budget::of(self.size);
        let resources = folder.join("resources");
        fs::create_dir_all(&resources).map_err(|e| failed(&resources, e))?;
        for name in self.names.clone() {
            if ["documentation/", "sources/"]
                .iter()
                .any(|other| name.starts_with(other))
            {
                continue;
            }
            let target = folder.join(name.replace('\\', "/"));
            let parent = target.parent().unwrap_or(folder);
            fs::create_dir_all(parent).map_err(|e| failed(parent, e))?;
            let entry = self.zip.by_name(&name).map_err(|e| failed(&target, e.into()))?;
            let mut file = File::create(&target).map_err(|e| failed(&target, e))?;
            budget.copy(entry, &mut file).map_err(|stopped| match stopped {
                Stopped::Read(error) | Stopped::Write(error) => failed(&target, error),
                Stopped::Full => failed(folder, io::Error::from(io::ErrorKind::FileTooLarge)),
            })?;
        }
        Ok(true)
    }
}
