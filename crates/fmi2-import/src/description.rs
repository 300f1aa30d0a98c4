//! What `modelDescription.xml` says, in the words of the standard, with look-ups by name.

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

use crate::value::{BaseType, Value};
use crate::{ImportError, suggest};

/// Contents of a `modelDescription.xml` that a co-simulation master needs.
#[derive(Debug, Clone)]
pub struct ModelDescription {
    /// Name of the model.
    pub model_name: String,
    /// Fingerprint that ties description and library together.
    pub guid: String,
    /// What the model is.
    pub description: Option<String>,
    /// Who made it.
    pub author: Option<String>,
    /// Version of the model.
    pub version: Option<String>,
    /// Copyright notice.
    pub copyright: Option<String>,
    /// Licence.
    pub license: Option<String>,
    /// Tool that wrote the FMU.
    pub generation_tool: Option<String>,
    /// When it was written.
    pub generation_date_and_time: Option<String>,
    /// `flat` or `structured`.
    pub variable_naming_convention: Option<String>,
    /// Capabilities of the slave.
    pub co_simulation: CoSimulation,
    /// Times the author suggests.
    pub default_experiment: DefaultExperiment,
    /// Units in use.
    pub units: Vec<Unit>,
    /// Enumeration types in use.
    pub enumerations: Vec<EnumerationType>,
    /// Categories the FMU logs under.
    pub log_categories: Vec<LogCategory>,
    /// Every variable, in the order of the file.
    pub variables: Vec<Variable>,
    /// What the FMU tells particular tools, in the order of the file.
    pub vendor_annotations: Vec<VendorAnnotation>,
    /// Position in `variables` by name.
    pub(crate) index: HashMap<String, usize>,
}

/// Attributes of the `CoSimulation` element.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CoSimulation {
    /// File name of the library, without suffix.
    pub model_identifier: String,
    /// The slave wraps a tool that must be installed.
    pub needs_execution_tool: bool,
    /// The communication step may change from step to step.
    pub can_handle_variable_communication_step_size: bool,
    /// `fmi2SetRealInputDerivatives` works.
    pub can_interpolate_inputs: bool,
    /// Highest order of `fmi2GetRealOutputDerivatives`.
    pub max_output_derivative_order: u32,
    /// `fmi2DoStep` may return Pending (spelled as in the standard).
    pub can_run_asynchronuously: bool,
    /// One instance per process at a time.
    pub can_be_instantiated_only_once_per_process: bool,
    /// The slave ignores the memory callbacks.
    pub can_not_use_memory_management_functions: bool,
    /// `fmi2GetFMUstate`, `fmi2SetFMUstate` and `fmi2FreeFMUstate` work.
    pub can_get_and_set_fmu_state: bool,
    /// The three functions that serialize a state work.
    pub can_serialize_fmu_state: bool,
    /// `fmi2GetDirectionalDerivative` works.
    pub provides_directional_derivative: bool,
}

/// Experiment suggested by the author; times in s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DefaultExperiment {
    /// Start time, s.
    pub start_time: Option<f64>,
    /// Stop time, s.
    pub stop_time: Option<f64>,
    /// Relative tolerance.
    pub tolerance: Option<f64>,
    /// Communication step, s.
    pub step_size: Option<f64>,
}

/// A unit: `base` is what `factor * x + offset` of a value in this unit is measured in.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Name that variables refer to.
    pub name: String,
    /// Exponents of the SI base units, if declared.
    pub base: Option<BaseUnit>,
    /// Units for display.
    pub display: Vec<DisplayUnit>,
}

/// Exponents of the SI base units, with factor and offset to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseUnit {
    /// Exponents in the order kg, m, s, A, K, mol, cd, rad.
    pub exponents: [i32; 8],
    /// Factor to the base unit.
    pub factor: f64,
    /// Offset to the base unit.
    pub offset: f64,
}

/// A unit for display: shown value = `factor * value + offset`.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnit {
    /// Name of the unit.
    pub name: String,
    /// Factor.
    pub factor: f64,
    /// Offset, in the display unit.
    pub offset: f64,
}

/// A named list of items.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EnumerationType {
    /// Name that variables refer to.
    pub name: String,
    /// The items, in the order of the file.
    pub items: Arc<[EnumerationItem]>,
}

/// One item of an enumeration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EnumerationItem {
    /// Name of the item.
    pub name: String,
    /// Its number, as it crosses the interface.
    pub value: i32,
    /// What it means.
    pub description: Option<String>,
}

/// A category of log messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogCategory {
    /// Name of the category.
    pub name: String,
    /// What is logged under it.
    pub description: Option<String>,
}

/// What an FMU tells one tool.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VendorAnnotation {
    /// Name of the tool; empty if the file gives none.
    pub tool: String,
    /// The XML inside, as it stands in the file but for the blanks around it. It is well-formed; what it means is between
    /// the FMU and the tool.
    pub xml: String,
}

/// Role of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Causality {
    /// Set before initialization ends, then constant (or tunable).
    Parameter,
    /// Computed from parameters.
    CalculatedParameter,
    /// Fed by another slave.
    Input,
    /// Offered to other slaves.
    Output,
    /// Internal, readable.
    Local,
    /// Time.
    Independent,
}

impl fmt::Display for Causality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Parameter => "parameter",
            Self::CalculatedParameter => "calculatedParameter",
            Self::Input => "input",
            Self::Output => "output",
            Self::Local => "local",
            Self::Independent => "independent",
        })
    }
}

/// When a variable may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variability {
    /// Never.
    Constant,
    /// Not after initialization.
    Fixed,
    /// When the environment sets it.
    Tunable,
    /// At communication points.
    Discrete,
    /// At any time.
    Continuous,
}

impl fmt::Display for Variability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Constant => "constant",
            Self::Fixed => "fixed",
            Self::Tunable => "tunable",
            Self::Discrete => "discrete",
            Self::Continuous => "continuous",
        })
    }
}

/// How a variable gets its initial value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Initial {
    /// The start value.
    Exact,
    /// The start value, as a first guess.
    Approx,
    /// Computed.
    Calculated,
}

/// One scalar variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Unique name.
    pub name: String,
    /// Handle for the get and set functions of its type.
    pub value_reference: u32,
    /// What it is.
    pub description: Option<String>,
    /// Role.
    pub causality: Causality,
    /// When it may change.
    pub variability: Variability,
    /// Origin of its initial value, if declared.
    pub initial: Option<Initial>,
    /// Type with its own attributes.
    pub kind: VariableKind,
}

/// Type of a variable with the attributes of that type; those of a declared type are filled in.
#[derive(Debug, Clone, PartialEq)]
pub enum VariableKind {
    /// A double.
    Real {
        /// Start value.
        start: Option<f64>,
        /// Unit of all values that cross the interface.
        unit: Option<String>,
        /// Unit to show to people.
        display_unit: Option<String>,
        /// Smallest value.
        min: Option<f64>,
        /// Largest value.
        max: Option<f64>,
    },
    /// A 32-bit integer.
    Integer {
        /// Start value.
        start: Option<i32>,
        /// Smallest value.
        min: Option<i32>,
        /// Largest value.
        max: Option<i32>,
    },
    /// A truth value.
    Boolean {
        /// Start value.
        start: Option<bool>,
    },
    /// A text.
    String {
        /// Start value.
        start: Option<String>,
    },
    /// One of several named items.
    Enumeration {
        /// Start value, the number of an item.
        start: Option<i32>,
        /// Name of the declared type.
        declared_type: String,
        /// Items of that type.
        items: Arc<[EnumerationItem]>,
    },
}

impl Variable {
    /// The type without its attributes.
    #[must_use]
    pub fn base_type(&self) -> BaseType {
        match self.kind {
            VariableKind::Real { .. } => BaseType::Real,
            VariableKind::Integer { .. } => BaseType::Integer,
            VariableKind::Boolean { .. } => BaseType::Boolean,
            VariableKind::String { .. } => BaseType::String,
            VariableKind::Enumeration { .. } => BaseType::Enumeration,
        }
    }

    /// Unit of a Real, if declared.
    #[must_use]
    pub fn unit(&self) -> Option<&str> {
        match &self.kind {
            VariableKind::Real { unit, .. } => unit.as_deref(),
            _ => None,
        }
    }

    /// Display unit of a Real, if declared.
    #[must_use]
    pub fn display_unit(&self) -> Option<&str> {
        match &self.kind {
            VariableKind::Real { display_unit, .. } => display_unit.as_deref(),
            _ => None,
        }
    }

    /// Start value, if declared.
    #[must_use]
    pub fn start(&self) -> Option<Value> {
        match &self.kind {
            VariableKind::Real { start, .. } => start.map(Value::Real),
            VariableKind::Integer { start, .. } | VariableKind::Enumeration { start, .. } => start.map(Value::Integer),
            VariableKind::Boolean { start } => start.map(Value::Boolean),
            VariableKind::String { start } => start.clone().map(Value::String),
        }
    }

    /// Items of an enumeration; `None` for the other types.
    #[must_use]
    pub fn enumeration_items(&self) -> Option<&[EnumerationItem]> {
        match &self.kind {
            VariableKind::Enumeration { items, .. } => Some(items),
            _ => None,
        }
    }
}

impl ModelDescription {
    /// The variable of this name, if there is one.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Variable> {
        self.index.get(name).map(|&i| &self.variables[i])
    }

    /// The variable of this name.
    ///
    /// # Errors
    /// [`ImportError::UnknownVariable`], with the nearest name that exists.
    pub fn variable(&self, name: &str) -> Result<&Variable, ImportError> {
        self.get(name).ok_or_else(|| ImportError::UnknownVariable {
            model: self.model_name.clone(),
            name: name.to_owned(),
            suggestion: suggest(name, self.variables.iter().map(|v| v.name.as_str())),
        })
    }

    /// Items of the enumeration variable `name`; none where there is no such variable.
    #[must_use]
    pub fn items(&self, name: &str) -> &[EnumerationItem] {
        self.get(name).and_then(Variable::enumeration_items).unwrap_or_default()
    }

    /// The XML inside each annotation for the tool of this name, in the order of the file.
    pub fn annotations<'a>(&'a self, tool: &'a str) -> impl Iterator<Item = &'a str> {
        let own = self.vendor_annotations.iter().filter(move |a| a.tool == tool);
        own.map(|annotation| annotation.xml.as_str())
    }

    /// Value references of the Reals `name[1]`..`name[n]`.
    ///
    /// # Errors
    /// [`ImportError::UnknownVariable`] if an element is missing, [`ImportError::WrongType`] if one is no Real.
    pub fn find_vector(&self, name: &str, n: usize) -> Result<Vec<u32>, ImportError> {
        (1..=n).map(|i| self.real_reference(&format!("{name}[{i}]"))).collect()
    }

    /// Value references of the Reals `name[1,1]`..`name[rows,columns]`, row by row.
    ///
    /// # Errors
    /// [`ImportError::UnknownVariable`] if an element is missing, [`ImportError::WrongType`] if one is no Real.
    pub fn find_matrix(&self, name: &str, rows: usize, columns: usize) -> Result<Vec<u32>, ImportError> {
        (0..rows * columns)
            .map(|k| self.real_reference(&format!("{name}[{},{}]", k / columns + 1, k % columns + 1)))
            .collect()
    }

    fn real_reference(&self, name: &str) -> Result<u32, ImportError> {
        let variable = self.variable(name)?;
        if variable.base_type() == BaseType::Real {
            Ok(variable.value_reference)
        } else {
            Err(ImportError::WrongType {
                model: self.model_name.clone(),
                variable: name.to_owned(),
                found: variable.base_type(),
                expected: BaseType::Real,
            })
        }
    }
}
