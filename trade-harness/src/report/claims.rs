//! Whether a study bears out what its scenario's source claims.

use super::summary::SummaryRow;
use crate::scenarios::{Bound, Scenario};

/// A bound, and the number that was held to it.
#[derive(Debug, Clone, Copy)]
pub struct Verdict<'a> {
    /// The bound.
    pub bound: &'a Bound,
    /// The number; `None` where the study has none, which misses the bound.
    pub value: Option<f64>,
}

impl Verdict<'_> {
    /// Whether the number is within the bound.
    pub fn holds(&self) -> bool {
        self.value
            .is_some_and(|v| (self.bound.low..=self.bound.high).contains(&v))
    }
}

/// Every bound of the scenario whose filter is part of the study.
pub fn verdicts<'a>(scenario: &'a Scenario, rows: &[SummaryRow]) -> Vec<Verdict<'a>> {
    let judge = |bound: &'a Bound| {
        let row = rows
            .iter()
            .find(|r| r.scenario == scenario.name && r.filter == bound.filter)?;
        Some(Verdict {
            bound,
            value: row.number(bound.column),
        })
    };
    scenario.bounds.iter().filter_map(judge).collect()
}
