//! The library of a packed FMU with all its functions.

use std::ffi::CString;

use fmi2_abi::{functions as f, symbols};
use fmi2_import::loader::{self, file_uri};
use fmi2_import::{BaseType, Fmu, LIBRARY_SUFFIX, PLATFORM};
use tempfile::TempDir;

macro_rules! functions {
    ($($field:ident: $type:ident = $symbol:ident;)*) => {
        /// Every function of the standard that takes an instance, but for those of model exchange.
        pub struct Functions {
            $(pub $field: f::$type,)*
        }

        impl Functions {
            fn of(library: &libloading::Library) -> Self {
                // SAFETY: the library is ours, and the types those of the standard for these names.
                unsafe { Self { $($field: loader::function(library, &symbols::$symbol).unwrap(),)* } }
            }
        }
    };
}

functions! {
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
    get_state: GetFmuState = GET_FMU_STATE;
    set_state: SetFmuState = SET_FMU_STATE;
    free_state: FreeFmuState = FREE_FMU_STATE;
    state_size: SerializedFmuStateSize = SERIALIZED_FMU_STATE_SIZE;
    serialize_state: SerializeFmuState = SERIALIZE_FMU_STATE;
    deserialize_state: DeSerializeFmuState = DE_SERIALIZE_FMU_STATE;
    directional_derivative: GetDirectionalDerivative = GET_DIRECTIONAL_DERIVATIVE;
    input_derivatives: SetRealInputDerivatives = SET_REAL_INPUT_DERIVATIVES;
    output_derivatives: GetRealOutputDerivatives = GET_REAL_OUTPUT_DERIVATIVES;
    do_step: DoStep = DO_STEP;
    cancel_step: CancelStep = CANCEL_STEP;
    get_status: GetStatus = GET_STATUS;
    get_real_status: GetRealStatus = GET_REAL_STATUS;
    get_integer_status: GetIntegerStatus = GET_INTEGER_STATUS;
    get_boolean_status: GetBooleanStatus = GET_BOOLEAN_STATUS;
    get_string_status: GetStringStatus = GET_STRING_STATUS;
    set_time: SetTime = SET_TIME;
    get_derivatives: GetDerivatives = GET_DERIVATIVES;
}

pub struct Library {
    pub name: &'static str,
    pub c: Functions,
    pub guid: CString,
    /// `file:` URI.
    pub resources: String,
    /// Value references by type.
    pub reals: Vec<u32>,
    pub integers: Vec<u32>,
    pub booleans: Vec<u32>,
    pub strings: Vec<u32>,
    _loaded: libloading::Library,
    _folder: TempDir,
}

impl Library {
    pub fn load(name: &'static str) -> Self {
        let path = crate::common::fmu(name);
        let folder = tempfile::tempdir().unwrap();
        zip::ZipArchive::new(std::fs::File::open(&path).unwrap())
            .unwrap()
            .extract(folder.path())
            .unwrap();
        let fmu = Fmu::open(&path).unwrap();
        let about = fmu.description();
        let file = format!(
            "binaries/{PLATFORM}/{}.{LIBRARY_SUFFIX}",
            about.co_simulation.model_identifier
        );
        // SAFETY: the library is ours.
        let loaded = unsafe { libloading::Library::new(folder.path().join(file)) }.unwrap();
        let of_type = |kinds: &[BaseType]| -> Vec<u32> {
            let fit = about.variables.iter().filter(|v| kinds.contains(&v.base_type()));
            fit.map(|v| v.value_reference).collect()
        };
        Self {
            name,
            c: Functions::of(&loaded),
            guid: CString::new(about.guid.as_str()).unwrap(),
            resources: file_uri(&folder.path().join("resources")),
            reals: of_type(&[BaseType::Real]),
            integers: of_type(&[BaseType::Integer, BaseType::Enumeration]),
            booleans: of_type(&[BaseType::Boolean]),
            strings: of_type(&[BaseType::String]),
            _loaded: loaded,
            _folder: folder,
        }
    }
}
