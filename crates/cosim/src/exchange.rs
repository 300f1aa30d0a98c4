//! Values between slaves: one get and one set per type and slave, through buffers made before the first step.

use fmi2_import::BaseType;

use crate::units::Conversion;
use crate::{Slave, SlaveError};

/// Variables of one type, and room for their values in the same order.
#[derive(Debug, Clone)]
pub(crate) struct Lane<T> {
    references: Vec<u32>,
    pub(crate) values: Vec<T>,
}

// Derived, it would ask for `T: Default` here already.
impl<T> Default for Lane<T> {
    fn default() -> Self {
        Self {
            references: Vec::new(),
            values: Vec::new(),
        }
    }
}

impl<T: Default> Lane<T> {
    fn push(&mut self, reference: u32) -> usize {
        self.references.push(reference);
        self.values.push(T::default());
        self.values.len() - 1
    }
}

/// Variables of one slave that are read, or set, together.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bundle {
    pub(crate) reals: Lane<f64>,
    /// Integers and Enumerations.
    pub(crate) integers: Lane<i32>,
    pub(crate) booleans: Lane<bool>,
    pub(crate) strings: Lane<String>,
}

impl Bundle {
    /// Adds a variable; answers its place among those of its type.
    pub(crate) fn push(&mut self, kind: BaseType, reference: u32) -> usize {
        match kind {
            BaseType::Real => self.reals.push(reference),
            BaseType::Integer | BaseType::Enumeration => self.integers.push(reference),
            BaseType::Boolean => self.booleans.push(reference),
            BaseType::String => self.strings.push(reference),
        }
    }

    /// Reads all variables from the slave.
    pub(crate) fn get(&mut self, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        if !self.reals.references.is_empty() {
            slave.get_real(&self.reals.references, &mut self.reals.values)?;
        }
        if !self.integers.references.is_empty() {
            slave.get_integer(&self.integers.references, &mut self.integers.values)?;
        }
        if !self.booleans.references.is_empty() {
            slave.get_boolean(&self.booleans.references, &mut self.booleans.values)?;
        }
        if !self.strings.references.is_empty() {
            slave.get_string(&self.strings.references, &mut self.strings.values)?;
        }
        Ok(())
    }

    /// Sets all variables of the slave.
    pub(crate) fn set(&self, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        if !self.reals.references.is_empty() {
            slave.set_real(&self.reals.references, &self.reals.values)?;
        }
        if !self.integers.references.is_empty() {
            slave.set_integer(&self.integers.references, &self.integers.values)?;
        }
        if !self.booleans.references.is_empty() {
            slave.set_boolean(&self.booleans.references, &self.booleans.values)?;
        }
        if !self.strings.references.is_empty() {
            slave.set_string(&self.strings.references, &self.strings.values)?;
        }
        Ok(())
    }
}

/// One value's way: from a place in the outputs of slave `source` to a place in the inputs of another.
#[derive(Debug, Clone, Copy)]
struct Route {
    source: usize,
    from: usize,
    to: usize,
}

/// All ways that lead to the inputs of one slave.
#[derive(Debug, Clone, Default)]
pub(crate) struct Routes {
    reals: Vec<Route>,
    integers: Vec<Route>,
    booleans: Vec<Route>,
    strings: Vec<Route>,
    /// Places among the Reals whose values come in another unit.
    conversions: Vec<(usize, Conversion)>,
}

impl Routes {
    /// Adds a way for values of type `kind`.
    pub(crate) fn push(&mut self, kind: BaseType, source: usize, from: usize, to: usize) {
        let route = Route { source, from, to };
        match kind {
            BaseType::Real => self.reals.push(route),
            BaseType::Integer | BaseType::Enumeration => self.integers.push(route),
            BaseType::Boolean => self.booleans.push(route),
            BaseType::String => self.strings.push(route),
        }
    }

    /// Converts the Reals that arrive at a place.
    pub(crate) fn convert(&mut self, to: usize, conversion: Conversion) {
        self.conversions.push((to, conversion));
    }

    /// Copies values from the outputs of all slaves, by their position, into `inputs`.
    pub(crate) fn gather(&self, outputs: &[Bundle], inputs: &mut Bundle) {
        for r in &self.reals {
            inputs.reals.values[r.to] = outputs[r.source].reals.values[r.from];
        }
        for (to, conversion) in &self.conversions {
            conversion.apply(&mut inputs.reals.values[*to]);
        }
        for r in &self.integers {
            inputs.integers.values[r.to] = outputs[r.source].integers.values[r.from];
        }
        for r in &self.booleans {
            inputs.booleans.values[r.to] = outputs[r.source].booleans.values[r.from];
        }
        for r in &self.strings {
            inputs.strings.values[r.to].clone_from(&outputs[r.source].strings.values[r.from]);
        }
    }
}
