//! Every filter of a scenario searched at once, side by side in the same worlds.

use study::{Participant, Spec, Tally, evaluate};

use super::contender::Contender;
use super::ranges::Axis;
use super::search::{Candidate, Search};
use super::standing::{Limits, Objective, Standing};

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
    /// Whose search it is.
    pub contender: Contender,
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
        let names = self.contender.axes.iter().map(|a| a.variable.as_str());
        names.zip(evaluation.values.iter().flatten().copied())
    }

    fn values(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        match candidate {
            Candidate::Start => None,
            Candidate::Point(point) => Some(
                self.contender
                    .axes
                    .iter()
                    .zip(point)
                    .map(|(a, u)| a.value(*u))
                    .collect(),
            ),
        }
    }

    fn participant(&self, number: usize, values: Option<&[f64]>) -> Participant {
        let mut participant = self.contender.base.clone();
        participant.label = format!("{}#{number}", self.contender.base.label);
        for (axis, value) in self.contender.axes.iter().zip(values.unwrap_or_default()) {
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
    /// * `spec`: the world and its seed; its filters take no part but as contenders.
    /// * `contenders`: one with nothing to search is not evaluated.
    pub fn new(spec: Spec, contenders: Vec<Contender>, options: Options) -> Self {
        let seed = u64::from(spec.seed.unsigned_abs());
        let searched = |contender: Contender| {
            let start: Vec<_> = contender.axes.iter().map(Axis::start_fraction).collect();
            let budget = if start.is_empty() {
                0
            } else {
                options.evaluations as usize
            };
            Searched {
                search: Search::new(start, budget, seed),
                contender,
                evaluations: Vec::new(),
            }
        };
        Self {
            filters: contenders.into_iter().map(searched).collect(),
            spec,
            options,
        }
    }

    /// Runs of candidates that the whole search takes.
    pub fn work(&self) -> u64 {
        let searched = self.filters.iter().filter(|f| !f.contender.axes.is_empty()).count() as u64;
        searched * u64::from(self.options.evaluations) * u64::from(self.options.runs)
    }

    /// One round of every filter; `false` when there was none left.
    ///
    /// * `finished`: called after each run with the number of candidates in it.
    pub fn round(&mut self, mut finished: impl FnMut(u64)) -> bool {
        // Candidates of the round: whose, in which of its rounds, and with which values.
        let mut asked: Vec<(usize, usize, Option<Vec<f64>>)> = Vec::new();
        for (index, filter) in self.filters.iter_mut().enumerate() {
            if let Some(round) = filter.search.next_round() {
                let values = round.candidates.iter().map(|c| filter.values(c));
                asked.extend(values.map(|values| (index, round.number, values)));
            }
        }
        let mut tallies = Vec::with_capacity(asked.len());
        for batch in asked.chunks(TOGETHER) {
            let participants = batch
                .iter()
                .zip(tallies.len()..)
                .map(|((filter, _, values), number)| self.filters[*filter].participant(number, values.as_deref()));
            self.spec.filters = participants.collect();
            let beside = batch.len() as u64;
            tallies.extend(evaluate(&self.spec, self.options.runs, self.options.jobs, || {
                finished(beside);
            }));
        }
        let any = !asked.is_empty();
        let Options { objective, limits, .. } = self.options;
        for ((index, round, values), tally) in asked.into_iter().zip(tallies) {
            let standing = Standing::new(&tally, objective, &limits);
            let filter = &mut self.filters[index];
            filter.search.tell(standing);
            filter.evaluations.push(Evaluation {
                round,
                values,
                tally,
                standing,
            });
        }
        any
    }
}
