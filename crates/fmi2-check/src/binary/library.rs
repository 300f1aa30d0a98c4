//! The loaded library and its functions, each of which may be missing.

use std::ffi::CString;
use std::path::Path;

use fmi2_abi::functions as f;
use libloading::Library as Loaded;

use super::logger::text;

/// Functions by their name in the standard.
macro_rules! functions {
    ($($field:ident: $type:ident = $name:literal;)*) => {
        /// The functions that the trials call.
        #[derive(Debug)]
        pub(super) struct Functions {
            $(pub(super) $field: Option<f::$type>,)*
        }

        impl Functions {
            /// # Safety
            /// The library keeps to the C types of the standard.
            unsafe fn of(library: &Loaded) -> Self {
                Self {
                    // SAFETY: the type is the one that the standard gives to the name.
                    $($field: unsafe { library.get::<f::$type>($name) }.ok().map(|symbol| *symbol),)*
                }
            }
        }
    };
}

functions! {
    get_version: GetVersion = "fmi2GetVersion";
    get_types_platform: GetTypesPlatform = "fmi2GetTypesPlatform";
    set_debug_logging: SetDebugLogging = "fmi2SetDebugLogging";
    instantiate: Instantiate = "fmi2Instantiate";
    free_instance: FreeInstance = "fmi2FreeInstance";
    setup_experiment: SetupExperiment = "fmi2SetupExperiment";
    enter_initialization_mode: EnterInitializationMode = "fmi2EnterInitializationMode";
    exit_initialization_mode: ExitInitializationMode = "fmi2ExitInitializationMode";
    terminate: Terminate = "fmi2Terminate";
    reset: Reset = "fmi2Reset";
    get_real: GetReal = "fmi2GetReal";
    get_integer: GetInteger = "fmi2GetInteger";
    get_boolean: GetBoolean = "fmi2GetBoolean";
    get_string: GetString = "fmi2GetString";
    set_real: SetReal = "fmi2SetReal";
    set_integer: SetInteger = "fmi2SetInteger";
    set_boolean: SetBoolean = "fmi2SetBoolean";
    set_string: SetString = "fmi2SetString";
    do_step: DoStep = "fmi2DoStep";
    get_state: GetFmuState = "fmi2GetFMUstate";
    set_state: SetFmuState = "fmi2SetFMUstate";
    free_state: FreeFmuState = "fmi2FreeFMUstate";
    state_size: SerializedFmuStateSize = "fmi2SerializedFMUstateSize";
    serialize: SerializeFmuState = "fmi2SerializeFMUstate";
    deserialize: DeSerializeFmuState = "fmi2DeSerializeFMUstate";
}

/// The library in this process. It is never unloaded: some FMUs leave threads and exit handlers behind.
#[derive(Debug)]
pub(super) struct Library {
    pub(super) functions: Functions,
    /// URI of the resources.
    pub(super) resources: CString,
}

impl Library {
    /// * returns: the loader's own words where it cannot be loaded.
    pub(super) fn load(file: &Path, resources: &Path) -> Result<Self, String> {
        // SAFETY: loading runs initializers of a library that the user asked for, in a process that is made to die of it.
        let loaded = unsafe { open(file) }.map_err(|error| {
            std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string)
        })?;
        // SAFETY: the archive is said to be an FMU 2.0; what is not is found by dying.
        let functions = unsafe { Functions::of(&loaded) };
        std::mem::forget(loaded);
        let resources = CString::new(uri(resources)).map_err(|error| error.to_string())?;
        Ok(Self { functions, resources })
    }

    /// What one of the two inquiries answers; nothing where it is missing.
    pub(super) fn inquire(inquiry: Option<f::GetVersion>) -> Option<String> {
        // SAFETY: inquiries have no preconditions, and answer with a string that stays.
        inquiry.map(|inquiry| unsafe { text(inquiry()) })
    }
}

#[cfg(unix)]
unsafe fn open(file: &Path) -> Result<Loaded, libloading::Error> {
    use libloading::os::unix::{Library as Unix, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: passed on to the caller.
    unsafe { Unix::open(Some(file), RTLD_NOW | RTLD_LOCAL) }.map(Loaded::from)
}

#[cfg(windows)]
unsafe fn open(file: &Path) -> Result<Loaded, libloading::Error> {
    use libloading::os::windows::{LOAD_WITH_ALTERED_SEARCH_PATH, Library as Windows};
    // SAFETY: passed on to the caller.
    unsafe { Windows::load_with_flags(file, LOAD_WITH_ALTERED_SEARCH_PATH) }.map(Loaded::from)
}

/// An absolute path as a URI.
fn uri(path: &Path) -> String {
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
