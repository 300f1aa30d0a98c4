//! Causality, variability and initial, and which of them go together.

use serde::{Deserialize, Serialize};

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Kind {
    Real,
    Integer,
    Boolean,
    String,
    Enumeration,
}

/// Role of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Causality {
    Parameter,
    CalculatedParameter,
    Input,
    Output,
    Local,
    Independent,
}

/// When a variable may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Variability {
    Constant,
    Fixed,
    Tunable,
    Discrete,
    Continuous,
}

/// Where the initial value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Initial {
    Exact,
    Approx,
    Calculated,
}

/// An enumeration whose values have words in the description.
pub(crate) trait Word: Copy + 'static {
    /// All values with their words.
    const WORDS: &'static [(&'static str, Self)];

    /// The value of this word.
    fn read(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(name, _)| *name == word).map(|(_, v)| *v)
    }
}

impl Word for Kind {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("Real", Self::Real),
        ("Integer", Self::Integer),
        ("Boolean", Self::Boolean),
        ("String", Self::String),
        ("Enumeration", Self::Enumeration),
    ];
}

impl Word for Causality {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("parameter", Self::Parameter),
        ("calculatedParameter", Self::CalculatedParameter),
        ("input", Self::Input),
        ("output", Self::Output),
        ("local", Self::Local),
        ("independent", Self::Independent),
    ];
}

impl Word for Variability {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("constant", Self::Constant),
        ("fixed", Self::Fixed),
        ("tunable", Self::Tunable),
        ("discrete", Self::Discrete),
        ("continuous", Self::Continuous),
    ];
}

impl Word for Initial {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("exact", Self::Exact),
        ("approx", Self::Approx),
        ("calculated", Self::Calculated),
    ];
}

/// What the standard says of `initial` for a causality and a variability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Beginning {
    /// Taken where nothing is said; nothing where `initial` has no meaning.
    pub(crate) default: Option<Initial>,
    /// What may be said.
    pub(crate) allowed: &'static [Initial],
}

/// The table of the standard; nothing for what does not go together.
pub(crate) fn beginning(causality: Causality, variability: Variability) -> Option<Beginning> {
    use {Causality as C, Initial as I, Variability as V};
    let (default, allowed): (Option<Initial>, &'static [Initial]) = match (causality, variability) {
        (C::Parameter, V::Fixed | V::Tunable) | (C::Output | C::Local, V::Constant) => (Some(I::Exact), &[I::Exact]),
        (C::CalculatedParameter | C::Local, V::Fixed | V::Tunable) => {
            (Some(I::Calculated), &[I::Approx, I::Calculated])
        }
        (C::Output | C::Local, V::Discrete | V::Continuous) => {
            (Some(I::Calculated), &[I::Exact, I::Approx, I::Calculated])
        }
        (C::Input, V::Discrete | V::Continuous) | (C::Independent, V::Continuous) => (None, &[]),
        _ => return None,
    };
    Some(Beginning { default, allowed })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fifteen pairs go together, as the table of the standard has them.
    #[test]
    fn val_pairs_of_causality_and_variability() {
        let count = |causality| {
            let all = Variability::WORDS.iter();
            all.filter(|(_, v)| beginning(causality, *v).is_some()).count()
        };
        let counts: Vec<usize> = Causality::WORDS.iter().map(|(_, c)| count(*c)).collect();
        assert_eq!(counts, [2, 2, 2, 3, 5, 1]);
        assert_eq!(
            Causality::read("calculatedParameter"),
            Some(Causality::CalculatedParameter)
        );
        assert_eq!(Kind::read("real"), None);
    }
}
