//! Values as text, the way people write them on command lines and in files.

use std::fmt;

use crate::ImportError;
use crate::description::{Variable, VariableKind};
use crate::value::Value;

impl Variable {
    /// Reads `text` as a value of this variable.
    ///
    /// Reals are finite decimal numbers in the variable's unit; Booleans are `true`, `false`, `1` or `0`; an enumeration
    /// takes an item's name or its number. Surrounding blanks are ignored except in Strings.
    ///
    /// # Errors
    /// [`ImportError::BadValue`] if the text is no such value or lies outside the declared minimum and maximum.
    pub fn parse_value(&self, text: &str) -> Result<Value, ImportError> {
        let bare = text.trim();
        let refuse = |reason: String| ImportError::BadValue {
            variable: self.name.clone(),
            kind: self.base_type(),
            text: text.to_owned(),
            reason,
        };
        match &self.kind {
            VariableKind::Real { min, max, .. } => {
                let value: f64 = bare.parse().map_err(|_| refuse("expected a number".to_owned()))?;
                if !value.is_finite() {
                    return Err(refuse("expected a finite number".to_owned()));
                }
                within(value, *min, *max, self.unit()).map_err(refuse)?;
                Ok(Value::Real(value))
            }
            VariableKind::Integer { min, max, .. } => {
                let value: i32 = bare
                    .parse()
                    .map_err(|_| refuse("expected a whole number of at most 32 bits".to_owned()))?;
                within(value, *min, *max, None).map_err(refuse)?;
                Ok(Value::Integer(value))
            }
            VariableKind::Boolean { .. } => match bare {
                "true" | "1" => Ok(Value::Boolean(true)),
                "false" | "0" => Ok(Value::Boolean(false)),
                _ => Err(refuse("expected true, false, 1 or 0".to_owned())),
            },
            VariableKind::String { .. } => Ok(Value::String(text.to_owned())),
            VariableKind::Enumeration { items, .. } => items
                .iter()
                .find(|item| item.name == bare)
                .or_else(|| {
                    let number: i32 = bare.parse().ok()?;
                    items.iter().find(|item| item.value == number)
                })
                .map(|item| Value::Integer(item.value))
                .ok_or_else(|| {
                    let allowed: Vec<_> = items
                        .iter()
                        .map(|item| format!("{} ({})", item.name, item.value))
                        .collect();
                    refuse(format!("expected one of {}", allowed.join(", ")))
                }),
        }
    }

    /// The text that [`Variable::parse_value`] reads back as `value`; enumerations by item name.
    #[must_use]
    pub fn format_value(&self, value: &Value) -> String {
        if let (Some(items), Value::Integer(number)) = (self.enumeration_items(), value)
            && let Some(item) = items.iter().find(|item| item.value == *number)
        {
            return item.name.clone();
        }
        value.to_string()
    }
}

/// Checks declared bounds; the error says which one is broken.
fn within<T: PartialOrd + fmt::Display>(
    value: T,
    min: Option<T>,
    max: Option<T>,
    unit: Option<&str>,
) -> Result<(), String> {
    let unit = unit.map_or(String::new(), |u| format!(" {u}"));
    match (min, max) {
        (Some(min), _) if value < min => Err(format!("the minimum is {min}{unit}")),
        (_, Some(max)) if value > max => Err(format!("the maximum is {max}{unit}")),
        _ => Ok(()),
    }
}
