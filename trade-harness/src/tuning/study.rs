//! Every filter of a scenario searched at once, side by side in the same worlds.

use super::ranges::Axis;
use super::search::{Candidate, Search};
use super::standing::{Limits, Objective, Standing};
use super::tally::{Tally, evaluate};
use crate::HarnessError;
use crate::models::Participant;
use crate::run::Spec;

/// Candidates in one run at most; each is a slave of its own beside the truth.
const TOGETHER: usize = 64;

/// What a search is after and what it may spend.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The error to make small.
    pub objective: Objective,
    /// The NEES that a candidate must have.
    pub limits: Limits,
    /// Candidates of each filter, its starting point included.
    pub evaluations: u32,
    /// Runs of each candidate; the seed is that of the spec.
    pub runs: u32,
    /// Threads.
    pub jobs: usize,
}

/// A candidate and how it did.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Round of the search, from 0: the whole box.
    pub round: usize,
    /// Values of the searched parameters, in the order of the axes; `None` for the starting point, which sets nothing.
    pub values: Option<Vec<f64>>,
    /// Its runs.
    pub tally: Tally,
    /// Its rank.
    pub standing: Standing,
}

/// One filter's search.
#[derive(Debug)]
pub struct Searched {
    /// The filter before the search.
    pub base: Participant,
    /// What is varied.
    pub axes: Vec<Axis>,
    /// Every candidate, in order.
    pub evaluations: Vec<Evaluation>,
    search: Search,
}

impl Searched {
    /// The best candidate; `None` before the first turn.
    pub fn best(&self) -> Option<&Evaluation> {
        self.evaluations.get(self.search.best()?)
    }

    /// Share by which the last quarter of the evaluations has lowered the objective: 0 when the winner is older, 1 when
    /// nothing before was feasible.
    pub fn late_gain(&self) -> f64 {
        let early = self.evaluations.len() * 3 / 4;
        let standings = |part: &[Evaluation]| part.iter().map(|e| e.standing).min_by(Standing::total_cmp);
        let (Some(before), Some(best)) = (standings(&self.evaluations[..early]), self.best()) else {
            return 0.0;
        };
        match (before.feasible(), best.standing.feasible()) {
            (true, true) => 1.0 - best.standing.objective / before.objective,
            (false, true) => 1.0,
            _ => 0.0,
        }
    }

    /// A candidate's values: a name and a number each, none for the starting point.
    pub fn settings<'a>(&'a self, evaluation: &'a Evaluation) -> impl Iterator<Item = (&'a str, f64)> {
        let names = self.axes.iter().map(|a| a.variable.as_str());
        names.zip(evaluation.values.iter().flatten().copied())
    }

    fn values(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        match candidate {
            Candidate::Start => None,
            Candidate::Point(point) => Some(self.axes.iter().zip(point).map(|(a, u)| a.value(*u)).collect()),
        }
    }

    fn participant(&self, number: usize, values: Option<&[f64]>) -> Participant {
        let mut participant = self.base.clone();
        participant.label = format!("{}#{number}", self.base.label);
        for (axis, value) in self.axes.iter().zip(values.unwrap_or_default()) {
            participant.set_real(&axis.variable, *value);
        }
        participant
    }
}

/// The searches of one scenario.
#[derive(Debug)]
pub struct Tuning {
    spec: Spec,
    options: Options,
    /// By filter, in the order of the spec.
    pub filters: Vec<Searched>,
}

impl Tuning {
    /// * `spec`: the world and its seed, and each filter at its starting point.
    /// * `axes`: what is searched, by filter; a filter with none is not evaluated.
    pub fn new(mut spec: Spec, axes: Vec<Vec<Axis>>, options: Options) -> Self {
        let seed = u64::from(spec.seed.unsigned_abs());
        let searched = |(base, axes): (Participant, Vec<Axis>)| Searched {
            search: Search::new(
                axes.iter().map(Axis::start_fraction).collect(),
                if axes.is_empty() {
                    0
                } else {
                    options.evaluations as usize
                },
                seed,
            ),
            base,
            axes,
            evaluations: Vec::new(),
        };
        let filters = std::mem::take(&mut spec.filters).into_iter().zip(axes).map(searched);
        Self {
            filters: filters.collect(),
            spec,
            options,
        }
    }

    /// Runs of candidates that the whole search takes.
    pub fn work(&self) -> u64 {
        let searched = self.filters.iter().filter(|f| !f.axes.is_empty()).count() as u64;
        searched * u64::from(self.options.evaluations) * u64::from(self.options.runs)
    }

    /// One round of every filter; `false` when there was none left.
    ///
    /// * `finished`: called after each run with the number of candidates in it.
    ///
    /// # Errors
    /// As for [`evaluate`].
    pub fn round(&mut self, mut finished: impl FnMut(u64)) -> Result<bool, HarnessError> {
        // (filter, values) of every candidate of the round.
        let mut asked: Vec<(usize, Option<Vec<f64>>)> = Vec::new();
        for (index, filter) in self.filters.iter_mut().enumerate() {
            let candidates = filter.search.ask().to_vec();
            asked.extend(candidates.iter().map(|c| (index, filter.values(c))));
        }
        let mut tallies = Vec::with_capacity(asked.len());
        for batch in asked.chunks(TOGETHER) {
            let number = tallies.len();
            let participants = batch
                .iter()
                .zip(number..)
                .map(|((filter, values), number)| self.filters[*filter].participant(number, values.as_deref()));
            self.spec.filters = participants.collect();
            let beside = batch.len() as u64;
            tallies.extend(evaluate(&self.spec, self.options.runs, self.options.jobs, || {
                finished(beside)
            })?);
        }
        let Options { objective, limits, .. } = self.options;
        for (filter_index, filter) in self.filters.iter_mut().enumerate() {
            let round = filter.search.turns();
            let own = asked
                .iter()
                .zip(&tallies)
                .filter(|((index, _), _)| *index == filter_index);
            let evaluations = own.map(|((_, values), tally)| Evaluation {
                round,
                values: values.clone(),
                tally: *tally,
                standing: Standing::new(tally, objective, &limits),
            });
            let first = filter.evaluations.len();
            filter.evaluations.extend(evaluations);
            filter
                .search
                .tell(filter.evaluations[first..].iter().map(|e| e.standing));
        }
        Ok(!asked.is_empty())
    }
}
