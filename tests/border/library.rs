//! The library of a packed FMU with all its functions.

use std::ffi::CString;

use fmi2_abi::functions as f;
use fmi2_import::loader::file_uri;
use fmi2_import::{BaseType, Fmu, LIBRARY_SUFFIX, PLATFORM};
use tempfile::TempDir;

macro_rules! functions {
    ($($field:ident: $type:ident = $name:literal;)*) => {
        /// Every function of the standard that takes an instance, but for those of model exchange.
        pub struct Functions {
            $(pub $field: f::$type,)*
        }

        impl Functions {
            fn of(library: &libloading::Library) -> Self {
                // SAFETY: the types are those of the standard for these names.
                unsafe { Self { $($field: *library.get::<f::$type>($name).unwrap(),)* } }
            }
        }
    };
}

functions! {
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
    get_state: GetFmuState = "fmi2GetFMUstate";
    set_state: SetFmuState = "fmi2SetFMUstate";
    free_state: FreeFmuState = "fmi2FreeFMUstate";
    state_size: SerializedFmuStateSize = "fmi2SerializedFMUstateSize";
    serialize_state: SerializeFmuState = "fmi2SerializeFMUstate";
    deserialize_state: DeSerializeFmuState = "fmi2DeSerializeFMUstate";
    directional_derivative: GetDirectionalDerivative = "fmi2GetDirectionalDerivative";
    input_derivatives: SetRealInputDerivatives = "fmi2SetRealInputDerivatives";
    output_derivatives: GetRealOutputDerivatives = "fmi2GetRealOutputDerivatives";
    do_step: DoStep = "fmi2DoStep";
    cancel_step: CancelStep = "fmi2CancelStep";
    get_status: GetStatus = "fmi2GetStatus";
    get_real_status: GetRealStatus = "fmi2GetRealStatus";
    get_integer_status: GetIntegerStatus = "fmi2GetIntegerStatus";
    get_boolean_status: GetBooleanStatus = "fmi2GetBooleanStatus";
    get_string_status: GetStringStatus = "fmi2GetStringStatus";
    set_time: SetTime = "fmi2SetTime";
    get_derivatives: GetDerivatives = "fmi2GetDerivatives";
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
