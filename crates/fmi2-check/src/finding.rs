//! What is found.

use std::collections::BTreeSet;

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use crate::rule::{Rule, Severity};

/// One breach of one rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// What breaks it: a variable by its name, an entry of the archive, a function of C, else an element of
    /// modelDescription.xml as a path.
    pub element: String,
    /// What is wrong with it.
    pub what: String,
    /// Line of modelDescription.xml, from 1.
    pub line: Option<usize>,
}

impl Serialize for Finding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Finding", 7)?;
        fields.serialize_field("rule", self.rule.id)?;
        fields.serialize_field("severity", &self.rule.severity)?;
        fields.serialize_field("section", self.rule.section)?;
        fields.serialize_field("element", &self.element)?;
        fields.serialize_field("what", &self.what)?;
        fields.serialize_field("line", &self.line)?;
        fields.serialize_field("advice", self.rule.advice)?;
        fields.end()
    }
}

/// Everything that is found in one FMU.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Findings(pub Vec<Finding>);

impl Findings {
    /// Adds one that has no place in modelDescription.xml.
    pub fn add(&mut self, rule: &'static Rule, element: impl Into<String>, what: impl Into<String>) {
        self.0.push(Finding {
            rule,
            element: element.into(),
            what: what.into(),
            line: None,
        });
    }

    /// Adds one at a line of modelDescription.xml.
    pub fn at(&mut self, line: usize, rule: &'static Rule, element: impl Into<String>, what: impl Into<String>) {
        self.0.push(Finding {
            rule,
            element: element.into(),
            what: what.into(),
            line: Some(line),
        });
    }

    /// How many there are of a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.0.iter().filter(|f| f.rule.severity == severity).count()
    }

    /// Worst first, and otherwise in the order in which they were found; each once.
    pub(crate) fn sorted(self) -> Self {
        let mut kept: Vec<Finding> = Vec::new();
        let mut seen = BTreeSet::new();
        for finding in self.0 {
            // Two interfaces in one library, and several trials, find the same.
            if seen.insert((finding.rule.id, finding.element.clone(), finding.what.clone())) {
                kept.push(finding);
            }
        }
        kept.sort_by_key(|finding| finding.rule.severity);
        Self(kept)
    }
}
