//! Whether a study bears out what its scenario's source claims.

use super::summary::SummaryRow;
use crate::scenarios::{Claim, Scenario};

/// A claim, and the number that was held to its bound.
#[derive(Debug, Clone, Copy)]
pub struct Verdict<'a> {
    /// The claim.
    pub claim: &'a Claim,
    /// The number; `None` where the study has none, which misses the bound.
    pub value: Option<f64>,
}

impl Verdict<'_> {
    /// Whether the number is within the bound.
    pub fn holds(&self) -> bool {
        self.claim.bound.holds(self.value)
    }
}

/// Every claim of the scenario whose filter is part of the study.
pub fn verdicts<'a>(scenario: &'a Scenario, rows: &[SummaryRow]) -> Vec<Verdict<'a>> {
    let judge = |claim: &'a Claim| {
        let row = rows
            .iter()
            .find(|r| r.scenario == scenario.name && r.filter == claim.filter)?;
        Some(Verdict {
            claim,
            value: row.number(claim.column),
        })
    };
    scenario.claims.iter().filter_map(judge).collect()
}
