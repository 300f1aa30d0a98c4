//! What the master needs a slave to do.

use std::sync::Arc;

use fmi2_import::{BaseType, Causality, Experiment, Unit};

use crate::SlaveError;

/// Names a slave of one [`System`](crate::System).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SlaveId(pub(crate) usize);

impl SlaveId {
    /// Position in the order of adding, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.0
    }
}

/// A variable that can be wired, set or read.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// Name, unique within the slave.
    pub name: String,
    /// Handle for the get and set methods of its type.
    pub reference: u32,
    /// Type; Enumerations travel through the Integer methods.
    pub kind: BaseType,
    /// Role.
    pub causality: Causality,
    /// Unit of a Real's values, if it is known.
    pub unit: Option<Arc<Unit>>,
}

impl Port {
    /// A port without a unit, from its parts.
    #[must_use]
    pub fn new(name: impl Into<String>, reference: u32, kind: BaseType, causality: Causality) -> Self {
        Self {
            name: name.into(),
            reference,
            kind,
            causality,
            unit: None,
        }
    }

    /// The same with a unit.
    #[must_use]
    pub fn with_unit(mut self, unit: Option<Arc<Unit>>) -> Self {
        self.unit = unit;
        self
    }
}

/// A model that is stepped from outside: an FMU, or plain Rust in its place.
///
/// Calls come in the order of FMI 2.0: `setup`, start values, `enter_initialization`, inputs and outputs,
/// `exit_initialization`, then inputs, `do_step`, outputs for each step, and `terminate`. The get and set methods are
/// called with at least one reference, slices of equal length, and only for types that the slave has ports of.
///
/// # Errors
/// Each method may answer with a [`SlaveError`]; the master adds the slave's name and the time. What a method does by
/// default is nothing, or for get and set to refuse.
pub trait Slave: Send {
    /// Name in messages; unique within a system.
    fn name(&self) -> &str;

    /// Every variable that may be wired, set or read. Asked for once.
    fn ports(&self) -> Vec<Port>;

    /// Times and tolerance of the run to come.
    fn setup(&mut self, _experiment: &Experiment) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Start values are set; initial outputs are to be computed.
    fn enter_initialization(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Initial inputs are set; stepping begins.
    fn exit_initialization(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Steps from time `t` to `t + h`, both s.
    fn do_step(&mut self, t: f64, h: f64) -> Result<(), SlaveError>;

    /// The run is over; outputs stay readable.
    fn terminate(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Back to where the slave was when it was made.
    fn reset(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    /// What the slave has logged since the last time, warnings among it, oldest first.
    fn messages(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Reads Reals.
    fn get_real(&mut self, _references: &[u32], _values: &mut [f64]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("get_real"))
    }

    /// Sets Reals.
    fn set_real(&mut self, _references: &[u32], _values: &[f64]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("set_real"))
    }

    /// Reads Integers and Enumerations.
    fn get_integer(&mut self, _references: &[u32], _values: &mut [i32]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("get_integer"))
    }

    /// Sets Integers and Enumerations.
    fn set_integer(&mut self, _references: &[u32], _values: &[i32]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("set_integer"))
    }

    /// Reads Booleans.
    fn get_boolean(&mut self, _references: &[u32], _values: &mut [bool]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("get_boolean"))
    }

    /// Sets Booleans.
    fn set_boolean(&mut self, _references: &[u32], _values: &[bool]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("set_boolean"))
    }

    /// Reads Strings.
    fn get_string(&mut self, _references: &[u32], _values: &mut [String]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("get_string"))
    }

    /// Sets Strings.
    fn set_string(&mut self, _references: &[u32], _values: &[String]) -> Result<(), SlaveError> {
        Err(SlaveError::unsupported("set_string"))
    }
}
