//! One mission at one level.

use serde::{Deserialize, Serialize};
use study::{Participant, Quantity, RunTally, Spec, Tally, evaluate_each, ratio};

use super::row::{Kind, Row, family};

/// Candidates in one run at most; each is a slave of its own beside the truth.
const TOGETHER: usize = 32;
/// NEES of position and velocity above which a filter of constant noise, or a bound, is not honest, and does not count.
pub const MOST_NEES: f64 = 1.5;
/// Of each family, by each error, so many of the best scouts fly every run.
const KEPT: usize = 2;

/// What a trial may spend.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Runs of every filter that counts.
    pub runs: u32,
    /// Of those, runs by which filters of constant noise are chosen for it.
    pub scouts: u32,
    /// Threads.
    pub jobs: usize,
}

/// Laws, filters of constant noise and bounds in one world.
#[derive(Debug)]
pub struct Trial {
    /// The world; its filters are the laws, and bounds that are asked for by name.
    pub spec: Spec,
    /// Filters of constant noise, and bounds, family by family.
    pub families: Vec<(Kind, Vec<Participant>)>,
}

/// What flew every run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// What is asked for by name first.
    pub filters: Vec<(String, Kind, Vec<RunTally>)>,
}

impl Trial {
    /// Runs of filters that it takes at most.
    pub fn work(&self, options: &Options) -> u64 {
        let scouts: usize = self.families.iter().map(|(_, family)| family.len()).sum();
        let kept: usize = (self.families.iter())
            .map(|(_, family)| family.len().min(2 * KEPT))
            .sum();
        u64::from(options.scouts) * scouts as u64 + u64::from(options.runs) * (self.spec.filters.len() + kept) as u64
    }

    /// Runs it.
    ///
    /// * `finished`: called after each run with the number of filters in it.
    pub fn run(&self, options: &Options, mut finished: impl FnMut(u64)) -> Tried {
        let mut fly = |filters: &[Participant], runs: u32| {
            let mut found = Vec::new();
            for batch in filters.chunks(TOGETHER) {
                let mut spec = self.spec.subset(&[]);
                spec.filters = batch.to_vec();
                let beside = batch.len() as u64;
                found.extend(evaluate_each(&spec, runs, options.jobs, || finished(beside)));
            }
            found
        };
        let mut chosen = Vec::new();
        for (kind, family) in &self.families {
            let scouts = fly(family, options.scouts.min(options.runs));
            let tallies: Vec<Tally> = scouts.iter().map(|runs| Tally::of(runs)).collect();
            let mut kept: Vec<usize> = [Quantity::Position, Quantity::Velocity]
                .into_iter()
                .flat_map(|quantity| best(&tallies, quantity).into_iter().take(KEPT))
                .collect();
            kept.sort_unstable();
            kept.dedup();
            chosen.extend(kept.into_iter().map(|place| (family[place].clone(), *kind)));
        }
        let asked = self.spec.filters.iter().map(|filter| {
            let kind = if filter.bound { Kind::Bound } else { Kind::Law };
            (filter.clone(), kind)
        });
        let (filters, kinds): (Vec<Participant>, Vec<Kind>) = asked.chain(chosen).unzip();
        let runs = fly(&filters, options.runs);
        let labels = filters.into_iter().map(|filter| filter.label);
        Tried {
            filters: labels.zip(kinds).zip(runs).map(|((l, k), r)| (l, k, r)).collect(),
        }
    }
}

/// Places of the filters that count, the best first: those in which no run went wrong and the NEES is honest.
fn best(tallies: &[Tally], quantity: Quantity) -> Vec<usize> {
    let counts = |tally: &Tally| tally.bad_runs == 0 && tally.nees6().is_some_and(|nees| nees <= MOST_NEES);
    let rmse = |place: usize| tallies[place].rmse(quantity).unwrap_or(f64::INFINITY);
    let mut places: Vec<usize> = (0..tallies.len()).filter(|place| counts(&tallies[*place])).collect();
    places.sort_by(|a, b| rmse(*a).total_cmp(&rmse(*b)));
    places
}

impl Tried {
    /// A row for each filter.
    ///
    /// * `seed`: of the study.
    pub fn rows(&self, mission: &str, level: &str, seed: i32) -> Vec<Row> {
        let tallies: Vec<Tally> = self.filters.iter().map(|(_, _, runs)| Tally::of(runs)).collect();
        // The best by each error of those that are meant.
        let best_of = |meant: &dyn Fn(&str, Kind) -> bool| {
            let places: Vec<usize> = (0..tallies.len())
                .filter(|place| meant(&self.filters[*place].0, self.filters[*place].1))
                .collect();
            let own: Vec<Tally> = places.iter().map(|place| tallies[*place]).collect();
            [Quantity::Position, Quantity::Velocity]
                .map(|quantity| best(&own, quantity).first().map(|place| places[*place]))
        };
        let hindsight = best_of(&|_, kind| kind == Kind::Fixed);
        let row = |(place, (label, kind, runs)): (usize, &(String, Kind, Vec<RunTally>))| {
            let shown = match kind {
                Kind::Law | Kind::Fixed => [true; 2],
                Kind::Bound => best_of(&|other, kind| kind == Kind::Bound && family(other) == family(label))
                    .map(|best| best == Some(place)),
            };
            let held = |at: usize, quantity| {
                if !shown[at] {
                    return None;
                }
                let other = &self.filters[hindsight[at]?].2;
                ratio(runs, other, quantity, seed)
            };
            Row {
                mission: mission.to_owned(),
                level: level.to_owned(),
                filter: label.clone(),
                kind: *kind,
                runs: runs.len() as u64,
                tally: tallies[place],
                best: hindsight.map(|best| best.map(|place| self.filters[place].0.clone())),
                ratios: [held(0, Quantity::Position), held(1, Quantity::Velocity)],
            }
        };
        self.filters.iter().enumerate().map(row).collect()
    }
}
