//! The loaded library and its functions, each of which may be missing.

use std::ffi::CString;
use std::path::Path;

use fmi2_abi::functions as f;
use fmi2_import::loader;
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
        let loaded = unsafe { loader::open(file) }.map_err(|error| loader::loader_text(&error))?;
        // SAFETY: the archive is said to be an FMU 2.0; what is not is found by dying.
        let functions = unsafe { Functions::of(&loaded) };
        std::mem::forget(loaded);
        let resources = CString::new(loader::file_uri(resources)).map_err(|error| error.to_string())?;
        Ok(Self { functions, resources })
    }

    /// What one of the two inquiries answers; nothing where it is missing.
    pub(super) fn inquire(inquiry: Option<f::GetVersion>) -> Option<String> {
        // SAFETY: inquiries have no preconditions, and answer with a string that stays.
        inquiry.map(|inquiry| unsafe { text(inquiry()) })
    }
}
