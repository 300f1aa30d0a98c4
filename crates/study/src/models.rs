//! The FMUs of a study: which file plays which part.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fmi2_import::{BaseType, Causality, Fmu, ModelDescription};
use interface::annotation::{self, Filters};

use crate::arguments::{FilterChoice, ForeignFilter, Mapping, PAPER};
use crate::error::StudyError;
use crate::participant::contract_name;
use crate::samples::StatusItems;

/// Name under which assignments address the truth.
pub const TRUTH: &str = "fmu-truth";
/// Name under which assignments address the navigation FMU.
pub const NAV: &str = "fmu-nav";

/// How the outputs of a filter begin that a driver may read.
const OF_FILTERS: [&str; 2] = ["est.", "pred."];
/// How the outputs of the truth begin that only a bound may read.
pub(crate) const OF_TRUTH: &str = "truth.";

/// An opened FMU and its name in the study.
#[derive(Clone)]
pub struct Model {
    /// `fmu-truth`, `fmu-nav` or the label of a foreign filter.
    pub name: String,
    /// The FMU.
    pub fmu: Arc<Fmu>,
    /// What it tells of its filters.
    pub filters: Filters,
    /// Name mapping, (own name, contract name), by scalar.
    pub aliases: Vec<(String, String)>,
}

/// What an FMU tells of its filters: presets, search ranges, and where each has a meaning.
///
/// # Errors
/// [`StudyError::Annotation`].
pub fn filters_of(description: &ModelDescription) -> Result<Filters, StudyError> {
    Filters::read(description.annotations(annotation::TOOL)).map_err(|source| StudyError::Annotation {
        model: description.model_name.clone(),
        source,
    })
}

impl Model {
    fn open(name: &str, path: &Path, mappings: &[Mapping]) -> Result<Self, StudyError> {
        let fmu = Arc::new(Fmu::open(path)?);
        let mut aliases = Vec::new();
        for mapping in mappings.iter().filter(|m| m.model == name) {
            aliases.extend(scalar_mappings(fmu.description(), mapping)?);
        }
        Ok(Self {
            name: name.to_owned(),
            filters: filters_of(fmu.description())?,
            fmu,
            aliases,
        })
    }

    /// What the FMU says of itself.
    pub fn description(&self) -> &ModelDescription {
        self.fmu.description()
    }

    /// The name of the contract that a name of this FMU stands for.
    pub(crate) fn contract_name<'a>(&'a self, own: &'a str) -> &'a str {
        contract_name(&self.aliases, own)
    }

    /// Whether it has an input that a filter feeds.
    pub(crate) fn reads_a_filter(&self) -> bool {
        OF_FILTERS.iter().any(|begin| self.has_input(begin))
    }

    /// Whether it has an input that no filter is fed.
    pub(crate) fn asks_for_the_truth(&self) -> bool {
        self.has_input(OF_TRUTH)
    }

    /// Whether it has an input whose name in the contract begins like this.
    fn has_input(&self, begin: &str) -> bool {
        let mut inputs = self
            .description()
            .variables
            .iter()
            .filter(|v| v.causality == Causality::Input);
        inputs.any(|v| self.contract_name(&v.name).starts_with(begin))
    }

    /// Real parameters that it calculates at initialization, by contract name.
    pub(crate) fn calculated(&self) -> Vec<String> {
        let variables = self.description().variables.iter();
        variables
            .filter(|v| v.causality == Causality::CalculatedParameter && v.base_type() == BaseType::Real)
            .map(|v| self.contract_name(&v.name).to_owned())
            .collect()
    }

    /// What the numbers of its `status` mean: the items of the enumeration, or a plain Integer's order.
    pub(crate) fn statuses(&self) -> StatusItems {
        let variables = &self.description().variables;
        let status = variables.iter().find(|v| self.contract_name(&v.name) == "status");
        let items = status.and_then(|v| v.enumeration_items());
        items.map_or_else(StatusItems::default, |items| {
            StatusItems::named(items.iter().map(|i| (i.name.as_str(), i.value)))
        })
    }
}

/// The mapping of each scalar that a mapping of names stands for.
fn scalar_mappings(description: &ModelDescription, mapping: &Mapping) -> Result<Vec<(String, String)>, StudyError> {
    let scalars: Vec<_> = description
        .variables
        .iter()
        .filter_map(|v| {
            let indices = v.name.strip_prefix(&mapping.own)?;
            (indices.is_empty() || indices.starts_with('['))
                .then(|| (v.name.clone(), format!("{}{indices}", mapping.contract)))
        })
        .collect();
    if scalars.is_empty() {
        description.variable(&mapping.own)?;
    }
    Ok(scalars)
}

/// Files of our own FMUs; absent where a plan does without.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OwnFmus {
    /// fmu-truth.
    pub truth: Option<PathBuf>,
    /// fmu-nav.
    pub nav: Option<PathBuf>,
}

/// Every FMU of a study.
#[derive(Clone)]
pub struct Models {
    /// The world.
    pub truth: Model,
    /// Our filters; absent when a study holds foreign ones only.
    pub nav: Option<Model>,
    /// Filters of others, in the order given.
    pub foreign: Vec<Model>,
    /// Drivers, in the order given.
    pub drivers: Vec<Model>,
}

impl Models {
    /// Opens the files.
    ///
    /// # Errors
    /// A file that is no usable FMU; [`StudyError::UnknownModel`] for a mapping of an FMU that is not in the study.
    pub fn open(
        truth: &Path,
        nav: Option<&Path>,
        foreign: &[ForeignFilter],
        drivers: &[ForeignFilter],
        mappings: &[Mapping],
    ) -> Result<Self, StudyError> {
        let others = |all: &[ForeignFilter]| {
            let opened = all.iter().map(|f| Model::open(&f.label, &f.path, mappings));
            opened.collect::<Result<Vec<_>, _>>()
        };
        let models = Self {
            truth: Model::open(TRUTH, truth, mappings)?,
            nav: nav.map(|path| Model::open(NAV, path, mappings)).transpose()?,
            foreign: others(foreign)?,
            drivers: others(drivers)?,
        };
        for mapping in mappings {
            models.require(&mapping.model, &mapping.to_string())?;
        }
        Ok(models)
    }

    /// Every FMU, truth first.
    pub fn all(&self) -> impl Iterator<Item = &Model> {
        std::iter::once(&self.truth)
            .chain(&self.nav)
            .chain(&self.foreign)
            .chain(&self.drivers)
    }

    /// Checks that an FMU is in the study; `text` is what named it.
    ///
    /// # Errors
    /// [`StudyError::UnknownModel`].
    pub fn require(&self, name: &str, text: &str) -> Result<&Model, StudyError> {
        self.all()
            .find(|m| m.name == name)
            .ok_or_else(|| StudyError::UnknownModel {
                model: name.to_owned(),
                text: text.to_owned(),
                known: self.all().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", "),
            })
    }

    /// The FMU that a choice is about: fmu-nav, or a foreign one under its label with a tuned set.
    ///
    /// # Errors
    /// [`StudyError::NoNav`].
    pub fn model_of(&self, choice: &FilterChoice) -> Result<&Model, StudyError> {
        // Without a preset the label of a foreign filter can only be a filter of ours.
        let foreign = self
            .foreign
            .iter()
            .find(|m| m.name == choice.name && choice.preset != PAPER);
        foreign.or(self.nav.as_ref()).ok_or_else(|| StudyError::NoNav {
            label: choice.label.clone(),
        })
    }
}
