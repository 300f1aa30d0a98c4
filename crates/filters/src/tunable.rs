//! Tunables of a law: what the FMU offers as parameters under the law's own prefix, where their starts come from, and how the
//! law reads them.

use crate::beliefs::{Beliefs, is_own};
use crate::error::FilterError;
use crate::units::Units;
use interface::Navigation;
use interface::mission::Quantity;
use serde::{Deserialize, Serialize};

pub use interface::Bound;

/// What the start values of a law are derived from: sizes that a mission states, SI.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// A typical acceleration that is not modelled, m/s2.
    pub disturbance: f64,
    /// How long it typically lasts, s.
    pub time: f64,
    /// Shortest time between samples of the sensors that see the target, s.
    pub period: f64,
    /// Noise of the best measured length, m; 1 m where angles alone are measured.
    pub length: f64,
    /// Initial standard deviation of a position, m.
    pub position: f64,
    /// Units that the law adapts in.
    pub units: Units,
}

impl Scales {
    /// Those of a mission.
    pub fn of(told: &Navigation) -> Self {
        let lengths = told.sensors.iter().flat_map(|known| {
            let sigmas = known.sensor.sigmas().iter().zip(&known.sigmas);
            sigmas
                .filter(|(sigma, _)| sigma.quantity == Quantity::Length)
                .map(|(_, value)| *value)
        });
        let periods = told.sensors.iter().map(|known| known.period_s);
        Self {
            disturbance: told.scale.disturbance_m_s2,
            time: told.scale.disturbance_time_s,
            period: periods.reduce(f64::min).unwrap_or(1.0),
            length: lengths.reduce(f64::min).unwrap_or(1.0),
            position: told.p0.position,
            units: Units::of(&told.units),
        }
    }

    /// Square root of a white acceleration density with the effect of the disturbance, m/s^1.5: pushes of size a that last T and
    /// come one behind the other, in any direction, add velocity like white noise of density a^2 T.
    pub fn root_acceleration_density(&self) -> f64 {
        self.disturbance * self.time.sqrt()
    }

    /// Square root of a white jerk density under which the acceleration walks by its own size in the time that it lasts, m/s^2.5.
    pub fn root_jerk_density(&self) -> f64 {
        self.disturbance / self.time.sqrt()
    }
}

/// Where a real tunable starts.
#[derive(Clone, Copy, Debug)]
pub enum Start {
    /// The same in every mission.
    Fixed(f64),
    /// What the mission states for it in `[navigation.law]`, else this function of its scales; shown as -1.
    Derived(fn(&Scales) -> f64),
}

impl Start {
    /// The value where it is the same in every mission.
    pub fn fixed(self) -> Option<f64> {
        match self {
            Self::Fixed(value) => Some(value),
            Self::Derived(_) => None,
        }
    }
}

/// Type, start value and range of a tunable.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A real number.
    Real {
        /// Start value.
        start: Start,
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
        /// What the choice is of.
        about: &'static str,
        /// Names of the choices, and what each means.
        items: &'static [(&'static str, &'static str)],
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
    /// Whether it reads its source in another way, which is a filter of its own in a search.
    pub other_reading: bool,
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
    /// Whether the mission may state the value.
    pub fn derived(&self) -> bool {
        matches!(
            self,
            Self::Real {
                start: Start::Derived(_),
                ..
            }
        )
    }

    /// The start value; -1 for "the mission's own".
    pub fn start(&self) -> Value {
        match *self {
            Self::Real { start, .. } => Value::Real(start.fixed().unwrap_or(Beliefs::OWN)),
            Self::Integer { start, .. } => Value::Integer(start),
            Self::Boolean { start } => Value::Boolean(start),
            Self::Choice { .. } => Value::Choice(0),
        }
    }
}

/// The tunables of one law with their values, the mission's own filled in on reading.
pub struct Tunables<'a> {
    /// The law's name, the prefix of its tunables.
    pub law: &'static str,
    /// Its declared tunables.
    pub declared: &'static [Tunable],
    /// One value for each, in the same order.
    pub values: &'a [Value],
    /// The mission: its stated start values and its scales.
    pub told: &'a Navigation,
}

impl Tunables<'_> {
    fn value(&self, name: &str) -> Option<(&'static Tunable, Value)> {
        let at = self.declared.iter().position(|t| t.name == name)?;
        Some((&self.declared[at], *self.values.get(at)?))
    }

    /// A real tunable, with the mission's own value where it is left at -1.
    ///
    /// # Errors
    /// When the value is out of range.
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
        let value = match start {
            Start::Derived(rule) if is_own(value) => {
                self.told.law(&full).unwrap_or_else(|| rule(&Scales::of(self.told)))
            }
            _ => value,
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
                    Err(self.refused(name, f64::from(v), format!("{min} to {max}")))
                }
            }
            _ => Err(self.mistyped(full)),
        }
    }

    /// What is said of a value that a tunable must not have, for its own sake or beside that of another.
    ///
    /// * `permitted`: what it may be.
    pub(crate) fn refused(&self, name: &str, value: f64, permitted: String) -> FilterError {
        let declared = self.declared.iter().find(|tunable| tunable.name == name);
        let unit = match declared.map(|tunable| &tunable.kind) {
            Some(Kind::Real { unit, .. }) => unit,
            _ => "",
        };
        FilterError::OutOfRange {
            name: format!("{}.{name}", self.law),
            value,
            unit,
            permitted,
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
