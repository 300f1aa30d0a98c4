//! Who takes part in a search.

use std::collections::BTreeSet;

use study::{Assignment, FilterChoice, Models, NAV, PAPER, Participant, Spec, StudyError, TunedSet};

use super::ranges::{Axis, Range, axes};
use crate::HarnessError;

/// A filter on its way through a search.
#[derive(Debug, Clone)]
pub struct Contender {
    /// Filter of fmu-nav, or label of a foreign filter.
    pub filter: String,
    /// Preset that the search starts from.
    pub preset: String,
    /// How it was chosen; `None` for a foreign filter, which takes part without.
    pub choice: Option<FilterChoice>,
    /// The filter before the search.
    pub base: Participant,
    /// What is searched; nothing for a filter that is only judged.
    pub axes: Vec<Axis>,
}

impl Contender {
    /// A foreign filter, under its label.
    pub fn foreign(base: Participant, axes: Vec<Axis>) -> Self {
        Self {
            filter: base.label.clone(),
            preset: PAPER.to_owned(),
            choice: None,
            base,
            axes,
        }
    }

    fn chosen(choice: &FilterChoice, base: Participant, axes: Vec<Axis>) -> Self {
        Self {
            filter: choice.name.clone(),
            preset: choice.preset.clone(),
            choice: Some(choice.clone()),
            base,
            axes,
        }
    }

    /// The set that the search leaves behind, as a choice.
    pub fn tuned(&self) -> FilterChoice {
        let preset = TunedSet::name_for(&self.preset);
        FilterChoice {
            label: format!("{}@{preset}", self.filter),
            name: self.filter.clone(),
            preset,
        }
    }

    /// What of it is judged by choice: as given and, if it can be tuned, as tuned. A foreign filter as given needs none.
    pub fn judged(&self) -> impl Iterator<Item = FilterChoice> {
        let tuned = (!self.axes.is_empty()).then(|| self.tuned());
        self.choice.clone().into_iter().chain(tuned)
    }
}

/// The filters of a study, each with what is searched of it.
///
/// * `spec`: with the filters as they would run without a search: those chosen, then the foreign ones.
/// * `ranges`, `assignments`: what is searched beside the FMU's own ranges, and what is set and so not searched.
///
/// # Errors
/// What cannot be searched, and [`StudyError::LabelTwice`] for two filters that would leave the same set.
pub fn contenders(
    models: &Models,
    choices: &[FilterChoice],
    spec: &Spec,
    ranges: &[Range],
    assignments: &[Assignment],
) -> Result<Vec<Contender>, HarnessError> {
    let (chosen, foreign) = spec.filters.split_at(choices.len().min(spec.filters.len()));
    let mut contenders = Vec::new();
    for (choice, base) in choices.iter().zip(chosen) {
        let model = models.model_of(choice)?;
        let filter = (model.name == NAV).then_some(choice.name.as_str());
        let axes = axes(model, filter, base, ranges, assignments)?;
        contenders.push(Contender::chosen(choice, base.clone(), axes));
    }
    for (model, base) in models.foreign.iter().zip(foreign) {
        let axes = axes(model, None, base, ranges, assignments)?;
        contenders.push(Contender::foreign(base.clone(), axes));
    }
    let mut labels = BTreeSet::new();
    let twice = contenders
        .iter()
        .flat_map(Contender::judged)
        .find(|c| !labels.insert(c.label.clone()));
    match twice {
        Some(twice) => Err(StudyError::LabelTwice { label: twice.label }.into()),
        None => Ok(contenders),
    }
}

/// Every filter of fmu-nav but its bounds, and the presets that no search of numbers finds: the other reading of a law.
pub fn every_filter(models: &Models) -> Vec<FilterChoice> {
    let items = models.nav.iter().flat_map(|nav| nav.description().items("filter"));
    let bound = |name: &str| models.nav.as_ref().is_some_and(|nav| nav.filters.is_bound(name));
    let filters = items.map(|item| item.name.clone()).filter(|name| !bound(name));
    let presets = models.nav.iter().flat_map(|nav| &nav.filters.presets);
    let presets = presets.filter(|p| p.other_reading);
    let labels = filters.chain(presets.map(|p| format!("{}@{}", p.filter, p.name)));
    labels.filter_map(|label| label.parse().ok()).collect()
}
