//! The contract as documents: what `docs/INTERFACE.md` and `docs/MISSION.md` say is rendered from what the code says.

use std::fmt::Write;

use serde_json::{Map, Value};

use crate::mission::{EMBEDDED, Embedded, schema_value};
use crate::ports::{Kind, Port, Role, Shape, of};
use crate::status::Status;

/// The interface document: every port, its unit, shape and meaning, statuses and scenarios.
pub fn interface_document() -> String {
    let mut out = String::from(INTERFACE_HEAD);
    for (roles, title) in [
        (&[Role::Sensor][..], "From fmu-truth to fmu-nav"),
        (&[Role::Untold], "From fmu-truth to the bounds among fmu-nav's filters"),
        (
            &[Role::Command],
            "Into fmu-truth, and into fmu-nav where the filter shall know",
        ),
        (&[Role::Disturbance, Role::Attitude], "Into fmu-truth alone"),
        (&[Role::Truth], "From fmu-truth, for scoring"),
        (&[Role::Estimate], "From fmu-nav"),
    ] {
        let rows = roles
            .iter()
            .flat_map(|role| of(*role))
            .map(|port| vec![elements(port), kind(port), units(port), meaning(port)]);
        section(&mut out, title, &["name", "type", "unit", "meaning"], rows);
    }
    let rows = Status::ALL
        .iter()
        .map(|(status, name, about)| vec![status.number().to_string(), format!("`{name}`"), (*about).to_owned()]);
    section(&mut out, "Items of `status`", &["number", "name", "meaning"], rows);
    let scenarios = Embedded::scenarios().zip(1..).map(|(entry, number)| {
        let about = entry.mission().map(|m| m.about).unwrap_or_default();
        vec![number.to_string(), format!("`{}`", entry.name), about]
    });
    section(
        &mut out,
        "Items of `scenario`",
        &["number", "name", "mission"],
        scenarios,
    );
    out.push_str(INTERFACE_TAIL);
    out
}

const INTERFACE_HEAD: &str = "# Interface

Rendered from `crates/interface`; a test holds it to the code. Values are SI and radians. Axes `_n` are inertial; in a mission of the
three-body problem they are the rotating ones, with velocities relative to them. Vectors are `name[1]`, `name[2]`, ..., matrices
`name[1,1]`, row by row, with consecutive value references. **Equal names connect**: that is the whole wiring rule.

";

const INTERFACE_TAIL: &str = "## Rules

* Sample k of a sensor is taken k of its periods after the start time. `sample_count` counts the epochs at which any sensor samples;
  count 1 is the first, and the initial estimate holds at the start time.
* `due` and not `valid` is a dropout; an epoch at which no sensor that sees the target was due is no dropout.
* The filter acts once for each new `sample_count`, at `sample_time`, whatever the communication step: Gauss-Seidel and Jacobi masters
  get the same estimates, the latter one step later.
* An accelerometer reading with `accelerometer.mean` false is held over the step that follows; with true it is the mean over the
  time since the last reading, which the filter propagates with it. The direction cosine matrix is that of the epoch.
* A filter that is a bound reads `truth.dv_t_n` and `truth.event_time` and stops with an error where nobody says them; whatever stands
  there, any other filter's estimates are the same, bit for bit.
* Inputs take effect in `fmi2DoStep` only. What pushes a vehicle acts from the communication point at which it was set for as long as
  it stays: a pulse has its momentum at any phase of the truth's grid. All zero, they leave the samples as they are, bit for bit. What
  holds \"just after\" a time holds inputs as they stood over the step that ended there: the next ones are not known yet.
* A filter that is told of the commands (`a_cmd_c_n`, `impulse_c_n`, `impulse_count` connected to it too) propagates with them at their
  own times, and with what the accelerometer reads beyond them: from a reading is taken what was commanded while it was taken. In the
  LVLH frame commands need `dcm_lvlh_n`; without it they are left out, and the log says so. Truth and filter must get the same command
  in the same step: truth, filter, guidance is the order of a Gauss-Seidel master.
* `guidance.burn_enabled` = false leaves out the mission's own burns of the chaser. It is a parameter of both FMUs and must be the same
  in both: in fmu-truth no such burn acts, in finding the start neither; in fmu-nav no filter reckons with one that it is told of.
* `est.*` holds at `est.time`, the epoch of the last sample used; `pred.*` at `pred.time`, the end of the communication step.
  Both begin as `nav_init.x`. Where a prediction fails, `pred.*` is the estimate and `pred.time` is `est.time`.
* `scenario_index` and `filter_index` stand for the enumerations of the same items where they are not 0; `mission_file` goes before both.
* LiDAR axes: x_L = z_B, y_L = x_B, z_L = y_B. Camera angles are in the same axes; radio range rate is that of inertial space.
* Parameters that start at -1 mean \"the mission's own\".
";

/// The reference of the mission file: every key with its default and meaning.
pub fn mission_document() -> String {
    let mut out = String::from(MISSION_HEAD);
    let schema = schema_value();
    let definitions = schema
        .get("$defs")
        .and_then(Value::as_object)
        .cloned()
        .unwrap_or_default();
    table(&mut out, "Top level", &schema);
    for (name, definition) in &definitions {
        table(&mut out, &format!("`{name}`"), definition);
    }
    let names: Vec<String> = EMBEDDED.iter().map(|e| format!("`{}`", e.name)).collect();
    let _ = writeln!(out, "Missions that come with the FMUs: {}.", names.join(", "));
    out
}

const MISSION_HEAD: &str = "# The mission file

A mission is one TOML file: a world, what a filter is told of it, and how a study scores it. `trade-harness mission new NAME` writes
a commented one to start from, `mission check FILE` reads it, flies it without noise and shows what happens, `mission schema` prints
the JSON schema for editors. A key ends in its unit. Unknown keys are errors, and every problem is named with file, line and column.

Axes N are inertial: about the Earth its mean equator and equinox of date, about the Moon its own equator with x at the node on the
ICRF equator, about any other body what the file means by them. In the three-body problem they are the rotating ones, from the
barycentre, x to the smaller body, z along the orbital momentum. RTN: R along the position, N along the angular momentum, T completes;
LVLH are the same axes, turning with the orbit. `line_of_sight` points body y at the other vehicle, body z along the normal of the
relative motion (along the orbit's normal where there is none), and body x completes; LiDAR and camera look along body y.

A coefficient file is CSV: lines `mu_m3_s2 = ...` and `radius_m = ...`, the header `degree,order,c,s`, then fully normalised
coefficients, one row for each degree and order.

This reference is rendered from `crates/interface`; a test holds it to the code. Required keys have no default.

";

fn section(out: &mut String, title: &str, head: &[&str], rows: impl Iterator<Item = Vec<String>>) {
    let _ = writeln!(out, "## {title}\n");
    let _ = writeln!(out, "| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()));
    for row in rows {
        let _ = writeln!(out, "| {} |", row.join(" | "));
    }
    out.push('\n');
}

fn elements(port: &Port) -> String {
    match port.shape {
        Shape::Scalar => format!("`{}`", port.name),
        Shape::Vector(n) => format!("`{}[1..{n}]`", port.name),
        Shape::Matrix(rows, columns) => format!("`{}[1..{rows},1..{columns}]`", port.name),
    }
}

fn kind(port: &Port) -> String {
    match port.kind {
        Kind::Real => "Real".into(),
        Kind::Integer => "Integer".into(),
        Kind::Boolean => "Boolean".into(),
        Kind::String => "String".into(),
        Kind::Enumeration(name) => format!("enumeration `{name}`"),
    }
}

fn units(port: &Port) -> String {
    match port.shape {
        // Of a covariance.
        Shape::Matrix(..) if port.units.len() > 1 => "products of the states' units".into(),
        _ => port.units.join(", "),
    }
}

fn meaning(port: &Port) -> String {
    let each = port.about.len() == port.shape.len();
    match port.about {
        [one] => (*one).to_owned(),
        several => several
            .iter()
            .enumerate()
            .map(|(group, about)| match each {
                true => format!("{}: {about}", group + 1),
                false => format!("{} to {}: {about}", 3 * group + 1, 3 * group + 3),
            })
            .collect::<Vec<_>>()
            .join("; "),
    }
}

/// A definition of the schema as a table of its keys, or of its values.
fn table(out: &mut String, title: &str, definition: &Value) {
    let about = text(definition, "description");
    let required: Vec<&str> = list(definition, "required").iter().filter_map(Value::as_str).collect();
    let _ = writeln!(out, "## {title}\n");
    if !about.is_empty() && !title.starts_with("Top") {
        let _ = writeln!(out, "{about}\n");
    }
    if let Some(keys) = definition.get("properties").and_then(Value::as_object) {
        let _ = writeln!(out, "| key | value | default | meaning |\n|---|---|---|---|");
        for (key, property) in keys {
            let _ = writeln!(
                out,
                "| `{key}` | {} | {} | {} |",
                values(property),
                default(property, required.contains(&key.as_str())),
                text(property, "description").replace('\n', " ")
            );
        }
        out.push('\n');
    }
    for choice in choices(definition) {
        let _ = writeln!(
            out,
            "* {}: {}",
            values(choice),
            text(choice, "description").replace('\n', " ")
        );
    }
    if !choices(definition).is_empty() {
        out.push('\n');
    }
}

fn choices(definition: &Value) -> &[Value] {
    match list(definition, "oneOf") {
        [] => list(definition, "anyOf"),
        choices => choices,
    }
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn default(property: &Value, required: bool) -> String {
    match property.get("default") {
        _ if required => String::new(),
        None | Some(Value::Null) => "-".into(),
        Some(Value::Object(_)) => "its defaults".into(),
        Some(Value::Array(items)) if items.is_empty() => "none".into(),
        Some(value) => format!("`{value}`"),
    }
}

/// What a value looks like, in words.
fn values(property: &Value) -> String {
    if let Some(reference) = property.get("$ref").and_then(Value::as_str) {
        return format!("`{}`", reference.rsplit('/').next().unwrap_or(reference));
    }
    if let Some(constant) = property.get("const").and_then(Value::as_str) {
        return format!("`\"{constant}\"`");
    }
    let options: Vec<String> = choices(property)
        .iter()
        .filter(|choice| text(choice, "type") != "null")
        .map(values)
        .collect();
    if !options.is_empty() {
        return options.join(" or ");
    }
    if let Some(kinds) = property.get("type").and_then(Value::as_array) {
        let kinds: Vec<&str> = kinds
            .iter()
            .filter_map(Value::as_str)
            .filter(|k| *k != "null")
            .collect();
        let mut same: Map<String, Value> = property.as_object().cloned().unwrap_or_default();
        same.insert("type".into(), kinds.first().copied().unwrap_or_default().into());
        return values(&Value::Object(same));
    }
    match text(property, "type") {
        "array" => match (property.get("minItems").and_then(Value::as_u64), property.get("items")) {
            (Some(n), Some(item)) if property.get("maxItems").and_then(Value::as_u64) == Some(n) => {
                format!("{n} of {}", values(item))
            }
            (_, Some(item)) => format!("list of {}", values(item)),
            _ => "list".into(),
        },
        "object" => match property.get("properties").and_then(Value::as_object) {
            Some(keys) => {
                let keys: Vec<String> = keys
                    .iter()
                    .map(|(key, value)| format!("`{key}` = {}", values(value)))
                    .collect();
                format!("{{ {} }}", keys.join(", "))
            }
            None => "table".into(),
        },
        "string" => match list(property, "enum") {
            [] => "text".into(),
            names => names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(" or "),
        },
        "number" => "number".into(),
        "integer" => "whole number".into(),
        "boolean" => "true or false".into(),
        other => other.into(),
    }
}
