//! Values of variables, and their textual form on command lines and in presets.

use std::fmt;

use crate::ImportError;
use crate::description::{Variable, VariableKind};

/// Type of a variable, as modelDescription.xml declares it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BaseType {
    /// `fmi2Real`, a double.
    Real,
    /// `fmi2Integer`, 32 bits.
    Integer,
    /// `fmi2Boolean`.
    Boolean,
    /// `fmi2String`, UTF-8.
    String,
    /// An Integer restricted to named items; read and set through the Integer functions.
    Enumeration,
}

impl fmt::Display for BaseType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::String => "String",
            Self::Enumeration => "Enumeration",
        })
    }
}

/// One value. Enumerations are carried as [`Value::Integer`].
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A Real, in the unit of its variable.
    Real(f64),
    /// An Integer, or the number of an enumeration item.
    Integer(i32),
    /// A Boolean.
    Boolean(bool),
    /// A String.
    String(String),
}

impl Value {
    /// Whether a variable of type `kind` can hold this value.
    #[must_use]
    pub fn fits(&self, kind: BaseType) -> bool {
        matches!(
            (self, kind),
            (Self::Real(_), BaseType::Real)
                | (Self::Integer(_), BaseType::Integer | BaseType::Enumeration)
                | (Self::Boolean(_), BaseType::Boolean)
                | (Self::String(_), BaseType::String)
        )
    }

    /// The type of the value itself; an enumeration item answers Integer.
    #[must_use]
    pub fn base_type(&self) -> BaseType {
        match self {
            Self::Real(_) => BaseType::Real,
            Self::Integer(_) => BaseType::Integer,
            Self::Boolean(_) => BaseType::Boolean,
            Self::String(_) => BaseType::String,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // The shortest text that reads back as the same double.
            Self::Real(v) => write!(f, "{v:?}"),
            Self::Integer(v) => write!(f, "{v}"),
            Self::Boolean(v) => write!(f, "{v}"),
            Self::String(v) => f.write_str(v),
        }
    }
}

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
