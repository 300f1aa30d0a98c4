//! Elements and attributes of the schema, one to one. Only what a co-simulation master uses is read.

use serde::Deserialize;

#[derive(Deserialize)]
pub(super) struct RawRoot {
    #[serde(rename = "@fmiVersion")]
    pub(super) fmi_version: String,
}

#[derive(Deserialize)]
pub(super) struct RawDescription {
    #[serde(rename = "@modelName")]
    pub(super) model_name: String,
    #[serde(rename = "@guid")]
    pub(super) guid: String,
    #[serde(rename = "@description")]
    pub(super) description: Option<String>,
    #[serde(rename = "@author")]
    pub(super) author: Option<String>,
    #[serde(rename = "@version")]
    pub(super) version: Option<String>,
    #[serde(rename = "@copyright")]
    pub(super) copyright: Option<String>,
    #[serde(rename = "@license")]
    pub(super) license: Option<String>,
    #[serde(rename = "@generationTool")]
    pub(super) generation_tool: Option<String>,
    #[serde(rename = "@generationDateAndTime")]
    pub(super) generation_date_and_time: Option<String>,
    #[serde(rename = "@variableNamingConvention")]
    pub(super) variable_naming_convention: Option<String>,
    #[serde(rename = "CoSimulation")]
    pub(super) co_simulation: Option<RawCoSimulation>,
    #[serde(rename = "UnitDefinitions", default)]
    pub(super) unit_definitions: RawUnits,
    #[serde(rename = "TypeDefinitions", default)]
    pub(super) type_definitions: RawTypes,
    #[serde(rename = "LogCategories", default)]
    pub(super) log_categories: RawLogCategories,
    #[serde(rename = "DefaultExperiment", default)]
    pub(super) default_experiment: RawExperiment,
    #[serde(rename = "ModelVariables")]
    pub(super) model_variables: RawVariables,
}

#[derive(Deserialize)]
pub(super) struct RawCoSimulation {
    #[serde(rename = "@modelIdentifier")]
    pub(super) model_identifier: String,
    #[serde(rename = "@needsExecutionTool", default)]
    pub(super) needs_execution_tool: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize", default)]
    pub(super) can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@canInterpolateInputs", default)]
    pub(super) can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder", default)]
    pub(super) max_output_derivative_order: u32,
    #[serde(rename = "@canRunAsynchronuously", default)]
    pub(super) can_run_asynchronuously: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess", default)]
    pub(super) can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions", default)]
    pub(super) can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate", default)]
    pub(super) can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate", default)]
    pub(super) can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative", default)]
    pub(super) provides_directional_derivative: bool,
}

#[derive(Deserialize, Default)]
pub(super) struct RawExperiment {
    #[serde(rename = "@startTime")]
    pub(super) start_time: Option<f64>,
    #[serde(rename = "@stopTime")]
    pub(super) stop_time: Option<f64>,
    #[serde(rename = "@tolerance")]
    pub(super) tolerance: Option<f64>,
    #[serde(rename = "@stepSize")]
    pub(super) step_size: Option<f64>,
}

#[derive(Deserialize, Default)]
pub(super) struct RawUnits {
    #[serde(rename = "Unit", default)]
    pub(super) units: Vec<RawUnit>,
}

#[derive(Deserialize)]
pub(super) struct RawUnit {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "BaseUnit")]
    pub(super) base: Option<RawBaseUnit>,
    #[serde(rename = "DisplayUnit", default)]
    pub(super) display: Vec<RawDisplayUnit>,
}

#[derive(Deserialize)]
pub(super) struct RawBaseUnit {
    #[serde(rename = "@kg", default)]
    pub(super) kg: i32,
    #[serde(rename = "@m", default)]
    pub(super) m: i32,
    #[serde(rename = "@s", default)]
    pub(super) s: i32,
    #[serde(rename = "@A", default)]
    pub(super) a: i32,
    #[serde(rename = "@K", default)]
    pub(super) k: i32,
    #[serde(rename = "@mol", default)]
    pub(super) mol: i32,
    #[serde(rename = "@cd", default)]
    pub(super) cd: i32,
    #[serde(rename = "@rad", default)]
    pub(super) rad: i32,
    #[serde(rename = "@factor", default = "one")]
    pub(super) factor: f64,
    #[serde(rename = "@offset", default)]
    pub(super) offset: f64,
}

#[derive(Deserialize)]
pub(super) struct RawDisplayUnit {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "@factor", default = "one")]
    pub(super) factor: f64,
    #[serde(rename = "@offset", default)]
    pub(super) offset: f64,
}

fn one() -> f64 {
    1.0
}

#[derive(Deserialize, Default)]
pub(super) struct RawTypes {
    #[serde(rename = "SimpleType", default)]
    pub(super) types: Vec<RawSimpleType>,
}

#[derive(Deserialize)]
pub(super) struct RawSimpleType {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "Real")]
    pub(super) real: Option<RawReal>,
    #[serde(rename = "Integer")]
    pub(super) integer: Option<RawInteger>,
    #[serde(rename = "Enumeration")]
    pub(super) enumeration: Option<RawEnumerationType>,
}

#[derive(Deserialize)]
pub(super) struct RawEnumerationType {
    #[serde(rename = "Item", default)]
    pub(super) items: Vec<RawItem>,
}

#[derive(Deserialize)]
pub(super) struct RawItem {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "@value")]
    pub(super) value: i32,
    #[serde(rename = "@description")]
    pub(super) description: Option<String>,
}

#[derive(Deserialize, Default)]
pub(super) struct RawLogCategories {
    #[serde(rename = "Category", default)]
    pub(super) categories: Vec<RawCategory>,
}

#[derive(Deserialize)]
pub(super) struct RawCategory {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "@description")]
    pub(super) description: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct RawVariables {
    #[serde(rename = "ScalarVariable", default)]
    pub(super) variables: Vec<RawVariable>,
}

#[derive(Deserialize)]
pub(super) struct RawVariable {
    #[serde(rename = "@name")]
    pub(super) name: String,
    #[serde(rename = "@valueReference")]
    pub(super) value_reference: u32,
    #[serde(rename = "@description")]
    pub(super) description: Option<String>,
    #[serde(rename = "@causality")]
    pub(super) causality: Option<String>,
    #[serde(rename = "@variability")]
    pub(super) variability: Option<String>,
    #[serde(rename = "@initial")]
    pub(super) initial: Option<String>,
    #[serde(rename = "Real")]
    pub(super) real: Option<RawReal>,
    #[serde(rename = "Integer")]
    pub(super) integer: Option<RawInteger>,
    #[serde(rename = "Boolean")]
    pub(super) boolean: Option<RawBoolean>,
    #[serde(rename = "String")]
    pub(super) string: Option<RawString>,
    #[serde(rename = "Enumeration")]
    pub(super) enumeration: Option<RawEnumeration>,
}

#[derive(Deserialize)]
pub(super) struct RawReal {
    #[serde(rename = "@declaredType")]
    pub(super) declared_type: Option<String>,
    #[serde(rename = "@start")]
    pub(super) start: Option<f64>,
    #[serde(rename = "@unit")]
    pub(super) unit: Option<String>,
    #[serde(rename = "@displayUnit")]
    pub(super) display_unit: Option<String>,
    #[serde(rename = "@min")]
    pub(super) min: Option<f64>,
    #[serde(rename = "@max")]
    pub(super) max: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct RawInteger {
    #[serde(rename = "@declaredType")]
    pub(super) declared_type: Option<String>,
    #[serde(rename = "@start")]
    pub(super) start: Option<i32>,
    #[serde(rename = "@min")]
    pub(super) min: Option<i32>,
    #[serde(rename = "@max")]
    pub(super) max: Option<i32>,
}

#[derive(Deserialize)]
pub(super) struct RawBoolean {
    #[serde(rename = "@start")]
    pub(super) start: Option<bool>,
}

#[derive(Deserialize)]
pub(super) struct RawString {
    #[serde(rename = "@start")]
    pub(super) start: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct RawEnumeration {
    #[serde(rename = "@declaredType")]
    pub(super) declared_type: String,
    #[serde(rename = "@start")]
    pub(super) start: Option<i32>,
}
