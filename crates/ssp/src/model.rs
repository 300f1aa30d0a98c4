//! A system structure as values.

use std::fmt;

/// Media type of a component that is an FMU.
pub const FMU: &str = "application/x-fmu-sharedlibrary";

/// The contents of an `.ssd` file, with the values of the `.ssv` and `.ssm` files that it names.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemStructure {
    /// Name of the structure.
    pub name: String,
    /// What it is, for people.
    pub description: Option<String>,
    /// Tool that wrote it.
    pub generation_tool: Option<String>,
    /// The system at the top.
    pub system: System,
    /// Units that connectors and values name.
    pub units: Vec<Unit>,
    /// Times of a run that makes sense.
    pub experiment: Option<Experiment>,
}

impl SystemStructure {
    /// A structure whose system is empty and has the same name.
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            description: None,
            generation_tool: None,
            system: System {
                name: name.to_owned(),
                ..System::default()
            },
            units: Vec::new(),
            experiment: None,
        }
    }
}

/// Times of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Experiment {
    /// Start, s.
    pub start_time: Option<f64>,
    /// End, s.
    pub stop_time: Option<f64>,
    /// Communication step, s. The standard has no place for it; it stands in an annotation that the Open Simulation Platform's tools
    /// read.
    pub step_size: Option<f64>,
}

/// A system: elements, and what connects them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct System {
    /// Name.
    pub name: String,
    /// Connectors to the outside.
    pub connectors: Vec<Connector>,
    /// Components and systems inside.
    pub elements: Vec<Element>,
    /// Connections between them and with the own connectors.
    pub connections: Vec<Connection>,
    /// Parameters.
    pub bindings: Vec<Binding>,
}

impl System {
    /// Adds a component.
    pub fn add(&mut self, component: Component) {
        self.elements.push(Element::Component(component));
    }
}

/// An element of a system.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// A component.
    Component(Component),
    /// A system inside.
    System(System),
}

impl Element {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Component(component) => &component.name,
            Self::System(system) => &system.name,
        }
    }

    /// Its connectors.
    pub fn connectors(&self) -> &[Connector] {
        match self {
            Self::Component(component) => &component.connectors,
            Self::System(system) => &system.connectors,
        }
    }
}

/// A component.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Name.
    pub name: String,
    /// What it is, for people.
    pub description: Option<String>,
    /// Where its file is: a URI, relative to the `.ssd` file.
    pub source: String,
    /// Media type; [`FMU`] where none is said.
    pub media_type: String,
    /// Connectors by the names of the FMU's variables.
    pub connectors: Vec<Connector>,
    /// Parameters.
    pub bindings: Vec<Binding>,
}

impl Component {
    /// An FMU without connectors.
    pub fn new(name: &str, source: &str) -> Self {
        Self {
            name: name.to_owned(),
            description: None,
            source: source.to_owned(),
            media_type: FMU.to_owned(),
            connectors: Vec::new(),
            bindings: Vec::new(),
        }
    }

    /// The same with one connector more.
    #[must_use]
    pub fn with(mut self, connector: Connector) -> Self {
        self.connectors.push(connector);
        self
    }
}

/// A connector.
#[derive(Debug, Clone, PartialEq)]
pub struct Connector {
    /// Name.
    pub name: String,
    /// Direction.
    pub kind: Kind,
    /// Type; `None` where it is left to the component's file.
    pub data: Option<DataType>,
}

impl Connector {
    /// A connector of a type.
    pub fn new(name: &str, kind: Kind, data: DataType) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            data: Some(data),
        }
    }
}

/// Direction of a connector, seen from its element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Takes values at every step.
    Input,
    /// Gives values at every step.
    Output,
    /// Takes a value before the start.
    Parameter,
    /// Gives a value that was calculated from parameters.
    CalculatedParameter,
}

impl Kind {
    pub(crate) const ALL: [(Self, &'static str); 4] = [
        (Self::Input, "input"),
        (Self::Output, "output"),
        (Self::Parameter, "parameter"),
        (Self::CalculatedParameter, "calculatedParameter"),
    ];

    /// As in a file.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(kind, _)| *kind == self)
            .map_or("", |(_, name)| name)
    }

    /// Whether it takes values.
    pub fn takes(self) -> bool {
        matches!(self, Self::Input | Self::Parameter)
    }
}

/// Type of a connector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DataType {
    /// A real number.
    Real {
        /// Its unit.
        unit: Option<String>,
    },
    /// A whole number.
    Integer,
    /// A truth value.
    Boolean,
    /// Text.
    String,
    /// An item of an enumeration of this name.
    Enumeration(String),
    /// Another type, as Binary, which is kept and cannot be connected.
    Other(Other),
}

/// What is not read, by its name in a file, as `Binary`, and its attributes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Other {
    /// Name.
    pub name: String,
    /// Names and values of its attributes.
    pub attributes: Vec<(String, String)>,
}

impl DataType {
    /// As in a file.
    pub fn name(&self) -> &str {
        match self {
            Self::Real { .. } => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::String => "String",
            Self::Enumeration(_) => "Enumeration",
            Self::Other(other) => &other.name,
        }
    }
}

/// One end of a connection: a connector of an element, or of the system itself.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct End {
    /// Name of the element; `None` for the system.
    pub element: Option<String>,
    /// Name of the connector.
    pub connector: String,
}

impl End {
    /// A connector of an element.
    pub fn of(element: &str, connector: &str) -> Self {
        Self {
            element: Some(element.to_owned()),
            connector: connector.to_owned(),
        }
    }

    /// A connector of the system.
    pub fn system(connector: &str) -> Self {
        Self {
            element: None,
            connector: connector.to_owned(),
        }
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.element {
            Some(element) => write!(f, "{element}.{}", self.connector),
            None => write!(f, "{}", self.connector),
        }
    }
}

/// A connection. Which end gives and which takes is told by the connectors.
#[derive(Debug, Clone, PartialEq)]
pub struct Connection {
    /// One end.
    pub start: End,
    /// The other.
    pub end: End,
    /// What becomes of values on their way, after their unit was converted.
    pub transformation: Option<Linear>,
    /// Whether units are not converted: the transformation stands for that.
    pub suppress_unit_conversion: bool,
}

impl Connection {
    /// A connection that changes no value.
    pub fn new(start: End, end: End) -> Self {
        Self {
            start,
            end,
            transformation: None,
            suppress_unit_conversion: false,
        }
    }
}

/// `factor * value + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl Linear {
    /// What changes nothing.
    pub const NONE: Self = Self {
        factor: 1.0,
        offset: 0.0,
    };

    /// A value after it.
    pub fn apply(self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// Both, this one first.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self {
            factor: next.factor * self.factor,
            offset: next.factor * self.offset + next.offset,
        }
    }
}

/// Values for the parameters of an element.
#[derive(Debug, Clone, PartialEq)]
pub struct Binding {
    /// File that holds the values, a URI relative to the `.ssd` file; `None` where they stand in the structure.
    pub source: Option<String>,
    /// Begins the names of parameters that are meant.
    pub prefix: String,
    /// The values.
    pub values: ParameterSet,
    /// Which parameter stands for which; `None`: each for that of its name.
    pub mapping: Option<Vec<MappingEntry>>,
}

impl Binding {
    /// Values from a file of the archive.
    pub fn file(source: &str, values: ParameterSet) -> Self {
        Self {
            source: Some(source.to_owned()),
            prefix: String::new(),
            values,
            mapping: None,
        }
    }
}

/// A row of a parameter mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct MappingEntry {
    /// Name among the values.
    pub source: String,
    /// Name in the element.
    pub target: String,
    /// What becomes of the value, after its unit was converted.
    pub transformation: Option<Linear>,
    /// Whether its unit is not converted: the transformation stands for that.
    pub suppress_unit_conversion: bool,
}

/// Values by name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParameterSet {
    /// Name of the set.
    pub name: String,
    /// What it is, for people.
    pub description: Option<String>,
    /// The values.
    pub parameters: Vec<Parameter>,
    /// Units that they name.
    pub units: Vec<Unit>,
}

/// A value and its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// What it is, for people.
    pub description: Option<String>,
    /// Value.
    pub value: Value,
}

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number, and its unit where it is said.
    Real(f64, Option<String>),
    /// A whole number.
    Integer(i32),
    /// A truth value.
    Boolean(bool),
    /// Text.
    String(String),
    /// An item of an enumeration: its name or its number, as it stands.
    Enumeration(String),
    /// A value of another type, as Binary, which is kept and cannot be given to anybody.
    Other(Other),
}

impl Value {
    /// Name of its type, as in a file.
    pub fn type_name(&self) -> &str {
        match self {
            Self::Real(..) => "Real",
            Self::Integer(_) => "Integer",
            Self::Boolean(_) => "Boolean",
            Self::String(_) => "String",
            Self::Enumeration(_) => "Enumeration",
            Self::Other(other) => &other.name,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // The shortest text that reads back to the same number.
            Self::Real(value, _) => write!(f, "{value:?}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Boolean(value) => write!(f, "{value}"),
            Self::String(text) | Self::Enumeration(text) => f.write_str(text),
            Self::Other(other) => f.write_str(&other.name),
        }
    }
}

/// A unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Name.
    pub name: String,
    /// What it comes to in SI base units.
    pub base: BaseUnit,
}

/// `factor * value + offset` is the value in a product of powers of SI base units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseUnit {
    /// Exponents of kg, m, s, A, K, mol, cd and rad.
    pub exponents: [i32; 8],
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl BaseUnit {
    /// Attributes of the exponents, in their order.
    pub(crate) const NAMES: [&'static str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];
}
