//! Values of variables.

use std::fmt;

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
