//! Units and types, and their use by types and variables.

use std::collections::BTreeSet;

use super::view::View;
use super::whole::distinct;
use crate::finding::Findings;
use crate::role::{Kind, Word};
use crate::rules::description as rules;
use crate::xml::lexical::{double, int};
use crate::xml::tree::Node;

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    let root = view.root;
    distinct(root.inside("UnitDefinitions", "Unit"), &rules::UNIT, findings);
    for unit in root.inside("UnitDefinitions", "Unit") {
        distinct(unit.named("DisplayUnit"), &rules::DISPLAY_UNIT, findings);
        for scaled in unit.named("BaseUnit").chain(unit.named("DisplayUnit")) {
            let factor = scaled.get("factor").and_then(double);
            if let Some(factor) = factor.filter(|factor| *factor == 0.0 || !factor.is_finite()) {
                findings.at(scaled.line, &rules::FACTOR, &scaled.path, format!("factor is {factor}"));
            }
        }
        // Exponents are integers, so a unit such as m/s^1.5 has no BaseUnit.
        let fraction = unit
            .get("name")
            .is_some_and(|name| name.contains('.') && name.contains('^'));
        if unit.child("BaseUnit").is_none() && !fraction {
            findings.at(unit.line, &rules::BASE, &unit.path, "there is no BaseUnit");
        }
    }
    types(view, findings);
    for variable in &view.variables {
        if let Some(inner) = variable.inner {
            quantity(
                view,
                inner,
                variable.called(),
                view.attribute(variable, "unit"),
                findings,
            );
            bounds(inner, view.type_of(variable), variable.called(), findings);
        }
    }
}

fn types(view: &View<'_>, findings: &mut Findings) {
    let root = view.root;
    distinct(root.inside("TypeDefinitions", "SimpleType"), &rules::TYPE, findings);
    let variables: BTreeSet<&str> = view.variables.iter().map(|v| v.name).collect();
    for simple in root.inside("TypeDefinitions", "SimpleType") {
        if let Some(name) = simple.get("name").filter(|name| variables.contains(name)) {
            let what = format!("a variable is called {name}, too");
            findings.at(simple.line, &rules::TYPE_SHADOW, &simple.path, what);
        }
        for kind in simple.children.iter().filter(|c| Kind::read(&c.name).is_some()) {
            quantity(view, kind, &simple.path, kind.get("unit"), findings);
            bounds(kind, None, &simple.path, findings);
            distinct(kind.named("Item"), &rules::ITEM_NAME, findings);
            let mut values = BTreeSet::new();
            for item in kind.named("Item") {
                if let Some(value) = item.get("value").and_then(int).filter(|value| !values.insert(*value)) {
                    let what = format!("another item has the value {value}, too");
                    findings.at(item.line, &rules::ITEM_VALUE, &item.path, what);
                }
            }
        }
    }
}

/// * `unit`: the one in force, which may come from a declared type.
fn quantity(view: &View<'_>, node: &Node, called: &str, unit: Option<&str>, findings: &mut Findings) {
    if let Some(own) = node.get("unit").filter(|own| !view.units.contains_key(own)) {
        let what = format!("unit \"{own}\" is not in UnitDefinitions");
        findings.at(node.line, &rules::UNIT_UNKNOWN, called, what);
    }
    let Some(display) = node.get("displayUnit") else {
        return;
    };
    match unit {
        None => {
            let what = format!("displayUnit \"{display}\" has no unit beside it");
            findings.at(node.line, &rules::DISPLAY_ALONE, called, what);
        }
        // The unit itself is allowed to be shown.
        Some(unit)
            if view
                .units
                .get(unit)
                .is_some_and(|all| display != unit && !all.contains(display)) =>
        {
            let what = format!("displayUnit \"{display}\" is not defined for the unit \"{unit}\"");
            findings.at(node.line, &rules::DISPLAY_UNKNOWN, called, what);
        }
        Some(_) => (),
    }
}

fn bounds(node: &Node, declared: Option<&Node>, called: &str, findings: &mut Findings) {
    let number = |name| node.get(name).or_else(|| declared?.get(name)).and_then(double);
    // What a type alone gets wrong is found at the type.
    let own = ["min", "max"].iter().any(|name| node.get(name).is_some());
    if let (Some(min), Some(max), true) = (number("min"), number("max"), own)
        && min > max
    {
        findings.at(
            node.line,
            &rules::RANGE,
            called,
            format!("min {min} is above max {max}"),
        );
    }
    if let Some(nominal) = node
        .get("nominal")
        .and_then(double)
        .filter(|nominal| *nominal <= 0.0 || nominal.is_nan())
    {
        findings.at(node.line, &rules::NOMINAL, called, format!("nominal is {nominal}"));
    }
}
