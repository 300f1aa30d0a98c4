//! One number beside the paper's.

use crate::bound::Bound;

/// What a number says about the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Within its bound.
    Holds,
    /// Outside, or there is no number.
    Fails,
    /// Shown, held to nothing.
    PrintedOnly,
}

impl Verdict {
    /// As the tables have it.
    pub fn text(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::PrintedOnly => "printed only",
        }
    }
}

/// One number beside the paper's.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Authors.
    pub paper: &'static str,
    /// Table, figure or section.
    pub item: String,
    /// What is measured.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// The paper's number; `None` for a claim in words.
    pub printed: Option<f64>,
    /// Ours; `None` where the studies have none.
    pub value: Option<f64>,
    /// Standard error of ours over the runs.
    pub standard_error: Option<f64>,
    /// What ours is held to.
    pub bound: Option<Bound>,
    /// Missing the bound means that the reproduction has failed, not the paper.
    pub required: bool,
    /// What to know when reading it.
    pub note: String,
}

impl Line {
    /// A line without numbers.
    pub fn new(paper: &'static str, item: &str, quantity: &str, unit: &'static str) -> Self {
        Self {
            paper,
            item: item.to_owned(),
            quantity: quantity.to_owned(),
            unit,
            printed: None,
            value: None,
            standard_error: None,
            bound: None,
            required: false,
            note: String::new(),
        }
    }

    /// With the paper's number.
    pub fn printed(mut self, value: f64) -> Self {
        self.printed = Some(value);
        self
    }

    /// With our number.
    pub fn value(mut self, value: Option<f64>) -> Self {
        self.value = value;
        self
    }

    /// With the standard error of our number.
    pub fn error(mut self, value: Option<f64>) -> Self {
        self.standard_error = value;
        self
    }

    /// With what our number is held to.
    pub fn bound(mut self, bound: Bound) -> Self {
        self.bound = Some(bound);
        self
    }

    /// Whether missing the bound is a failure of the reproduction.
    pub fn required(mut self, required: bool) -> Self {
        self.required = required;
        self
    }

    /// With a remark.
    pub fn note(mut self, text: &str) -> Self {
        self.note = text.to_owned();
        self
    }

    /// What the number says.
    pub fn verdict(&self) -> Verdict {
        match self.bound {
            None => Verdict::PrintedOnly,
            Some(bound) if bound.holds(self.value) => Verdict::Holds,
            Some(_) => Verdict::Fails,
        }
    }

    /// Outside a bound it is required to hold.
    pub fn is_missed(&self) -> bool {
        self.required && self.verdict() == Verdict::Fails
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_needs_a_bound_and_a_missed_one_a_requirement() {
        let line = Line::new("p", "i", "q", "m").printed(2.0);
        assert_eq!(line.clone().value(Some(9.0)).verdict(), Verdict::PrintedOnly);
        let held = line.bound(Bound::within(0.15, 2.0));
        for (value, verdict) in [
            (Some(1.71), Verdict::Holds),
            (Some(2.29), Verdict::Holds),
            (Some(1.69), Verdict::Fails),
            (Some(2.31), Verdict::Fails),
            (Some(f64::NAN), Verdict::Fails),
            (None, Verdict::Fails),
        ] {
            let line = held.clone().value(value);
            assert_eq!(line.verdict(), verdict, "{value:?}");
            assert!(!line.is_missed());
            assert_eq!(line.required(true).is_missed(), verdict == Verdict::Fails, "{value:?}");
        }
        assert_eq!(
            held.bound(Bound::exactly(0.0)).value(Some(0.0)).verdict(),
            Verdict::Holds
        );
    }
}
