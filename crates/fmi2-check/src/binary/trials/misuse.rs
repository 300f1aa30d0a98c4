//! Wrong calls, which are refused by an FMU that helps its master to find mistakes.

use std::collections::BTreeSet;

use crate::binary::instance::{Bench, Ended, Instance, Manner};
use crate::binary::job::{Value, Variable};
use crate::binary::run::Failed;
use crate::role::{Causality, Kind, Variability};
use crate::rule::Rule;
use crate::rules::binary as rules;

/// Finds a call that should have been refused.
fn refused(bench: &Bench<'_>, rule: &'static Rule, element: &str, ended: Ended, what: &str) {
    if matches!(ended, Ended::Well | Ended::Later) {
        bench.journal.found(rule, element, format!("{what} was taken"));
    }
}

pub(super) fn wrong_guid(bench: &Bench<'_>) -> Result<(), Failed> {
    let manner = Manner {
        guid: "{00000000-0000-0000-0000-00000badf00d}",
        ..bench.manner()
    };
    if Instance::new(bench, "checked", manner).is_some() {
        bench
            .journal
            .found(&rules::GUID, "fmi2Instantiate", "another guid was taken");
    }
    Ok(())
}

pub(super) fn step_at_once(bench: &Bench<'_>) -> Result<(), Failed> {
    let ended = bench.instance()?.do_step(bench.job.start, bench.job.step);
    refused(
        bench,
        &rules::ORDER,
        "fmi2DoStep",
        ended,
        "a step before initialization",
    );
    Ok(())
}

pub(super) fn step_too_early(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = bench.instance()?;
    bench.reach_initialization(&instance)?;
    let ended = instance.do_step(bench.job.start, bench.job.step);
    refused(
        bench,
        &rules::ORDER,
        "fmi2DoStep",
        ended,
        "a step in initialization mode",
    );
    Ok(())
}

pub(super) fn exit_at_once(bench: &Bench<'_>) -> Result<(), Failed> {
    let ended = bench.instance()?.exit_initialization();
    let what = "the end of an initialization that was not begun";
    refused(bench, &rules::ORDER, "fmi2ExitInitializationMode", ended, what);
    Ok(())
}

pub(super) fn enter_twice(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = bench.instance()?;
    bench.reach_initialization(&instance)?;
    let ended = instance.enter_initialization();
    refused(
        bench,
        &rules::ORDER,
        "fmi2EnterInitializationMode",
        ended,
        "a second beginning of the initialization",
    );
    Ok(())
}

fn initialized<'a>(bench: &'a Bench<'a>) -> Result<Instance<'a>, Failed> {
    let instance = bench.instance()?;
    bench.initialize(&instance)?;
    Ok(instance)
}

pub(super) fn setup_too_late(bench: &Bench<'_>) -> Result<(), Failed> {
    let ended = initialized(bench)?.setup();
    refused(
        bench,
        &rules::ORDER,
        "fmi2SetupExperiment",
        ended,
        "an experiment after initialization",
    );
    Ok(())
}

pub(super) fn terminate_at_once(bench: &Bench<'_>) -> Result<(), Failed> {
    let ended = bench.instance()?.terminate();
    refused(
        bench,
        &rules::ORDER,
        "fmi2Terminate",
        ended,
        "an end before initialization",
    );
    Ok(())
}

pub(super) fn step_too_late(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = initialized(bench)?;
    bench.step(&instance, 0)?;
    bench.expect("fmi2Terminate", instance.terminate(), &instance)?;
    let ended = instance.do_step(bench.time(1), bench.job.step);
    refused(bench, &rules::ORDER, "fmi2DoStep", ended, "a step after fmi2Terminate");
    Ok(())
}

pub(super) fn step_back(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = initialized(bench)?;
    bench.step(&instance, 0)?;
    let ended = instance.do_step(bench.time(1), -bench.job.step);
    refused(bench, &rules::ORDER, "fmi2DoStep", ended, "a step of negative size");
    Ok(())
}

pub(super) fn step_elsewhere(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = initialized(bench)?;
    bench.step(&instance, 0)?;
    let ended = instance.do_step(bench.time(3), bench.job.step);
    refused(
        bench,
        &rules::ORDER,
        "fmi2DoStep",
        ended,
        "a step that does not begin where the last one ended",
    );
    Ok(())
}

pub(super) fn step_nan(bench: &Bench<'_>) -> Result<(), Failed> {
    let ended = initialized(bench)?.do_step(bench.job.start, f64::NAN);
    refused(
        bench,
        &rules::ORDER,
        "fmi2DoStep",
        ended,
        "a step whose size is no number",
    );
    Ok(())
}

/// A reference that no variable of the kind has.
fn unknown(bench: &Bench<'_>, kind: Kind) -> u32 {
    let used: BTreeSet<u32> = bench
        .job
        .variables
        .iter()
        .filter(|v| v.kind == kind || kind == Kind::Integer && v.kind == Kind::Enumeration)
        .map(|v| v.reference)
        .collect();
    (0..=0xffff_fff0).rev().find(|r| !used.contains(r)).unwrap_or(u32::MAX)
}

pub(super) fn get_unknown(bench: &Bench<'_>) -> Result<(), Failed> {
    for (kind, function) in [
        (Kind::Real, "fmi2GetReal"),
        (Kind::Integer, "fmi2GetInteger"),
        (Kind::Boolean, "fmi2GetBoolean"),
        (Kind::String, "fmi2GetString"),
    ] {
        let reference = unknown(bench, kind);
        let (ended, _) = initialized(bench)?.get(kind, &[reference]);
        refused(
            bench,
            &rules::REFERENCE,
            function,
            ended,
            &format!("reference {reference}, which does not exist,"),
        );
    }
    Ok(())
}

pub(super) fn set_unknown(bench: &Bench<'_>) -> Result<(), Failed> {
    for (kind, function, value) in [
        (Kind::Real, "fmi2SetReal", Value::real(0.0)),
        (Kind::Integer, "fmi2SetInteger", Value::Integer(0)),
        (Kind::Boolean, "fmi2SetBoolean", Value::Boolean(0)),
        (Kind::String, "fmi2SetString", Value::Text(String::new())),
    ] {
        let reference = unknown(bench, kind);
        let instance = bench.instance()?;
        bench.reach_initialization(&instance)?;
        let ended = instance.set_reference(reference, &value);
        refused(
            bench,
            &rules::REFERENCE,
            function,
            ended,
            &format!("reference {reference}, which does not exist,"),
        );
    }
    Ok(())
}

fn first<'a>(bench: &Bench<'a>, wanted: impl Fn(&&Variable) -> bool) -> Option<&'a Variable> {
    bench.job.variables.iter().find(wanted)
}

/// Sets a variable to the value that it has: what is refused is the setting, not the value.
fn set_same(bench: &Bench<'_>, variable: &Variable, rule: &'static Rule, what: &str) -> Result<(), Failed> {
    let instance = initialized(bench)?;
    let value = bench.read(&instance, &[variable])?;
    let ended = instance.set(variable, &value[0]);
    refused(bench, rule, &variable.name, ended, what);
    Ok(())
}

pub(super) fn set_constant(bench: &Bench<'_>) -> Result<(), Failed> {
    match first(bench, |v| v.variability == Variability::Constant) {
        Some(constant) => set_same(bench, constant, &rules::CONSTANT_SET, "a value for a constant"),
        None => Ok(()),
    }
}

pub(super) fn set_fixed(bench: &Bench<'_>) -> Result<(), Failed> {
    let fixed = |v: &&Variable| v.causality == Causality::Parameter && v.variability == Variability::Fixed;
    match first(bench, fixed) {
        Some(fixed) => set_same(bench, fixed, &rules::FIXED_SET, "a value for a fixed parameter"),
        None => Ok(()),
    }
}

pub(super) fn set_output(bench: &Bench<'_>) -> Result<(), Failed> {
    let output = |v: &&Variable| v.causality == Causality::Output && v.variability != Variability::Constant;
    match first(bench, output) {
        Some(output) => set_same(bench, output, &rules::OUTPUT_SET, "a value for an output"),
        None => Ok(()),
    }
}

pub(super) fn set_nan(bench: &Bench<'_>) -> Result<(), Failed> {
    let input = |v: &&Variable| v.causality == Causality::Input && v.kind == Kind::Real;
    if let Some(input) = first(bench, input) {
        let ended = initialized(bench)?.set(input, &Value::real(f64::NAN));
        refused(bench, &rules::NOT_A_NUMBER, &input.name, ended, "NaN");
    }
    Ok(())
}
