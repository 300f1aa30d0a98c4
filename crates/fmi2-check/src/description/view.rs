//! The tree as variables, types and units; what is wrong is left out here and found elsewhere.

use std::collections::{BTreeMap, BTreeSet};

use crate::role::{Causality, Initial, Kind, Variability, Word, beginning};
use crate::xml::lexical::{int, unsigned};
use crate::xml::tree::Node;

/// A variable as far as it can be read.
#[derive(Debug)]
pub(crate) struct Scalar<'a> {
    pub(crate) node: &'a Node,
    /// From 1, as ModelStructure counts.
    pub(crate) index: usize,
    pub(crate) name: &'a str,
    /// The element of its type.
    pub(crate) inner: Option<&'a Node>,
    pub(crate) kind: Option<Kind>,
    pub(crate) reference: Option<u32>,
    pub(crate) causality: Causality,
    /// As it is said, or as masters read it where it is not.
    pub(crate) variability: Variability,
    /// As it is said, or the standard's default.
    pub(crate) initial: Option<Initial>,
}

impl<'a> Scalar<'a> {
    fn new(node: &'a Node, index: usize) -> Self {
        let inner = node.children.iter().find(|child| Kind::read(&child.name).is_some());
        let kind = inner.and_then(|inner| Kind::read(&inner.name));
        let causality = node
            .get("causality")
            .and_then(Causality::read)
            .unwrap_or(Causality::Local);
        let usual = if kind == Some(Kind::Real) {
            Variability::Continuous
        } else {
            Variability::Discrete
        };
        let variability = node.get("variability").and_then(Variability::read).unwrap_or(usual);
        let said = node.get("initial").and_then(Initial::read);
        Self {
            node,
            index,
            name: node.get("name").unwrap_or_default(),
            inner,
            kind,
            reference: node.get("valueReference").and_then(unsigned),
            causality,
            variability,
            initial: said.or_else(|| beginning(causality, variability)?.default),
        }
    }

    /// What findings call it.
    pub(crate) fn called(&self) -> &'a str {
        &self.node.path
    }

    /// An attribute of its type's element.
    pub(crate) fn get(&self, name: &str) -> Option<&'a str> {
        self.inner?.get(name)
    }
}

/// The whole description.
#[derive(Debug)]
pub(crate) struct View<'a> {
    pub(crate) root: &'a Node,
    /// Units with their display units.
    pub(crate) units: BTreeMap<&'a str, BTreeSet<&'a str>>,
    /// Elements of types by name.
    pub(crate) types: BTreeMap<&'a str, &'a Node>,
    pub(crate) variables: Vec<Scalar<'a>>,
    /// Values of the items of each enumeration, by the name of its type.
    items: BTreeMap<&'a str, BTreeSet<i32>>,
    /// Indices of variables that a derivative belongs to.
    states: BTreeSet<u32>,
}

impl<'a> View<'a> {
    pub(crate) fn new(root: &'a Node) -> Self {
        let units = root.inside("UnitDefinitions", "Unit").filter_map(|unit| {
            let display = unit.named("DisplayUnit").filter_map(|d| d.get("name"));
            Some((unit.get("name")?, display.collect()))
        });
        let types = root.inside("TypeDefinitions", "SimpleType").filter_map(|simple| {
            let kind = simple.children.iter().find(|c| Kind::read(&c.name).is_some())?;
            Some((simple.get("name")?, kind))
        });
        let variables = root.inside("ModelVariables", "ScalarVariable").enumerate();
        let variables: Vec<Scalar<'_>> = variables.map(|(place, node)| Scalar::new(node, place + 1)).collect();
        let types: BTreeMap<&str, &Node> = types.collect();
        let values = |node: &'a Node| node.named("Item").filter_map(|item| int(item.get("value")?));
        Self {
            root,
            units: units.collect(),
            items: types
                .iter()
                .map(|(name, node)| (*name, values(node).collect()))
                .collect(),
            types,
            states: variables
                .iter()
                .filter_map(|v| v.get("derivative").and_then(unsigned))
                .collect(),
            variables,
        }
    }

    /// Whether a derivative belongs to a variable.
    pub(crate) fn is_state(&self, variable: &Scalar<'a>) -> bool {
        u32::try_from(variable.index).is_ok_and(|index| self.states.contains(&index))
    }

    /// The element of the declared type of a variable.
    pub(crate) fn type_of(&self, variable: &Scalar<'a>) -> Option<&'a Node> {
        self.types.get(variable.get("declaredType")?).copied()
    }

    /// An attribute of a variable, or of its declared type.
    pub(crate) fn attribute(&self, variable: &Scalar<'a>, name: &str) -> Option<&'a str> {
        variable.get(name).or_else(|| self.type_of(variable)?.get(name))
    }

    /// Values of the items of an enumeration.
    pub(crate) fn items(&self, variable: &Scalar<'a>) -> Option<&BTreeSet<i32>> {
        self.items
            .get(variable.get("declaredType")?)
            .filter(|_| variable.kind == Some(Kind::Enumeration))
    }

    /// The variable of an index as ModelStructure counts.
    pub(crate) fn at(&self, index: u32) -> Option<&Scalar<'a>> {
        self.variables.get(usize::try_from(index).ok()?.checked_sub(1)?)
    }

    /// The interface of a name, `CoSimulation` or `ModelExchange`.
    pub(crate) fn interface(&self, name: &str) -> Option<&'a Node> {
        self.root.child(name)
    }
}
