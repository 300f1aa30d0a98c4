//! The loaded library: its functions, and the folder it was unpacked to.
#![allow(unsafe_code, reason = "loads a C library and looks its functions up")]

use std::fs;
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use fmi2_abi::functions as f;
use fmi2_abi::symbols::{self, Symbol};
use libloading::Library;
use tempfile::TempDir;

use crate::ImportError;
use crate::archive::Archive;
use crate::description::CoSimulation;
use crate::guard::{self, BeforeLoading, Watch};
use crate::loader::{file_uri, function, loader_text, open};
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
    /// Whether it can change folder and signal handlers of the process.
    pub(crate) wide: bool,
    /// What was unusual about loading it.
    pub(crate) warnings: Vec<String>,
    /// Instances alive.
    pub(crate) alive: AtomicUsize,
    /// Set when an instance ended in a way that makes unloading unsafe.
    pub(crate) keep_loaded: AtomicBool,
    before_loading: BeforeLoading,
    loaded: ManuallyDrop<Library>,
    // Dropped after the library: an open library cannot be deleted everywhere.
    folder: TempDir,
}

impl Drop for Binary {
    fn drop(&mut self) {
        if !self.keep_loaded.load(Ordering::Relaxed) {
            // SAFETY: the field is not used again, and no instance is left that could call into the library.
            guard::around(Watch::Whole, || unsafe { ManuallyDrop::drop(&mut self.loaded) });
            self.before_loading.after_unloading();
        } else {
            // Code that may still run may still read its resources.
            self.folder.disable_cleanup(true);
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
        let wide = fs::read(&file).map_or(true, |bytes| guard::is_wide(&bytes));
        let before_loading = BeforeLoading::now();
        let mut warnings = Vec::new();
        let library = open_with_help(&file, &entry, &mut warnings).map_err(|e| ImportError::Load {
            path: path.to_owned(),
            library: entry.clone(),
            reason: loader_text(&e),
        })?;
        let offered = Symbols {
            loaded: &library,
            path,
            entry: &entry,
        };
        offered.check_answer(&symbols::GET_VERSION, "2.0")?;
        offered.check_answer(&symbols::GET_TYPES_PLATFORM, "default")?;
        let functions = offered.functions(attributes)?;
        Ok(Self {
            functions,
            resources: file_uri(&folder.path().join("resources")),
            wide,
            warnings,
            alive: AtomicUsize::new(0),
            keep_loaded: AtomicBool::new(false),
            before_loading,
            loaded: ManuallyDrop::new(library),
            folder,
        })
    }
}

/// Libraries of the system that an FMU may use without saying so: builders forget `-lm`, and older C libraries had parts that are
/// one with newer ones.
#[cfg(target_os = "linux")]
const FORGOTTEN: [&str; 7] = [
    "libm.so.6",
    "libpthread.so.0",
    "libdl.so.2",
    "librt.so.1",
    "libstdc++.so.6",
    "libgfortran.so.5",
    "libgomp.so.1",
];
#[cfg(not(target_os = "linux"))]
const FORGOTTEN: [&str; 0] = [];

/// Loads a library; if it uses a function that none of the libraries it names has, after those that are often forgotten.
///
/// * `entry`: what to call it in `warnings`.
fn open_with_help(file: &Path, entry: &str, warnings: &mut Vec<String>) -> Result<Library, libloading::Error> {
    // SAFETY: loading runs the initializers of a library that the user asked for by path.
    let attempt = || guard::around(Watch::Whole, || unsafe { open(file) });
    let mut result = attempt();
    // Each helper ends one complaint.
    for _ in FORGOTTEN {
        let Err(error) = &result else { break };
        let text = loader_text(error);
        let Some(symbol) = undefined_symbol(&text) else { break };
        let Some(helper) = FORGOTTEN.into_iter().find(|library| has(library, symbol)) else {
            break;
        };
        warnings.push(format!(
            "{entry} uses {symbol} without naming {helper}, which was loaded for it: link the FMU with that library"
        ));
        result = attempt();
    }
    result
}

/// The symbol that the loader has missed, if that is what it complains of.
fn undefined_symbol(complaint: &str) -> Option<&str> {
    let (_, symbol) = complaint.split_once("undefined symbol: ")?;
    let end = symbol.find([',', ' ', '(']).unwrap_or(symbol.len());
    Some(&symbol[..end])
}

/// Whether a library of the system has a symbol; from then on all libraries find it.
#[cfg(unix)]
fn has(library: &str, symbol: &str) -> bool {
    use libloading::os::unix::{Library as Unix, RTLD_GLOBAL, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: libraries of the system have no initializers that ask anything of their user.
    let open = |visible| unsafe { Unix::open(Some(library), RTLD_NOW | visible) };
    let Ok(loaded) = open(RTLD_LOCAL) else { return false };
    // SAFETY: the symbol is looked for, not used.
    if unsafe { loaded.get::<*const ()>(symbol) }.is_err() {
        return false;
    }
    // Kept for as long as the process lives: the FMU uses it without the loader knowing.
    open(RTLD_GLOBAL).map(std::mem::forget).is_ok()
}

#[cfg(not(unix))]
fn has(_library: &str, _symbol: &str) -> bool {
    false
}

/// Look-up in one library, with what messages need to say.
struct Symbols<'a> {
    loaded: &'a Library,
    path: &'a Path,
    entry: &'a str,
}

impl Symbols<'_> {
    fn get<F: Copy>(&self, symbol: &Symbol<F>) -> Result<F, ImportError> {
        // SAFETY: `F` is the type that the standard gives to this name; `fmi2GetVersion` guards against other versions.
        unsafe { function(self.loaded, symbol) }.ok_or_else(|| ImportError::MissingSymbol {
            path: self.path.to_owned(),
            library: self.entry.to_owned(),
            symbol: symbol.name.to_owned(),
        })
    }

    /// Calls one of the two inquiry functions, which share one shape.
    fn check_answer(&self, symbol: &Symbol<f::GetVersion>, expected: &'static str) -> Result<(), ImportError> {
        let (function, inquiry) = (symbol.name, self.get(symbol)?);
        // SAFETY: the inquiries have no preconditions and answer with a static C string.
        let found = guard::around(Watch::Whole, || unsafe { text(inquiry()) });
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
            instantiate: self.get(&symbols::INSTANTIATE)?,
            free_instance: self.get(&symbols::FREE_INSTANCE)?,
            set_debug_logging: self.get(&symbols::SET_DEBUG_LOGGING)?,
            setup_experiment: self.get(&symbols::SETUP_EXPERIMENT)?,
            enter_initialization_mode: self.get(&symbols::ENTER_INITIALIZATION_MODE)?,
            exit_initialization_mode: self.get(&symbols::EXIT_INITIALIZATION_MODE)?,
            terminate: self.get(&symbols::TERMINATE)?,
            reset: self.get(&symbols::RESET)?,
            get_real: self.get(&symbols::GET_REAL)?,
            get_integer: self.get(&symbols::GET_INTEGER)?,
            get_boolean: self.get(&symbols::GET_BOOLEAN)?,
            get_string: self.get(&symbols::GET_STRING)?,
            set_real: self.get(&symbols::SET_REAL)?,
            set_integer: self.get(&symbols::SET_INTEGER)?,
            set_boolean: self.get(&symbols::SET_BOOLEAN)?,
            set_string: self.get(&symbols::SET_STRING)?,
            do_step: self.get(&symbols::DO_STEP)?,
            get_real_status: self.get(&symbols::GET_REAL_STATUS).ok(),
            get_boolean_status: self.get(&symbols::GET_BOOLEAN_STATUS).ok(),
            states: if attributes.can_get_and_set_fmu_state {
                Some(StateFunctions {
                    get: self.get(&symbols::GET_FMU_STATE)?,
                    set: self.get(&symbols::SET_FMU_STATE)?,
                    free: self.get(&symbols::FREE_FMU_STATE)?,
                })
            } else {
                None
            },
            serialization: if attributes.can_serialize_fmu_state {
                Some(SerializationFunctions {
                    size: self.get(&symbols::SERIALIZED_FMU_STATE_SIZE)?,
                    serialize: self.get(&symbols::SERIALIZE_FMU_STATE)?,
                    deserialize: self.get(&symbols::DE_SERIALIZE_FMU_STATE)?,
                })
            } else {
                None
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_missing_symbol_is_read_from_the_loaders_words() {
        for (complaint, symbol) in [
            ("/tmp/a b/tank.so: undefined symbol: cos", Some("cos")),
            ("tank.so: undefined symbol: j0 (tank.so)", Some("j0")),
            ("tank.so: undefined symbol: cos, version GLIBC_2.2.5", Some("cos")),
            ("tank.so: file too short", None),
        ] {
            assert_eq!(undefined_symbol(complaint), symbol);
        }
    }
}
