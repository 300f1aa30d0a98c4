//! Interfaces, capabilities, the default experiment, log categories and annotations.

use std::collections::BTreeSet;

use super::view::View;
use crate::finding::Findings;
use crate::rule::Rule;
use crate::rules::description as rules;
use crate::xml::lexical::{boolean, double, unsigned};
use crate::xml::tree::Node;

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    let root = view.root;
    let interfaces: Vec<&Node> = ["ModelExchange", "CoSimulation"]
        .into_iter()
        .filter_map(|name| view.interface(name))
        .collect();
    if interfaces.is_empty() {
        let what = "there is neither ModelExchange nor CoSimulation";
        findings.at(root.line, &rules::INTERFACE, &root.path, what);
    }
    for interface in &interfaces {
        of_interface(interface, findings);
    }
    for (attribute, rule) in [("modelName", &rules::NAME), ("guid", &rules::GUID)] {
        if root.get(attribute).is_some_and(|text| text.trim().is_empty()) {
            findings.at(root.line, rule, &root.path, format!("{attribute} is empty"));
        }
    }
    if root
        .get("generationDateAndTime")
        .is_some_and(|d| !d.trim().ends_with('Z'))
    {
        let what = "generationDateAndTime does not end in Z";
        findings.at(root.line, &rules::DATE, &root.path, what);
    }
    if root.get("generationTool").is_none_or(str::is_empty) {
        findings.at(root.line, &rules::TOOL, &root.path, "there is no generationTool");
    }
    let events = root.get("numberOfEventIndicators").and_then(unsigned).unwrap_or(0);
    if events > 0 && view.interface("ModelExchange").is_none() && !interfaces.is_empty() {
        let what = format!("numberOfEventIndicators is {events}, and there is no ModelExchange");
        findings.at(root.line, &rules::EVENTS, &root.path, what);
    }
    for experiment in root.named("DefaultExperiment") {
        of_experiment(experiment, findings);
    }
    distinct(root.inside("LogCategories", "Category"), &rules::LOG, findings);
    distinct(root.inside("VendorAnnotations", "Tool"), &rules::ANNOTATION, findings);
    for variable in &view.variables {
        let tools = variable.node.inside("Annotations", "Tool");
        distinct(tools, &rules::ANNOTATION, findings);
    }
}

fn of_interface(interface: &Node, findings: &mut Findings) {
    if let Some(identifier) = interface.get("modelIdentifier")
        && !is_identifier(identifier)
    {
        let what = format!("modelIdentifier \"{identifier}\" is no C identifier");
        findings.at(interface.line, &rules::IDENTIFIER, &interface.path, what);
    }
    let flag = |name| interface.get(name).and_then(boolean).unwrap_or(false);
    if flag("canSerializeFMUstate") && !flag("canGetAndSetFMUstate") {
        let what = "canSerializeFMUstate is true, and canGetAndSetFMUstate is not";
        findings.at(interface.line, &rules::SERIALIZE, &interface.path, what);
    }
}

fn is_identifier(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !text.starts_with(|c: char| c.is_ascii_digit())
        && !text.is_empty()
}

fn of_experiment(experiment: &Node, findings: &mut Findings) {
    let number = |name| experiment.get(name).and_then(double);
    let start = number("startTime").unwrap_or(0.0);
    if let Some(stop) = number("stopTime")
        && (stop <= start || stop.is_nan())
    {
        let what = format!("stopTime {stop} is not after startTime {start}");
        findings.at(experiment.line, &rules::EXPERIMENT_STOP, &experiment.path, what);
    }
    for (name, rule) in [
        ("stepSize", &rules::EXPERIMENT_STEP),
        ("tolerance", &rules::EXPERIMENT_TOLERANCE),
    ] {
        if let Some(value) = number(name)
            && !(value > 0.0 && value.is_finite())
        {
            findings.at(experiment.line, rule, &experiment.path, format!("{name} is {value}"));
        }
    }
}

/// Finds elements whose name another has already.
pub(super) fn distinct<'a>(nodes: impl Iterator<Item = &'a Node>, rule: &'static Rule, findings: &mut Findings) {
    let mut seen = BTreeSet::new();
    for node in nodes {
        if let Some(name) = node.get("name")
            && !seen.insert(name)
        {
            let what = format!("there is another {} of the name \"{name}\"", node.name);
            findings.at(node.line, rule, &node.path, what);
        }
    }
}
