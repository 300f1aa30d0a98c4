//! What `tune` does in one scenario: which filters, which ranges, and what is judged in the end.

use std::collections::BTreeSet;

use super::super::{Cast, note};
use crate::HarnessError;
use crate::cli::{StudyArgs, TuneArgs};
use crate::models::{FilterChoice, NAV, PAPER, TRUTH};
use crate::run::{Spec, rehearse};
use crate::scenarios::Scenario;
use crate::study::Study;
use crate::tuning::ranges::{Axis, axes, concerns};
use crate::tuning::sets::TunedSet;
use crate::tuning::study::{Options, Searched, Tuning};

/// Text of the `case` column.
const CASE: &str = "nominal";

/// Presets that no search of numbers finds: the other reading of a law.
const OTHER_READINGS: [&str; 1] = ["rbfnn_aekf@repaired"];

/// Filters of fmu-nav to tune: those asked for, else every one.
fn choices(args: &TuneArgs, cast: &Cast) -> Vec<FilterChoice> {
    if !args.study.filters.is_empty() {
        return args.study.filters.iter().filter_map(|f| f.0.clone()).collect();
    }
    let items = cast
        .models
        .nav
        .iter()
        .flat_map(|nav| nav.fmu.description().items("filter"));
    let names = items.map(|item| item.name.as_str()).chain(OTHER_READINGS);
    names.filter_map(|name| name.parse().ok()).collect()
}

/// Every `--range` names a filter of the study, and none a variable twice.
pub(super) fn check_ranges(args: &TuneArgs, cast: &Cast) -> Result<(), HarnessError> {
    let (models, choices) = (&cast.models, choices(args, cast));
    let mut seen = BTreeSet::new();
    for range in &args.ranges {
        let (model, variable) = (&range.model, &range.variable);
        let text = format!("{model}.{variable}={:?}:{:?}", range.low, range.high);
        models.require(model, &text)?;
        if !seen.insert((model, variable)) {
            return Err(HarnessError::RangeTwice {
                model: model.clone(),
                variable: variable.clone(),
            });
        }
        let acts = match &models.nav {
            _ if model == TRUTH => false,
            Some(nav) if model == NAV => {
                let nav = nav.fmu.description();
                choices.iter().any(|c| concerns(nav, &c.name, variable))
            }
            _ => true,
        };
        if !acts {
            let foreign = models.foreign.iter().map(|m| m.name.as_str());
            return Err(HarnessError::RangeOfNothing {
                model: model.clone(),
                variable: variable.clone(),
                known: choices
                    .iter()
                    .map(|c| c.label.as_str())
                    .chain(foreign)
                    .collect::<Vec<_>>()
                    .join(", "),
            });
        }
    }
    Ok(())
}

/// What is done in one scenario.
pub(super) struct Plan {
    pub(super) scenario: &'static Scenario,
    /// Filters that are chosen by name; the foreign ones follow them in a study.
    choices: Vec<FilterChoice>,
    /// The search, by filter: the choices, then the foreign filters.
    pub(super) tuning: Tuning,
    /// What is judged: every filter as given and as tuned.
    judged: Vec<FilterChoice>,
    /// Foreign filters.
    foreign: usize,
}

impl Plan {
    pub(super) fn new(
        args: &TuneArgs,
        options: Options,
        cast: &Cast,
        scenario: &'static Scenario,
    ) -> Result<Self, HarnessError> {
        let models = &cast.models;
        let mut choices = choices(args, cast);
        if let Some(nav) = &models.nav {
            choices.retain(
                |choice| match nav.filters.without_meaning(&choice.name, scenario.name) {
                    Some(why) => {
                        note(&format!(
                            "note: {} is left out of {}: {why}",
                            choice.label, scenario.name
                        ));
                        false
                    }
                    None => true,
                },
            );
        }
        let spec = cast.spec_of(&choices, &args.study, scenario)?;
        for open in rehearse(&spec)? {
            note(&format!("note: nothing feeds {open}; it keeps its start value"));
        }
        let own = choices
            .iter()
            .map(|choice| models.model_of(choice).map(|m| (m, choice)));
        let own = own.collect::<Result<Vec<_>, _>>()?.into_iter();
        let named = own.map(|(model, choice)| (model, (model.name == NAV).then_some(choice.name.as_str())));
        let foreign = models.foreign.iter().map(|model| (model, None));
        let axes = named
            .chain(foreign)
            .zip(&spec.filters)
            .map(|((model, filter), base)| axes(model, filter, base, &args.ranges, &args.study.assignments))
            .collect::<Result<Vec<_>, _>>()?;
        let judged = judged(&choices, &spec, &axes)?;
        Ok(Self {
            scenario,
            choices,
            tuning: Tuning::new(spec, axes, options),
            judged,
            foreign: models.foreign.len(),
        })
    }

    /// Runs of filters that searching and judging take.
    pub(super) fn work(&self, args: &TuneArgs) -> u64 {
        self.tuning.work() + u64::from(args.judge_runs) * (self.judged.len() + self.foreign) as u64
    }

    /// The study that judges what the search found, which `cast` must know by then.
    pub(super) fn judge(&self, args: &TuneArgs, options: &Options, cast: &Cast) -> Result<Study, HarnessError> {
        let judged = StudyArgs {
            seed: args.judge_seed,
            ..args.study.clone()
        };
        Ok(Study {
            spec: cast.spec_of(&self.judged, &judged, self.scenario)?,
            runs: args.judge_runs,
            jobs: options.jobs,
            case: CASE.to_owned(),
        })
    }

    /// The winners, in the order of the spec; none for a filter with nothing to tune.
    pub(super) fn sets(&self, cast: &Cast) -> Vec<TunedSet> {
        let set = |(index, searched): (usize, &Searched)| {
            let best = searched.best()?;
            let found = searched.settings(best).map(|(name, value)| (name.to_owned(), value));
            let (filter, given) = match self.choices.get(index) {
                Some(choice) => (&choice.name, choice.preset.as_str()),
                None => (&searched.base.label, PAPER),
            };
            // A search may start from what another one found.
            let before = cast.models.tuned_set(self.scenario, filter, given);
            let mut values = before.map(|t| t.values.clone()).unwrap_or_default();
            values.extend(found);
            Some(TunedSet {
                file: None,
                scenario: self.scenario.name.to_owned(),
                filter: filter.clone(),
                preset: before.map_or(given, |t| &t.preset).to_owned(),
                name: TunedSet::name_for(given),
                values,
                search_objective: Some(best.standing.objective).filter(|o| o.is_finite()),
                search_nees: best.tally.nees(),
                feasible: best.standing.feasible(),
            })
        };
        self.tuning.filters.iter().enumerate().filter_map(set).collect()
    }
}

/// Each filter as given and, if it can be tuned, as tuned.
fn judged(choices: &[FilterChoice], spec: &Spec, axes: &[Vec<Axis>]) -> Result<Vec<FilterChoice>, HarnessError> {
    let mut judged = Vec::new();
    for (index, (base, axes)) in spec.filters.iter().zip(axes).enumerate() {
        let choice = choices.get(index);
        judged.extend(choice.cloned());
        if !axes.is_empty() {
            judged.push(tuned_choice(choice, &base.label));
        }
    }
    let mut labels = BTreeSet::new();
    match judged.iter().find(|c| !labels.insert(c.label.as_str())) {
        Some(twice) => Err(HarnessError::LabelTwice {
            label: twice.label.clone(),
        }),
        None => Ok(judged),
    }
}

/// The tuned set of a filter of ours, or of the foreign filter of that label.
fn tuned_choice(choice: Option<&FilterChoice>, label: &str) -> FilterChoice {
    let (name, preset) = choice.map_or((label, PAPER), |c| (&c.name, &c.preset));
    let preset = TunedSet::name_for(preset);
    FilterChoice {
        label: format!("{name}@{preset}"),
        name: name.to_owned(),
        preset,
    }
}

/// Label of the tuned set of a filter with this label.
pub(super) fn tuned_label(given: &str) -> String {
    tuned_choice(given.parse().ok().as_ref(), given).label
}
