//! Which function may be called when: the state machine of a standard as a table of these.

use fmi_model::Phase;

use crate::error::CallError;

/// A function of the standard and the phases in which it may be called.
#[derive(Debug)]
pub struct Function {
    /// Its name in C.
    pub name: &'static str,
    allowed: &'static [Phase],
}

/// Any phase but fatal, in which nothing is answered.
pub const ALIVE: &[Phase] = &[
    Phase::Instantiated,
    Phase::Initialization,
    Phase::StepComplete,
    Phase::Failed,
    Phase::Terminated,
];

impl Function {
    /// A function that these phases allow.
    pub const fn new(name: &'static str, allowed: &'static [Phase]) -> Self {
        Self { name, allowed }
    }

    /// Refuses a call in the wrong phase.
    pub(crate) fn check(&self, phase: Phase) -> Result<(), CallError> {
        if self.allowed.contains(&phase) {
            return Ok(());
        }
        let allowed: Vec<_> = self.allowed.iter().map(Phase::to_string).collect();
        Err(CallError::CallOrder {
            phase,
            allowed: allowed.join(", "),
        })
    }
}
