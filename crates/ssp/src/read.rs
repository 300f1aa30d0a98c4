//! Elements of `.ssd`, `.ssv` and `.ssm` files as values.

use std::collections::HashSet;

use crate::SspError;
use crate::model::{
    BaseUnit, Binding, Component, Connection, Connector, DataType, Element, End, Experiment, FMU, Kind, Linear,
    MappingEntry, Other, Parameter, ParameterSet, System, SystemStructure, Unit, Value,
};
use crate::tree::{ELEMENTS, Node, parse};

/// Annotations of the Open Simulation Platform.
pub(crate) const OSP: &str = "com.opensimulationplatform";

/// Attribute of connections and of entries of mappings.
pub(crate) const SUPPRESS: &str = "suppressUnitConversion";

/// Gives the bytes of a file that a structure names: who names it, and its URI.
pub(crate) type Files<'a> = dyn FnMut(&str, &str) -> Result<Vec<u8>, SspError> + 'a;

/// Reads the structure, and the files that its bindings name.
pub(crate) fn structure(file: &str, bytes: &[u8], files: &mut Files<'_>) -> Result<SystemStructure, SspError> {
    let mut left = ELEMENTS;
    let root = parse(file, bytes, &mut left)?;
    let mut reader = Reader {
        file,
        files,
        left: &mut left,
    };
    if root.name != "ssd:SystemStructureDescription" {
        return Err(reader.wrong(&root, "is not ssd:SystemStructureDescription of SSP 1.0"));
    }
    let version = reader.required(&root, "version")?;
    if !matches!(version.split('.').next(), Some("1")) {
        return Err(reader.wrong(&root, format!("version '{version}' is not read; give 1.0")));
    }
    let system = root
        .child("ssd:System")
        .ok_or_else(|| reader.wrong(&root, "has no ssd:System"))?;
    Ok(SystemStructure {
        name: reader.required(&root, "name")?.to_owned(),
        description: root.attribute("description").map(str::to_owned),
        generation_tool: root.attribute("generationTool").map(str::to_owned),
        system: reader.system(system)?,
        units: reader.units(root.list("ssd:Units"))?,
        experiment: root
            .child("ssd:DefaultExperiment")
            .map(|node| reader.experiment(node))
            .transpose()?,
    })
}

/// A type that is not read.
fn other(name: &str, node: &Node) -> Other {
    Other {
        name: name.to_owned(),
        attributes: node.attributes.clone(),
    }
}

struct Reader<'a, 'f> {
    /// The file that is read, for messages.
    file: &'a str,
    files: &'a mut Files<'f>,
    /// Elements that may still be read.
    left: &'a mut usize,
}

impl<'f> Reader<'_, 'f> {
    /// The reader of another file of the structure.
    fn of<'b>(&'b mut self, file: &'b str) -> Reader<'b, 'f> {
        Reader {
            file,
            files: &mut *self.files,
            left: &mut *self.left,
        }
    }

    fn wrong(&self, node: &Node, problem: impl Into<String>) -> SspError {
        SspError::Invalid {
            file: self.file.to_owned(),
            line: node.line,
            element: node.label(),
            problem: problem.into(),
        }
    }

    fn required<'n>(&self, node: &'n Node, name: &str) -> Result<&'n str, SspError> {
        node.attribute(name)
            .ok_or_else(|| self.wrong(node, format!("has no attribute '{name}'")))
    }

    fn number<T: std::str::FromStr>(&self, node: &Node, name: &str) -> Result<Option<T>, SspError> {
        let Some(text) = node.attribute(name) else {
            return Ok(None);
        };
        let parsed = text.trim().parse().map(Some);
        parsed.map_err(|_| self.wrong(node, format!("{name}='{text}' is not a number of its type")))
    }

    fn boolean(&self, node: &Node, name: &str) -> Result<Option<bool>, SspError> {
        match node.attribute(name).map(str::trim) {
            None => Ok(None),
            Some("true" | "1") => Ok(Some(true)),
            Some("false" | "0") => Ok(Some(false)),
            Some(other) => Err(self.wrong(node, format!("{name}='{other}' is not true or false"))),
        }
    }

    fn experiment(&self, node: &Node) -> Result<Experiment, SspError> {
        let annotations = node.list("ssd:Annotations").iter();
        let mut step_size = None;
        for annotation in annotations.filter(|a| a.attribute("type") == Some(OSP)) {
            // `osp:Algorithm` with `osp:FixedStepAlgorithm` in it.
            for algorithm in annotation.list("Algorithm") {
                step_size = self.number(algorithm, "baseStepSize")?.or(step_size);
            }
        }
        Ok(Experiment {
            start_time: self.number(node, "startTime")?,
            stop_time: self.number(node, "stopTime")?,
            step_size,
        })
    }

    fn system(&mut self, node: &Node) -> Result<System, SspError> {
        let mut elements: Vec<Element> = Vec::new();
        let mut names = HashSet::new();
        for child in node.list("ssd:Elements") {
            let element = match child.name.as_str() {
                "ssd:Component" => Element::Component(self.component(child)?),
                "ssd:System" => Element::System(self.system(child)?),
                _ => {
                    let problem = "only ssd:Component and ssd:System are read as elements; connect them without a signal dictionary";
                    return Err(self.wrong(child, problem));
                }
            };
            if !names.insert(element.name().to_owned()) {
                return Err(self.wrong(child, "a second element of this name; give each a name of its own"));
            }
            elements.push(element);
        }
        let connections = node.list("ssd:Connections").iter();
        Ok(System {
            name: self.required(node, "name")?.to_owned(),
            connectors: self.connectors(node)?,
            elements,
            connections: connections
                .map(|child| self.connection(child))
                .collect::<Result<_, _>>()?,
            bindings: self.bindings(node)?,
        })
    }

    fn component(&mut self, node: &Node) -> Result<Component, SspError> {
        Ok(Component {
            name: self.required(node, "name")?.to_owned(),
            description: node.attribute("description").map(str::to_owned),
            source: self.required(node, "source")?.to_owned(),
            media_type: node.attribute("type").unwrap_or(FMU).to_owned(),
            connectors: self.connectors(node)?,
            bindings: self.bindings(node)?,
        })
    }

    fn connectors(&self, node: &Node) -> Result<Vec<Connector>, SspError> {
        let mut connectors: Vec<Connector> = Vec::new();
        let mut names = HashSet::new();
        for child in node.list("ssd:Connectors") {
            if child.name != "ssd:Connector" {
                return Err(self.wrong(child, "is no ssd:Connector"));
            }
            let name = self.required(child, "name")?.to_owned();
            let kind = self.required(child, "kind")?;
            let known = Kind::ALL.iter().find(|(_, name)| *name == kind);
            let (kind, _) = known.ok_or_else(|| {
                let names = Kind::ALL.map(|(_, name)| name).join(", ");
                self.wrong(child, format!("kind '{kind}' is not read; give {names}"))
            })?;
            if !names.insert(name.clone()) {
                return Err(self.wrong(child, "a second connector of this name"));
            }
            connectors.push(Connector {
                name,
                kind: *kind,
                data: self.data_type(child)?,
            });
        }
        Ok(connectors)
    }

    fn data_type(&self, node: &Node) -> Result<Option<DataType>, SspError> {
        let mut types = node.children.iter().filter_map(|child| {
            let name = child.name.strip_prefix("ssc:")?;
            Some(match name {
                "Real" => Ok(DataType::Real {
                    unit: child.attribute("unit").map(str::to_owned),
                }),
                "Integer" => Ok(DataType::Integer),
                "Boolean" => Ok(DataType::Boolean),
                "String" => Ok(DataType::String),
                "Enumeration" => self
                    .required(child, "name")
                    .map(|name| DataType::Enumeration(name.to_owned())),
                "Annotations" => return None,
                name => Ok(DataType::Other(other(name, child))),
            })
        });
        types.next().transpose()
    }

    fn connection(&self, node: &Node) -> Result<Connection, SspError> {
        if node.name != "ssd:Connection" {
            return Err(self.wrong(node, "is no ssd:Connection"));
        }
        let end = |side: &str| -> Result<End, SspError> {
            Ok(End {
                element: node.attribute(&format!("{side}Element")).map(str::to_owned),
                connector: self.required(node, &format!("{side}Connector"))?.to_owned(),
            })
        };
        Ok(Connection {
            start: end("start")?,
            end: end("end")?,
            transformation: self.transformation(node)?,
            suppress_unit_conversion: self.boolean(node, SUPPRESS)?.unwrap_or(false),
        })
    }

    fn transformation(&self, node: &Node) -> Result<Option<Linear>, SspError> {
        let mut found = None;
        for child in &node.children {
            match child.name.as_str() {
                "ssc:LinearTransformation" => {
                    found = Some(Linear {
                        factor: self.number(child, "factor")?.unwrap_or(1.0),
                        offset: self.number(child, "offset")?.unwrap_or(0.0),
                    });
                }
                name if name.ends_with("MappingTransformation") => {
                    return Err(self.wrong(node, format!("{name} is not read; only ssc:LinearTransformation is")));
                }
                _ => {}
            }
        }
        Ok(found)
    }

    fn bindings(&mut self, node: &Node) -> Result<Vec<Binding>, SspError> {
        let bindings = node.list("ssd:ParameterBindings").iter();
        bindings.map(|child| self.binding(node, child)).collect()
    }

    fn binding(&mut self, owner: &Node, node: &Node) -> Result<Binding, SspError> {
        let by = format!("the parameter binding of {}", owner.label());
        let source = node.attribute("source");
        self.readable(node, "application/x-ssp-parameter-set")?;
        let values = match (source, node.child("ssd:ParameterValues")) {
            (Some(uri), None) => {
                let bytes = (self.files)(&by, uri)?;
                let root = parse(uri, &bytes, self.left)?;
                self.of(uri).parameter_set(&root)?
            }
            (None, Some(inline)) => match inline.child("ssv:ParameterSet") {
                Some(set) => self.parameter_set(set)?,
                None => return Err(self.wrong(inline, "holds no ssv:ParameterSet")),
            },
            _ => return Err(self.wrong(node, "give either source or ssd:ParameterValues")),
        };
        let mapping = node.child("ssd:ParameterMapping").map(|mapping| {
            self.readable(mapping, "application/x-ssp-parameter-mapping")?;
            if let Some(uri) = mapping.attribute("source") {
                let bytes = (self.files)(&by, uri)?;
                let root = parse(uri, &bytes, self.left)?;
                return self.of(uri).mapping(&root);
            }
            let inline = mapping.child("ssm:ParameterMapping");
            self.mapping(inline.ok_or_else(|| self.wrong(mapping, "holds no ssm:ParameterMapping"))?)
        });
        Ok(Binding {
            source: source.map(str::to_owned),
            prefix: node.attribute("prefix").unwrap_or_default().to_owned(),
            values,
            mapping: mapping.transpose()?,
        })
    }

    /// Checks where a binding or mapping has its file, and of which type that is.
    fn readable(&self, node: &Node, media_type: &str) -> Result<(), SspError> {
        // Relative to the component's file rather than to the structure's.
        if node.attribute("source").is_some() && node.attribute("sourceBase") == Some("component") {
            return Err(self.wrong(
                node,
                "sourceBase 'component' is not read; put the file beside the .ssd file",
            ));
        }
        match node.attribute("type").filter(|other| *other != media_type) {
            Some(other) => Err(self.wrong(node, format!("type '{other}' is not read; give {media_type}"))),
            None => Ok(()),
        }
    }

    fn mapping(&self, node: &Node) -> Result<Vec<MappingEntry>, SspError> {
        if node.name != "ssm:ParameterMapping" {
            return Err(self.wrong(node, "is not ssm:ParameterMapping of SSP 1.0"));
        }
        let entries = node.children.iter().filter(|child| child.name == "ssm:MappingEntry");
        let entries = entries.map(|entry| {
            Ok(MappingEntry {
                source: self.required(entry, "source")?.to_owned(),
                target: self.required(entry, "target")?.to_owned(),
                transformation: self.transformation(entry)?,
                suppress_unit_conversion: self.boolean(entry, SUPPRESS)?.unwrap_or(false),
            })
        });
        entries.collect()
    }

    fn parameter_set(&self, node: &Node) -> Result<ParameterSet, SspError> {
        if node.name != "ssv:ParameterSet" {
            return Err(self.wrong(node, "is not ssv:ParameterSet of SSP 1.0"));
        }
        let mut parameters: Vec<Parameter> = Vec::new();
        let mut names = HashSet::new();
        for child in node.list("ssv:Parameters") {
            let parameter = self.parameter(child)?;
            if !names.insert(parameter.name.clone()) {
                return Err(self.wrong(child, "a second value of this name"));
            }
            parameters.push(parameter);
        }
        Ok(ParameterSet {
            name: self.required(node, "name")?.to_owned(),
            description: node.attribute("description").map(str::to_owned),
            parameters,
            units: self.units(node.list("ssv:Units"))?,
        })
    }

    fn parameter(&self, node: &Node) -> Result<Parameter, SspError> {
        let mut values = node.children.iter().filter(|child| child.name.starts_with("ssv:"));
        let typed = values.next().ok_or_else(|| self.wrong(node, "has no value"))?;
        let text = || self.required(typed, "value");
        let none = || self.wrong(typed, "has no attribute 'value'");
        let value = match typed.name.as_str() {
            "ssv:Real" => Value::Real(
                self.number(typed, "value")?.ok_or_else(none)?,
                typed.attribute("unit").map(str::to_owned),
            ),
            "ssv:Integer" => Value::Integer(self.number(typed, "value")?.ok_or_else(none)?),
            "ssv:Boolean" => Value::Boolean(self.boolean(typed, "value")?.ok_or_else(none)?),
            "ssv:String" => Value::String(text()?.to_owned()),
            "ssv:Enumeration" => Value::Enumeration(text()?.to_owned()),
            name => Value::Other(other(name.trim_start_matches("ssv:"), typed)),
        };
        Ok(Parameter {
            name: self.required(node, "name")?.to_owned(),
            description: node.attribute("description").map(str::to_owned),
            value,
        })
    }

    fn units(&self, nodes: &[Node]) -> Result<Vec<Unit>, SspError> {
        let units = nodes.iter().map(|node| {
            let base = node
                .child("ssc:BaseUnit")
                .ok_or_else(|| self.wrong(node, "has no ssc:BaseUnit"))?;
            let mut exponents = [0; 8];
            for (exponent, name) in exponents.iter_mut().zip(BaseUnit::NAMES) {
                *exponent = self.number(base, name)?.unwrap_or(0);
            }
            Ok(Unit {
                name: self.required(node, "name")?.to_owned(),
                base: BaseUnit {
                    exponents,
                    factor: self.number(base, "factor")?.unwrap_or(1.0),
                    offset: self.number(base, "offset")?.unwrap_or(0.0),
                },
            })
        });
        units.collect()
    }
}
