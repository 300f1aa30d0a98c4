//! Start values of one FMU: world, filter, preset, then what is set.

use std::collections::BTreeSet;

use cosim::{BaseType, Value};
use fmi2_import::{Causality, suggest};

use crate::arguments::{Assignment, FilterChoice, PAPER};
use crate::error::StudyError;
use crate::models::{Model, NAV, TRUTH};
use crate::participant::Participant;
use crate::tuned::TunedSet;
use crate::world::World;

/// Start values of one FMU as they come together: scenario, filter, preset, then the user's own.
pub(crate) struct StartValues<'a> {
    model: &'a Model,
    values: Vec<(String, Value)>,
}

impl<'a> StartValues<'a> {
    pub(crate) fn new(model: &'a Model) -> Self {
        Self {
            model,
            values: Vec::new(),
        }
    }

    /// Sets a variable by its own name; the last value of a name counts.
    fn set(&mut self, name: &str, text: &str) -> Result<(), StudyError> {
        let variable = self.model.description().variable(name)?;
        let value = variable.parse_value(text).map_err(|source| StudyError::Value {
            model: self.model.name.clone(),
            source: Box::new(source),
        })?;
        self.values.retain(|(n, _)| n != name);
        self.values.push((name.to_owned(), value));
        Ok(())
    }

    /// A foreign FMU without the parameters knows one world only.
    ///
    /// A world is named twice where it can be: to an FMU that was packed with a mission, the first scenario is that mission.
    pub(crate) fn world(mut self, world: &World) -> Result<Self, StudyError> {
        let has = |name| self.model.description().get(name).is_some();
        match &world.mission_file {
            Some(path) if has("mission_file") => self.set("mission_file", &path.display().to_string())?,
            Some(_) => {}
            None => {
                if has("scenario") {
                    self.set("scenario", &world.name)?;
                }
                if has("mission_file") {
                    self.set("mission_file", &world.name)?;
                }
            }
        }
        Ok(self)
    }

    pub(crate) fn filter<'t>(
        mut self,
        choice: &FilterChoice,
        mut tuned: impl Iterator<Item = &'t TunedSet> + Clone,
    ) -> Result<Self, StudyError> {
        let items = self.model.description().items("filter");
        if !items.iter().any(|i| i.name == choice.name) {
            return Err(StudyError::UnknownFilter {
                name: choice.name.clone(),
                meant: suggest(&choice.name, items.iter().map(|i| i.name.as_str())),
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
    pub(crate) fn tuned<'t>(
        mut self,
        choice: &FilterChoice,
        mut tuned: impl Iterator<Item = &'t TunedSet> + Clone,
    ) -> Result<Self, StudyError> {
        let sets = tuned.clone();
        let set = tuned
            .find(|t| t.name == choice.preset)
            .ok_or_else(|| unknown_preset(choice, BTreeSet::new(), sets))?;
        self.values_of(set)?;
        Ok(self)
    }

    fn values_of(&mut self, set: &TunedSet) -> Result<(), StudyError> {
        for (variable, value) in &set.values {
            check_parameter(self.model, variable)
                .and_then(|()| self.set(variable, &format!("{value:?}")))
                .map_err(|source| StudyError::BadTunedSet {
                    file: set.file.clone().unwrap_or_else(|| "the plan".into()),
                    set: format!("{}@{}", set.filter, set.name),
                    scenario: set.scenario.clone(),
                    source: Box::new(source),
                })?;
        }
        Ok(())
    }

    /// Sets what the truth is told and this filter must be told alike, where it can be. What is meant for the filter itself comes later
    /// and goes before.
    pub(crate) fn share<'t>(
        mut self,
        assignments: impl IntoIterator<Item = &'t Assignment>,
    ) -> Result<Self, StudyError> {
        let of_truth = assignments.into_iter().filter(|a| a.model == TRUTH);
        for Assignment { variable, value, .. } in of_truth {
            let own = self.model.description().get(variable);
            let takes = own.is_some_and(|own| own.causality == Causality::Parameter);
            if takes && SHARED.contains(&variable.as_str()) {
                self.set(variable, value)?;
            }
        }
        Ok(self)
    }

    /// Sets what is meant for this FMU.
    pub(crate) fn assign<'t>(
        mut self,
        assignments: impl IntoIterator<Item = &'t Assignment>,
    ) -> Result<Self, StudyError> {
        let model = self.model;
        let own = assignments.into_iter().filter(|a| a.model == model.name);
        for Assignment { variable, value, .. } in own {
            check_parameter(self.model, variable)?;
            self.set(variable, value)?;
        }
        Ok(self)
    }

    pub(crate) fn named(self, label: &str) -> Participant {
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
            bound: false,
            beside_bounds: !self.model.filters.bounds.is_empty(),
            calculated: self.model.calculated(),
            statuses: self.model.statuses(),
        }
    }
}

/// Parameters of the truth that say what a filter is told of, too.
const SHARED: [&str; 1] = ["guidance.burn_enabled"];

/// Refuses what no option may set: no parameter, or one that another option governs.
fn check_parameter(model: &Model, variable: &str) -> Result<(), StudyError> {
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
        return Err(StudyError::Reserved {
            model,
            variable,
            option,
        });
    }
    let causality = model.description().variable(variable)?.causality;
    if causality != Causality::Parameter {
        let (model, variable) = names();
        return Err(StudyError::NotAParameter {
            model,
            variable,
            causality,
        });
    }
    Ok(())
}

/// Refuses to spread anything but a Real parameter that can take these values.
///
/// # Errors
/// What the variable is, or which value it cannot take.
pub fn check_real_range(model: &Model, variable: &str, values: &[f64]) -> Result<(), StudyError> {
    check_parameter(model, variable)?;
    let described = model.description().variable(variable)?;
    if described.base_type() != BaseType::Real {
        return Err(StudyError::NotReal {
            model: model.name.clone(),
            variable: variable.to_owned(),
            found: described.base_type(),
        });
    }
    for value in values {
        described
            .parse_value(&value.to_string())
            .map_err(|source| StudyError::Value {
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
) -> StudyError {
    let known: Vec<&str> = presets.into_iter().chain(tuned.map(|t| t.name.as_str())).collect();
    StudyError::UnknownPreset {
        filter: choice.name.clone(),
        preset: choice.preset.clone(),
        known: known.join(", "),
    }
}
