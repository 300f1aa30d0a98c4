//! Variables that share a value reference.

use std::collections::BTreeMap;

use super::view::{Scalar, View};
use crate::finding::Findings;
use crate::role::{Causality, Kind, Variability};
use crate::rules::variable as rules;

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    let mut sets: BTreeMap<(Kind, u32), Vec<&Scalar<'_>>> = BTreeMap::new();
    for variable in &view.variables {
        if let (Some(kind), Some(reference)) = (variable.kind, variable.reference) {
            // Both go through fmi2GetInteger.
            let kind = if kind == Kind::Enumeration { Kind::Integer } else { kind };
            sets.entry((kind, reference)).or_default().push(variable);
        }
    }
    for set in sets.values().filter(|set| set.len() > 1) {
        of_set(view, set, findings);
    }
}

fn of_set(view: &View<'_>, set: &[&Scalar<'_>], findings: &mut Findings) {
    let constant = |v: &&&Scalar<'_>| v.variability == Variability::Constant;
    let settable = |v: &&&Scalar<'_>| matches!(v.causality, Causality::Input | Causality::Parameter);
    let mut found = |rule, first: &Scalar<'_>, second: &Scalar<'_>, what: &str| {
        let what = format!("it shares its value reference with {}, and {what}", first.called());
        findings.at(second.node.line, rule, second.called(), what);
    };

    let mut sets = set.iter().filter(settable);
    if let (Some(first), Some(second)) = (sets.next(), sets.next()) {
        found(&rules::ALIAS_SETTABLE, first, second, "both can be set");
    } else {
        let mut starts = set.iter().filter(|v| !constant(v) && v.get("start").is_some());
        if let (Some(first), Some(second)) = (starts.next(), starts.next()) {
            found(&rules::ALIAS_START, first, second, "both have a start value");
        }
    }

    if let Some(first) = set.iter().find(constant) {
        for other in set.iter().filter(|v| v.index != first.index) {
            if !constant(&other) {
                found(
                    &rules::ALIAS_CONSTANT,
                    first,
                    other,
                    "one of them is constant and the other is not",
                );
            } else if other.get("start") != first.get("start") {
                found(&rules::ALIAS_CONSTANT, first, other, "their values differ");
            }
        }
    }

    let mut units = set.iter().map(|v| (v, view.attribute(v, "unit")));
    if let Some((first, unit)) = units.next()
        && let Some((other, its)) = units.find(|(_, its)| *its != unit)
    {
        let what = if unit.is_some() && its.is_some() {
            "their units differ"
        } else {
            "only one of them has a unit"
        };
        found(&rules::ALIAS_UNIT, first, other, what);
    }
}
