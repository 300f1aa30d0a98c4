//! The FMUs of a study: which file plays which part, and with which values it starts.

mod arguments;
mod variation;

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use cosim::{BaseType, FmuSlave, Slave, Value};
use fmi2_import::{Causality, Fmu, ModelDescription};
use interface::annotation::{self, Filters};

use crate::HarnessError;
use crate::scenarios::Scenario;
use crate::tuning::sets::TunedSet;

pub use arguments::{Assignment, FilterChoice, ForeignFilter, Mapping, PAPER, Range};
pub use variation::{Distribution, Variation, Varied};

/// Name under which `--set` addresses the truth.
pub const TRUTH: &str = "fmu-truth";
/// Name under which `--set` addresses the navigation FMU.
pub const NAV: &str = "fmu-nav";

/// Where new slaves come from: an FMU, or a mock in tests.
pub trait SlaveSource: Send + Sync {
    /// A fresh slave of this name.
    ///
    /// # Errors
    /// Why there is none.
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, HarnessError>;
}

impl SlaveSource for Fmu {
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, HarnessError> {
        Ok(Box::new(FmuSlave::new(self.instantiate(name, false)?)))
    }
}

/// One part in a run: where its slave comes from and what is set before it starts.
#[derive(Clone)]
pub struct Participant {
    /// Name of the slave; for a filter the text of the `filter` column.
    pub label: String,
    /// Name of its [`Model`], as `--set` and `--vary` address it.
    pub model: String,
    /// Where the slave comes from.
    pub source: Arc<dyn SlaveSource>,
    /// Name mapping, (own name, contract name).
    pub aliases: Vec<(String, String)>,
    /// Start values by contract name, each name once.
    pub starts: Vec<(String, Value)>,
    /// Start values that each run draws anew.
    pub varied: Vec<Varied>,
    /// Both as text, under the FMU's own names, for the record.
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
/// [`HarnessError::Annotation`].
pub fn filters_of(description: &ModelDescription) -> Result<Filters, HarnessError> {
    Filters::read(description.annotations(annotation::TOOL)).map_err(|source| HarnessError::Annotation {
        model: description.model_name.clone(),
        source,
    })
}

impl Model {
    fn open(name: &str, path: &Path, mappings: &[Mapping]) -> Result<Self, HarnessError> {
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

    fn description(&self) -> &ModelDescription {
        self.fmu.description()
    }

    /// The name of the contract that a name of this FMU stands for.
    fn contract_name<'a>(&'a self, own: &'a str) -> &'a str {
        contract_name(&self.aliases, own)
    }
}

/// The name of the contract that an FMU's own name stands for: another one only where it is mapped.
fn contract_name<'a>(aliases: &'a [(String, String)], own: &'a str) -> &'a str {
    let alias = aliases.iter().find(|(name, _)| name == own);
    alias.map_or(own, |(_, contract)| contract)
}

/// The mapping of each scalar that a mapping of names stands for.
fn scalar_mappings(description: &ModelDescription, mapping: &Mapping) -> Result<Vec<(String, String)>, HarnessError> {
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

/// Every FMU of a study.
pub struct Models {
    /// The world.
    pub truth: Model,
    /// Our filters; absent when a study holds foreign ones only.
    pub nav: Option<Model>,
    /// Filters of others, in the order given.
    pub foreign: Vec<Model>,
    /// Parameter sets from a search, beside the presets of the FMUs.
    pub tuned: Vec<TunedSet>,
}

impl Models {
    /// Opens the files.
    ///
    /// # Errors
    /// A file that is no usable FMU; [`HarnessError::UnknownModel`] for a mapping of an FMU that is not in the study.
    pub fn open(
        truth: &Path,
        nav: Option<&Path>,
        foreign: &[ForeignFilter],
        mappings: &[Mapping],
    ) -> Result<Self, HarnessError> {
        let models = Self {
            truth: Model::open(TRUTH, truth, mappings)?,
            nav: nav.map(|path| Model::open(NAV, path, mappings)).transpose()?,
            foreign: foreign
                .iter()
                .map(|f| Model::open(&f.label, &f.path, mappings))
                .collect::<Result<_, _>>()?,
            tuned: Vec::new(),
        };
        for mapping in mappings {
            models.require(
                &mapping.model,
                &format!("{}.{}={}", mapping.model, mapping.own, mapping.contract),
            )?;
        }
        Ok(models)
    }

    /// Every FMU, truth first.
    pub fn all(&self) -> impl Iterator<Item = &Model> {
        std::iter::once(&self.truth).chain(&self.nav).chain(&self.foreign)
    }

    /// Checks that an FMU is in the study; `text` is what named it.
    ///
    /// # Errors
    /// [`HarnessError::UnknownModel`].
    pub fn require(&self, name: &str, text: &str) -> Result<&Model, HarnessError> {
        self.all()
            .find(|m| m.name == name)
            .ok_or_else(|| HarnessError::UnknownModel {
                model: name.to_owned(),
                text: text.to_owned(),
                known: self.all().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", "),
            })
    }

    /// The parts of a run: the truth, then each chosen filter, then the foreign ones.
    ///
    /// # Errors
    /// What cannot be set or does not exist, with the names that do.
    pub fn cast(
        &self,
        scenario: &Scenario,
        choices: &[FilterChoice],
        assignments: &[Assignment],
    ) -> Result<(Participant, Vec<Participant>), HarnessError> {
        for a in assignments {
            self.require(&a.model, &format!("{}.{}={}", a.model, a.variable, a.value))?;
        }
        let truth = StartValues::new(&self.truth)
            .scenario(scenario)?
            .assign(assignments)?
            .named(TRUTH);
        let mut filters = Vec::new();
        for choice in choices {
            let model = self.model_of(choice)?;
            let starts = StartValues::new(model).scenario(scenario)?;
            let tuned = self
                .tuned
                .iter()
                .filter(|t| t.scenario == scenario.name && t.filter == choice.name);
            let starts = if model.name == NAV {
                starts.filter(choice, tuned)?
            } else {
                starts.tuned(choice, tuned)?
            };
            if let Some(why) = model.filters.without_meaning(&choice.name, scenario.name) {
                return Err(HarnessError::NoMeaning {
                    filter: choice.label.clone(),
                    scenario: scenario.name.to_owned(),
                    why: why.to_owned(),
                });
            }
            filters.push(starts.assign(assignments)?.named(&choice.label));
        }
        for model in &self.foreign {
            filters.push(
                StartValues::new(model)
                    .scenario(scenario)?
                    .assign(assignments)?
                    .named(&model.name),
            );
        }
        let mut labels = BTreeSet::from([TRUTH]);
        if let Some(twice) = filters.iter().find(|f| !labels.insert(&f.label)) {
            return Err(HarnessError::LabelTwice {
                label: twice.label.clone(),
            });
        }
        if filters.is_empty() {
            return Err(HarnessError::NoFilter);
        }
        Ok((truth, filters))
    }

    /// The FMU that a choice is about: fmu-nav, or a foreign one under its label with a tuned set.
    ///
    /// # Errors
    /// [`HarnessError::NoNav`].
    pub fn model_of(&self, choice: &FilterChoice) -> Result<&Model, HarnessError> {
        // Without a preset the label of a foreign filter can only be a filter of ours.
        let foreign = self
            .foreign
            .iter()
            .find(|m| m.name == choice.name && choice.preset != PAPER);
        foreign.or(self.nav.as_ref()).ok_or_else(|| HarnessError::NoNav {
            label: choice.label.clone(),
        })
    }

    /// The tuned set of this name, if there is one.
    pub fn tuned_set(&self, scenario: &Scenario, filter: &str, name: &str) -> Option<&TunedSet> {
        let wanted = |t: &&TunedSet| t.scenario == scenario.name && t.filter == filter && t.name == name;
        self.tuned.iter().find(wanted)
    }

    /// Adds what a search found, in place of sets of the same names.
    pub fn add_tuned(&mut self, sets: Vec<TunedSet>) {
        let same = |a: &TunedSet, b: &TunedSet| (&a.scenario, &a.filter, &a.name) == (&b.scenario, &b.filter, &b.name);
        self.tuned.retain(|old| !sets.iter().any(|new| same(old, new)));
        self.tuned.extend(sets);
    }

    /// Time between the truth's samples, s, if it has a parameter of that name.
    pub fn sample_period(&self, truth: &Participant) -> Option<f64> {
        let variable = self.truth.description().get("sample_period");
        match truth.start("sample_period").cloned().or_else(|| variable?.start())? {
            Value::Real(period) => Some(period),
            _ => None,
        }
    }
}

/// Start values of one FMU as they come together: scenario, filter, preset, then the user's own.
struct StartValues<'a> {
    model: &'a Model,
    values: Vec<(String, Value)>,
}

impl<'a> StartValues<'a> {
    fn new(model: &'a Model) -> Self {
        Self {
            model,
            values: Vec::new(),
        }
    }

    /// Sets a variable by its own name; the last value of a name counts.
    fn set(&mut self, name: &str, text: &str) -> Result<(), HarnessError> {
        let variable = self.model.description().variable(name)?;
        let value = variable.parse_value(text).map_err(|source| HarnessError::Value {
            model: self.model.name.clone(),
            source: Box::new(source),
        })?;
        self.values.retain(|(n, _)| n != name);
        self.values.push((name.to_owned(), value));
        Ok(())
    }

    /// A foreign FMU without the parameter knows one world only.
    fn scenario(mut self, scenario: &Scenario) -> Result<Self, HarnessError> {
        if self.model.description().get("scenario").is_some() {
            self.set("scenario", scenario.name)?;
        }
        Ok(self)
    }

    fn filter<'t>(
        mut self,
        choice: &FilterChoice,
        mut tuned: impl Iterator<Item = &'t TunedSet> + Clone,
    ) -> Result<Self, HarnessError> {
        let items = self.model.description().items("filter");
        if !items.iter().any(|i| i.name == choice.name) {
            return Err(HarnessError::UnknownFilter {
                name: choice.name.clone(),
                known: items.iter().map(|i| i.name.as_str()).collect::<Vec<_>>().join(", "),
            });
        }
        self.set("filter", &choice.name)?;
        let presets = || self.model.filters.presets_of(&choice.name);
        let known: BTreeSet<&str> = presets().map(|p| p.name.as_str()).chain([PAPER]).collect();
        let sets = tuned.clone();
        // A tuned set holds what was searched; all else is as in the preset that the search started from.
        let set = tuned.find(|t| t.name == choice.preset && !known.contains(choice.preset.as_str()));
        let name = set.map_or(&choice.preset, |set| &set.preset);
        match presets().find(|p| p.name == *name) {
            Some(preset) => {
                for set in &preset.sets {
                    self.set(&set.variable, &set.value)?;
                }
            }
            // The paper's values are those the FMU starts with, so it need not list them.
            None if name == PAPER => {}
            None => return Err(unknown_preset(choice, known, sets)),
        }
        set.map_or(Ok(()), |set| self.values_of(set))?;
        Ok(self)
    }

    /// A foreign filter has no presets but those from a search.
    fn tuned<'t>(
        mut self,
        choice: &FilterChoice,
        mut tuned: impl Iterator<Item = &'t TunedSet> + Clone,
    ) -> Result<Self, HarnessError> {
        let sets = tuned.clone();
        let set = tuned
            .find(|t| t.name == choice.preset)
            .ok_or_else(|| unknown_preset(choice, BTreeSet::new(), sets))?;
        self.values_of(set)?;
        Ok(self)
    }

    fn values_of(&mut self, set: &TunedSet) -> Result<(), HarnessError> {
        for (variable, value) in &set.values {
            check_parameter(self.model, variable)
                .and_then(|()| self.set(variable, &format!("{value:?}")))
                .map_err(|source| HarnessError::BadTunedSet {
                    file: set.file.clone().unwrap_or_default(),
                    set: format!("{}@{}", set.filter, set.name),
                    scenario: set.scenario.clone(),
                    source: Box::new(source),
                })?;
        }
        Ok(())
    }

    fn assign(mut self, assignments: &[Assignment]) -> Result<Self, HarnessError> {
        for Assignment { variable, value, .. } in assignments.iter().filter(|a| a.model == self.model.name) {
            check_parameter(self.model, variable)?;
            self.set(variable, value)?;
        }
        Ok(self)
    }

    fn named(self, label: &str) -> Participant {
        let Model { name, fmu, aliases, .. } = self.model;
        let text = |name: &str, value: &Value| {
            fmu.description()
                .get(name)
                .map_or_else(|| format!("{value:?}"), |v| v.format_value(value))
        };
        Participant {
            label: label.to_owned(),
            model: name.clone(),
            source: fmu.clone(),
            aliases: aliases.clone(),
            record: self
                .values
                .iter()
                .map(|(name, value)| (name.clone(), text(name, value)))
                .collect(),
            starts: self
                .values
                .iter()
                .map(|(name, value)| (self.model.contract_name(name).to_owned(), value.clone()))
                .collect(),
            varied: Vec::new(),
        }
    }
}

/// Refuses what no option may set: no parameter, or one that another option governs.
fn check_parameter(model: &Model, variable: &str) -> Result<(), HarnessError> {
    let option = match variable {
        "scenario" => Some("--scenario"),
        "study_seed" => Some("--seed"),
        "run" => Some("--runs, or --run of replay"),
        "filter" if model.name == NAV => Some("--filters"),
        _ => None,
    };
    let names = || (model.name.clone(), variable.to_owned());
    if let Some(option) = option {
        let (model, variable) = names();
        return Err(HarnessError::Reserved {
            model,
            variable,
            option,
        });
    }
    let causality = model.description().variable(variable)?.causality;
    if causality != Causality::Parameter {
        let (model, variable) = names();
        return Err(HarnessError::NotAParameter {
            model,
            variable,
            causality,
        });
    }
    Ok(())
}

/// Refuses a range of anything but a Real parameter that can take both of its ends.
pub(crate) fn check_real_range(model: &Model, variable: &str, ends: [f64; 2]) -> Result<(), HarnessError> {
    check_parameter(model, variable)?;
    let described = model.description().variable(variable)?;
    if described.base_type() != BaseType::Real {
        return Err(HarnessError::NotReal {
            model: model.name.clone(),
            variable: variable.to_owned(),
            found: described.base_type(),
        });
    }
    for end in ends {
        described
            .parse_value(&end.to_string())
            .map_err(|source| HarnessError::Value {
                model: model.name.clone(),
                source: Box::new(source),
            })?;
    }
    Ok(())
}

fn unknown_preset<'t>(
    choice: &FilterChoice,
    presets: BTreeSet<&str>,
    tuned: impl Iterator<Item = &'t TunedSet>,
) -> HarnessError {
    let known: Vec<&str> = presets.into_iter().chain(tuned.map(|t| t.name.as_str())).collect();
    HarnessError::UnknownPreset {
        filter: choice.name.clone(),
        preset: choice.preset.clone(),
        known: known.join(", "),
    }
}
