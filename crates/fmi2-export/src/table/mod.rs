//! The variable table: the one place that knows a variable's name, type, unit, causality, bounds, start value and access.

mod bounds;
mod builder;
mod definition;
mod kind;
mod variable;

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use uuid::Uuid;

pub use bounds::Bounds;
pub use builder::{Row, TableBuilder};
pub use definition::DefinitionError;
pub(crate) use definition::is_identifier;
pub use kind::{Boolean, Enumeration, Integer, Kind, Real, Text};
pub use variable::{Access, Causality, EnumerationItem, EnumerationType, Scalar, Typed, Variability, Variable};

/// The variables of a model, by value reference. Written by a [`TableBuilder`].
#[derive(Debug)]
pub struct Table<M> {
    variables: Vec<Variable<M>>,
    types: Vec<Arc<EnumerationType>>,
    defect: Option<DefinitionError>,
    by_name: HashMap<String, u32>,
    pub(crate) guid: OnceLock<Uuid>,
}

impl<M> Table<M> {
    fn new(variables: Vec<Variable<M>>, types: Vec<Arc<EnumerationType>>, defect: Option<DefinitionError>) -> Self {
        let mut defect = defect;
        let mut by_name = HashMap::with_capacity(variables.len());
        for (reference, variable) in (0..).zip(&variables) {
            if by_name.insert(variable.name.clone(), reference).is_some() {
                defect.get_or_insert_with(|| DefinitionError::DuplicateName {
                    name: variable.name.clone(),
                });
            }
        }
        let is_input = |name: &str| {
            let mut inputs = variables.iter().filter(|v| v.causality == Causality::Input);
            inputs.any(|v| v.base_name() == name)
        };
        for variable in &variables {
            if let Some(input) = variable.initial_inputs.iter().find(|input| !is_input(input)) {
                defect.get_or_insert_with(|| DefinitionError::UnknownInput {
                    name: variable.name.clone(),
                    input,
                });
            }
        }
        Self {
            variables,
            types,
            defect,
            by_name,
            guid: OnceLock::new(),
        }
    }

    /// Every variable, in order of value reference.
    pub fn variables(&self) -> &[Variable<M>] {
        &self.variables
    }

    /// Every declared enumeration, in order of declaration.
    pub fn enumeration_types(&self) -> impl Iterator<Item = &EnumerationType> {
        self.types.iter().map(AsRef::as_ref)
    }

    /// The variable with this value reference.
    pub fn variable(&self, reference: u32) -> Option<&Variable<M>> {
        self.variables.get(usize::try_from(reference).ok()?)
    }

    /// Value reference of the variable with this name.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    /// Sets every variable that has a start value to it.
    pub fn apply_start(&self, model: &mut M) {
        for variable in &self.variables {
            variable.typed.row().apply_start(model);
        }
    }

    /// The first mistake in the rows, if there is one.
    pub(crate) fn defect(&self) -> Option<&DefinitionError> {
        self.defect.as_ref()
    }

    /// Whether `model`, to which the start column has been applied, reads as it says.
    pub(crate) fn check_start(&self, model: &M) -> Result<(), DefinitionError> {
        for variable in &self.variables {
            if let Some((start, read)) = variable.typed.row().start_mismatch(model) {
                return Err(DefinitionError::StartNotKept {
                    name: variable.name.clone(),
                    start,
                    read,
                });
            }
        }
        Ok(())
    }
}
