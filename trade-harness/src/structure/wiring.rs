//! What a structure's connections come to in a study, where equal names connect: who plays which part, and what each calls the
//! quantities that cross between them.

use std::collections::{BTreeMap, BTreeSet};

use fmi2_import::{BaseType, Causality, ModelDescription, Variable, suggest};
use interface::ports::{self, Port, port};
use ssp::{BaseUnit, Connector, DataType, Flat, FlatConnection, Kind, Linear, NamedUnit, Way};
use study::{Mapping, did_you_mean};

/// An element, and what is wrong with it or with what leads there.
pub(super) type Problem = (String, String);

/// The part that a component plays in a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    World,
    Filter,
    Driver,
}

/// A component.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// Name of the element.
    pub(super) element: &'a str,
    /// Name in the study.
    pub(super) label: String,
    pub(super) description: &'a ModelDescription,
    pub(super) role: Role,
    /// What of its variables has another name here, by its own.
    pub(super) names: BTreeMap<String, String>,
}

impl Part<'_> {
    fn contract<'n>(&'n self, own: &'n str) -> &'n str {
        self.names.get(own).map_or(own, String::as_str)
    }

    fn of(&self, causality: Causality) -> impl Iterator<Item = &Variable> {
        self.description
            .variables
            .iter()
            .filter(move |v| v.causality == causality)
    }

    /// Its variable of a causality that has a name in the study.
    fn named(&self, causality: Causality, contract: &str) -> Option<&str> {
        let mut variables = self.of(causality).map(|v| v.name.as_str());
        variables.find(|own| self.contract(own) == contract)
    }

    fn problem(&self, text: String) -> Problem {
        (format!("component '{}'", self.element), text)
    }
}

/// The port of a name, of an element of a vector or not.
fn port_of(name: &str) -> Option<&'static Port> {
    port(name.split('[').next().unwrap_or(name))
}

/// Whether a name is one that truth and filters share.
fn is_shared(name: &str) -> bool {
    port_of(name).is_some()
}

/// Whether a name is that of a command, which a study tells a filter that asks for it.
fn is_announced(name: &str) -> bool {
    port_of(name).is_some_and(|port| port.role == ports::Role::Command)
}

/// The parts of a study, with their names for what crosses between them.
///
/// * `models`: of each component: its name in the study and its description.
/// * `mappings`: names that a command line gives.
///
/// # Errors
/// The first element that a study cannot represent.
pub(super) fn parts<'a>(
    flat: &'a Flat,
    models: &[(String, &'a ModelDescription)],
    mappings: &[Mapping],
) -> Result<Vec<Part<'a>>, Problem> {
    let mut parts = Vec::new();
    for (place, (component, (label, description))) in flat.components.iter().zip(models).enumerate() {
        let mut part = Part {
            element: &component.name,
            label: label.clone(),
            description,
            role: Role::Driver,
            names: given(label, description, mappings),
        };
        for connector in &component.connectors {
            fits(&part, connector)?;
        }
        // What the system offers under a shared name is that quantity, whatever its component calls it.
        for output in flat
            .outputs
            .iter()
            .filter(|output| output.at.0 == place && is_shared(&output.name))
        {
            rename(&mut part, &output.at.1, &output.name)?;
            let unit = named_unit(description, &output.at.1);
            let label = || format!("connector '{}' of the system", output.name);
            converts(&output.way, unit.as_ref(), output.unit.as_ref(), label)?;
        }
        let begins = |begin: &str| {
            part.of(Causality::Output)
                .any(|v| part.contract(&v.name).starts_with(begin))
        };
        part.role = match (begins("truth."), begins("est.")) {
            (true, true) => {
                let text = "has outputs truth.* and est.*, and would be world and filter; put them into two components";
                return Err(part.problem(text.to_owned()));
            }
            (true, false) => Role::World,
            (false, true) => Role::Filter,
            (false, false) => Role::Driver,
        };
        parts.push(part);
    }
    let worlds: Vec<&str> = parts
        .iter()
        .filter(|p| p.role == Role::World)
        .map(|p| p.element)
        .collect();
    if worlds.len() != 1 {
        let found = if worlds.is_empty() {
            "no component has".to_owned()
        } else {
            format!("{} have", worlds.join(", "))
        };
        let text = format!(
            "{found} outputs truth.*; a study needs one world, told by these names, or by connectors of the system or --map"
        );
        return Err(("the system".to_owned(), text));
    }
    // What a filter is told of a command goes by the name that the world has for it.
    let told = |c: &&FlatConnection| (parts[c.from.0].role, parts[c.to.0].role) == (Role::Driver, Role::Filter);
    let (told, others): (Vec<_>, Vec<_>) = flat.connections.iter().partition(told);
    for connection in others.into_iter().chain(told) {
        connect(&mut parts, connection)?;
    }
    parts.iter().try_for_each(distinct)?;
    for connection in &flat.connections {
        let ((from, output), (to, input)) = (&connection.from, &connection.to);
        let (giver, taker) = (&parts[*from], &parts[*to]);
        let units = [(giver, output), (taker, input)].map(|(part, name)| named_unit(part.description, name));
        let [given, taken] = units.each_ref().map(Option::as_ref);
        converts(&connection.way, given, taken, || label(giver, output, taker, input))?;
    }
    complete(flat, &parts)?;
    Ok(parts)
}

/// What a command line says of the names of an FMU, by scalar.
fn given(label: &str, description: &ModelDescription, mappings: &[Mapping]) -> BTreeMap<String, String> {
    let mut names = BTreeMap::new();
    for mapping in mappings.iter().filter(|mapping| mapping.model == label) {
        for variable in &description.variables {
            let indices = variable.name.strip_prefix(&mapping.own);
            if let Some(indices) = indices.filter(|rest| rest.is_empty() || rest.starts_with('[')) {
                names.insert(variable.name.clone(), format!("{}{indices}", mapping.contract));
            }
        }
    }
    names
}

fn rename(part: &mut Part<'_>, own: &str, contract: &str) -> Result<(), Problem> {
    match part.names.get(own) {
        Some(other) if other != contract => {
            let text =
                format!("'{own}' would stand for {other} and for {contract}; a study has one name for a quantity");
            Err(part.problem(text))
        }
        _ if own == contract => Ok(()),
        _ => {
            part.names.insert(own.to_owned(), contract.to_owned());
            Ok(())
        }
    }
}

/// Checks that no two variables of a component stand for one quantity, as where one output feeds two of its inputs.
fn distinct(part: &Part<'_>) -> Result<(), Problem> {
    let mut known = BTreeMap::new();
    for variable in &part.description.variables {
        let name = part.contract(&variable.name);
        if let Some(other) = known.insert(name, &variable.name) {
            let text = format!(
                "'{other}' and '{}' would both stand for {name}; a study feeds one input of a component with it, leave one \
                 connection away",
                variable.name
            );
            return Err(part.problem(text));
        }
    }
    Ok(())
}

/// Checks a connector against the variable of its name.
fn fits(part: &Part<'_>, connector: &Connector) -> Result<(), Problem> {
    // What is not read is not connected, and is nothing to a study; it may be no variable at all.
    if matches!(connector.data, Some(DataType::Other(_))) {
        return Ok(());
    }
    let wrong = |text: String| Err((format!("connector '{}.{}'", part.element, connector.name), text));
    let Some(variable) = part.description.get(&connector.name) else {
        let names = part.description.variables.iter().map(|v| v.name.as_str());
        let meant = suggest(&connector.name, names);
        let model = &part.description.model_name;
        return wrong(format!(
            "{model} has no variable of this name{}",
            did_you_mean(meant.as_deref())
        ));
    };
    let causality = match connector.kind {
        Kind::Input => Causality::Input,
        Kind::Output => Causality::Output,
        Kind::Parameter => Causality::Parameter,
        Kind::CalculatedParameter => Causality::CalculatedParameter,
    };
    if variable.causality != causality {
        return wrong(format!(
            "is of kind {}, and the variable is of causality {}",
            connector.kind.name(),
            variable.causality
        ));
    }
    let Some(data) = &connector.data else { return Ok(()) };
    let same = matches!(
        (data, variable.base_type()),
        (DataType::Real { .. }, BaseType::Real)
            | (DataType::Boolean, BaseType::Boolean)
            | (
                DataType::Integer | DataType::Enumeration(_),
                BaseType::Integer | BaseType::Enumeration
            )
            | (DataType::String, BaseType::String)
    );
    if !same {
        return wrong(format!(
            "is {}, and the variable is {}",
            data.name(),
            variable.base_type()
        ));
    }
    if let (DataType::Real { unit: Some(unit) }, Some(own)) = (data, variable.unit())
        && unit != own
    {
        return wrong(format!(
            "is in '{unit}', and the variable is in '{own}'; say the same unit"
        ));
    }
    Ok(())
}

/// Gives both ends of a connection one name, if a study has such a connection at all.
fn connect(parts: &mut [Part<'_>], connection: &FlatConnection) -> Result<(), Problem> {
    let ((from, output), (to, input)) = (&connection.from, &connection.to);
    let (giver, taker) = (&parts[*from], &parts[*to]);
    let label = label(giver, output, taker, input);
    let (own, theirs) = (giver.contract(output), taker.contract(input));
    let shared = if is_shared(theirs) && !is_shared(own) {
        theirs
    } else {
        own
    };
    let shared = shared.to_owned();
    let why = match (giver.role, taker.role) {
        (Role::World, _) | (Role::Filter, Role::Driver) | (Role::Driver, Role::World) => None,
        (Role::Driver, Role::Filter) if is_announced(&shared) => None,
        (Role::Filter, Role::World) => {
            Some("in a study a filter acts on the world through a driver alone; put one between them".to_owned())
        }
        (Role::Driver, Role::Filter) => {
            let commands: Vec<&str> = ports::of(ports::Role::Command).map(|port| port.name).collect();
            Some(format!(
                "in a study a driver tells a filter no more than the commands that the world has from it, {}; take the connection away",
                commands.join(", ")
            ))
        }
        (Role::Filter, Role::Filter) => Some("in a study no filter feeds another; take the connection away".to_owned()),
        (Role::Driver, Role::Driver) => Some("in a study no driver feeds another; put them into one FMU".to_owned()),
    };
    if let Some(why) = why {
        return Err((label, why));
    }
    rename(&mut parts[*from], output, &shared)?;
    rename(&mut parts[*to], input, &shared)
}

fn label(giver: &Part<'_>, output: &str, taker: &Part<'_>, input: &str) -> String {
    format!(
        "connection from {}.{output} to {}.{input}",
        giver.element, taker.element
    )
}

/// The unit of a variable.
pub(super) fn named_unit(description: &ModelDescription, variable: &str) -> Option<NamedUnit> {
    let name = description.get(variable)?.unit()?;
    let declared = description.units.iter().find(|unit| unit.name == name);
    Some(NamedUnit {
        name: name.to_owned(),
        base: declared.and_then(|unit| unit.base).map(|base| BaseUnit {
            exponents: base.exponents,
            factor: base.factor,
            offset: base.offset,
        }),
    })
}

/// Checks that what a structure makes of values is what follows from the units of both ends, which is what a study does.
fn converts(
    way: &Way,
    from: Option<&NamedUnit>,
    to: Option<&NamedUnit>,
    label: impl Fn() -> String,
) -> Result<(), Problem> {
    // Whether these units go together is for the study to say.
    if way.is_bare() {
        return Ok(());
    }
    let given = way.linear(from, to).map_err(|error| (label(), error.to_string()))?;
    let told = match (from, to) {
        (Some(from), Some(to)) => from.to(to).unwrap_or(Linear::NONE),
        _ => Linear::NONE,
    };
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    if close(told.factor, given.factor) && close(told.offset, given.offset) {
        return Ok(());
    }
    let text = format!(
        "factor {} and offset {}, conversions of units among them, do not follow from the units of the two variables, and a study \
         converts by units alone; declare them in the FMUs, and set suppressUnitConversion where a factor stands for them",
        given.factor, given.offset
    );
    Err((label(), text))
}

/// Checks that nothing is left open that a study connects, since its names are equal.
fn complete(flat: &Flat, parts: &[Part<'_>]) -> Result<(), Problem> {
    let ends = flat.connections.iter();
    let made: BTreeSet<[(usize, &str); 2]> = ends
        .map(|c| [(c.from.0, c.from.1.as_str()), (c.to.0, c.to.1.as_str())])
        .collect();
    let connects = |giver: Role, taker: Role, name: &str| match (giver, taker) {
        // A bound alone is fed the truth, by the study.
        (Role::World, Role::Filter) => !name.starts_with("truth."),
        (Role::World, Role::Driver) | (Role::Filter, Role::Driver) | (Role::Driver, Role::World) => true,
        (Role::Driver, Role::Filter) => is_announced(name),
        _ => false,
    };
    for (to, taker) in parts.iter().enumerate() {
        for (from, giver) in parts.iter().enumerate() {
            let missing = taker.of(Causality::Input).find_map(|input| {
                let name = taker.contract(&input.name);
                let output = giver.named(Causality::Output, name)?;
                let made = made.contains(&[(from, output), (to, input.name.as_str())]);
                (!made && connects(giver.role, taker.role, name)).then_some((output, &input.name))
            });
            if let Some((output, input)) = missing {
                let text = format!(
                    "nothing feeds it, and a study would, from {}.{output}; connect them, or give one of them another name",
                    giver.element
                );
                return Err((format!("input '{}.{input}'", taker.element), text));
            }
        }
    }
    Ok(())
}
