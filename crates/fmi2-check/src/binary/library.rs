//! The loaded library and its functions, each of which may be missing.

use std::ffi::CString;
use std::path::Path;

use fmi2_abi::functions as f;
use fmi2_abi::symbols;
use fmi2_import::loader;
use libloading::Library as Loaded;

use super::logger::text;

/// Functions by their name in the standard.
macro_rules! functions {
    ($($field:ident: $type:ident = $symbol:ident;)*) => {
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
                    // SAFETY: by the contract above, with the type that the standard gives to the name.
                    $($field: unsafe { loader::function(library, &symbols::$symbol) },)*
                }
            }
        }
    };
}

functions! {
    get_version: GetVersion = GET_VERSION;
    get_types_platform: GetTypesPlatform = GET_TYPES_PLATFORM;
    set_debug_logging: SetDebugLogging = SET_DEBUG_LOGGING;
    instantiate: Instantiate = INSTANTIATE;
    free_instance: FreeInstance = FREE_INSTANCE;
    setup_experiment: SetupExperiment = SETUP_EXPERIMENT;
    enter_initialization_mode: EnterInitializationMode = ENTER_INITIALIZATION_MODE;
    exit_initialization_mode: ExitInitializationMode = EXIT_INITIALIZATION_MODE;
    terminate: Terminate = TERMINATE;
    reset: Reset = RESET;
    get_real: GetReal = GET_REAL;
    get_integer: GetInteger = GET_INTEGER;
    get_boolean: GetBoolean = GET_BOOLEAN;
    get_string: GetString = GET_STRING;
    set_real: SetReal = SET_REAL;
    set_integer: SetInteger = SET_INTEGER;
    set_boolean: SetBoolean = SET_BOOLEAN;
    set_string: SetString = SET_STRING;
    do_step: DoStep = DO_STEP;
    get_state: GetFmuState = GET_FMU_STATE;
    set_state: SetFmuState = SET_FMU_STATE;
    free_state: FreeFmuState = FREE_FMU_STATE;
    state_size: SerializedFmuStateSize = SERIALIZED_FMU_STATE_SIZE;
    serialize: SerializeFmuState = SERIALIZE_FMU_STATE;
    deserialize: DeSerializeFmuState = DE_SERIALIZE_FMU_STATE;
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
