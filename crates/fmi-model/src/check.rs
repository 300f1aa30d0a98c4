//! Whether a variable may be set, and to which value.

use crate::bounds::Bounds;
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
    Err(not_settable(entry, phase))
}

#[cold]
fn not_settable<M>(entry: Entry<'_, M>, phase: Phase) -> InstanceError {
    InstanceError::NotSettable {
        name: entry.name().into_owned(),
        causality: entry.row.causality,
        phase,
    }
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
        let fits = match &entry.row.typed {
            Typed::Real { bounds, .. } if value.is_finite() => bounds.admit(*value),
            Typed::Real { bounds, .. } => bounds.any_number,
            _ => value.is_finite(),
        };
        if fits { Ok(()) } else { Err(unfit_real(*value, entry)) }
    }
}

#[cold]
fn unfit_real<M>(value: f64, entry: Entry<'_, M>) -> InstanceError {
    match &entry.row.typed {
        Typed::Real { bounds, .. } if value.is_finite() => {
            let unit = entry.unit().filter(|unit| *unit != "1").unwrap_or_default();
            InstanceError::OutOfBounds {
                name: entry.name().into_owned(),
                value: format!("{value:?} {unit}").trim_end().to_owned(),
                bounds: bounds.to_string(),
            }
        }
        _ => InstanceError::NotFinite {
            what: format!("'{}'", entry.name()),
            value,
        },
    }
}

impl Checked for i32 {
    fn check<M>(value: &Self, entry: Entry<'_, M>) -> Result<(), InstanceError> {
        match &entry.row.typed {
            Typed::Integer { bounds, .. } if !bounds.admit(*value) => Err(out_of_bounds(*value, *bounds, entry)),
            Typed::Enumeration { declared, .. } if declared.item(*value).is_none() => {
                Err(InstanceError::no_such_item(entry, declared, i64::from(*value)))
            }
            _ => Ok(()),
        }
    }
}

#[cold]
fn out_of_bounds<M>(value: i32, bounds: Bounds<i32>, entry: Entry<'_, M>) -> InstanceError {
    InstanceError::OutOfBounds {
        name: entry.name().into_owned(),
        value: value.to_string(),
        bounds: bounds.to_string(),
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
