//! Raw elements to the public types: declared types filled in, the standard's defaults applied, names checked.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use super::raw::{RawCoSimulation, RawDescription, RawInteger, RawReal, RawTypes, RawUnit, RawVariable};
use crate::ImportError;
use crate::description::{
    BaseUnit, Causality, CoSimulation, DefaultExperiment, DisplayUnit, EnumerationItem, EnumerationType, Initial,
    LogCategory, ModelDescription, Unit, Variability, Variable, VariableKind, VendorAnnotation,
};

/// Turns raw elements into the public types.
pub(super) struct Resolver<'a> {
    pub(super) path: &'a Path,
}

/// Declared types by name.
#[derive(Default)]
struct Types {
    reals: HashMap<String, RawReal>,
    integers: HashMap<String, RawInteger>,
    enumerations: HashMap<String, Arc<[EnumerationItem]>>,
}

impl Resolver<'_> {
    fn invalid(&self, reason: String) -> ImportError {
        ImportError::InvalidDescription {
            path: self.path.to_owned(),
            reason,
        }
    }

    pub(super) fn description(
        &self,
        raw: RawDescription,
        vendor_annotations: Vec<VendorAnnotation>,
    ) -> Result<ModelDescription, ImportError> {
        let co_simulation = raw.co_simulation.ok_or_else(|| ImportError::NotCoSimulation {
            path: self.path.to_owned(),
        })?;
        let identifier = &co_simulation.model_identifier;
        // It becomes part of a file name.
        if identifier.is_empty() || identifier.contains(['/', '\\', '\0']) {
            return Err(self.invalid(format!("modelIdentifier {identifier:?} is no C identifier")));
        }

        let (types, enumerations) = types(raw.type_definitions);
        let mut variables = Vec::with_capacity(raw.model_variables.variables.len());
        let mut index = HashMap::with_capacity(variables.capacity());
        for variable in raw.model_variables.variables {
            if index.insert(variable.name.clone(), variables.len()).is_some() {
                return Err(self.invalid(format!("two variables are named {:?}", variable.name)));
            }
            variables.push(self.variable(variable, &types)?);
        }

        Ok(ModelDescription {
            model_name: raw.model_name,
            guid: raw.guid,
            description: raw.description,
            author: raw.author,
            version: raw.version,
            copyright: raw.copyright,
            license: raw.license,
            generation_tool: raw.generation_tool,
            generation_date_and_time: raw.generation_date_and_time,
            variable_naming_convention: raw.variable_naming_convention,
            co_simulation: co_simulation.into(),
            default_experiment: DefaultExperiment {
                start_time: raw.default_experiment.start_time,
                stop_time: raw.default_experiment.stop_time,
                tolerance: raw.default_experiment.tolerance,
                step_size: raw.default_experiment.step_size,
            },
            units: raw.unit_definitions.units.into_iter().map(Unit::from).collect(),
            enumerations,
            log_categories: raw
                .log_categories
                .categories
                .into_iter()
                .map(|c| LogCategory {
                    name: c.name,
                    description: c.description,
                })
                .collect(),
            variables,
            vendor_annotations,
            index,
        })
    }

    fn variable(&self, raw: RawVariable, types: &Types) -> Result<Variable, ImportError> {
        let name = &raw.name;
        let unknown =
            |attribute: &str, text: &str| self.invalid(format!("variable {name:?}: {attribute} cannot be {text:?}"));
        let causality = match raw.causality.as_deref() {
            None | Some("local") => Causality::Local,
            Some("parameter") => Causality::Parameter,
            Some("calculatedParameter") => Causality::CalculatedParameter,
            Some("input") => Causality::Input,
            Some("output") => Causality::Output,
            Some("independent") => Causality::Independent,
            Some(other) => return Err(unknown("causality", other)),
        };
        let variability = match raw.variability.as_deref() {
            Some("constant") => Variability::Constant,
            Some("fixed") => Variability::Fixed,
            Some("tunable") => Variability::Tunable,
            Some("discrete") => Variability::Discrete,
            None | Some("continuous") => Variability::Continuous,
            Some(other) => return Err(unknown("variability", other)),
        };
        let initial = match raw.initial.as_deref() {
            None => None,
            Some("exact") => Some(Initial::Exact),
            Some("approx") => Some(Initial::Approx),
            Some("calculated") => Some(Initial::Calculated),
            Some(other) => return Err(unknown("initial", other)),
        };
        let kind = match (raw.real, raw.integer, raw.boolean, raw.string, raw.enumeration) {
            (Some(v), None, None, None, None) => {
                let declared = v.declared_type.as_ref().and_then(|t| types.reals.get(t));
                let inherit = |own: Option<String>, theirs: fn(&RawReal) -> &Option<String>| {
                    own.or_else(|| declared.and_then(|d| theirs(d).clone()))
                };
                VariableKind::Real {
                    start: v.start,
                    unit: inherit(v.unit, |d| &d.unit),
                    display_unit: inherit(v.display_unit, |d| &d.display_unit),
                    min: v.min.or_else(|| declared.and_then(|d| d.min)),
                    max: v.max.or_else(|| declared.and_then(|d| d.max)),
                }
            }
            (None, Some(v), None, None, None) => {
                let declared = v.declared_type.as_ref().and_then(|t| types.integers.get(t));
                VariableKind::Integer {
                    start: v.start,
                    min: v.min.or_else(|| declared.and_then(|d| d.min)),
                    max: v.max.or_else(|| declared.and_then(|d| d.max)),
                }
            }
            (None, None, Some(v), None, None) => VariableKind::Boolean { start: v.start },
            (None, None, None, Some(v), None) => VariableKind::String { start: v.start },
            (None, None, None, None, Some(v)) => {
                let items = types.enumerations.get(&v.declared_type).ok_or_else(|| {
                    self.invalid(format!(
                        "variable {name:?}: no enumeration type {:?} is defined",
                        v.declared_type
                    ))
                })?;
                VariableKind::Enumeration {
                    start: v.start,
                    declared_type: v.declared_type,
                    items: Arc::clone(items),
                }
            }
            _ => return Err(self.invalid(format!("variable {name:?} needs exactly one type element"))),
        };
        Ok(Variable {
            name: raw.name,
            value_reference: raw.value_reference,
            description: raw.description,
            causality,
            variability,
            initial,
            kind,
        })
    }
}

fn types(raw: RawTypes) -> (Types, Vec<EnumerationType>) {
    let mut types = Types::default();
    let mut enumerations = Vec::new();
    for simple in raw.types {
        if let Some(real) = simple.real {
            types.reals.insert(simple.name, real);
        } else if let Some(integer) = simple.integer {
            types.integers.insert(simple.name, integer);
        } else if let Some(enumeration) = simple.enumeration {
            let items: Arc<[EnumerationItem]> = enumeration
                .items
                .into_iter()
                .map(|i| EnumerationItem {
                    name: i.name,
                    value: i.value,
                    description: i.description,
                })
                .collect();
            types.enumerations.insert(simple.name.clone(), Arc::clone(&items));
            enumerations.push(EnumerationType {
                name: simple.name,
                items,
            });
        }
    }
    (types, enumerations)
}

impl From<RawCoSimulation> for CoSimulation {
    fn from(raw: RawCoSimulation) -> Self {
        Self {
            model_identifier: raw.model_identifier,
            needs_execution_tool: raw.needs_execution_tool,
            can_handle_variable_communication_step_size: raw.can_handle_variable_communication_step_size,
            can_interpolate_inputs: raw.can_interpolate_inputs,
            max_output_derivative_order: raw.max_output_derivative_order,
            can_run_asynchronuously: raw.can_run_asynchronuously,
            can_be_instantiated_only_once_per_process: raw.can_be_instantiated_only_once_per_process,
            can_not_use_memory_management_functions: raw.can_not_use_memory_management_functions,
            can_get_and_set_fmu_state: raw.can_get_and_set_fmu_state,
            can_serialize_fmu_state: raw.can_serialize_fmu_state,
            provides_directional_derivative: raw.provides_directional_derivative,
        }
    }
}

impl From<RawUnit> for Unit {
    fn from(raw: RawUnit) -> Self {
        Self {
            name: raw.name,
            base: raw.base.map(|b| BaseUnit {
                exponents: [b.kg, b.m, b.s, b.a, b.k, b.mol, b.cd, b.rad],
                factor: b.factor,
                offset: b.offset,
            }),
            display: raw
                .display
                .into_iter()
                .map(|d| DisplayUnit {
                    name: d.name,
                    factor: d.factor,
                    offset: d.offset,
                })
                .collect(),
        }
    }
}
