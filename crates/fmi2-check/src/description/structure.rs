//! ModelStructure against the variables.

use std::collections::BTreeSet;

use super::view::{Scalar, View};
use crate::finding::Findings;
use crate::role::{Causality, Initial, Kind};
use crate::rule::Rule;
use crate::rules::structure as rules;
use crate::xml::lexical::unsigned;
use crate::xml::tree::Node;

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    let Some(structure) = view.root.child("ModelStructure") else {
        return;
    };
    let list = |name| List::read(structure, name);
    let (outputs, derivatives, initial) = (list("Outputs"), list("Derivatives"), list("InitialUnknowns"));
    for (list, name) in [
        (&outputs, "Outputs"),
        (&derivatives, "Derivatives"),
        (&initial, "InitialUnknowns"),
    ] {
        list.indices(view, name, findings);
    }

    let are = |wanted: &dyn Fn(&Scalar<'_>) -> bool| -> BTreeSet<usize> {
        view.variables.iter().filter(|v| wanted(v)).map(|v| v.index).collect()
    };
    let all_outputs = are(&|v| v.causality == Causality::Output);
    outputs.missing(
        view,
        &all_outputs,
        &rules::OUTPUT_MISSING,
        "Outputs",
        structure,
        findings,
    );
    outputs.extra(view, &all_outputs, &rules::OUTPUT_EXTRA, "it is no output", findings);

    let all_derivatives = are(&|v| v.get("derivative").is_some());
    if view.interface("ModelExchange").is_some() {
        let rule = &rules::DERIVATIVE_MISSING;
        let wanted = unlisted(view, &derivatives);
        derivatives.missing(view, &wanted, rule, "Derivatives", structure, findings);
    }
    let what = "it has no attribute derivative";
    derivatives.extra(view, &all_derivatives, &rules::DERIVATIVE_EXTRA, what, findings);

    let states: BTreeSet<usize> = derivatives.states(view).collect();
    let exposed: BTreeSet<usize> = derivatives.all().chain(states.iter().copied()).collect();
    let unknown = are(&|v| {
        let open = matches!(v.initial, Some(Initial::Approx | Initial::Calculated));
        v.causality == Causality::CalculatedParameter
            || open && (v.causality == Causality::Output || exposed.contains(&v.index))
    });
    initial.missing(
        view,
        &unknown,
        &rules::INITIAL_MISSING,
        "InitialUnknowns",
        structure,
        findings,
    );
    let what = "it is none of the unknowns of the initialization";
    initial.extra(view, &unknown, &rules::INITIAL_EXTRA, what, findings);
    for pair in initial.unknowns.windows(2) {
        if pair[1].1 < pair[0].1 {
            let what = format!("index {} comes after {}", pair[1].1, pair[0].1);
            findings.at(pair[1].0.line, &rules::INITIAL_ORDER, &pair[1].0.path, what);
        }
    }

    let at_runtime =
        |v: &Scalar<'_>| matches!(v.causality, Causality::Input | Causality::Independent) || states.contains(&v.index);
    let at_start = |v: &Scalar<'_>| {
        matches!(v.causality, Causality::Input | Causality::Independent) || v.initial == Some(Initial::Exact)
    };
    for (node, _) in outputs.unknowns.iter().chain(&derivatives.unknowns) {
        dependencies(view, node, &at_runtime, findings);
    }
    for (node, _) in &initial.unknowns {
        dependencies(view, node, &at_start, findings);
        let kinds = node.get("dependenciesKind").unwrap_or_default();
        for kind in kinds
            .split_whitespace()
            .filter(|kind| ["fixed", "tunable", "discrete"].contains(kind))
        {
            findings.at(
                node.line,
                &rules::INITIAL_KIND,
                &node.path,
                format!("a dependency is {kind}"),
            );
        }
    }
}

/// Derivatives that look like those of states, and of whose states no derivative is listed.
///
/// The attribute alone says less: inputs and outputs may be derivatives of each other, and what is an alias of a listed derivative,
/// or of its state, brings no state of its own.
fn unlisted(view: &View<'_>, derivatives: &List<'_>) -> BTreeSet<usize> {
    let aliases = |wanted: BTreeSet<usize>| -> BTreeSet<u32> {
        let there = view.variables.iter().filter(|v| v.kind == Some(Kind::Real));
        there
            .filter(|v| wanted.contains(&v.index))
            .filter_map(|v| v.reference)
            .collect()
    };
    let listed = aliases(derivatives.all().collect());
    let states = aliases(derivatives.states(view).collect());
    let inputs = view.variables.iter().filter(|v| v.causality == Causality::Input);
    let inputs = aliases(inputs.map(|v| v.index).collect());
    let is = |set: &BTreeSet<u32>, v: &Scalar<'_>| v.reference.is_some_and(|reference| set.contains(&reference));
    let missing = view.variables.iter().filter(|v| {
        let Some(of) = v.get("derivative").and_then(unsigned).and_then(|index| view.at(index)) else {
            return false;
        };
        let outputs = [v, of].iter().all(|v| v.causality == Causality::Output);
        !(outputs || is(&listed, v) || is(&states, of) || is(&inputs, v) || is(&inputs, of))
    });
    missing.map(|v| v.index).collect()
}

/// A list of unknowns with their indices, those that can be read.
struct List<'a> {
    unknowns: Vec<(&'a Node, u32)>,
}

impl<'a> List<'a> {
    fn read(structure: &'a Node, name: &'static str) -> Self {
        let nodes = structure.inside(name, "Unknown");
        Self {
            unknowns: nodes
                .filter_map(|node| Some((node, unsigned(node.get("index")?)?)))
                .collect(),
        }
    }

    fn all(&self) -> impl Iterator<Item = usize> {
        self.unknowns
            .iter()
            .filter_map(|(_, index)| usize::try_from(*index).ok())
    }

    /// Variables that the derivatives of this list belong to.
    fn states(&self, view: &View<'_>) -> impl Iterator<Item = usize> {
        self.unknowns.iter().filter_map(|(_, index)| {
            let state = view.at(*index)?.get("derivative").and_then(unsigned)?;
            Some(view.at(state)?.index)
        })
    }

    fn indices(&self, view: &View<'_>, name: &str, findings: &mut Findings) {
        let mut seen = BTreeSet::new();
        for (node, index) in &self.unknowns {
            let count = view.variables.len();
            match view.at(*index) {
                None => {
                    let what = format!("there is no variable {index}, there are {count}");
                    findings.at(node.line, &rules::INDEX, &node.path, what);
                }
                Some(variable) if !seen.insert(*index) => {
                    let what = format!("{name} lists it more than once");
                    findings.at(node.line, &rules::REPEATED, variable.called(), what);
                }
                Some(_) => (),
            }
        }
    }

    fn missing(
        &self,
        view: &View<'_>,
        wanted: &BTreeSet<usize>,
        rule: &'static Rule,
        name: &str,
        structure: &Node,
        findings: &mut Findings,
    ) {
        let there: BTreeSet<usize> = self.all().collect();
        for index in wanted.difference(&there) {
            let variable = &view.variables[index - 1];
            let what = format!("{name} does not list it (index {index})");
            findings.at(structure.line, rule, variable.called(), what);
        }
    }

    fn extra(
        &self,
        view: &View<'_>,
        wanted: &BTreeSet<usize>,
        rule: &'static Rule,
        what: &str,
        findings: &mut Findings,
    ) {
        let mut told = BTreeSet::new();
        for (node, index) in &self.unknowns {
            if let Some(variable) = view.at(*index)
                && !wanted.contains(&variable.index)
                && told.insert(variable.index)
            {
                findings.at(node.line, rule, variable.called(), format!("{what} (index {index})"));
            }
        }
    }
}

fn dependencies(view: &View<'_>, node: &Node, known: &dyn Fn(&Scalar<'_>) -> bool, findings: &mut Findings) {
    let kinds = node.get("dependenciesKind").map(|k| k.split_whitespace().count());
    let Some(text) = node.get("dependencies") else {
        if kinds.is_some() {
            let what = "there is dependenciesKind and no dependencies";
            findings.at(node.line, &rules::KINDS_ALONE, &node.path, what);
        }
        return;
    };
    let indices: Vec<Option<u32>> = text.split_whitespace().map(unsigned).collect();
    if let Some(kinds) = kinds.filter(|kinds| *kinds != indices.len()) {
        let what = format!("{} dependencies have {kinds} kinds", indices.len());
        findings.at(node.line, &rules::KINDS, &node.path, what);
    }
    factors(view, node, &indices, findings);
    let indices: Vec<u32> = indices.into_iter().flatten().collect();
    let mut seen = BTreeSet::new();
    for index in &indices {
        match view.at(*index) {
            None => {
                let what = format!("there is no variable {index}, there are {}", view.variables.len());
                findings.at(node.line, &rules::DEPENDENCY, &node.path, what);
            }
            Some(_) if !seen.insert(*index) => {
                let what = format!("dependency {index} is listed more than once");
                findings.at(node.line, &rules::DEPENDENCY_REPEATED, &node.path, what);
            }
            Some(variable) if !known(variable) => {
                let what = format!("dependency {index} is {}, which is no known here", variable.called());
                findings.at(node.line, &rules::DEPENDENCY_KNOWN, &node.path, what);
            }
            Some(_) => (),
        }
    }
    if !indices.is_sorted() {
        findings.at(
            node.line,
            &rules::DEPENDENCY_ORDER,
            &node.path,
            "dependencies are not sorted",
        );
    }
}

/// Kinds other than dependent say that a known enters by a factor, which only Real numbers have.
fn factors(view: &View<'_>, node: &Node, dependencies: &[Option<u32>], findings: &mut Findings) {
    let other = |index: Option<u32>| {
        let variable = view.at(index?)?;
        variable.kind.is_some_and(|kind| kind != Kind::Real).then_some(variable)
    };
    let unknown = other(node.get("index").and_then(unsigned));
    let kinds = node.get("dependenciesKind").unwrap_or_default().split_whitespace();
    for (kind, dependency) in kinds.zip(dependencies) {
        if !["constant", "fixed", "tunable", "discrete"].contains(&kind) {
            continue;
        }
        if let Some(unknown) = unknown {
            let what = format!("a dependency is {kind}, and {} is not Real", unknown.called());
            findings.at(node.line, &rules::KIND_REAL, &node.path, what);
        } else if let Some(known) = other(*dependency) {
            let what = format!("the dependency on {} is {kind}, and it is not Real", known.called());
            findings.at(node.line, &rules::KIND_KNOWN, &node.path, what);
        }
    }
}
