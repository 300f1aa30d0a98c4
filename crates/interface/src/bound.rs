//! Values that a parameter accepts.

/// A range of real values; always finite ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Any.
    Any,
    /// This value or more.
    AtLeast(f64),
    /// Zero or more.
    NonNegative,
    /// More than zero.
    Positive,
    /// From 0 to 1.
    Fraction,
}

impl Bound {
    /// Whether `value` is accepted.
    pub fn allows(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::AtLeast(least) => value >= least,
                Self::NonNegative => value >= 0.0,
                Self::Positive => value > 0.0,
                Self::Fraction => (0.0..=1.0).contains(&value),
            }
    }

    /// What is accepted, in words.
    pub fn words(self, unit: &str) -> String {
        let words = match self {
            Self::Any => "a finite number".into(),
            Self::AtLeast(least) => format!("finite and at least {least} {unit}"),
            Self::NonNegative => format!("finite and at least 0 {unit}"),
            Self::Positive => format!("finite and above 0 {unit}"),
            Self::Fraction => "between 0 and 1".into(),
        };
        words.trim_end().into()
    }
}
