//! Driving an FMU by names, without a master: one instance with what is set on it, and its answers as bits.

use fmi2_import::{Causality, Experiment, Fmu, ImportError, Instance, Value};
use std::hash::{DefaultHasher, Hash, Hasher};

/// The default experiment's start, without a stop time.
pub const FROM_ZERO: Experiment = Experiment {
    start_time: 0.0,
    stop_time: None,
    tolerance: None,
};

/// Sets a variable of any type, unchecked on this side of the interface.
pub fn set(instance: &mut Instance, name: &str, value: &Value) -> Result<(), ImportError> {
    let reference = [instance.description().variable(name)?.value_reference];
    match value {
        Value::Real(v) => instance.set_real(&reference, &[*v]),
        Value::Integer(v) => instance.set_integer(&reference, &[*v]),
        Value::Boolean(v) => instance.set_boolean(&reference, &[*v]),
        Value::String(v) => instance.set_string(&reference, &[v]),
    }
}

/// Reads a variable of any type.
pub fn get(instance: &mut Instance, name: &str) -> Value {
    let variable = instance.description().variable(name).unwrap();
    let (reference, start) = ([variable.value_reference], variable.base_type());
    match start {
        fmi2_import::BaseType::Real => {
            let mut v = [0.0];
            instance.get_real(&reference, &mut v).unwrap();
            Value::Real(v[0])
        }
        fmi2_import::BaseType::Integer | fmi2_import::BaseType::Enumeration => {
            let mut v = [0];
            instance.get_integer(&reference, &mut v).unwrap();
            Value::Integer(v[0])
        }
        fmi2_import::BaseType::Boolean => {
            let mut v = [false];
            instance.get_boolean(&reference, &mut v).unwrap();
            Value::Boolean(v[0])
        }
        fmi2_import::BaseType::String => Value::String(instance.get_string(&reference).unwrap().remove(0)),
    }
}

/// Names of all variables of some causalities, in the order of the description.
pub fn names(fmu: &Fmu, causalities: &[Causality]) -> Vec<String> {
    let chosen = fmu
        .description()
        .variables
        .iter()
        .filter(|v| causalities.contains(&v.causality));
    chosen.map(|v| v.name.clone()).collect()
}

/// The values of variables as bits, so that NaN equals itself and 0 is not -0; of a text its hash.
pub fn bits(instance: &mut Instance, names: &[String]) -> Vec<u64> {
    let bit = |value| match value {
        Value::Real(v) => v.to_bits(),
        Value::Integer(v) => v as u64,
        Value::Boolean(v) => v.into(),
        Value::String(v) => {
            let mut hasher = DefaultHasher::new();
            v.hash(&mut hasher);
            hasher.finish()
        }
    };
    names.iter().map(|name| bit(get(instance, name))).collect()
}

/// Sets parameters, each from text, and goes through initialization.
pub fn initialise(instance: &mut Instance, parameters: &[(String, String)], experiment: &Experiment) {
    for (name, text) in parameters {
        let value = instance
            .description()
            .variable(name)
            .unwrap()
            .parse_value(text)
            .unwrap();
        set(instance, name, &value).unwrap();
    }
    instance.setup_experiment(experiment).unwrap();
    instance.enter_initialization().unwrap();
    instance.exit_initialization().unwrap();
}

/// Takes a step that must go well and without a warning.
pub fn step(instance: &mut Instance, t: f64, h: f64) {
    let outcome = instance.do_step(t, h).unwrap();
    assert_eq!(
        outcome,
        fmi2_import::Outcome::Ok,
        "t = {t}, h = {h}: {:?}",
        instance.messages()
    );
}
