//! Runs that have to be the same.

use fmi2_abi::Fmi2Status;

use crate::binary::instance::{Bench, Ended, Instance};
use crate::binary::job::Variable;
use crate::binary::run::{Failed, Record};
use crate::role::{Causality, Kind};
use crate::rule::Rule;
use crate::rules::binary as rules;

fn tell(bench: &Bench<'_>, rule: &'static Rule, expected: &Record, found: &Record) {
    let outputs = bench.outputs();
    for (place, what) in bench.differences(expected, found, 0) {
        bench.journal.found(rule, &outputs[place].name, what);
    }
}

fn fresh(bench: &Bench<'_>) -> Result<Record, Failed> {
    let instance = bench.instance()?;
    bench.initialize(&instance)?;
    bench.record(&instance, 0..bench.job.steps)
}

pub(super) fn repeat(bench: &Bench<'_>) -> Result<(), Failed> {
    let first = fresh(bench)?;
    tell(bench, &rules::REPEAT, &first, &fresh(bench)?);
    Ok(())
}

/// Real inputs that may be moved, and are.
fn push(bench: &Bench<'_>, instance: &Instance<'_>) -> Result<(), Failed> {
    let movable = |v: &&Variable| v.causality == Causality::Input && v.kind == Kind::Real;
    for input in bench.job.variables.iter().filter(movable) {
        if let Some(value) = input.start_value().and_then(|start| input.moved(&start))
            && instance.set(input, &value) != Ended::Well
        {
            return Err(Failed);
        }
    }
    Ok(())
}

pub(super) fn reset(bench: &Bench<'_>) -> Result<(), Failed> {
    let expected = fresh(bench)?;
    let instance = bench.instance()?;
    bench.initialize(&instance)?;
    let half = bench.half();
    bench.record(&instance, 0..half)?;
    // Nothing of a step with other inputs may be left; an FMU that does not like them is reset none the less.
    if push(bench, &instance).is_ok() {
        instance.do_step(bench.time(half), bench.job.step);
    }
    bench.expect("fmi2Reset", instance.reset(), &instance)?;
    bench.initialize(&instance)?;
    let again = bench.record(&instance, 0..bench.job.steps)?;
    tell(bench, &rules::RESET, &expected, &again);
    Ok(())
}

pub(super) fn two(bench: &Bench<'_>) -> Result<(), Failed> {
    let expected = fresh(bench)?;
    let watched = bench.instance()?;
    let Some(other) = Instance::new(bench, "other", bench.manner()) else {
        let what = "a second instance is refused, and canBeInstantiatedOnlyOncePerProcess is not set";
        bench.journal.found(&rules::TWO, "fmi2Instantiate", what);
        return Ok(());
    };
    bench.initialize(&watched)?;
    bench.initialize(&other)?;
    let mut moving = push(bench, &other).is_ok();
    let outputs = bench.outputs();
    let mut found = vec![bench.read(&watched, &outputs)?];
    for step in 0..bench.job.steps {
        // The other one goes first, and ahead, so that what they share shows.
        moving = moving && other.do_step(bench.time(step), bench.job.step) == Ended::Well;
        let ended = watched.do_step(bench.time(step), bench.job.step);
        if let Ended::Refused(status) = ended {
            let status: Fmi2Status = status;
            let what = format!("with a second instance beside it fmi2DoStep returned {status}");
            bench.journal.found(&rules::TWO, "fmi2DoStep", what);
            return Ok(());
        }
        found.push(bench.read(&watched, &outputs)?);
    }
    tell(bench, &rules::TWO, &expected, &found);
    Ok(())
}
