//! Values as `.ssd` and `.ssv` files: what the schemas of SSP 1.0 want, and the prefixes that tools look for.

use std::fmt::Write;

use quick_xml::escape::escape;

use crate::model::{
    Binding, Component, Connection, Connector, DataType, Element, Experiment, Linear, Parameter, ParameterSet, System,
    SystemStructure, Unit, Value,
};
use crate::read::{OSP, SUPPRESS};
use crate::tree::{SPACES, namespace};

/// Namespace of the annotation that says the step.
const OSP_NAMESPACE: &str = "http://opensimulationplatform.com/SSP/OSPAnnotations";

impl SystemStructure {
    /// The text of `SystemStructure.ssd`. Values that come from files are named, and stand in [`ParameterSet::to_xml`].
    pub fn to_xml(&self) -> String {
        let mut out = Lines::new();
        let mut attributes = namespaces(&["ssd", "ssc", "ssv", "ssm"]);
        attributes.extend([
            ("version".to_owned(), "1.0".to_owned()),
            ("name".to_owned(), self.name.clone()),
        ]);
        optional(&mut attributes, "description", self.description.as_ref());
        optional(&mut attributes, "generationTool", self.generation_tool.as_ref());
        out.open("ssd:SystemStructureDescription", &attributes);
        system(&mut out, &self.system);
        units(&mut out, "ssd:Units", &self.units);
        if let Some(times) = &self.experiment {
            experiment(&mut out, times);
        }
        out.close();
        out.text
    }
}

impl ParameterSet {
    /// The text of an `.ssv` file.
    pub fn to_xml(&self) -> String {
        let mut out = Lines::new();
        parameter_set(&mut out, self, namespaces(&["ssv", "ssc"]));
        out.text
    }
}

type Attributes = Vec<(String, String)>;

fn named(name: &str) -> Attributes {
    vec![("name".to_owned(), name.to_owned())]
}

fn optional(attributes: &mut Attributes, name: &str, value: Option<&String>) {
    attributes.extend(value.map(|value| (name.to_owned(), value.clone())));
}

fn namespaces(prefixes: &[&str]) -> Attributes {
    let spaces = SPACES.iter().filter(|(prefix, _)| prefixes.contains(prefix));
    spaces
        .map(|(prefix, part)| (format!("xmlns:{prefix}"), namespace(part)))
        .collect()
}

fn experiment(out: &mut Lines, times: &Experiment) {
    let of = |name: &str, value: Option<f64>| value.map(|value| (name.to_owned(), number(value)));
    let attributes: Attributes = of("startTime", times.start_time)
        .into_iter()
        .chain(of("stopTime", times.stop_time))
        .collect();
    let Some(step) = times.step_size else {
        return out.empty("ssd:DefaultExperiment", &attributes);
    };
    out.open("ssd:DefaultExperiment", &attributes);
    out.open("ssd:Annotations", &[]);
    // libcosim takes an attribute of the algorithm for an algorithm, so the namespace is declared here.
    let attributes = [
        ("type".to_owned(), OSP.to_owned()),
        ("xmlns:osp".to_owned(), OSP_NAMESPACE.to_owned()),
    ];
    out.open("ssc:Annotation", &attributes);
    out.open("osp:Algorithm", &[]);
    out.empty("osp:FixedStepAlgorithm", &[("baseStepSize".to_owned(), number(step))]);
    for _ in 0..4 {
        out.close();
    }
}

fn system(out: &mut Lines, system: &System) {
    out.open("ssd:System", &named(&system.name));
    connectors(out, &system.connectors);
    bindings(out, &system.bindings);
    if !system.elements.is_empty() {
        out.open("ssd:Elements", &[]);
        for element in &system.elements {
            match element {
                Element::Component(inner) => component(out, inner),
                Element::System(inner) => self::system(out, inner),
            }
        }
        out.close();
    }
    if !system.connections.is_empty() {
        out.open("ssd:Connections", &[]);
        system.connections.iter().for_each(|inner| connection(out, inner));
        out.close();
    }
    out.close();
}

fn component(out: &mut Lines, component: &Component) {
    let mut attributes = named(&component.name);
    optional(&mut attributes, "description", component.description.as_ref());
    attributes.push(("type".to_owned(), component.media_type.clone()));
    attributes.push(("source".to_owned(), component.source.clone()));
    out.open("ssd:Component", &attributes);
    connectors(out, &component.connectors);
    bindings(out, &component.bindings);
    out.close();
}

fn connectors(out: &mut Lines, connectors: &[Connector]) {
    if connectors.is_empty() {
        return;
    }
    out.open("ssd:Connectors", &[]);
    for connector in connectors {
        let mut attributes = named(&connector.name);
        attributes.push(("kind".to_owned(), connector.kind.name().to_owned()));
        let Some(data) = &connector.data else {
            out.empty("ssd:Connector", &attributes);
            continue;
        };
        out.open("ssd:Connector", &attributes);
        let detail = match data {
            DataType::Real { unit } => unit.iter().map(|unit| ("unit".to_owned(), unit.clone())).collect(),
            DataType::Enumeration(name) => named(name),
            DataType::Other(other) => other.attributes.clone(),
            _ => Vec::new(),
        };
        out.empty(&format!("ssc:{}", data.name()), &detail);
        out.close();
    }
    out.close();
}

fn bindings(out: &mut Lines, bindings: &[Binding]) {
    if bindings.is_empty() {
        return;
    }
    out.open("ssd:ParameterBindings", &[]);
    for binding in bindings {
        let mut attributes = Attributes::new();
        optional(&mut attributes, "source", binding.source.as_ref());
        if !binding.prefix.is_empty() {
            attributes.push(("prefix".to_owned(), binding.prefix.clone()));
        }
        if binding.source.is_some() && binding.mapping.is_none() {
            out.empty("ssd:ParameterBinding", &attributes);
            continue;
        }
        out.open("ssd:ParameterBinding", &attributes);
        if binding.source.is_none() {
            out.open("ssd:ParameterValues", &[]);
            parameter_set(out, &binding.values, Vec::new());
            out.close();
        }
        if let Some(entries) = &binding.mapping {
            out.open("ssd:ParameterMapping", &[]);
            out.open("ssm:ParameterMapping", &[("version".to_owned(), "1.0".to_owned())]);
            for entry in entries {
                let mut attributes = vec![
                    ("source".to_owned(), entry.source.clone()),
                    ("target".to_owned(), entry.target.clone()),
                ];
                suppressed(&mut attributes, entry.suppress_unit_conversion);
                around(out, "ssm:MappingEntry", &attributes, entry.transformation);
            }
            out.close();
            out.close();
        }
        out.close();
    }
    out.close();
}

fn connection(out: &mut Lines, connection: &Connection) {
    let mut attributes = Attributes::new();
    for (side, end) in [("start", &connection.start), ("end", &connection.end)] {
        optional(&mut attributes, &format!("{side}Element"), end.element.as_ref());
        attributes.push((format!("{side}Connector"), end.connector.clone()));
    }
    suppressed(&mut attributes, connection.suppress_unit_conversion);
    around(out, "ssd:Connection", &attributes, connection.transformation);
}

fn suppressed(attributes: &mut Attributes, suppress: bool) {
    attributes.extend(suppress.then(|| (SUPPRESS.to_owned(), "true".to_owned())));
}

/// An element that may hold a transformation.
fn around(out: &mut Lines, name: &str, attributes: &[(String, String)], transformation: Option<Linear>) {
    let Some(Linear { factor, offset }) = transformation else {
        return out.empty(name, attributes);
    };
    out.open(name, attributes);
    let attributes = [
        ("factor".to_owned(), number(factor)),
        ("offset".to_owned(), number(offset)),
    ];
    out.empty("ssc:LinearTransformation", &attributes);
    out.close();
}

fn parameter_set(out: &mut Lines, set: &ParameterSet, mut attributes: Attributes) {
    attributes.extend([
        ("version".to_owned(), "1.0".to_owned()),
        ("name".to_owned(), set.name.clone()),
    ]);
    optional(&mut attributes, "description", set.description.as_ref());
    out.open("ssv:ParameterSet", &attributes);
    out.open("ssv:Parameters", &[]);
    for Parameter {
        name,
        description,
        value,
    } in &set.parameters
    {
        let mut attributes = named(name);
        optional(&mut attributes, "description", description.as_ref());
        out.open("ssv:Parameter", &attributes);
        let said = |text: String| vec![("value".to_owned(), text)];
        let attributes = match value {
            Value::Real(real, unit) => {
                let mut attributes = said(number(*real));
                optional(&mut attributes, "unit", unit.as_ref());
                attributes
            }
            Value::Other(other) => other.attributes.clone(),
            other => said(other.to_string()),
        };
        out.empty(&format!("ssv:{}", value.type_name()), &attributes);
        out.close();
    }
    out.close();
    units(out, "ssv:Units", &set.units);
    out.close();
}

fn units(out: &mut Lines, list: &str, units: &[Unit]) {
    if units.is_empty() {
        return;
    }
    out.open(list, &[]);
    for Unit { name, base } in units {
        out.open("ssc:Unit", &named(name));
        let exponents = base.exponents.iter().zip(crate::model::BaseUnit::NAMES);
        let mut attributes: Attributes = exponents
            .filter(|(exponent, _)| **exponent != 0)
            .map(|(exponent, name)| (name.to_owned(), exponent.to_string()))
            .collect();
        for (name, value, default) in [("factor", base.factor, 1.0_f64), ("offset", base.offset, 0.0)] {
            if value.to_bits() != default.to_bits() {
                attributes.push((name.to_owned(), number(value)));
            }
        }
        out.empty("ssc:BaseUnit", &attributes);
        out.close();
    }
    out.close();
}

/// The shortest text of an `xs:double` that reads back to the same number.
fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "INF".to_owned(),
        f64::NEG_INFINITY => "-INF".to_owned(),
        finite => format!("{finite:?}"),
    }
}

/// XML, an element a line.
struct Lines {
    text: String,
    open: Vec<String>,
}

impl Lines {
    fn new() -> Self {
        Self {
            text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(),
            open: Vec::new(),
        }
    }

    fn line(&mut self, content: &str, depth: usize) {
        // A write to a string does not fail.
        let _ = writeln!(self.text, "{:width$}{content}", "", width = 2 * depth);
    }

    fn open(&mut self, name: &str, attributes: &[(String, String)]) {
        self.line(&format!("<{name}{}>", rendered(attributes)), self.open.len());
        self.open.push(name.to_owned());
    }

    fn empty(&mut self, name: &str, attributes: &[(String, String)]) {
        self.line(&format!("<{name}{}/>", rendered(attributes)), self.open.len());
    }

    fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            self.line(&format!("</{name}>"), self.open.len());
        }
    }
}

fn rendered(attributes: &[(String, String)]) -> String {
    let one = |(name, value): &(String, String)| {
        // White space but blanks would be read as blanks.
        let value = escape(value.as_str())
            .replace('\n', "&#10;")
            .replace('\t', "&#9;")
            .replace('\r', "&#13;");
        format!(" {name}=\"{value}\"")
    };
    attributes.iter().map(one).collect()
}
