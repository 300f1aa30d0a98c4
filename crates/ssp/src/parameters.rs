//! What a binding gives its element: values after prefix and mapping.

use crate::SspError;
use crate::model::{BaseUnit, Binding, Parameter, Unit, Value};
use crate::way::{Stop, Way};

/// A value on its way to an element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Given {
    pub(crate) name: String,
    pub(crate) value: Value,
    /// What its unit comes to, where that is said.
    pub(crate) base: Option<BaseUnit>,
    /// What becomes of it.
    pub(crate) way: Way,
    /// The binding, for messages.
    pub(crate) by: String,
}

impl Given {
    fn readable(&self) -> Result<(), SspError> {
        let Value::Other(other) = &self.value else {
            return Ok(());
        };
        let problem = format!(
            "'{}' is of type {}, which is not read; give Real, Integer, Boolean, String or Enumeration",
            self.name, other.name
        );
        Err(SspError::structure(&self.by, problem))
    }

    /// The same for another name, on another way.
    fn under(&self, name: &str, way: Way) -> Result<Self, SspError> {
        if way.transforms() && !matches!(self.value, Value::Real(..)) {
            let what = self.value.type_name();
            let problem = format!("'{}' is {what} and cannot be transformed; only Real can", self.name);
            return Err(SspError::structure(&self.by, problem));
        }
        Ok(Self {
            name: name.to_owned(),
            way,
            ..self.clone()
        })
    }

    /// The same for a connector inside.
    ///
    /// * `stop`: unit of the connector that has the value now.
    pub(crate) fn through(&self, stop: Stop, way: &Way, name: &str) -> Result<Self, SspError> {
        self.under(name, self.way.clone().then(stop, way.clone()))
    }
}

/// The values of a binding under the names that its element knows.
///
/// * `owner`: element of the binding, for messages.
/// * `units`: of the structure; those of the set go before.
pub(crate) fn given(owner: &str, binding: &Binding, units: &[Unit]) -> Result<Vec<Given>, SspError> {
    let set = binding.source.as_ref().unwrap_or(&binding.values.name);
    let by = format!("binding '{set}' of {owner}");
    let base = |value: &Value| {
        let Value::Real(_, Some(unit)) = value else { return None };
        let mut known = binding.values.units.iter().chain(units);
        known.find(|known| known.name == *unit).map(|unit| unit.base)
    };
    let plain: Vec<Given> = binding
        .values
        .parameters
        .iter()
        .map(|Parameter { name, value, .. }| Given {
            name: format!("{}{name}", binding.prefix),
            value: value.clone(),
            base: base(value),
            way: Way::default(),
            by: by.clone(),
        })
        .collect();
    let Some(entries) = &binding.mapping else {
        plain.iter().try_for_each(Given::readable)?;
        return Ok(plain);
    };
    let mapped = entries.iter().map(|entry| {
        let source = plain.iter().find(|given| given.name == entry.source).ok_or_else(|| {
            let known: Vec<&str> = plain.iter().map(|given| given.name.as_str()).collect();
            SspError::structure(
                &by,
                format!(
                    "its mapping names '{}', which is no value of it; there are {}",
                    entry.source,
                    known.join(", ")
                ),
            )
        })?;
        source.readable()?;
        let way = Way::hop(entry.transformation, entry.suppress_unit_conversion);
        source.under(&entry.target, way)
    });
    mapped.collect()
}
