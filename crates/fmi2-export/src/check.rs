//! Whether a variable may be set, and to which value.

use crate::error::CallError;
use crate::order::Phase;
use crate::table::{Causality, Scalar, Typed, Variable};

/// Parameters are set before the first step, inputs also after it, nothing else ever.
pub(crate) fn check_settable<M>(variable: &Variable<M>, phase: Phase) -> Result<(), CallError> {
    let settable = match variable.causality {
        Causality::Parameter => matches!(phase, Phase::Instantiated | Phase::Initialization),
        Causality::Input => true,
        Causality::Output | Causality::Local => false,
    };
    if settable {
        return Ok(());
    }
    Err(CallError::NotSettable {
        name: variable.name.clone(),
        causality: variable.causality,
        phase,
    })
}

/// A value that can be held against the bounds of its row.
pub(crate) trait Checked: Scalar {
    fn check<M>(value: &Self, variable: &Variable<M>) -> Result<(), CallError>;
}

impl Checked for f64 {
    fn check<M>(value: &Self, variable: &Variable<M>) -> Result<(), CallError> {
        if !value.is_finite() {
            return Err(CallError::NotFinite {
                what: format!("'{}'", variable.name),
                value: *value,
            });
        }
        match &variable.typed {
            Typed::Real { bounds, unit, .. } if !bounds.admit(*value) => {
                let unit = unit.as_deref().filter(|unit| *unit != "1").unwrap_or_default();
                Err(CallError::OutOfBounds {
                    name: variable.name.clone(),
                    value: format!("{value:?} {unit}").trim_end().to_owned(),
                    bounds: bounds.to_string(),
                })
            }
            _ => Ok(()),
        }
    }
}

impl Checked for i32 {
    fn check<M>(value: &Self, variable: &Variable<M>) -> Result<(), CallError> {
        let name = || variable.name.clone();
        match &variable.typed {
            Typed::Integer { bounds, .. } if !bounds.admit(*value) => Err(CallError::OutOfBounds {
                name: name(),
                value: value.to_string(),
                bounds: bounds.to_string(),
            }),
            Typed::Enumeration { declared, .. } if declared.item(*value).is_none() => {
                let items = (1..).zip(&declared.items);
                let items = items.map(|(value, item): (usize, _)| format!("{value} {}", item.name));
                Err(CallError::NoSuchItem {
                    name: name(),
                    value: *value,
                    items: items.collect::<Vec<_>>().join(", "),
                })
            }
            _ => Ok(()),
        }
    }
}

impl Checked for bool {
    fn check<M>(_value: &Self, _variable: &Variable<M>) -> Result<(), CallError> {
        Ok(())
    }
}

impl Checked for String {
    fn check<M>(_value: &Self, _variable: &Variable<M>) -> Result<(), CallError> {
        Ok(())
    }
}

/// Refuses infinities and NaN.
pub(crate) fn finite(what: &str, value: f64) -> Result<(), CallError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(CallError::NotFinite {
        what: what.to_owned(),
        value,
    })
}
