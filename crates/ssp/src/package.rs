//! The archive, or the folder that it would unpack to.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Write};
use std::path::{Component as Step, Path, PathBuf};

use percent_encoding::percent_decode_str;
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::SspError;
use crate::model::{Element, System, SystemStructure};
use crate::read::structure;

/// Name of the structure's file.
pub const STRUCTURE: &str = "SystemStructure.ssd";

/// Most bytes of a file that is read, be it an FMU.
const LIMIT: u64 = 1 << 30;

/// Most bytes of XML.
const XML_LIMIT: u64 = 64 << 20;

/// Most bytes that all files of an archive may unpack to.
const MOST: u64 = 4 << 30;

/// What they may unpack to however small the archive is, bytes.
const ALWAYS: u64 = 256 << 20;

/// Most bytes for each byte of the archive beyond that: deflate makes up to a thousand of one, FMUs a few.
const RATIO: u64 = 200;

/// An opened SSP.
#[derive(Debug)]
pub struct Package {
    path: PathBuf,
    structure: SystemStructure,
    place: Place,
}

#[derive(Debug)]
enum Place {
    Archive {
        zip: ZipArchive<BufReader<File>>,
        /// Bytes that may still be read from it.
        left: u64,
    },
    /// Folder of the `.ssd` file.
    Folder(PathBuf),
}

impl Package {
    /// Opens an archive, a folder with [`STRUCTURE`] in it, or an `.ssd` file in its folder, and reads the structure.
    ///
    /// # Errors
    /// What cannot be read, and what the files say that is not allowed, with file and line.
    pub fn open(path: &Path) -> Result<Self, SspError> {
        let failed = |source| SspError::Read {
            path: path.to_owned(),
            source,
        };
        let no_archive = |error: ZipError| SspError::NotAnArchive {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        let is_structure = path.extension().is_some_and(|extension| extension == "ssd");
        let (mut place, name) = if path.is_dir() {
            (Place::Folder(path.to_owned()), STRUCTURE.to_owned())
        } else if is_structure {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            (Place::Folder(path.parent().unwrap_or(Path::new("")).to_owned()), name)
        } else {
            let file = File::open(path).map_err(failed)?;
            let size = file.metadata().map_err(failed)?.len();
            let zip = ZipArchive::new(BufReader::new(file)).map_err(no_archive)?;
            if zip.has_duplicate_names() {
                return Err(SspError::NotAnArchive {
                    path: path.to_owned(),
                    reason: "two entries have one name".to_owned(),
                });
            }
            let left = size.saturating_mul(RATIO).clamp(ALWAYS, MOST);
            (Place::Archive { zip, left }, STRUCTURE.to_owned())
        };
        let bytes = match place.bytes(path, &name, XML_LIMIT) {
            Ok(bytes) => bytes,
            Err(Lost::Absent) => {
                return Err(SspError::NotAnArchive {
                    path: path.to_owned(),
                    reason: format!("it has no {name}"),
                });
            }
            Err(Lost::Other(error)) => return Err(error),
        };
        let structure = structure(&name, &bytes, &mut |by, uri| place.source(path, by, uri, XML_LIMIT))?;
        Ok(Self {
            path: path.to_owned(),
            structure,
            place,
        })
    }

    /// What the files say.
    pub fn structure(&self) -> &SystemStructure {
        &self.structure
    }

    /// Where it was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The bytes of a file that the structure names.
    ///
    /// * `by`: who names it, for messages.
    /// * `uri`: as it stands there.
    ///
    /// # Errors
    /// [`SspError::Source`], [`SspError::Missing`], [`SspError::TooLarge`], [`SspError::Read`].
    pub fn source(&mut self, by: &str, uri: &str) -> Result<Vec<u8>, SspError> {
        self.place.source(&self.path, by, uri, LIMIT)
    }

    /// An archive of a structure and its files, which depends on names and contents alone. The structure stands first, then the
    /// values that its bindings name, then the other files in the order of their names; what is an archive itself is stored as it is.
    ///
    /// * `files`: contents by name, as `resources/model.fmu`.
    ///
    /// # Errors
    /// [`SspError::Zip`]; [`SspError::Structure`] for a file of values that two bindings fill differently.
    pub fn bytes(structure: &SystemStructure, files: &BTreeMap<String, Vec<u8>>) -> Result<Vec<u8>, SspError> {
        let mut named = BTreeMap::new();
        values(&structure.system, &mut named)?;
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        let mut add = |name: &str, contents: &[u8]| -> Result<(), ZipError> {
            let archive = contents.starts_with(b"PK\x03\x04");
            let method = if archive {
                CompressionMethod::Stored
            } else {
                CompressionMethod::Deflated
            };
            let options = SimpleFileOptions::default()
                .compression_method(method)
                .last_modified_time(zip::DateTime::default())
                .unix_permissions(0o644);
            writer.start_file(name, options)?;
            Ok(writer.write_all(contents)?)
        };
        add(STRUCTURE, structure.to_xml().as_bytes())?;
        for (name, text) in &named {
            add(name, text.as_bytes())?;
        }
        for (name, contents) in files.iter().filter(|(name, _)| !named.contains_key(*name)) {
            add(name, contents)?;
        }
        Ok(writer.finish()?.into_inner())
    }
}

/// The files of values that bindings name, with their texts.
fn values(system: &System, found: &mut BTreeMap<String, String>) -> Result<(), SspError> {
    let own = system.elements.iter().flat_map(|element| match element {
        Element::Component(component) => component.bindings.as_slice(),
        Element::System(_) => &[],
    });
    for binding in system.bindings.iter().chain(own) {
        let Some(source) = &binding.source else { continue };
        // What lies elsewhere is there already.
        let text = decoded(source).filter(|text| !has_scheme(text));
        let Some(name) = text.as_deref().and_then(inside) else {
            continue;
        };
        let text = binding.values.to_xml();
        if found.get(&name).is_some_and(|other| *other != text) {
            return Err(SspError::structure(
                format!("binding '{source}'"),
                "stands twice with different values; give each set a file of its own",
            ));
        }
        found.insert(name, text);
    }
    for element in &system.elements {
        if let Element::System(inner) = element {
            values(inner, found)?;
        }
    }
    Ok(())
}

/// Why there are no bytes.
enum Lost {
    Absent,
    Other(SspError),
}

impl Place {
    /// A file that a URI names.
    fn source(&mut self, path: &Path, by: &str, uri: &str, limit: u64) -> Result<Vec<u8>, SspError> {
        let wrong = |why| SspError::Source {
            by: by.to_owned(),
            uri: uri.to_owned(),
            why,
        };
        let missing = || SspError::Missing {
            path: path.to_owned(),
            by: by.to_owned(),
            name: uri.to_owned(),
        };
        let text = decoded(uri).ok_or_else(|| wrong("is no URI of UTF-8 text"))?;
        if let Some(rest) = text.strip_prefix("file:") {
            let absolute = match rest.strip_prefix("//") {
                None => rest,
                Some(rest) => rest.strip_prefix("localhost").unwrap_or(rest),
            };
            // A drive of Windows stands behind a slash of its own.
            let absolute = match absolute.as_bytes() {
                [b'/', drive, b':', ..] if cfg!(windows) && drive.is_ascii_alphabetic() => &absolute[1..],
                _ => absolute,
            };
            if !Path::new(absolute).is_absolute() {
                return Err(wrong("has no absolute path"));
            }
            return match read_limited(File::open(absolute), path, uri, limit) {
                Err(Lost::Absent) => Err(missing()),
                Err(Lost::Other(error)) => Err(error),
                Ok(bytes) => Ok(bytes),
            };
        }
        if has_scheme(&text) {
            return Err(wrong("is of another scheme than file:"));
        }
        let name = inside(&text).ok_or_else(|| wrong("does not lead into the SSP"))?;
        match self.bytes(path, &name, limit) {
            Err(Lost::Absent) => Err(missing()),
            Err(Lost::Other(error)) => Err(error),
            Ok(bytes) => Ok(bytes),
        }
    }

    fn bytes(&mut self, path: &Path, name: &str, limit: u64) -> Result<Vec<u8>, Lost> {
        match self {
            Self::Folder(folder) => read_limited(File::open(folder.join(name)), path, name, limit),
            Self::Archive { zip, left } => match zip.by_name(name) {
                Err(ZipError::FileNotFound) => Err(Lost::Absent),
                Err(error) => Err(Lost::Other(SspError::NotAnArchive {
                    path: path.to_owned(),
                    reason: format!("entry {name}: {error}"),
                })),
                Ok(entry) => {
                    let bytes = read_limited(Ok(entry), path, name, limit.min(*left))?;
                    *left = left.saturating_sub(bytes.len() as u64);
                    Ok(bytes)
                }
            },
        }
    }
}

/// A scheme has letters before its colon, and no slash.
fn has_scheme(uri: &str) -> bool {
    uri.split_once(':').is_some_and(|(scheme, _)| !scheme.contains('/'))
}

fn decoded(uri: &str) -> Option<String> {
    let text = percent_decode_str(uri).decode_utf8().ok()?;
    Some(text.into_owned())
}

/// The name of a file in the SSP, of a relative path without its steps to the same folder and back; `None` where it leads out.
fn inside(path: &str) -> Option<String> {
    let mut steps: Vec<&str> = Vec::new();
    // An absolute path has nothing before its first slash.
    if path.starts_with('/') {
        return None;
    }
    for step in path.split('/') {
        match step {
            "" | "." => {}
            ".." => {
                steps.pop()?;
            }
            // A drive, and whatever else a system has its own meaning for.
            _ if Path::new(step).components().all(|c| matches!(c, Step::Normal(_))) => steps.push(step),
            _ => return None,
        }
    }
    (!steps.is_empty()).then(|| steps.join("/"))
}

fn read_limited(file: io::Result<impl Read>, path: &Path, name: &str, limit: u64) -> Result<Vec<u8>, Lost> {
    let failed = |source: io::Error| {
        Lost::Other(SspError::Read {
            path: path.join(name),
            source,
        })
    };
    let file = file.map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => Lost::Absent,
        _ => failed(error),
    })?;
    let mut bytes = Vec::new();
    // The limit counts real bytes, since the size that an archive declares may be a lie.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limit {
        return Err(Lost::Other(SspError::TooLarge {
            path: path.to_owned(),
            name: name.to_owned(),
            limit,
        }));
    }
    Ok(bytes)
}
