//! What a process that runs the library is told.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::description::view::View;
use crate::role::{Causality, Initial, Kind, Variability};
use crate::xml::lexical::{boolean, double, int, unsigned};
use crate::xml::tree::Node;

/// Steps of a run, unless the default experiment ends before.
const STEPS: u32 = 10;

/// Everything about the FMU.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Job {
    /// The library.
    pub(super) file: PathBuf,
    /// The folder of resources.
    pub(super) resources: PathBuf,
    /// Where a trial keeps what the next one reads.
    pub(super) folder: PathBuf,
    /// The longest that a trial may take, s.
    pub(super) limit: f64,
    pub(super) guid: String,
    pub(super) once: bool,
    pub(super) own_memory: bool,
    pub(super) states: bool,
    pub(super) serializes: bool,
    pub(super) start: f64,
    pub(super) stop: Option<f64>,
    pub(super) tolerance: Option<f64>,
    pub(super) step: f64,
    pub(super) steps: u32,
    pub(super) categories: Vec<String>,
    pub(super) variables: Vec<Variable>,
    pub(super) outputs: Vec<Unknown>,
    pub(super) initial: Vec<Unknown>,
}

/// A variable.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) reference: u32,
    pub(super) kind: Kind,
    pub(super) causality: Causality,
    pub(super) variability: Variability,
    pub(super) initial: Option<Initial>,
    pub(super) start: Option<String>,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
    /// Values of the items of an enumeration.
    pub(super) items: Option<Vec<i32>>,
}

/// An entry of ModelStructure; variables by their place, from 0.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Unknown {
    pub(super) variable: usize,
    /// Nothing: any known.
    pub(super) dependencies: Option<Vec<usize>>,
}

impl Job {
    /// All that the description says; paths are for the caller to fill in.
    pub(super) fn new(view: &View<'_>, interface: &Node) -> Self {
        let flag = |name| interface.get(name).and_then(boolean).unwrap_or(false);
        let experiment = view.root.child("DefaultExperiment");
        let number = |name| experiment?.get(name).and_then(double).filter(|n| n.is_finite());
        let start = number("startTime").unwrap_or(0.0);
        let stop = number("stopTime").filter(|stop| *stop > start);
        let step = number("stepSize").filter(|step| *step > 0.0);
        let step = step.or_else(|| Some((stop? - start) / 100.0)).unwrap_or(0.1);
        let fitting = stop.map_or(f64::from(STEPS), |stop| ((stop - start) / step + 1e-9).floor());
        // A number from 1 to STEPS.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = fitting.clamp(1.0, f64::from(STEPS)) as u32;
        let categories = view.root.inside("LogCategories", "Category");
        Self {
            file: PathBuf::new(),
            resources: PathBuf::new(),
            folder: PathBuf::new(),
            limit: 0.0,
            guid: view.root.get("guid").unwrap_or_default().to_owned(),
            once: flag("canBeInstantiatedOnlyOncePerProcess"),
            own_memory: flag("canNotUseMemoryManagementFunctions"),
            states: flag("canGetAndSetFMUstate"),
            serializes: flag("canSerializeFMUstate"),
            start,
            stop,
            tolerance: number("tolerance"),
            step,
            steps,
            categories: categories.filter_map(|c| c.get("name").map(str::to_owned)).collect(),
            variables: variables(view),
            outputs: unknowns(view, "Outputs"),
            initial: unknowns(view, "InitialUnknowns"),
        }
    }
}

fn variables(view: &View<'_>) -> Vec<Variable> {
    let all = view.variables.iter();
    all.map(|v| Variable {
        name: v.called().to_owned(),
        reference: v.reference.unwrap_or(u32::MAX),
        kind: v.kind.unwrap_or(Kind::Real),
        causality: v.causality,
        variability: v.variability,
        initial: v.initial,
        start: v.get("start").map(str::to_owned),
        min: view.attribute(v, "min").and_then(double),
        max: view.attribute(v, "max").and_then(double),
        items: view.items(v).map(|items| items.iter().copied().collect()),
    })
    .collect()
}

fn unknowns(view: &View<'_>, list: &str) -> Vec<Unknown> {
    let structure = view.root.child("ModelStructure");
    let nodes = structure.into_iter().flat_map(|s| s.inside(list, "Unknown"));
    let place = |text: &str| view.at(unsigned(text)?).map(|v| v.index - 1);
    nodes
        .filter_map(|node| {
            let listed = node.get("dependencies");
            Some(Unknown {
                variable: place(node.get("index")?)?,
                dependencies: listed.map(|text| text.split_whitespace().filter_map(place).collect()),
            })
        })
        .collect()
}

/// A value as it crosses the border; equal where the bits are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Value {
    Real(u64),
    Integer(i32),
    Boolean(i32),
    Text(String),
    /// A string that is NULL.
    Nothing,
}

impl Value {
    pub(super) fn real(number: f64) -> Self {
        Self::Real(number.to_bits())
    }

    /// For people.
    pub(super) fn shown(&self) -> String {
        match self {
            Self::Real(bits) => format!("{:?}", f64::from_bits(*bits)),
            Self::Integer(number) => number.to_string(),
            Self::Boolean(number) => if *number == 0 { "false" } else { "true" }.to_owned(),
            Self::Text(text) => format!("{text:?}"),
            Self::Nothing => "NULL".to_owned(),
        }
    }
}

impl Variable {
    /// The start value of the description.
    pub(super) fn start_value(&self) -> Option<Value> {
        let text = self.start.as_deref()?;
        match self.kind {
            Kind::Real => double(text).map(Value::real),
            Kind::Integer | Kind::Enumeration => int(text).map(Value::Integer),
            Kind::Boolean => boolean(text).map(|b| Value::Boolean(b.into())),
            Kind::String => Some(Value::Text(text.to_owned())),
        }
    }

    /// Another value that is allowed, near the start value; nothing for what is no number, and for enumerations, whose items may
    /// be whole models.
    pub(super) fn moved(&self, from: &Value) -> Option<Value> {
        let fits = |number: f64| self.min.is_none_or(|min| number >= min) && self.max.is_none_or(|max| number <= max);
        match (from, self.kind) {
            (Value::Real(bits), _) => {
                let now = f64::from_bits(*bits);
                let by = (now.abs() * 1e-3).max(1e-3);
                let other = [now + by, now - by].into_iter().find(|n| n.is_finite() && fits(*n));
                other.map(Value::real)
            }
            (Value::Integer(now), Kind::Integer) => {
                let others = [now.checked_add(1), now.checked_sub(1)].into_iter().flatten();
                others.into_iter().find(|n| fits(f64::from(*n))).map(Value::Integer)
            }
            (Value::Boolean(now), _) => Some(Value::Boolean((*now == 0).into())),
            _ => None,
        }
    }
}
