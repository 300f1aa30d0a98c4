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
    /// More than zero and less than this.
    PositiveBelow(f64),
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
                Self::PositiveBelow(limit) => value > 0.0 && value < limit,
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
            Self::PositiveBelow(limit) => format!("above 0 and below {limit} {unit}"),
            Self::Fraction => "between 0 and 1".into(),
        };
        words.trim_end().into()
    }

    /// `value` if it is accepted.
    ///
    /// * `name`: of the parameter, for the message; `unit`: its unit, empty for none.
    ///
    /// # Errors
    /// [`OutOfRange`], naming the parameter and what is accepted.
    pub fn check(self, name: &str, value: f64, unit: &'static str) -> Result<f64, OutOfRange> {
        if self.allows(value) {
            return Ok(value);
        }
        Err(OutOfRange {
            name: name.to_owned(),
            value,
            unit,
            bound: self,
        })
    }
}

/// A value that a [`Bound`] does not accept.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} = {value}{}{unit}: must be {}", if unit.is_empty() { "" } else { " " }, bound.words(unit))]
pub struct OutOfRange {
    /// Name of the parameter.
    pub name: String,
    /// As given.
    pub value: f64,
    /// Its unit; empty for none.
    pub unit: &'static str,
    /// What is accepted.
    pub bound: Bound,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_accepted_is_named_with_what_is() {
        for (bound, good, bad) in [
            (Bound::Any, -1e9, f64::INFINITY),
            (Bound::AtLeast(1.0), 1.0, 0.5),
            (Bound::NonNegative, 0.0, -1e-9),
            (Bound::Positive, 1e-9, 0.0),
            (Bound::Fraction, 1.0, 1.5),
        ] {
            assert_eq!(bound.check("lidar.sigma_range", good, "m"), Ok(good));
            for value in [bad, f64::NAN] {
                let error = bound.check("lidar.sigma_range", value, "m").unwrap_err().to_string();
                let begin = format!("lidar.sigma_range = {value} m: must be {}", bound.words("m"));
                assert_eq!(error, begin);
            }
        }
        let error = Bound::Fraction.check("relaxation", 2.0, "").unwrap_err().to_string();
        assert_eq!(error, "relaxation = 2: must be between 0 and 1");
    }
}
