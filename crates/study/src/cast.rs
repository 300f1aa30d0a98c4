//! From a plan to the parts of its runs.

use std::collections::BTreeSet;

use cosim::Value;
use interface::Sensor;

use crate::arguments::{Assignment, FilterChoice};
use crate::error::StudyError;
use crate::models::{Model, Models, NAV, OwnFmus, TRUTH};
use crate::participant::Participant;
use crate::phase::Phases;
use crate::plan::{ALL, Plan};
use crate::spec::Spec;
use crate::starts::{StartValues, check_real_range};
use crate::study::Study;
use crate::tuned::TunedSet;
use crate::variation::{Variation, Varied};
use crate::world::World;

/// What a reader of the results must know of the drivers.
fn driven(drivers: &[Participant], closed_loop: bool) -> Option<String> {
    let labels: Vec<&str> = drivers.iter().map(|driver| driver.label.as_str()).collect();
    let labels = labels.join(", ");
    match (drivers.is_empty(), closed_loop) {
        (true, _) => None,
        (false, false) => Some(format!("driven by {labels}; all filters share each world")),
        (false, true) => Some(format!(
            "driven by {labels} on a filter's estimate: every filter flies in a world of its own, so that differences between \
             filters are paired by seed alone"
        )),
    }
}

impl Models {
    /// Opens the FMUs that a plan names.
    ///
    /// * `own`: our FMUs, as far as [`Plan::needs`] them.
    ///
    /// # Errors
    /// As for [`Models::open`].
    pub fn of(plan: &Plan, own: &OwnFmus) -> Result<Self, StudyError> {
        let truth = plan.truth.as_deref().or(own.truth.as_deref());
        Self::open(
            truth.unwrap_or(TRUTH.as_ref()),
            own.nav.as_deref(),
            &plan.foreign,
            &plan.drive,
            &plan.mappings,
        )
    }

    /// Refuses what is set twice, or set in vain: for a filter that is in no study, for a sensor that no mission has.
    ///
    /// # Errors
    /// [`StudyError::SetTwice`], [`StudyError::NoEffect`].
    pub fn check_effects(&self, plan: &Plan, worlds: &[World]) -> Result<(), StudyError> {
        for (index, a) in plan.assignments.iter().enumerate() {
            let same = |b: &Assignment| (&a.model, &a.variable) == (&b.model, &b.variable);
            if plan.assignments[..index].iter().any(same) {
                return Err(StudyError::SetTwice {
                    model: a.model.clone(),
                    variable: a.variable.clone(),
                });
            }
        }
        let set = plan.in_fmus().map(|a| (&a.model, &a.variable));
        let varied = plan.variations.iter().map(|v| (&v.model, &v.variable));
        for (model, variable) in set.chain(varied) {
            let why: Option<Vec<String>> = worlds.iter().map(|w| self.in_vain(plan, w, model, variable)).collect();
            if let Some(why) = why.and_then(|why| why.into_iter().next()) {
                return Err(StudyError::NoEffect {
                    model: model.clone(),
                    variable: variable.clone(),
                    why,
                });
            }
        }
        Ok(())
    }

    /// Why a setting does nothing in a world.
    fn in_vain(&self, plan: &Plan, world: &World, model: &str, variable: &str) -> Option<String> {
        let owner = variable.split_once('.').map_or("", |(owner, _)| owner);
        if model == NAV && self.has_filter(owner) {
            let chosen = self.choices(plan, world).iter().any(|choice| choice.name == owner);
            return (!chosen).then(|| format!("filter '{owner}' takes no part"));
        }
        if model != TRUTH || plan.truth.is_some() {
            return None;
        }
        let sensor = Sensor::ALL.into_iter().find(|sensor| sensor.name() == owner)?;
        let has = world.mission.sensors.of_the_target().any(|own| own.sensor == sensor);
        (!has).then(|| format!("the mission has no {}", sensor.table()))
    }

    /// What a reader should know of a plan in this world: settings that do nothing here, tuned sets from other conditions.
    fn notes(&self, plan: &Plan, world: &World) -> Vec<String> {
        let set = plan.in_fmus().map(|a| (&a.model, &a.variable));
        let varied = plan.variations.iter().map(|v| (&v.model, &v.variable));
        let in_vain = set.chain(varied).filter_map(|(model, variable)| {
            let why = self.in_vain(plan, world, model, variable)?;
            Some(format!("{model}.{variable} does nothing here: {why}"))
        });
        let here = plan.deviations();
        let choices = self.choices(plan, world);
        let elsewhere = choices.iter().filter_map(|choice| {
            let used = |t: &&TunedSet| t.scenario == world.name && t.filter == choice.name && t.name == choice.preset;
            plan.tuned.iter().find(used)?.elsewhere(&here)
        });
        in_vain.chain(elsewhere).collect()
    }

    /// Filters that are chosen by name in a world, where [`ALL`] stands for every one with a meaning there that is neither named
    /// nor a bound.
    fn choices(&self, plan: &Plan, world: &World) -> Vec<FilterChoice> {
        let asked = plan.choices(world);
        let Some(nav) = self
            .nav
            .as_ref()
            .filter(|_| asked.iter().any(|choice| choice.label == ALL))
        else {
            return asked.to_vec();
        };
        let named = |name: &str| asked.iter().any(|choice| choice.label == name);
        let mut chosen = Vec::new();
        for choice in asked {
            if choice.label != ALL {
                chosen.push(choice.clone());
                continue;
            }
            let items = nav.description().items("filter").iter().map(|item| item.name.as_str());
            let meant = items.filter(|name| {
                !named(name)
                    && !nav.filters.is_bound(name)
                    && nav
                        .filters
                        .without_meaning(name, &world.name, world.frame.name())
                        .is_none()
            });
            chosen.extend(meant.filter_map(|name| name.parse().ok()));
        }
        chosen
    }

    /// Whether a variable of fmu-nav is this filter's own, or of no filter in particular: its name has that of no other.
    fn concerns(&self, variable: &str, choice: &FilterChoice) -> bool {
        let mut parts = variable.split('.');
        parts.all(|part| part == choice.name || !self.has_filter(part))
    }

    /// Whether fmu-nav has a filter of this name.
    fn has_filter(&self, name: &str) -> bool {
        let filter = self.nav.as_ref().and_then(|nav| nav.description().get("filter"));
        let items = filter.and_then(|filter| filter.enumeration_items());
        items.is_some_and(|items| items.iter().any(|item| item.name == name))
    }

    /// The study of one world of a plan.
    ///
    /// # Errors
    /// As for [`Models::spec`].
    pub fn study(&self, plan: &Plan, world: &World) -> Result<Study, StudyError> {
        Ok(Study {
            spec: self.spec(plan, world)?,
            runs: plan.runs,
            jobs: plan.threads(),
            case: plan.case_text(),
        })
    }

    /// What the runs of one world of a plan share.
    ///
    /// # Errors
    /// What cannot be set or varied or does not exist, with the names that do.
    pub fn spec(&self, plan: &Plan, world: &World) -> Result<Spec, StudyError> {
        let choices = &self.choices(plan, world);
        let assignments: Vec<Assignment> = plan.in_fmus().cloned().collect();
        let (mut truth, mut filters) = self.cast(world, choices, &plan.tuned, &assignments)?;
        for filter in filters.iter_mut().filter(|_| plan.allow_truth) {
            let asks = |model: &Model| model.name == filter.model && model.asks_for_the_truth();
            filter.bound |= self.foreign.iter().any(asks);
        }
        let mut drivers = self.drivers(world, &filters, &assignments)?;
        let parts = std::iter::once(&mut truth).chain(&mut filters).chain(&mut drivers);
        self.vary(parts, &plan.variations, &assignments)?;
        let closed_loop = self.drivers.iter().any(Model::reads_a_filter);
        let suggested = self.truth.description().default_experiment.step_size;
        // A foreign truth may keep its sample period to itself; then it is taken to sample at each step.
        let sample_period = self
            .sample_period(&truth, world)
            .or(plan.step_s)
            .or(suggested)
            .unwrap_or(world.sample_period_s);
        let world = World {
            duration_s: plan.duration_s.unwrap_or(world.duration_s),
            notes: [
                world.notes.clone(),
                driven(&drivers, closed_loop).into_iter().collect(),
                self.notes(plan, world),
            ]
            .concat(),
            ..world.clone()
        };
        Ok(Spec {
            phases: Phases::new(&world, &truth, &plan.phases)?,
            world,
            truth,
            filters,
            drivers,
            closed_loop,
            seed: plan.seed,
            step: plan.step_s.unwrap_or(sample_period),
            sample_period,
            scheme: plan.scheme,
            allow_truth: plan.allow_truth,
        })
    }

    /// The truth of a world by itself, for a run that nobody navigates.
    ///
    /// # Errors
    /// What cannot be set or does not exist, with the names that do.
    pub fn truth_alone(&self, world: &World, assignments: &[Assignment]) -> Result<Participant, StudyError> {
        for a in assignments {
            self.require(&a.model, &a.to_string())?;
        }
        Ok(StartValues::new(&self.truth)
            .world(world)?
            .assign(assignments)?
            .named(TRUTH))
    }

    /// The parts of a run: the truth, then each chosen filter, then the foreign ones.
    ///
    /// * `tuned`: sets from a search, beside the presets of the FMUs.
    ///
    /// # Errors
    /// What cannot be set or does not exist, with the names that do.
    pub fn cast(
        &self,
        world: &World,
        choices: &[FilterChoice],
        tuned: &[TunedSet],
        assignments: &[Assignment],
    ) -> Result<(Participant, Vec<Participant>), StudyError> {
        let truth = self.truth_alone(world, assignments)?;
        let mut filters = Vec::new();
        for choice in choices {
            let model = self.model_of(choice)?;
            let starts = StartValues::new(model).world(world)?;
            let tuned = tuned
                .iter()
                .filter(|t| t.scenario == world.name && t.filter == choice.name);
            let starts = if model.name == NAV {
                starts.filter(choice, tuned)?
            } else {
                starts.tuned(choice, tuned)?
            };
            if let Some(why) = model
                .filters
                .without_meaning(&choice.name, &world.name, world.frame.name())
            {
                return Err(StudyError::NoMeaning {
                    filter: choice.label.clone(),
                    scenario: world.name.clone(),
                    why: why.to_owned(),
                });
            }
            let concerned = assignments
                .iter()
                .filter(|a| a.model != NAV || self.concerns(&a.variable, choice));
            let mut filter = starts.share(assignments)?.assign(concerned)?.named(&choice.label);
            filter.calculated.retain(|name| self.concerns(name, choice));
            filter.bound = model.filters.is_bound(&choice.name);
            filters.push(filter);
        }
        for model in &self.foreign {
            filters.push(
                StartValues::new(model)
                    .world(world)?
                    .share(assignments)?
                    .assign(assignments)?
                    .named(&model.name),
            );
        }
        let mut labels = BTreeSet::from([TRUTH]);
        if let Some(twice) = filters.iter().find(|f| !labels.insert(&f.label)) {
            return Err(StudyError::LabelTwice {
                label: twice.label.clone(),
            });
        }
        if filters.is_empty() {
            return Err(StudyError::NoFilter);
        }
        Ok((truth, filters))
    }

    /// The drivers of a run, beside these filters.
    ///
    /// # Errors
    /// What cannot be set or does not exist; [`StudyError::LabelTwice`].
    fn drivers(
        &self,
        world: &World,
        filters: &[Participant],
        assignments: &[Assignment],
    ) -> Result<Vec<Participant>, StudyError> {
        let mut labels: BTreeSet<&str> = filters.iter().map(|filter| filter.label.as_str()).collect();
        labels.extend([TRUTH, NAV]);
        let drivers = self.drivers.iter().map(|model| {
            if !labels.insert(&model.name) {
                return Err(StudyError::LabelTwice {
                    label: model.name.clone(),
                });
            }
            let starts = StartValues::new(model).world(world)?.assign(assignments)?;
            Ok(starts.named(&model.name))
        });
        drivers.collect()
    }

    /// Time between the truth's samples, s, if it has a parameter of that name; a value that is not positive stands for
    /// the world's own.
    pub fn sample_period(&self, truth: &Participant, world: &World) -> Option<f64> {
        let variable = self.truth.description().get("sample_period");
        match truth.start("sample_period").cloned().or_else(|| variable?.start())? {
            // The mission's own, also where a sensor has a period of its own.
            Value::Real(_) if self.truth.description().get("mission_file").is_some() => Some(world.sample_period_s),
            Value::Real(period) if period <= 0.0 => Some(world.sample_period_s),
            Value::Real(period) => Some(period),
            _ => None,
        }
    }

    /// Makes parameters of the parts of a run differ from run to run; after presets and `--set`.
    ///
    /// * `assignments`: what `--set` sets, to refuse what is both set and varied.
    ///
    /// # Errors
    /// What does not exist, is no Real parameter, cannot take an end of its range, or stands twice.
    pub fn vary<'a>(
        &self,
        parts: impl IntoIterator<Item = &'a mut Participant>,
        variations: &[Variation],
        assignments: &[Assignment],
    ) -> Result<(), StudyError> {
        let mut parts: Vec<&mut Participant> = parts.into_iter().collect();
        for (draw, variation) in variations.iter().enumerate() {
            let Variation {
                model: name,
                variable,
                distribution,
            } = variation;
            let model = self.require(name, &variation.to_string())?;
            check_real_range(model, variable, &distribution.extremes())?;
            let set = assignments.iter().any(|a| a.model == *name && a.variable == *variable);
            let earlier = &variations[..draw];
            if set || earlier.iter().any(|v| v.model == *name && v.variable == *variable) {
                return Err(StudyError::VariedTwice {
                    model: name.clone(),
                    variable: variable.clone(),
                });
            }
            let varied = Varied {
                name: model.contract_name(variable).to_owned(),
                distribution: distribution.clone(),
                draw,
            };
            for part in parts.iter_mut().filter(|p| p.model == *name) {
                part.starts.retain(|(name, _)| *name != varied.name);
                part.record.retain(|(name, _)| name != variable);
                part.record.push((variable.clone(), distribution.to_string()));
                part.varied.push(varied.clone());
            }
        }
        Ok(())
    }
}
