//! An FMU as a slave.

use std::collections::HashMap;
use std::sync::Arc;

use fmi2_import::{Experiment, Instance, Variable};

use crate::{Port, Slave, SlaveError};

/// An instance of an FMU, with every variable of its description as a port.
#[derive(Debug)]
pub struct FmuSlave {
    instance: Instance,
}

impl FmuSlave {
    /// Wraps a fresh instance; its name becomes the slave's.
    #[must_use]
    pub fn new(instance: Instance) -> Self {
        Self { instance }
    }
}

impl From<Instance> for FmuSlave {
    fn from(instance: Instance) -> Self {
        Self::new(instance)
    }
}

impl Slave for FmuSlave {
    fn name(&self) -> &str {
        self.instance.name()
    }

    fn ports(&self) -> Vec<Port> {
        let description = self.instance.description();
        let units: HashMap<_, _> = description
            .units
            .iter()
            .map(|unit| (unit.name.as_str(), Arc::new(unit.clone())))
            .collect();
        let port = |v: &Variable| {
            let unit = v.unit().and_then(|name| units.get(name).cloned());
            Port::new(&v.name, v.value_reference, v.base_type(), v.causality).with_unit(unit)
        };
        description.variables.iter().map(port).collect()
    }

    fn setup(&mut self, experiment: &Experiment) -> Result<(), SlaveError> {
        Ok(self.instance.setup_experiment(experiment)?)
    }

    fn enter_initialization(&mut self) -> Result<(), SlaveError> {
        Ok(self.instance.enter_initialization()?)
    }

    fn exit_initialization(&mut self) -> Result<(), SlaveError> {
        Ok(self.instance.exit_initialization()?)
    }

    fn do_step(&mut self, t: f64, h: f64) -> Result<(), SlaveError> {
        // A warning is counted by the instance and stops nothing.
        let _ = self.instance.do_step(t, h)?;
        Ok(())
    }

    fn terminate(&mut self) -> Result<(), SlaveError> {
        Ok(self.instance.terminate()?)
    }

    fn reset(&mut self) -> Result<(), SlaveError> {
        Ok(self.instance.reset()?)
    }

    fn messages(&mut self) -> Vec<String> {
        self.instance.messages().iter().map(ToString::to_string).collect()
    }

    fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), SlaveError> {
        Ok(self.instance.get_real(references, values)?)
    }

    fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), SlaveError> {
        Ok(self.instance.set_real(references, values)?)
    }

    fn get_integer(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), SlaveError> {
        Ok(self.instance.get_integer(references, values)?)
    }

    fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), SlaveError> {
        Ok(self.instance.set_integer(references, values)?)
    }

    fn get_boolean(&mut self, references: &[u32], values: &mut [bool]) -> Result<(), SlaveError> {
        Ok(self.instance.get_boolean(references, values)?)
    }

    fn set_boolean(&mut self, references: &[u32], values: &[bool]) -> Result<(), SlaveError> {
        Ok(self.instance.set_boolean(references, values)?)
    }

    fn get_string(&mut self, references: &[u32], values: &mut [String]) -> Result<(), SlaveError> {
        for (slot, value) in values.iter_mut().zip(self.instance.get_string(references)?) {
            *slot = value;
        }
        Ok(())
    }

    fn set_string(&mut self, references: &[u32], values: &[String]) -> Result<(), SlaveError> {
        Ok(self.instance.set_string(references, values)?)
    }
}
