//! Tunables of a law: what the FMU offers as parameters under the law's own prefix, and how the law reads them.

use crate::FilterError;
use crate::scenarios::{Defaults, default_of};
use serde::{Deserialize, Serialize};

pub use interface::Bound;

/// Type, start value and range of a tunable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A real number; `None` as start means "the scenario's own", shown as -1.
    Real {
        /// Start value.
        start: Option<f64>,
        /// Unit as FMI writes it; empty when it depends on the units the law adapts in.
        unit: &'static str,
        /// Permitted range.
        bound: Bound,
    },
    /// A whole number.
    Integer {
        /// Start value.
        start: i32,
        /// Smallest permitted value.
        min: i32,
        /// Largest permitted value.
        max: i32,
    },
    /// A switch.
    Boolean {
        /// Start value.
        start: bool,
    },
    /// One of a few named choices, the first being the start.
    Choice {
        /// FMI type name of the enumeration.
        type_name: &'static str,
        /// Names of the choices.
        items: &'static [&'static str],
    },
}

/// One tunable of a law.
#[derive(Clone, Copy, Debug)]
pub struct Tunable {
    /// Name without the law's prefix.
    pub name: &'static str,
    /// What it does.
    pub about: &'static str,
    /// Type, start and range.
    pub kind: Kind,
}

/// A named set of tunables of one law; what is not named keeps its start value.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Name after the `@`.
    pub name: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// Tunable (without prefix) and value as text.
    pub sets: &'static [(&'static str, &'static str)],
}

/// The value of a tunable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// Of a real tunable.
    Real(f64),
    /// Of a whole-number tunable.
    Integer(i32),
    /// Of a switch.
    Boolean(bool),
    /// Index of the choice, from 0.
    Choice(usize),
}

impl Kind {
    /// The start value; -1 for "the scenario's own".
    pub fn start(&self) -> Value {
        match *self {
            Self::Real { start, .. } => Value::Real(start.unwrap_or(crate::Beliefs::OWN)),
            Self::Integer { start, .. } => Value::Integer(start),
            Self::Boolean { start } => Value::Boolean(start),
            Self::Choice { .. } => Value::Choice(0),
        }
    }
}

/// The tunables of one law with their values, scenario defaults filled in on reading.
pub struct Tunables<'a> {
    /// The law's name, the prefix of its tunables.
    pub law: &'static str,
    /// Its declared tunables.
    pub declared: &'static [Tunable],
    /// One value for each, in the same order.
    pub values: &'a [Value],
    /// Name of the scenario, for messages.
    pub scenario: &'static str,
    /// The scenario's own values by full name.
    pub defaults: Defaults,
}

impl Tunables<'_> {
    fn value(&self, name: &str) -> Option<(&'static Tunable, Value)> {
        let at = self.declared.iter().position(|t| t.name == name)?;
        Some((&self.declared[at], *self.values.get(at)?))
    }

    /// A real tunable, with the scenario's own value where it is left at -1.
    ///
    /// # Errors
    /// When the scenario has no value of its own or the value is out of range.
    pub fn real(&self, name: &str) -> Result<f64, FilterError> {
        let full = format!("{}.{}", self.law, name);
        let Some((
            Tunable {
                kind: Kind::Real { start, unit, bound },
                ..
            },
            Value::Real(value),
        )) = self.value(name)
        else {
            return Err(self.mistyped(full));
        };
        let value = if start.is_none() && value == crate::Beliefs::OWN {
            default_of(self.defaults, &full).ok_or(FilterError::NoScenarioDefault {
                name: full.clone(),
                scenario: self.scenario,
            })?
        } else {
            value
        };
        Ok(bound.check(&full, value, unit)?)
    }

    /// A whole-number tunable.
    ///
    /// # Errors
    /// When it is out of range.
    pub fn integer(&self, name: &str) -> Result<i32, FilterError> {
        let full = format!("{}.{}", self.law, name);
        match self.value(name) {
            Some((
                Tunable {
                    kind: Kind::Integer { min, max, .. },
                    ..
                },
                Value::Integer(v),
            )) => {
                if (*min..=*max).contains(&v) {
                    Ok(v)
                } else {
                    Err(FilterError::OutOfRange {
                        name: full,
                        value: f64::from(v),
                        unit: "",
                        permitted: format!("{min} to {max}"),
                    })
                }
            }
            _ => Err(self.mistyped(full)),
        }
    }

    /// A switch.
    ///
    /// # Errors
    /// When no such switch is declared.
    pub fn boolean(&self, name: &str) -> Result<bool, FilterError> {
        match self.value(name) {
            Some((_, Value::Boolean(v))) => Ok(v),
            _ => Err(self.mistyped(format!("{}.{}", self.law, name))),
        }
    }

    /// Index of the choice taken, from 0.
    ///
    /// # Errors
    /// When no such choice is declared.
    pub fn choice(&self, name: &str) -> Result<usize, FilterError> {
        match self.value(name) {
            Some((
                Tunable {
                    kind: Kind::Choice { items, .. },
                    ..
                },
                Value::Choice(v),
            )) if v < items.len() => Ok(v),
            _ => Err(self.mistyped(format!("{}.{}", self.law, name))),
        }
    }

    fn mistyped(&self, name: String) -> FilterError {
        FilterError::Undeclared { name }
    }
}
