//! What `tune` does in one world: who is searched, and what is judged in the end.

use std::collections::BTreeSet;

use study::{ALL, FilterChoice, Models, NAV, Plan, TRUTH, TunedSet, World, rehearse};

use super::super::shared::note;
use crate::HarnessError;
use crate::tuning::contender::{Contender, contenders, every_filter};
use crate::tuning::ranges::{Range, concerns};
use crate::tuning::study::{Options, Searched, Tuning};

/// Filters that are chosen by name: those asked for, where [`ALL`] stands for every one of fmu-nav that is not named, else
/// every one.
fn choices(plan: &Plan, models: &Models) -> Vec<FilterChoice> {
    let Some(asked) = &plan.filters else {
        return every_filter(models);
    };
    let others = || {
        every_filter(models)
            .into_iter()
            .filter(|choice| !asked.contains(choice))
    };
    let expanded = |choice: &FilterChoice| match choice.label.as_str() {
        ALL => others().collect(),
        _ => vec![choice.clone()],
    };
    asked.iter().flat_map(expanded).collect()
}

/// Every `--range` names a filter of the study, and none a variable twice.
pub(super) fn check_ranges(ranges: &[Range], plan: &Plan, models: &Models) -> Result<(), HarnessError> {
    let choices = choices(plan, models);
    let mut seen = BTreeSet::new();
    for range in ranges {
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
                let nav = nav.description();
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

/// What is done in one world.
pub(super) struct Contest {
    pub(super) world: World,
    /// The search, by contender.
    pub(super) tuning: Tuning,
}

impl Contest {
    pub(super) fn new(
        ranges: &[Range],
        options: Options,
        plan: &Plan,
        models: &Models,
        world: World,
    ) -> Result<Self, HarnessError> {
        let mut choices = choices(plan, models);
        if let Some(nav) = &models.nav {
            choices.retain(|choice| {
                let why = nav
                    .filters
                    .without_meaning(&choice.name, &world.name, world.frame.name());
                if let Some(why) = why {
                    note(&format!("note: {} is left out of {}: {why}", choice.label, world.name));
                }
                why.is_none()
            });
        }
        let plan = Plan {
            filters: Some(choices.clone()),
            ..plan.clone()
        };
        let spec = models.spec(&plan, &world)?;
        for text in rehearse(&spec)? {
            note(&format!("note: {text}"));
        }
        let contenders = contenders(models, &choices, &spec, ranges, &plan.assignments)?;
        Ok(Self {
            world,
            tuning: Tuning::new(spec, contenders, options),
        })
    }

    fn contenders(&self) -> impl Iterator<Item = &Contender> {
        self.tuning.filters.iter().map(|f| &f.contender)
    }

    /// What is judged by choice: every filter as given and as tuned; a foreign one as given takes part without.
    pub(super) fn judged(&self) -> Vec<FilterChoice> {
        self.contenders().flat_map(Contender::judged).collect()
    }

    /// Runs of filters that searching and judging take.
    pub(super) fn work(&self, judge_runs: u32) -> u64 {
        let foreign = self.contenders().filter(|c| c.choice.is_none()).count();
        self.tuning.work() + u64::from(judge_runs) * (self.judged().len() + foreign) as u64
    }

    /// The winners, in the order of the contenders; none for a filter with nothing to tune.
    ///
    /// * `known`: sets from which this search may have started.
    /// * `conditions`: what differs from the missions as they stand.
    pub(super) fn sets(&self, known: &[TunedSet], conditions: &[String]) -> Vec<TunedSet> {
        let set = |searched: &Searched| {
            let best = searched.best()?;
            let found = searched.settings(best).map(|(name, value)| (name.to_owned(), value));
            let Contender { filter, preset, .. } = &searched.contender;
            let same = |t: &&TunedSet| t.scenario == self.world.name && t.filter == *filter && t.name == *preset;
            let before = known.iter().find(same);
            let mut values = before.map(|t| t.values.clone()).unwrap_or_default();
            values.extend(found);
            Some(TunedSet {
                file: None,
                scenario: self.world.name.clone(),
                filter: filter.clone(),
                preset: before.map_or(preset, |t| &t.preset).clone(),
                name: TunedSet::name_for(preset),
                values,
                conditions: conditions.to_vec(),
                search_objective: Some(best.standing.objective).filter(|o| o.is_finite()),
                search_nees: best.tally.nees6(),
                feasible: best.standing.feasible(),
            })
        };
        self.tuning.filters.iter().filter_map(set).collect()
    }
}
