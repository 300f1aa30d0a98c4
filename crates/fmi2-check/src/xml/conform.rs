//! The document against the table of the schema.

use fmi2_import::suggest;

use super::schema::{Child, Element};
use super::tree::Node;
use crate::finding::Findings;
use crate::rules::xml as rules;

/// Everything in which an element and what is inside it differ from the schema.
pub(crate) fn conform(node: &Node, element: &'static Element, findings: &mut Findings) {
    attributes(node, element, findings);
    if element.open {
        return;
    }
    if node.text {
        findings.at(
            node.line,
            &rules::TEXT,
            &node.path,
            "there is text right inside this element",
        );
    }
    let mut last: Option<(&Node, &Child)> = None;
    for child in &node.children {
        let Some(known) = element.children.iter().find(|c| c.element.name == child.name) else {
            let names: Vec<&str> = element.children.iter().map(|c| c.element.name).collect();
            let what = format!(
                "there is no element {} in {}{}",
                child.name,
                node.name,
                near(&child.name, &names)
            );
            findings.at(child.line, &rules::ELEMENT, &child.path, what);
            continue;
        };
        if let Some((before, rank)) = last
            && rank.rank > known.rank
        {
            let what = format!("{} stands after {}", child.name, before.name);
            findings.at(child.line, &rules::ORDER, &child.path, what);
        } else {
            last = Some((child, known));
        }
        conform(child, known.element, findings);
    }
    for known in element.children {
        let mut found = node.children.iter().filter(|c| c.name == known.element.name);
        if found.next().is_none() && known.required {
            let what = format!("{} has no {}", node.name, known.element.name);
            findings.at(node.line, &rules::MISSING, &node.path, what);
        }
        for second in found.filter(|_| !known.many) {
            let what = format!("{} has more than one {}", node.name, known.element.name);
            findings.at(second.line, &rules::REPEATED, &second.path, what);
        }
    }
    if let Some(kinds) = element.one_of {
        let is_kind = |child: &&Node| {
            element
                .children
                .iter()
                .any(|c| c.rank == 0 && c.element.name == child.name)
        };
        match node.children.iter().filter(is_kind).count() {
            0 => {
                let what = format!("{} has no element {kinds}", node.name);
                findings.at(node.line, &rules::MISSING, &node.path, what);
            }
            1 => (),
            count => {
                let what = format!("{} has {count} of {kinds}, where one is meant", node.name);
                findings.at(node.line, &rules::REPEATED, &node.path, what);
            }
        }
    }
}

fn attributes(node: &Node, element: &Element, findings: &mut Findings) {
    for (name, value) in &node.attributes {
        if name == "xmlns" || name.starts_with("xmlns:") || name.starts_with("xsi:") || name.starts_with("xml:") {
            continue;
        }
        let Some(known) = element.attributes.iter().find(|a| a.name == name) else {
            let names: Vec<&str> = element.attributes.iter().map(|a| a.name).collect();
            let what = format!("{} has no attribute {name}{}", node.name, near(name, &names));
            findings.at(node.line, &rules::ATTRIBUTE, &node.path, what);
            continue;
        };
        if !known.kind.takes(value) {
            let what = format!("{name}=\"{value}\" is not {}", known.kind.described());
            findings.at(node.line, &rules::VALUE, &node.path, what);
        }
    }
    for known in element.attributes.iter().filter(|a| a.required) {
        if node.get(known.name).is_none() {
            let what = format!("{} has no attribute {}", node.name, known.name);
            findings.at(node.line, &rules::ATTRIBUTE_MISSING, &node.path, what);
        }
    }
}

fn near(name: &str, known: &[&str]) -> String {
    suggest(name, known.iter().copied()).map_or_else(String::new, |near| format!("; is {near} meant?"))
}
