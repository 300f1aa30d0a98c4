//! Who takes part in a run.

use std::fmt;
use std::sync::Arc;

use cosim::{FmuSlave, Slave, Value};
use fmi2_import::{Fmu, ImportError};

use crate::error::StudyError;
use crate::samples::StatusItems;
use crate::variation::Varied;

/// Where new slaves come from: an FMU, or a mock in tests.
pub trait SlaveSource: Send + Sync {
    /// A fresh slave of this name.
    ///
    /// # Errors
    /// Why there is none.
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, StudyError>;
}

impl SlaveSource for Fmu {
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, StudyError> {
        match self.instantiate(name, false) {
            Ok(instance) => Ok(Box::new(FmuSlave::new(instance))),
            Err(source) if expects_python(&source) => Err(StudyError::ExpectsPython {
                label: name.to_owned(),
                source: Box::new(source),
            }),
            Err(source) => Err(source.into()),
        }
    }
}

/// Whether the loader missed a symbol of Python.
fn expects_python(error: &ImportError) -> bool {
    let ImportError::Load { reason, .. } = error else {
        return false;
    };
    ["symbol: Py", "symbol: _Py"].iter().any(|start| reason.contains(start))
}

/// One part in a run: where its slave comes from and what is set before it starts.
#[derive(Clone)]
pub struct Participant {
    /// Name of the slave; for a filter the text of the `filter` column.
    pub label: String,
    /// Name of its FMU in the study, by which assignments and variations address it.
    pub model: String,
    /// Where the slave comes from.
    pub source: Arc<dyn SlaveSource>,
    /// Name mapping, (own name, contract name).
    pub aliases: Vec<(String, String)>,
    /// Start values by contract name, each name once.
    pub starts: Vec<(String, Value)>,
    /// Start values that each run draws anew.
    pub varied: Vec<Varied>,
    /// Whether it is a bound and no filter: fed `truth.*`, and never ranked.
    pub bound: bool,
    /// Whether its FMU has bounds, so that inputs `truth.*` are theirs and stay open where it is a filter.
    pub beside_bounds: bool,
    /// What the numbers of its `status` mean.
    pub statuses: StatusItems,
    /// Real parameters that it calculates at initialization, by contract name: what its settings come to.
    pub calculated: Vec<String>,
    /// Start values and variations as text, under the FMU's own names, for the record.
    pub record: Vec<(String, String)>,
}

impl Participant {
    /// Start value of a variable by the FMU's own name, if one is set.
    pub fn start(&self, own: &str) -> Option<&Value> {
        let contract = self.contract(own);
        self.starts
            .iter()
            .find(|(name, _)| name == contract)
            .map(|(_, value)| value)
    }

    /// Whether each run draws the start value of this variable anew, by the FMU's own name.
    pub fn varies(&self, own: &str) -> bool {
        let contract = self.contract(own);
        self.varied.iter().any(|v| v.name == contract)
    }

    /// Real value of a variable in one run, by the FMU's own name: drawn, or set; `None` where neither is.
    ///
    /// * `seed`: of the study.
    pub fn value_in_run(&self, own: &str, seed: i32, run: u32) -> Option<f64> {
        let contract = self.contract(own);
        let drawn = self.varied.iter().find(|v| v.name == contract);
        drawn.map(|v| v.value(seed, run)).or_else(|| match self.start(own) {
            Some(Value::Real(x)) => Some(*x),
            _ => None,
        })
    }

    /// What one run draws: `MODEL.VARIABLE` by the FMU's own name, and the value.
    ///
    /// * `seed`: of the study.
    pub fn drawn(&self, seed: i32, run: u32) -> Vec<(String, f64)> {
        let own = |contract: &'_ str| {
            let alias = self.aliases.iter().find(|(_, name)| name == contract);
            alias.map_or_else(|| contract.to_owned(), |(own, _)| own.clone())
        };
        self.varied
            .iter()
            .map(|v| (format!("{}.{}", self.model, own(&v.name)), v.value(seed, run)))
            .collect()
    }

    /// Sets the start value of a Real variable by the FMU's own name.
    pub fn set_real(&mut self, own: &str, value: f64) {
        let contract = self.contract(own).to_owned();
        self.starts.retain(|(name, _)| *name != contract);
        self.starts.push((contract, Value::Real(value)));
        self.record.retain(|(name, _)| name != own);
        self.record.push((own.to_owned(), format!("{value:?}")));
    }

    fn contract<'a>(&'a self, own: &'a str) -> &'a str {
        contract_name(&self.aliases, own)
    }
}

impl fmt::Debug for Participant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Participant")
            .field("label", &self.label)
            .field("record", &self.record)
            .finish_non_exhaustive()
    }
}

/// The name of the contract that an FMU's own name stands for: another one only where it is mapped.
pub(crate) fn contract_name<'a>(aliases: &'a [(String, String)], own: &'a str) -> &'a str {
    let alias = aliases.iter().find(|(name, _)| name == own);
    alias.map_or(own, |(_, contract)| contract)
}
