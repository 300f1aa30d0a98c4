//! Each variable by itself, and the few things that hold among all of them.

use super::view::{Scalar, View};
use super::whole::distinct;
use crate::finding::Findings;
use crate::role::{Beginning, Causality, Initial, Kind, Variability, beginning};
use crate::rules::variable as rules;
use crate::xml::lexical::{boolean, double, int, unsigned};

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    distinct(view.variables.iter().map(|v| v.node), &rules::DUPLICATE, findings);
    for variable in &view.variables {
        role(variable, findings);
        start(view, variable, findings);
        declared(view, variable, findings);
        derivative(view, variable, findings);
    }
    let independent: Vec<&Scalar<'_>> = of(view, Causality::Independent).collect();
    for second in independent.iter().skip(1) {
        let what = format!("{} is independent, too", independent[0].called());
        findings.at(second.node.line, &rules::INDEPENDENT, second.called(), what);
    }
    for wrong in independent
        .iter()
        .filter(|v| v.kind.is_some_and(|kind| kind != Kind::Real))
    {
        let what = "the independent variable is not Real";
        findings.at(wrong.node.line, &rules::INDEPENDENT, wrong.called(), what);
    }
}

fn of<'v, 'a>(view: &'v View<'a>, causality: Causality) -> impl Iterator<Item = &'v Scalar<'a>> {
    view.variables.iter().filter(move |v| v.causality == causality)
}

fn role(variable: &Scalar<'_>, findings: &mut Findings) {
    let (node, called) = (variable.node, variable.called());
    let said = |name| node.get(name);
    let real = variable.kind.is_none_or(|kind| kind == Kind::Real);
    if !real && said("variability") == Some("continuous") {
        findings.at(node.line, &rules::CONTINUOUS, called, "it is continuous and not Real");
    } else if !real && said("variability").is_none() && variable.causality != Causality::Independent {
        let what = "it says no variability and is not Real";
        findings.at(node.line, &rules::CONTINUOUS_DEFAULT, called, what);
    }
    let words = format!(
        "causality {} with variability {}",
        said("causality").unwrap_or("local, the default,"),
        said("variability").unwrap_or("continuous, the default")
    );
    match beginning(variable.causality, variable.variability) {
        None => findings.at(node.line, &rules::COMBINATION, called, words),
        Some(Beginning { allowed, .. }) => {
            if let (Some(word), Some(initial)) = (said("initial"), variable.initial)
                && !allowed.contains(&initial)
            {
                let what = format!("initial {word} goes not with {words}");
                findings.at(node.line, &rules::INITIAL, called, what);
            }
        }
    }
    if variable.causality != Causality::Input && said("canHandleMultipleSetPerTimeInstant").and_then(boolean).is_some()
    {
        let what = "canHandleMultipleSetPerTimeInstant is said of what is no input";
        findings.at(node.line, &rules::MULTIPLE_SET, called, what);
    }
}

fn start(view: &View<'_>, variable: &Scalar<'_>, findings: &mut Findings) {
    let (Some(inner), called) = (variable.inner, variable.called()) else {
        return;
    };
    let Some(text) = inner.get("start") else {
        let must = matches!(variable.causality, Causality::Input | Causality::Parameter)
            || matches!(variable.initial, Some(Initial::Exact | Initial::Approx));
        if must && variable.causality != Causality::Independent {
            findings.at(inner.line, &rules::START_MISSING, called, "there is no start value");
        }
        return;
    };
    if variable.causality == Causality::Independent {
        let what = "the independent variable has a start value";
        findings.at(inner.line, &rules::START_FORBIDDEN, called, what);
    } else if variable.initial == Some(Initial::Calculated) {
        let what = format!("it is calculated, and has the start value {text}");
        findings.at(inner.line, &rules::START_FORBIDDEN, called, what);
    }
    if matches!(variable.kind, Some(Kind::Boolean | Kind::String)) {
        return;
    }
    if let Some(items) = view.items(variable) {
        if int(text).is_some_and(|value| !items.contains(&value)) {
            let what = format!("no item has the start value {text}");
            findings.at(inner.line, &rules::START_ITEM, called, what);
        }
        return;
    }
    let number = |name| view.attribute(variable, name).and_then(double);
    let Some(value) = double(text) else { return };
    for (name, outside) in [
        ("min", number("min").is_some_and(|min| value < min)),
        ("max", number("max").is_some_and(|max| value > max)),
    ] {
        if outside {
            let bound = view.attribute(variable, name).unwrap_or_default();
            let what = format!("start {text} lies outside {name} {bound}");
            findings.at(inner.line, &rules::START_RANGE, called, what);
        }
    }
}

fn declared(view: &View<'_>, variable: &Scalar<'_>, findings: &mut Findings) {
    let (Some(inner), Some(name)) = (variable.inner, variable.get("declaredType")) else {
        return;
    };
    match view.type_of(variable) {
        None => {
            let what = format!("declaredType \"{name}\" is not in TypeDefinitions");
            findings.at(inner.line, &rules::TYPE_UNKNOWN, variable.called(), what);
        }
        Some(declared) if declared.name != inner.name => {
            let what = format!(
                "declaredType \"{name}\" is of kind {}, the variable is {}",
                declared.name, inner.name
            );
            findings.at(inner.line, &rules::TYPE_KIND, variable.called(), what);
        }
        Some(_) => (),
    }
}

fn derivative(view: &View<'_>, variable: &Scalar<'_>, findings: &mut Findings) {
    let (Some(inner), called) = (variable.inner, variable.called()) else {
        return;
    };
    if let Some(index) = variable.get("derivative").and_then(unsigned) {
        let state = view.at(index).filter(|state| state.index != variable.index);
        if state.is_none_or(|s| s.kind != Some(Kind::Real) || s.variability != Variability::Continuous) {
            let what = match state {
                Some(state) => format!(
                    "derivative {index} is {}, which is not a continuous Real",
                    state.called()
                ),
                None => format!("derivative {index} is no other variable"),
            };
            findings.at(inner.line, &rules::DERIVATIVE, called, what);
        }
        if variable.variability != Variability::Continuous {
            findings.at(
                inner.line,
                &rules::DERIVATIVE_KIND,
                called,
                "a derivative is not continuous",
            );
        }
    }
    if variable.get("reinit").and_then(boolean).is_some() && !view.is_state(variable) {
        findings.at(
            inner.line,
            &rules::REINIT,
            called,
            "reinit is said of what is no continuous state",
        );
    }
}
