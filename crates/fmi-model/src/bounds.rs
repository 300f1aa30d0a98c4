//! The values that may be set.

use std::fmt;

/// The value -1 of a parameter that starts at "the mission's own".
pub(crate) const OWN_DEFAULT: i8 = -1;

/// Which values a variable takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds<T> {
    /// Least value.
    pub min: Option<T>,
    /// Greatest value.
    pub max: Option<T>,
    /// Only values above 0.
    pub positive: bool,
    /// Also -1, meaning the mission's own.
    pub own_default: bool,
    /// Also infinities and NaN, which no other variable takes.
    pub any_number: bool,
}

impl<T> Default for Bounds<T> {
    fn default() -> Self {
        Self {
            min: None,
            max: None,
            positive: false,
            own_default: false,
            any_number: false,
        }
    }
}

impl<T: Copy + PartialOrd + From<i8>> Bounds<T> {
    /// Whether `value` may be set. Never true of NaN if there is any bound.
    pub fn admit(&self, value: T) -> bool {
        (self.own_default && value == T::from(OWN_DEFAULT)) || self.within(value)
    }

    /// Whether `value` keeps to the bounds proper, leaving the mission's own aside.
    pub(crate) fn within(&self, value: T) -> bool {
        (!self.positive || value > T::from(0))
            && self.min.is_none_or(|min| value >= min)
            && self.max.is_none_or(|max| value <= max)
    }

    /// The inclusive `min` of the XML, which has no way to exclude 0.
    pub fn declared_min(&self) -> Option<T> {
        if self.own_default {
            return Some(T::from(OWN_DEFAULT));
        }
        match self.min {
            Some(min) if !(self.positive && min < T::from(0)) => Some(min),
            _ if self.positive => Some(T::from(0)),
            _ => None,
        }
    }
}

impl<T: fmt::Debug> fmt::Display for Bounds<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if self.positive {
            parts.push("greater than 0".to_owned());
        }
        if let Some(min) = &self.min {
            parts.push(format!("at least {min:?}"));
        }
        if let Some(max) = &self.max {
            parts.push(format!("at most {max:?}"));
        }
        f.write_str(&parts.join(" and "))?;
        if self.own_default {
            f.write_str(", or -1 for the mission's own")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_default_admits_minus_one_beside_the_stated_bound() {
        let bounds = Bounds {
            positive: true,
            max: Some(2.0),
            own_default: true,
            ..Bounds::default()
        };
        for (value, admitted) in [
            (-1.0, true),
            (-0.5, false),
            (0.0, false),
            (1e-300, true),
            (2.0, true),
            (2.5, false),
            (f64::NAN, false),
        ] {
            assert_eq!(bounds.admit(value), admitted, "{value}");
        }
        assert_eq!(bounds.declared_min(), Some(-1.0));
        assert_eq!(
            bounds.to_string(),
            "greater than 0 and at most 2.0, or -1 for the mission's own"
        );
    }

    #[test]
    fn the_declared_min_of_a_positive_value_is_zero_or_its_min() {
        let with = |min| Bounds {
            positive: true,
            min,
            ..Bounds::default()
        };
        assert_eq!(with(None).declared_min(), Some(0));
        assert_eq!(with(Some(-3)).declared_min(), Some(0));
        assert_eq!(with(Some(3)).declared_min(), Some(3));
        assert_eq!(Bounds::<i32>::default().declared_min(), None);
    }
}
