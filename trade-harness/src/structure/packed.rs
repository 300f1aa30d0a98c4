//! Our two FMUs as one system that other tools load: `relative-navigation.ssp`.
//!
//! The forms are those that every tool reads that the tests try: values are bound to components and not to systems, one set for each
//! component; what tools skip or refuse where it is an enumeration has its Integer twin; an input stands among the connectors only
//! where it is connected.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use fmi2_import::{BaseType, Causality, Fmu, ModelDescription, Variable};
use interface::annotation::Filters;
use ssp::{
    Binding, Component, Connection, Connector, DataType, End, Experiment, Kind, Package, Parameter, ParameterSet,
    SystemStructure, Unit, Value,
};
use study::{NAV, TRUTH, World, filters_of, worlds};

use crate::HarnessError;
use crate::output::write_whole;

/// Name of the file, beside the FMUs.
pub const SSP: &str = "relative-navigation.ssp";

/// Names of the elements: truth, then filter.
pub const ELEMENTS: [&str; 2] = ["truth", "nav"];

/// The filter that is bound where it has a meaning.
const RECOMMENDED: &str = "hybrid";

/// Puts two packed FMUs into one system.
///
/// * `folder`: where `fmu-truth.fmu` and `fmu-nav.fmu` are, and where the file goes.
/// * `mission`: the one that they were packed with; it is bound then, and `leo_venting` otherwise.
///
/// * returns: whether the file had to be written.
///
/// # Errors
/// Reading and writing; what [`Package::bytes`] says.
pub fn write(folder: &Path, mission: Option<&World>) -> Result<bool, HarnessError> {
    let [truth, nav] = [TRUTH, NAV].map(|name| Fmu::open(folder.join(format!("{name}.fmu"))));
    let (truth, nav) = (truth?, nav?);
    let filters = filters_of(nav.description())?;
    let mut worlds = worlds::all()?;
    if let Some(mission) = mission {
        // What an FMU was packed with goes before what comes with it under the same name.
        worlds.retain(|world| world.name != mission.name);
        worlds.insert(0, mission.clone());
    }
    let named = |world: &World| match mission {
        Some(mission) if mission.name == world.name => Named::Not,
        Some(_) => Named::Whole,
        None => Named::Number,
    };
    let models = [truth.description(), nav.description()];

    let mut files = BTreeMap::new();
    for (name, place) in [TRUTH, NAV].into_iter().zip(sources()) {
        let path = folder.join(format!("{name}.fmu"));
        files.insert(
            place,
            fs::read(&path).map_err(|source| HarnessError::Read { path, source })?,
        );
    }
    let mut choices = Vec::new();
    for world in &worlds {
        let filter = filter_of(world, &filters, nav.description());
        for (element, description) in ELEMENTS.into_iter().zip(models) {
            let set = values(world, named(world), &filter, description);
            files.insert(value_file(world, element), set.to_xml().into_bytes());
        }
        choices.push((world, filter));
    }
    files.insert(
        "documentation/README.txt".to_owned(),
        readme(&choices, nav.description()).into_bytes(),
    );

    let (bound, filter) = choices.first().ok_or(study::StudyError::NoFilter)?;
    let structure = structure(models, bound, named(bound), filter);
    let archive = Package::bytes(&structure, &files)?;
    let path = folder.join(SSP);
    let written = fs::read(&path).ok().as_ref() != Some(&archive);
    if written {
        write_whole(&path, &archive)?;
    }
    Ok(written)
}

/// Places of the FMUs in the archive.
fn sources() -> [String; 2] {
    [TRUTH, NAV].map(|name| format!("resources/{name}.fmu"))
}

/// Place of the values of a mission for an element.
fn value_file(world: &World, element: &str) -> String {
    format!("resources/{}_{element}.ssv", world.name)
}

/// The filter that a mission is bound with.
fn filter_of(world: &World, filters: &Filters, nav: &ModelDescription) -> String {
    let has = |name: &str| nav.items("filter").iter().any(|item| item.name == name);
    let meant = |name: &str| has(name) && filters.without_meaning(name, &world.name, world.frame.name()).is_none();
    let own = world.filters.iter().map(|choice| choice.name.as_str());
    let chosen = std::iter::once(RECOMMENDED).chain(own).find(|name| meant(name));
    chosen.unwrap_or(RECOMMENDED).to_owned()
}

/// How an FMU is told its mission.
#[derive(Debug, Clone, Copy)]
enum Named {
    /// Not at all: it was packed with it.
    Not,
    /// By its number where it has one.
    Number,
    /// By its name: in an FMU that was packed with a mission, the first number stands for that one.
    Whole,
}

/// What a mission sets in an FMU.
fn values(world: &World, named: Named, filter: &str, description: &ModelDescription) -> ParameterSet {
    let item = |variable: &str, name: &str| {
        let items = description.items(variable);
        items.iter().find(|item| item.name == name).map(|item| item.value)
    };
    let mut chosen = Vec::new();
    match (named, item("scenario", &world.name)) {
        (Named::Not, _) => {}
        (Named::Number, Some(number)) => chosen.push(("scenario_index", Value::Integer(number))),
        _ => chosen.push(("mission_file", Value::String(world.name.clone()))),
    }
    chosen.extend(item("filter", filter).map(|number| ("filter_index", Value::Integer(number))));
    chosen.extend([("study_seed", Value::Integer(1)), ("run", Value::Integer(0))]);
    let parameters = chosen.into_iter().filter_map(|(name, value)| {
        let variable = description.get(name)?;
        Some(Parameter {
            name: name.to_owned(),
            description: variable.description.clone(),
            value,
        })
    });
    ParameterSet {
        name: world.name.clone(),
        description: Some(world.about.clone()),
        parameters: parameters.collect(),
        units: Vec::new(),
    }
}

/// Components, the connections of equal names, and the times of the mission.
fn structure([truth, nav]: [&ModelDescription; 2], world: &World, named: Named, filter: &str) -> SystemStructure {
    let offered = |name: &str| truth.get(name).is_some_and(|v| v.causality == Causality::Output);
    let wires: Vec<&str> = nav
        .variables
        .iter()
        .filter(|v| v.causality == Causality::Input && offered(&v.name))
        .map(|v| v.name.as_str())
        .collect();
    let wired: BTreeSet<&str> = wires.iter().copied().collect();
    let mut structure = SystemStructure::new("relative_navigation");
    structure.description = Some(format!("{}; the filter is {filter}", world.about));
    structure.generation_tool = Some(format!("trade-harness {}", env!("CARGO_PKG_VERSION")));
    for ((element, description), source) in ELEMENTS.into_iter().zip([truth, nav]).zip(sources()) {
        let mut component = Component::new(element, &source);
        component.description.clone_from(&description.description);
        component.connectors = connectors(description, &wired);
        let set = values(world, named, filter, description);
        component.bindings.push(Binding::file(&value_file(world, element), set));
        structure.system.add(component);
    }
    let [from, to] = ELEMENTS;
    structure.system.connections = wires
        .iter()
        .map(|name| Connection::new(End::of(from, name), End::of(to, name)))
        .collect();
    structure.units = units([truth, nav], &structure);
    declared_only(&mut structure);
    structure.experiment = Some(Experiment {
        start_time: Some(0.0),
        stop_time: Some(world.duration_s),
        step_size: Some(world.sample_period_s),
    });
    structure
}

/// Outputs, and those inputs that are fed.
fn connectors(description: &ModelDescription, wired: &BTreeSet<&str>) -> Vec<Connector> {
    let connector = |variable: &Variable| {
        let kind = match variable.causality {
            Causality::Output => Kind::Output,
            Causality::Input if wired.contains(variable.name.as_str()) => Kind::Input,
            _ => return None,
        };
        let data = match variable.base_type() {
            BaseType::Real => DataType::Real {
                unit: variable.unit().map(str::to_owned),
            },
            BaseType::Integer => DataType::Integer,
            BaseType::Boolean => DataType::Boolean,
            // Its Integer twin stands beside it.
            BaseType::Enumeration | BaseType::String => return None,
        };
        Some(Connector::new(&variable.name, kind, data))
    };
    description.variables.iter().filter_map(connector).collect()
}

/// The units that connectors name, as the FMUs declare them.
fn units(models: [&ModelDescription; 2], structure: &SystemStructure) -> Vec<Unit> {
    let connectors = structure.system.elements.iter().flat_map(ssp::Element::connectors);
    let named: BTreeSet<&str> = connectors
        .filter_map(|connector| match &connector.data {
            Some(DataType::Real { unit }) => unit.as_deref(),
            _ => None,
        })
        .collect();
    let declared = |name: &&str| {
        let mut units = models.into_iter().flat_map(|model| &model.units);
        let base = units.find(|unit| unit.name == **name)?.base?;
        Some(Unit {
            name: (*name).to_owned(),
            base: ssp::BaseUnit {
                exponents: base.exponents,
                factor: base.factor,
                offset: base.offset,
            },
        })
    };
    named.iter().filter_map(declared).collect()
}

/// Leaves a unit away that no exponents of base units declare.
fn declared_only(structure: &mut SystemStructure) {
    let units = &structure.units;
    for element in &mut structure.system.elements {
        let ssp::Element::Component(component) = element else {
            continue;
        };
        for connector in &mut component.connectors {
            if let Some(DataType::Real { unit }) = &mut connector.data {
                unit.take_if(|name| units.iter().all(|known| known.name != *name));
            }
        }
    }
}

/// How to choose another mission or filter.
fn readme(choices: &[(&World, String)], nav: &ModelDescription) -> String {
    let mut text = "Relative navigation: a simulated world and a filter\n\
         ===================================================\n\n\
         Elements: truth (resources/fmu-truth.fmu) and nav (resources/fmu-nav.fmu). Every output of truth that nav reads is\n\
         connected to the input of the same name; no other input is connected, and none needs to be.\n\n\
         Another mission\n---------------\n\n\
         Each mission has two files of values, one for each element. SystemStructure.ssd binds those of the first; to fly\n\
         another, write its files into the attribute 'source' of both ssd:ParameterBinding. Length and step of a run are\n\
         suggested by ssd:DefaultExperiment for the mission that is bound.\n\n"
        .to_owned();
    for (world, filter) in choices {
        text.push_str(&format!(
            "  {name}\n    resources/{name}_truth.ssv, resources/{name}_nav.ssv\n    filter {filter}, {} s in steps of {} s\n",
            world.duration_s,
            world.sample_period_s,
            name = world.name,
        ));
    }
    text.push_str("\nAnother filter\n--------------\n\nfilter_index of nav chooses it:\n\n");
    for item in nav.items("filter").iter() {
        text.push_str(&format!("  {:>3}  {}\n", item.value, item.name));
    }
    text.push_str(
        "\nrun and study_seed choose the random streams, and must be the same for both elements, as must guidance.burn_enabled:\n\
         false leaves out the mission's own burns of the chaser. Any other parameter of an FMU can be added to its file of\n\
         values; documentation/index.html inside each FMU lists them.\n",
    );
    text
}
