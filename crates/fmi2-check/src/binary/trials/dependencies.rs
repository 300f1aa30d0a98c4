//! Knowns are moved one by one, and what moves with them has to be declared.

use std::time::{Duration, Instant};

use crate::binary::instance::{Bench, Ended, Instance};
use crate::binary::job::{Unknown, Value, Variable};
use crate::binary::run::Failed;
use crate::role::{Causality, Initial, Variability};
use crate::rule::Rule;
use crate::rules::binary as rules;

/// Long enough for any but the largest FMUs.
const PATIENCE: Duration = Duration::from_secs(10);

pub(super) fn initial(bench: &Bench<'_>) -> Result<(), Failed> {
    let known = |v: &Variable| {
        v.causality == Causality::Input || v.initial == Some(Initial::Exact) && v.variability != Variability::Constant
    };
    let begin = |bench: &Bench<'_>, instance: &Instance<'_>| bench.reach_initialization(instance);
    perturb(
        bench,
        &bench.job.initial,
        &known,
        &begin,
        &rules::INITIAL_DEPENDENCY,
        "InitialUnknowns",
    )
}

pub(super) fn between_steps(bench: &Bench<'_>) -> Result<(), Failed> {
    let known = |v: &Variable| v.causality == Causality::Input;
    let begin = |bench: &Bench<'_>, instance: &Instance<'_>| {
        bench.initialize(instance)?;
        bench.record(instance, 0..bench.half()).map(drop)
    };
    perturb(bench, &bench.job.outputs, &known, &begin, &rules::DEPENDENCY, "Outputs")
}

type Begin<'b> = dyn Fn(&Bench<'_>, &Instance<'_>) -> Result<(), Failed> + 'b;

fn perturb(
    bench: &Bench<'_>,
    unknowns: &[Unknown],
    known: &dyn Fn(&Variable) -> bool,
    begin: &Begin<'_>,
    rule: &'static Rule,
    list: &str,
) -> Result<(), Failed> {
    let all = &bench.job.variables;
    let read: Vec<&Variable> = unknowns.iter().map(|unknown| &all[unknown.variable]).collect();
    let knowns: Vec<usize> = (0..all.len()).filter(|place| known(&all[*place])).collect();
    let started = Instant::now();
    let mut instance = bench.instance()?;
    begin(bench, &instance)?;
    let mut base = bench.read(&instance, &read)?;
    if bench.read(&instance, &read)? != base {
        // What moves by itself says nothing of what moves it.
        return Ok(());
    }
    for (tried, place) in knowns.iter().enumerate() {
        if started.elapsed() > PATIENCE {
            let what = format!(
                "{tried} of {} knowns of {list} were moved, then time was up",
                knowns.len()
            );
            bench.journal.found(&rules::SKIPPED, "ModelStructure", what);
            return Ok(());
        }
        let variable = &all[*place];
        let Ok(now) = instance.read(&[variable]) else { continue };
        let Some(other) = variable.moved(&now[0]) else { continue };
        if instance.set(variable, &other) == Ended::Well
            && let Ok(moved) = instance.read(&read)
        {
            tell(bench, unknowns, *place, &base, &moved, (rule, list));
            let back = instance.set(variable, &now[0]) == Ended::Well;
            if back && instance.read(&read).is_ok_and(|again| again == base) {
                continue;
            }
        }
        // An instance that refused, or does not find back, is none to go on with.
        drop(instance);
        instance = bench.instance()?;
        begin(bench, &instance)?;
        base = bench.read(&instance, &read)?;
    }
    Ok(())
}

fn tell(
    bench: &Bench<'_>,
    unknowns: &[Unknown],
    known: usize,
    base: &[Value],
    moved: &[Value],
    (rule, list): (&'static Rule, &str),
) {
    let all = &bench.job.variables;
    for ((unknown, base), moved) in unknowns.iter().zip(base).zip(moved) {
        let declared = unknown.dependencies.as_ref().is_none_or(|d| d.contains(&known));
        // An unknown that is set moves with itself.
        if base != moved && !declared && unknown.variable != known {
            let what = format!(
                "it moves with {} (index {}), which {list} does not declare",
                all[known].name,
                known + 1
            );
            bench.journal.found(rule, &all[unknown.variable].name, what);
        }
    }
}
