//! The loaded library: its functions, and the folder it was unpacked to.

use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use fmi2_abi::functions as f;
use libloading::Library;
use tempfile::TempDir;

use crate::ImportError;
use crate::archive::Archive;
use crate::description::CoSimulation;
use crate::logger::text;
use crate::platform::{LIBRARY_SUFFIX, PLATFORM};

/// The functions of FMI 2.0 that a co-simulation master calls.
#[derive(Debug)]
pub(crate) struct Functions {
    pub(crate) instantiate: f::Instantiate,
    pub(crate) free_instance: f::FreeInstance,
    pub(crate) set_debug_logging: f::SetDebugLogging,
    pub(crate) setup_experiment: f::SetupExperiment,
    pub(crate) enter_initialization_mode: f::EnterInitializationMode,
    pub(crate) exit_initialization_mode: f::ExitInitializationMode,
    pub(crate) terminate: f::Terminate,
    pub(crate) reset: f::Reset,
    pub(crate) get_real: f::GetReal,
    pub(crate) get_integer: f::GetInteger,
    pub(crate) get_boolean: f::GetBoolean,
    pub(crate) get_string: f::GetString,
    pub(crate) set_real: f::SetReal,
    pub(crate) set_integer: f::SetInteger,
    pub(crate) set_boolean: f::SetBoolean,
    pub(crate) set_string: f::SetString,
    pub(crate) do_step: f::DoStep,
    /// Asked for details of a discarded step; required by the standard, yet missing from some FMUs.
    pub(crate) get_real_status: Option<f::GetRealStatus>,
    /// Likewise.
    pub(crate) get_boolean_status: Option<f::GetBooleanStatus>,
    /// Present when the description says so.
    pub(crate) states: Option<StateFunctions>,
    /// Present when the description says so.
    pub(crate) serialization: Option<SerializationFunctions>,
}

/// `canGetAndSetFMUstate`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StateFunctions {
    pub(crate) get: f::GetFmuState,
    pub(crate) set: f::SetFmuState,
    pub(crate) free: f::FreeFmuState,
}

/// `canSerializeFMUstate`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SerializationFunctions {
    pub(crate) size: f::SerializedFmuStateSize,
    pub(crate) serialize: f::SerializeFmuState,
    pub(crate) deserialize: f::DeSerializeFmuState,
}

/// A library in this process. Instances share it; it is unloaded, and its folder removed, with the last of them.
#[derive(Debug)]
pub(crate) struct Binary {
    pub(crate) functions: Functions,
    /// `file:` URI of the unpacked `resources` folder.
    pub(crate) resources: String,
    /// Instances alive.
    pub(crate) alive: AtomicUsize,
    /// Set when an instance ended in a way that makes unloading unsafe.
    pub(crate) keep_loaded: AtomicBool,
    loaded: ManuallyDrop<Library>,
    // Dropped after the library: an open library cannot be deleted everywhere.
    _folder: TempDir,
}

impl Drop for Binary {
    fn drop(&mut self) {
        if !self.keep_loaded.load(Ordering::Relaxed) {
            // SAFETY: the field is not used again, and no instance is left that could call into the library.
            unsafe { ManuallyDrop::drop(&mut self.loaded) };
        }
    }
}

impl Binary {
    /// Unpacks and loads the library for this platform.
    pub(crate) fn load(
        path: &Path,
        archive: &mut Archive,
        platforms: &[String],
        attributes: &CoSimulation,
    ) -> Result<Self, ImportError> {
        let entry = format!("binaries/{PLATFORM}/{}.{LIBRARY_SUFFIX}", attributes.model_identifier);
        if !archive.contains(&entry) {
            return Err(ImportError::NoBinary {
                path: path.to_owned(),
                wanted: entry,
                present: platforms.to_owned(),
            });
        }
        let folder = archive.unpack()?;
        let file: PathBuf = folder.path().join(&entry);
        // SAFETY: loading runs the initializers of a library that the user asked for by path.
        let library = unsafe { open(&file) }.map_err(|e| ImportError::Load {
            path: path.to_owned(),
            library: entry.clone(),
            reason: loader_text(&e),
        })?;
        let symbols = Symbols {
            loaded: &library,
            path,
            entry: &entry,
        };
        symbols.check_answer("fmi2GetVersion", "2.0")?;
        symbols.check_answer("fmi2GetTypesPlatform", "default")?;
        let functions = symbols.functions(attributes)?;
        Ok(Self {
            functions,
            resources: file_uri(&folder.path().join("resources")),
            alive: AtomicUsize::new(0),
            keep_loaded: AtomicBool::new(false),
            loaded: ManuallyDrop::new(library),
            _folder: folder,
        })
    }
}

/// Loads a library with all its symbols resolved at once: a missing one is an error here rather than an abort later.
///
/// # Safety
/// As [`Library::new`].
#[cfg(unix)]
unsafe fn open(file: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::unix::{Library as Unix, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: passed on to the caller.
    unsafe { Unix::open(Some(file), RTLD_NOW | RTLD_LOCAL) }.map(Library::from)
}

/// Loads a library whose own dependencies may lie beside it.
///
/// # Safety
/// As [`Library::new`].
#[cfg(windows)]
unsafe fn open(file: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::windows::{LOAD_WITH_ALTERED_SEARCH_PATH, Library as Windows};
    // SAFETY: passed on to the caller.
    unsafe { Windows::load_with_flags(file, LOAD_WITH_ALTERED_SEARCH_PATH) }.map(Library::from)
}

/// The loader's own words, which `libloading` keeps in the source of its error.
fn loader_text(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

/// Look-up in one library, with what messages need to say.
struct Symbols<'a> {
    loaded: &'a Library,
    path: &'a Path,
    entry: &'a str,
}

impl Symbols<'_> {
    /// The function `name`.
    fn get<T: Copy>(&self, name: &str) -> Result<T, ImportError> {
        // SAFETY: `T` is the type that the standard gives to this name; `fmi2GetVersion` guards against other versions.
        unsafe { self.loaded.get::<T>(name) }
            .map(|symbol| *symbol)
            .map_err(|_| ImportError::MissingSymbol {
                path: self.path.to_owned(),
                library: self.entry.to_owned(),
                symbol: name.to_owned(),
            })
    }

    /// Calls one of the two inquiry functions, which share one shape.
    fn check_answer(&self, function: &'static str, expected: &'static str) -> Result<(), ImportError> {
        let inquiry: f::GetVersion = self.get(function)?;
        // SAFETY: the inquiries have no preconditions and answer with a static C string.
        let found = unsafe { text(inquiry()) };
        if found == expected {
            return Ok(());
        }
        Err(ImportError::Incompatible {
            path: self.path.to_owned(),
            library: self.entry.to_owned(),
            function,
            found,
            expected,
        })
    }

    fn functions(&self, attributes: &CoSimulation) -> Result<Functions, ImportError> {
        Ok(Functions {
            instantiate: self.get("fmi2Instantiate")?,
            free_instance: self.get("fmi2FreeInstance")?,
            set_debug_logging: self.get("fmi2SetDebugLogging")?,
            setup_experiment: self.get("fmi2SetupExperiment")?,
            enter_initialization_mode: self.get("fmi2EnterInitializationMode")?,
            exit_initialization_mode: self.get("fmi2ExitInitializationMode")?,
            terminate: self.get("fmi2Terminate")?,
            reset: self.get("fmi2Reset")?,
            get_real: self.get("fmi2GetReal")?,
            get_integer: self.get("fmi2GetInteger")?,
            get_boolean: self.get("fmi2GetBoolean")?,
            get_string: self.get("fmi2GetString")?,
            set_real: self.get("fmi2SetReal")?,
            set_integer: self.get("fmi2SetInteger")?,
            set_boolean: self.get("fmi2SetBoolean")?,
            set_string: self.get("fmi2SetString")?,
            do_step: self.get("fmi2DoStep")?,
            get_real_status: self.get("fmi2GetRealStatus").ok(),
            get_boolean_status: self.get("fmi2GetBooleanStatus").ok(),
            states: if attributes.can_get_and_set_fmu_state {
                Some(StateFunctions {
                    get: self.get("fmi2GetFMUstate")?,
                    set: self.get("fmi2SetFMUstate")?,
                    free: self.get("fmi2FreeFMUstate")?,
                })
            } else {
                None
            },
            serialization: if attributes.can_serialize_fmu_state {
                Some(SerializationFunctions {
                    size: self.get("fmi2SerializedFMUstateSize")?,
                    serialize: self.get("fmi2SerializeFMUstate")?,
                    deserialize: self.get("fmi2DeSerializeFMUstate")?,
                })
            } else {
                None
            },
        })
    }
}

/// `path`, which must be absolute, as a `file:` URI.
fn file_uri(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~:".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_escape_what_uris_cannot_hold() {
        assert_eq!(file_uri(Path::new("/tmp/a b/ü%")), "file:///tmp/a%20b/%C3%BC%25");
    }
}
