//! What a rule is.

use serde::Serialize;

/// How bad it is to break a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The standard is broken.
    Error,
    /// The standard allows it, and masters in the field stumble over it.
    Warning,
    /// Advice.
    Note,
}

impl Severity {
    /// The word for it, in lower case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// One thing that is demanded of an FMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule {
    /// `group.name`; stays the same between versions.
    pub id: &'static str,
    /// How bad it is to break it.
    pub severity: Severity,
    /// Section of FMI 2.0.4 that it comes from.
    pub section: &'static str,
    /// What is demanded.
    pub demands: &'static str,
    /// What to do where it is not so.
    pub advice: &'static str,
}

/// Declares rules and the list of all of them: `NAME = "id", Severity, "section", "what is demanded", "what to do";`.
macro_rules! rules {
    ($($name:ident = $id:literal, $severity:ident, $section:literal, $demands:literal, $advice:literal;)*) => {
        $(
            #[doc = $demands]
            pub static $name: $crate::rule::Rule = $crate::rule::Rule {
                id: $id,
                severity: $crate::rule::Severity::$severity,
                section: $section,
                demands: $demands,
                advice: $advice,
            };
        )*
        /// Every rule of the group, in the order in which documents list them.
        pub static ALL: &[&$crate::rule::Rule] = &[$(&$name),*];
    };
}
pub(crate) use rules;
