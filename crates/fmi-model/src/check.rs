//! Whether a variable may be set, and to which value.

use crate::error::InstanceError;
use crate::phase::Phase;
use crate::variable::{Causality, Entry, Scalar, Typed};

/// Parameters are set before the first step, inputs also after it, nothing else ever.
pub(crate) fn check_settable<M>(entry: Entry<'_, M>, phase: Phase) -> Result<(), InstanceError> {
    let settable = match entry.row.causality {
        Causality::Parameter => matches!(phase, Phase::Instantiated | Phase::Initialization),
        Causality::Input => true,
        Causality::CalculatedParameter | Causality::Output | Causality::Local => false,
    };
    if settable {
        return Ok(());
    }
    Err(InstanceError::NotSettable {
        name: entry.name().into_owned(),
        causality: entry.row.causality,
        phase,
    })
}

/// A value that can be held against the bounds of its row.
pub trait Checked: Scalar {
    /// Whether an entry takes the value.
    ///
    /// # Errors
    /// [`InstanceError::NotFinite`], [`InstanceError::OutOfBounds`] or [`InstanceError::NoSuchItem`].
    fn check<M>(value: &Self, entry: Entry<'_, M>) -> Result<(), InstanceError>;
}

impl Checked for f64 {
    fn check<M>(value: &Self, entry: Entry<'_, M>) -> Result<(), InstanceError> {
        match &entry.row.typed {
            Typed::Real { bounds, .. } if !value.is_finite() && bounds.any_number => Ok(()),
            _ if !value.is_finite() => Err(InstanceError::NotFinite {
                what: format!("'{}'", entry.name()),
                value: *value,
            }),
            Typed::Real { bounds, .. } if !bounds.admit(*value) => {
                let unit = entry.unit().filter(|unit| *unit != "1").unwrap_or_default();
                Err(InstanceError::OutOfBounds {
                    name: entry.name().into_owned(),
                    value: format!("{value:?} {unit}").trim_end().to_owned(),
                    bounds: bounds.to_string(),
                })
            }
            _ => Ok(()),
        }
    }
}

impl Checked for i32 {
    fn check<M>(value: &Self, entry: Entry<'_, M>) -> Result<(), InstanceError> {
        let name = || entry.name().into_owned();
        match &entry.row.typed {
            Typed::Integer { bounds, .. } if !bounds.admit(*value) => Err(InstanceError::OutOfBounds {
                name: name(),
                value: value.to_string(),
                bounds: bounds.to_string(),
            }),
            Typed::Enumeration { declared, .. } if declared.item(*value).is_none() => {
                Err(InstanceError::no_such_item(entry, declared, i64::from(*value)))
            }
            _ => Ok(()),
        }
    }
}

impl Checked for bool {
    fn check<M>(_value: &Self, _entry: Entry<'_, M>) -> Result<(), InstanceError> {
        Ok(())
    }
}

impl Checked for String {
    fn check<M>(_value: &Self, _entry: Entry<'_, M>) -> Result<(), InstanceError> {
        Ok(())
    }
}

/// Refuses infinities and NaN.
pub(crate) fn finite(what: &str, value: f64) -> Result<(), InstanceError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(InstanceError::NotFinite {
        what: what.to_owned(),
        value,
    })
}
