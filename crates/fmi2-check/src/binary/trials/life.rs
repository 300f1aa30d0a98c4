//! A whole life: inquiries, instance, initialization, start values, steps, end.

use crate::binary::instance::{Bench, Instance};
use crate::binary::job::{Value, Variable};
use crate::binary::library::Library;
use crate::binary::run::Failed;
use crate::role::{Causality, Initial, Kind, Variability};
use crate::rules::binary as rules;

pub(super) fn life(bench: &Bench<'_>) -> Result<(), Failed> {
    let functions = &bench.loaded.functions;
    for (function, inquiry, expected, rule) in [
        ("fmi2GetVersion", functions.get_version, "2.0", &rules::VERSION),
        (
            "fmi2GetTypesPlatform",
            functions.get_types_platform,
            "default",
            &rules::PLATFORM,
        ),
    ] {
        bench.journal.calling(function);
        let answer = Library::inquire(inquiry);
        bench.look_round(function);
        if let Some(answer) = answer.filter(|answer| answer != expected) {
            bench
                .journal
                .found(rule, function, format!("it answers {answer:?} instead of {expected:?}"));
        }
    }
    let Some(instance) = Instance::usual(bench) else {
        if functions.instantiate.is_some() {
            let what = format!("it returned NULL{}", bench.last_words.borrow());
            bench.journal.found(&rules::INSTANTIATE, "fmi2Instantiate", what);
        }
        return Err(Failed);
    };
    bench.reach_initialization(&instance)?;
    starts(bench, &instance)?;
    bench.expect("fmi2ExitInitializationMode", instance.exit_initialization(), &instance)?;
    let outputs = bench.outputs();
    let mut told = vec![false; outputs.len()];
    for step in 0..=bench.job.steps {
        let values = bench.read(&instance, &outputs)?;
        for ((variable, value), told) in outputs.iter().zip(&values).zip(&mut told) {
            if !*told {
                *told = sound(bench, variable, value, bench.time(step));
            }
        }
        if step < bench.job.steps {
            bench.step(&instance, step)?;
        }
    }
    bench.expect("fmi2Terminate", instance.terminate(), &instance)?;
    // Whatever is logged with OK says that all is well.
    if let Some(message) = instance.sink.messages().iter().find(|message| message.status == 0) {
        let what = format!("with loggingOn false it logged: {}", message.text.trim_end());
        bench.journal.found(&rules::SILENT, "fmi2CallbackLogger", what);
    }
    Ok(())
}

/// Start values against what is read in initialization mode.
fn starts(bench: &Bench<'_>, instance: &Instance<'_>) -> Result<(), Failed> {
    let known = |v: &&Variable| {
        v.start.is_some()
            && v.causality != Causality::Independent
            && (matches!(v.causality, Causality::Input | Causality::Parameter)
                || v.initial == Some(Initial::Exact)
                || v.variability == Variability::Constant)
    };
    let variables: Vec<&Variable> = bench.job.variables.iter().filter(known).collect();
    let values = bench.read(instance, &variables)?;
    for (variable, value) in variables.into_iter().zip(values) {
        let Some(start) = variable.start_value() else { continue };
        let same = match (&start, &value) {
            (Value::Real(a), Value::Real(b)) => {
                let (a, b) = (f64::from_bits(*a), f64::from_bits(*b));
                a.total_cmp(&b).is_eq() || a - b == 0.0 || a.is_nan() && b.is_nan()
            }
            (Value::Boolean(a), Value::Boolean(b)) => (*a != 0) == (*b != 0),
            (start, value) => start == value,
        };
        if value == Value::Nothing {
            bench
                .journal
                .found(&rules::STRING, &variable.name, "fmi2GetString answers NULL");
        } else if !same {
            let what = format!("it is {} instead of {}", value.shown(), start.shown());
            bench.journal.found(&rules::START, &variable.name, what);
        }
    }
    Ok(())
}

/// Whether something was found of a value.
fn sound(bench: &Bench<'_>, variable: &Variable, value: &Value, time: f64) -> bool {
    let outside =
        |number: f64| variable.min.is_some_and(|min| number < min) || variable.max.is_some_and(|max| number > max);
    let (rule, what) = match value {
        Value::Real(bits) if !f64::from_bits(*bits).is_finite() => (&rules::FINITE, "is not finite"),
        Value::Real(bits) if outside(f64::from_bits(*bits)) => (&rules::RANGE, "lies outside min and max"),
        Value::Integer(number) if variable.items.as_ref().is_some_and(|items| !items.contains(number)) => {
            (&rules::ITEM, "is none of the items")
        }
        Value::Integer(number) if variable.kind == Kind::Integer && outside(f64::from(*number)) => {
            (&rules::RANGE, "lies outside min and max")
        }
        Value::Boolean(number) if ![0, 1].contains(number) => (&rules::BOOLEAN, "is neither 0 nor 1"),
        Value::Nothing => (&rules::STRING, "fmi2GetString answers it"),
        _ => return false,
    };
    let number = match value {
        Value::Boolean(number) => number.to_string(),
        other => other.shown(),
    };
    bench
        .journal
        .found(rule, &variable.name, format!("at {time} s it is {number}: {what}"));
    true
}
