//! Nested systems as one: components, what leads from output to input, and values.

use std::collections::BTreeMap;

use crate::SspError;
use crate::model::{
    BaseUnit, Binding, Component, Connection, Connector, DataType, Element, End, Experiment, Kind, Linear, System,
    SystemStructure, Unit, Value,
};
use crate::parameters::{Given, given};
use crate::way::{NamedUnit, Stop, Way};

/// A structure without systems inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Flat {
    /// Every component, in the order of the file.
    pub components: Vec<FlatComponent>,
    /// What feeds inputs and parameters of components.
    pub connections: Vec<FlatConnection>,
    /// Inputs and parameters of the system at the top, and the inputs of components that they lead to.
    pub inputs: Vec<FlatPort>,
    /// Outputs of the system at the top, and the outputs of components that lead to them.
    pub outputs: Vec<FlatPort>,
    /// Times of a run.
    pub experiment: Option<Experiment>,
}

/// A component.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatComponent {
    /// Its name with those of the systems that it is in, as `sub.filter`.
    pub name: String,
    /// Where its file is.
    pub source: String,
    /// Media type of that file.
    pub media_type: String,
    /// Its connectors.
    pub connectors: Vec<Connector>,
    /// What its bindings and those of its systems give it; outer systems go before inner ones, later bindings before earlier ones.
    pub parameters: Vec<FlatParameter>,
}

/// A value of a component.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatParameter {
    /// Name of the variable.
    pub name: String,
    /// Value, as it is given; [`Self::in_unit`] is what the variable takes.
    pub value: Value,
    /// What its unit comes to, where that is said.
    pub base: Option<BaseUnit>,
    /// What mappings and connections make of it.
    pub way: Way,
    /// The binding that gives it, for messages.
    pub by: String,
}

impl FlatParameter {
    /// The value as its variable takes it.
    ///
    /// * `unit`: of the variable, where it has one.
    ///
    /// # Errors
    /// [`SspError::Units`].
    pub fn in_unit(&self, unit: Option<&NamedUnit>) -> Result<Value, SspError> {
        let Value::Real(value, own) = &self.value else {
            return Ok(self.value.clone());
        };
        let own = own.as_ref().map(|name| NamedUnit {
            name: name.clone(),
            base: self.base,
        });
        let linear = self.way.linear(own.as_ref(), unit)?;
        let value = if linear == Linear::NONE {
            *value
        } else {
            linear.apply(*value)
        };
        Ok(Value::Real(value, unit.map(|unit| unit.name.clone())))
    }
}

/// What feeds an input.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatConnection {
    /// Component that gives, by its place, and its connector.
    pub from: (usize, String),
    /// Component that takes.
    pub to: (usize, String),
    /// What becomes of values.
    pub way: Way,
}

/// A connector of the system at the top, and that of a component behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatPort {
    /// Name in the system.
    pub name: String,
    /// Component, by its place, and its connector.
    pub at: (usize, String),
    /// Its unit, where it says one.
    pub unit: Option<NamedUnit>,
    /// What becomes of values between the two.
    pub way: Way,
}

/// Takes the systems of a structure apart.
///
/// # Errors
/// [`SspError::Structure`]: elements and connectors that are not there, connections between two outputs or two inputs, of different
/// types or in circles, inputs with two sources, values for nobody.
pub fn flatten(structure: &SystemStructure) -> Result<Flat, SspError> {
    let mut walk = Walk {
        units: &structure.units,
        components: Vec::new(),
        places: BTreeMap::new(),
        wires: BTreeMap::new(),
        stops: BTreeMap::new(),
        held: BTreeMap::new(),
    };
    walk.system("", &structure.system)?;
    walk.finish(&structure.system, structure.experiment)
}

/// A connector by the full name of its element and its own; the element of the system at the top has no name.
type Port = (String, String);

struct Walk<'a> {
    units: &'a [Unit],
    components: Vec<FlatComponent>,
    /// Places of components by full name.
    places: BTreeMap<String, usize>,
    /// Source of what takes values.
    wires: BTreeMap<Port, (Port, Way)>,
    /// Units of connectors of systems.
    stops: BTreeMap<Port, Stop>,
    /// Values of connectors of systems.
    held: BTreeMap<Port, Given>,
}

/// Connectors of systems that values pass on their way, at most.
const LONGEST_WAY: usize = 1000;

/// Longest name of an element with those of its systems, bytes.
const LONGEST_NAME: usize = 2000;

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}

fn shown((element, connector): &Port) -> String {
    joined(element, connector)
}

impl Walk<'_> {
    fn system(&mut self, path: &str, system: &System) -> Result<(), SspError> {
        for connector in &system.connectors {
            let stop = match &connector.data {
                Some(DataType::Real { unit: Some(name) }) => Stop::Unit(NamedUnit {
                    name: name.clone(),
                    base: self.units.iter().find(|unit| unit.name == *name).map(|unit| unit.base),
                }),
                // That of what it is connected to inside.
                _ if connector.kind.takes() => Stop::After,
                _ => Stop::Before,
            };
            self.stops.insert((path.to_owned(), connector.name.clone()), stop);
        }
        for element in &system.elements {
            let name = joined(path, element.name());
            if name.len() > LONGEST_NAME {
                let problem = format!("its name is longer than {LONGEST_NAME} bytes, with those of its systems");
                return Err(SspError::structure(format!("element '{}'", element.name()), problem));
            }
            match element {
                Element::Component(component) => self.component(&name, component)?,
                Element::System(inner) => self.system(&name, inner)?,
            }
        }
        for connection in &system.connections {
            self.connect(path, system, connection)?;
        }
        for binding in &system.bindings {
            self.bind(path, system, binding)?;
        }
        Ok(())
    }

    fn component(&mut self, name: &str, component: &Component) -> Result<(), SspError> {
        let place = self.components.len();
        if self.places.insert(name.to_owned(), place).is_some() {
            return Err(SspError::structure(
                format!("component '{name}'"),
                "stands there twice, once inside a system; rename one of them",
            ));
        }
        self.components.push(FlatComponent {
            name: name.to_owned(),
            source: component.source.clone(),
            media_type: component.media_type.clone(),
            connectors: component.connectors.clone(),
            parameters: Vec::new(),
        });
        for binding in &component.bindings {
            for value in given(&format!("component '{name}'"), binding, self.units)? {
                self.give(place, value);
            }
        }
        Ok(())
    }

    /// A value of a component; it replaces an earlier one.
    fn give(&mut self, place: usize, value: Given) {
        let Given {
            name,
            value,
            base,
            way,
            by,
        } = value;
        let parameters = &mut self.components[place].parameters;
        parameters.retain(|parameter| parameter.name != name);
        parameters.push(FlatParameter {
            name,
            value,
            base,
            way,
            by,
        });
    }

    fn bind(&mut self, path: &str, system: &System, binding: &Binding) -> Result<(), SspError> {
        for value in given(&format!("system '{}'", system.name), binding, self.units)? {
            self.deliver(path, system, value.name.clone(), value)?;
        }
        Ok(())
    }

    /// Brings a value from a system to whom its name means.
    fn deliver(&mut self, path: &str, system: &System, name: String, value: Given) -> Result<(), SspError> {
        if let Some(own) = system.connectors.iter().find(|c| c.name == name) {
            if own.kind.takes() {
                self.held.insert((path.to_owned(), name), value);
                return Ok(());
            }
            let problem = format!("'{name}' is an {} of the system and takes no value", own.kind.name());
            return Err(SspError::structure(value.by, problem));
        }
        for element in &system.elements {
            let rest = name
                .strip_prefix(element.name())
                .and_then(|rest| rest.strip_prefix('.'));
            let Some(rest) = rest else { continue };
            let inner = joined(path, element.name());
            match element {
                Element::System(system) => return self.deliver(&inner, system, rest.to_owned(), value),
                Element::Component(_) => {
                    let value = Given {
                        name: rest.to_owned(),
                        ..value
                    };
                    if let Some(place) = self.places.get(&inner).copied() {
                        self.give(place, value);
                    }
                    return Ok(());
                }
            }
        }
        let elements: Vec<&str> = system.elements.iter().map(Element::name).collect();
        let problem = format!(
            "'{name}' is no connector of the system and begins with no element of it; there are {}",
            elements.join(", ")
        );
        Err(SspError::structure(value.by, problem))
    }

    fn connect(&mut self, path: &str, system: &System, connection: &Connection) -> Result<(), SspError> {
        let label = format!("connection from {} to {}", connection.start, connection.end);
        let wrong = |problem: String| {
            let place = if path.is_empty() {
                String::new()
            } else {
                format!(" in system '{path}'")
            };
            SspError::structure(format!("{label}{place}"), problem)
        };
        let ends = [&connection.start, &connection.end].map(|end| locate(path, system, end).map_err(&wrong));
        let [start, end] = ends;
        let (start, end) = (start?, end?);
        let (from, to) = match (start.gives, end.gives) {
            (true, false) => (start, end),
            // Ends have no order where connectors have a direction.
            (false, true) => (end, start),
            (true, true) => return Err(wrong("both ends give values; connect an output to an input".to_owned())),
            (false, false) => return Err(wrong("both ends take values; connect an output to an input".to_owned())),
        };
        for end in [&from, &to] {
            if let Some(DataType::Other(other)) = &end.connector.data {
                let problem = format!(
                    "type {} of {} is not read; connect Real, Integer, Boolean, String or Enumeration",
                    other.name,
                    shown(&end.port)
                );
                return Err(wrong(problem));
            }
        }
        if let (Some(one), Some(other)) = (&from.connector.data, &to.connector.data)
            && one.name() != other.name()
        {
            let problem = format!(
                "the types differ: {} and {}; give both ends one type",
                one.name(),
                other.name()
            );
            return Err(wrong(problem));
        }
        let real = |data: &Option<DataType>| data.as_ref().is_none_or(|data| data.name() == "Real");
        if connection.transformation.is_some() && !real(&from.connector.data) {
            return Err(wrong("only values of type Real can be transformed".to_owned()));
        }
        let way = Way::hop(connection.transformation, connection.suppress_unit_conversion);
        let source = from.port.clone();
        if let Some((earlier, _)) = self.wires.insert(to.port, (from.port, way)) {
            let problem = format!(
                "the input is fed twice, by {} and by {}",
                shown(&earlier),
                shown(&source)
            );
            return Err(wrong(problem));
        }
        Ok(())
    }

    /// Where the values of a connector come from, and what becomes of them.
    fn origin(&self, port: &Port, (source, way): &(Port, Way)) -> Result<(Port, Way), SspError> {
        let (mut at, mut way) = (source.clone(), way.clone());
        // Each connector is passed once at most.
        for _ in 0..=self.wires.len().min(LONGEST_WAY) {
            let Some((source, step)) = self.wires.get(&at) else {
                return Ok((at, way));
            };
            way = step.clone().then(self.stop(&at), way);
            at = source.clone();
        }
        Err(SspError::structure(
            format!("connector {}", shown(port)),
            "is fed by itself through connectors of systems, or through too many; take one of these connections away",
        ))
    }

    fn stop(&self, port: &Port) -> Stop {
        self.stops.get(port).cloned().unwrap_or(Stop::Before)
    }

    /// The unit that a connector of a system says.
    fn unit(&self, port: &Port) -> Option<NamedUnit> {
        match self.stops.get(port) {
            Some(Stop::Unit(unit)) => Some(unit.clone()),
            _ => None,
        }
    }

    fn finish(mut self, system: &System, experiment: Option<Experiment>) -> Result<Flat, SspError> {
        let (mut connections, mut inputs, mut outputs) = (Vec::new(), Vec::new(), Vec::new());
        let wires = self.wires.iter();
        let wires: Vec<(Port, (Port, Way))> = wires
            .map(|(port, wire)| Ok((port.clone(), self.origin(port, wire)?)))
            .collect::<Result<_, SspError>>()?;
        for (port, (source, way)) in wires {
            let taker = self.places.get(&port.0).copied();
            let giver = self.places.get(&source.0).copied();
            match (giver, taker) {
                (Some(from), Some(to)) => connections.push(FlatConnection {
                    from: (from, source.1),
                    to: (to, port.1),
                    way,
                }),
                (Some(from), None) if port.0.is_empty() => outputs.push(FlatPort {
                    unit: self.unit(&port),
                    name: port.1,
                    at: (from, source.1),
                    way,
                }),
                (None, Some(to)) => {
                    if let Some(value) = self.held.get(&source) {
                        let value = value.through(self.stop(&source), &way, &port.1)?;
                        self.give(to, value);
                    }
                    if source.0.is_empty() {
                        inputs.push(FlatPort {
                            unit: self.unit(&source),
                            name: source.1,
                            at: (to, port.1),
                            way,
                        });
                    }
                }
                _ => {}
            }
        }
        // In the order of the file rather than of names.
        let order = |port: &FlatPort| system.connectors.iter().position(|c| c.name == port.name);
        inputs.sort_by_key(order);
        outputs.sort_by_key(order);
        connections.sort_by_key(|connection: &FlatConnection| connection.to.0);
        Ok(Flat {
            components: self.components,
            connections,
            inputs,
            outputs,
            experiment,
        })
    }
}

/// An end of a connection.
struct Located<'a> {
    port: Port,
    connector: &'a Connector,
    /// Whether values come from it.
    gives: bool,
}

/// An end in the structure.
fn locate<'a>(path: &str, system: &'a System, end: &End) -> Result<Located<'a>, String> {
    let (owner, connectors, what) = match &end.element {
        None => (path.to_owned(), system.connectors.as_slice(), "the system".to_owned()),
        Some(name) => {
            let element = system.elements.iter().find(|element| element.name() == name);
            let element = element.ok_or_else(|| {
                let known: Vec<&str> = system.elements.iter().map(Element::name).collect();
                format!("there is no element '{name}'; there are {}", known.join(", "))
            })?;
            (joined(path, name), element.connectors(), format!("element '{name}'"))
        }
    };
    let connector = connectors.iter().find(|c| c.name == end.connector);
    let connector = connector.ok_or_else(|| format!("{what} has no connector '{}'; list it there", end.connector))?;
    let outward = matches!(connector.kind, Kind::Output | Kind::CalculatedParameter);
    Ok(Located {
        port: (owner, end.connector.clone()),
        connector,
        // What a system takes from outside it gives inside.
        gives: outward == end.element.is_some(),
    })
}
