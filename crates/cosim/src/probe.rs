//! Variables to be read together while a system runs.

use crate::SlaveId;
use crate::exchange::Bundle;

/// Variables of one slave with room for their values; made by [`crate::System::probe`] and filled by
/// [`crate::StepContext::read`], with one call per type.
///
/// Within each type the values stand in the order in which the names were given. Before the first reading they are
/// 0, false or empty.
#[derive(Debug, Clone)]
pub struct Probe {
    pub(crate) slave: SlaveId,
    pub(crate) bundle: Bundle,
}

impl Probe {
    /// The slave it reads.
    #[must_use]
    pub fn slave(&self) -> SlaveId {
        self.slave
    }

    /// Values of the Reals, in the units of their variables.
    #[must_use]
    pub fn reals(&self) -> &[f64] {
        &self.bundle.reals.values
    }

    /// Values of the Integers and Enumerations.
    #[must_use]
    pub fn integers(&self) -> &[i32] {
        &self.bundle.integers.values
    }

    /// Values of the Booleans.
    #[must_use]
    pub fn booleans(&self) -> &[bool] {
        &self.bundle.booleans.values
    }

    /// Values of the Strings.
    #[must_use]
    pub fn strings(&self) -> &[String] {
        &self.bundle.strings.values
    }
}
