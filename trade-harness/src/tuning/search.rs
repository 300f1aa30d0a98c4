//! The search itself: where to look next, given how the places looked at so far have done.
//!
//! It needs no derivative, tolerates noise that all candidates share, and treats every filter alike, however many values
//! it varies. Half of the evaluations fill the whole box, the starting point among them. The other half come in rounds
//! that fill a smaller box around the best candidate so far. The first of those boxes is as wide as the points before it
//! lay apart, and each is narrower than the last by what its points resolve, but never by more than half.

use std::collections::VecDeque;

use super::design::Design;
use super::standing::Standing;

/// Rounds of the second half.
const ROUNDS: usize = 6;
/// Least ratio of a box to the one before.
const NARROWEST: f64 = 0.5;

/// A place to try.
#[derive(Debug, Clone, PartialEq)]
pub enum Candidate {
    /// The starting point, whose coordinates need not be known.
    Start,
    /// A point of the unit cube.
    Point(Vec<f64>),
}

/// Candidates that are tried together.
#[derive(Debug, Clone, PartialEq)]
pub struct Round {
    /// Number, from 0: the whole box.
    pub number: usize,
    /// In the order in which [`Search::tell`] wants to hear of them.
    pub candidates: Vec<Candidate>,
}

/// What is known of a round before its candidates are.
#[derive(Debug)]
struct Planned {
    number: usize,
    /// Number of candidates, at least one.
    count: usize,
    /// Half of the side of the box around the best so far; `None` for the whole box with the start in it.
    half_width: Option<f64>,
}

/// One search: it gives a round of candidates and is told how they did, in turns.
#[derive(Debug)]
pub struct Search {
    start: Vec<Option<f64>>,
    design: Design,
    /// Rounds to come.
    rounds: VecDeque<Planned>,
    /// Candidates that nothing has been told of yet.
    asked: VecDeque<Candidate>,
    /// Everything tried, in order.
    tried: Vec<(Candidate, Standing)>,
}

impl Search {
    /// * `start`: coordinates of the starting point in the unit cube, as far as they are known; one for each value varied.
    ///   Without anything to vary there is the start alone.
    /// * `budget`: number of candidates.
    /// * `seed`: selects the points.
    pub fn new(start: Vec<Option<f64>>, budget: usize, seed: u64) -> Self {
        let budget = if start.is_empty() { budget.min(1) } else { budget };
        Self {
            design: Design::new(start.len(), seed),
            rounds: plan(budget, start.len()),
            start,
            asked: VecDeque::new(),
            tried: Vec::new(),
        }
    }

    /// The next round; `None` when the budget is spent.
    pub fn next_round(&mut self) -> Option<Round> {
        let Planned {
            number,
            count,
            half_width,
        } = self.rounds.pop_front()?;
        let candidates: Vec<Candidate> = match half_width {
            None => {
                let others = (1..count).map(|_| Candidate::Point(self.design.next()));
                std::iter::once(Candidate::Start).chain(others).collect()
            }
            Some(half_width) => {
                let centre = self.centre();
                let within = |centre: f64, u: f64| {
                    let (low, high) = ((centre - half_width).max(0.0), (centre + half_width).min(1.0));
                    low + (high - low) * u
                };
                let points = (0..count).map(|_| self.design.next());
                let moved = |point: Vec<f64>| centre.iter().zip(point).map(|(c, u)| within(*c, u)).collect();
                points.map(moved).map(Candidate::Point).collect()
            }
        };
        self.asked.extend(candidates.iter().cloned());
        Some(Round { number, candidates })
    }

    /// How the next of the candidates that were given has done.
    pub fn tell(&mut self, standing: Standing) {
        let candidate = self.asked.pop_front();
        self.tried.extend(candidate.map(|c| (c, standing)));
    }

    /// Number of the best candidate so far, from 0; of equals the first.
    pub fn best(&self) -> Option<usize> {
        let tried = self.tried.iter().enumerate();
        // `min_by` keeps the first of equals.
        tried
            .min_by(|(_, a), (_, b)| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    /// The best candidate; what is not known of it is taken from the best that is known.
    fn centre(&self) -> Vec<f64> {
        let known = self.tried.iter().filter_map(|(candidate, standing)| match candidate {
            Candidate::Start => None,
            Candidate::Point(point) => Some((point, standing)),
        });
        let best_known = known.min_by(|a, b| a.1.total_cmp(b.1)).map(|(point, _)| point);
        let at = |axis: usize| best_known.map_or(0.5, |p| p[axis]);
        match self.best().map(|index| &self.tried[index].0) {
            Some(Candidate::Point(point)) => point.clone(),
            _ => self
                .start
                .iter()
                .enumerate()
                .map(|(axis, s)| s.unwrap_or_else(|| at(axis)))
                .collect(),
        }
    }
}

/// Every round of a search: half of the budget in the whole box, the rest in boxes that become narrower.
fn plan(budget: usize, dimension: usize) -> VecDeque<Planned> {
    let whole = budget.div_ceil(2);
    let rest = budget - whole;
    let until = |round: usize| rest * round / ROUNDS;
    let mut rounds = VecDeque::from([Planned {
        number: 0,
        count: whole,
        half_width: None,
    }]);
    let mut half_width = spacing(whole.max(1) as f64, dimension);
    for number in 1..=ROUNDS {
        let count = until(number) - until(number - 1);
        // With few evaluations a round may be empty; it makes no box narrower.
        if count > 0 {
            rounds.push_back(Planned {
                number,
                count,
                half_width: Some(half_width),
            });
            half_width *= spacing(count as f64, dimension).max(NARROWEST);
        }
    }
    rounds.retain(|round| round.count > 0);
    rounds
}

/// Distance of neighbours when this many points fill a unit cube.
fn spacing(points: f64, dimension: usize) -> f64 {
    points.powf(-1.0 / dimension.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing(objective: f64) -> Standing {
        Standing {
            bad_runs: 0,
            violation: 0.0,
            objective,
        }
    }

    /// Searches a function of the unit cube; returns the candidates and their values.
    fn search(
        start: Vec<Option<f64>>,
        budget: usize,
        seed: u64,
        value: impl Fn(&Candidate) -> f64,
    ) -> (Vec<(Candidate, f64)>, usize) {
        let mut search = Search::new(start, budget, seed);
        let mut tried = Vec::new();
        while let Some(round) = search.next_round() {
            for candidate in round.candidates {
                let found = value(&candidate);
                search.tell(standing(found));
                tried.push((candidate, found));
            }
        }
        (tried, search.best().unwrap())
    }

    /// A bowl with its own curvature on each axis and a ripple that stands for shared noise.
    fn bowl(optimum: &[f64], point: &[f64]) -> f64 {
        let bowl: f64 = optimum.iter().zip(point).map(|(o, p)| (p - o).powi(2)).sum();
        let ripple: f64 = point.iter().map(|p| (157.0 * p).sin()).sum();
        1.0 + bowl + 1e-4 * ripple
    }

    /// 48 evaluations come within a small share of the range of any optimum, in every coordinate. The tolerances are the
    /// worst of 200 searches and half as much again.
    #[test]
    fn the_optimum_is_found_in_one_to_four_dimensions() {
        for (dimension, tolerance) in [(1, 0.012), (2, 0.08), (3, 0.17), (4, 0.26)] {
            for seed in 0..200_u64 {
                let at = |axis: usize| (seed as f64 * 0.618 + axis as f64 * 0.277 + 0.1).fract();
                let optimum: Vec<f64> = (0..dimension).map(at).collect();
                let (tried, best) = search(vec![None; dimension], 48, seed, |c| match c {
                    Candidate::Start => 9.0,
                    Candidate::Point(p) => bowl(&optimum, p),
                });
                assert_eq!(tried.len(), 48);
                let Candidate::Point(p) = &tried[best].0 else {
                    unreachable!()
                };
                let worst = optimum.iter().zip(p).map(|(o, p)| (p - o).abs()).fold(0.0, f64::max);
                assert!(worst < tolerance, "dimension {dimension}, seed {seed}: {worst}");
            }
        }
    }

    #[test]
    fn an_optimum_beyond_the_range_leads_to_its_edge() {
        let (tried, best) = search(vec![Some(0.5)], 48, 3, |c| match c {
            Candidate::Start => 0.5,
            Candidate::Point(p) => 1.0 - p[0],
        });
        let Candidate::Point(p) = &tried[best].0 else {
            unreachable!()
        };
        assert!((0.99..=1.0).contains(&p[0]), "{p:?}");
    }

    /// A unique optimum at 0.2 where the NEES is too large, and limits that admit 0.6 and above.
    #[test]
    fn the_best_of_what_is_allowed_lies_at_its_border() {
        let mut search = Search::new(vec![None], 48, 1);
        let place = |candidate: &Candidate| match candidate {
            Candidate::Start => 0.0,
            Candidate::Point(p) => p[0],
        };
        let mut tried = Vec::new();
        while let Some(round) = search.next_round() {
            for p in round.candidates.iter().map(place) {
                search.tell(Standing {
                    violation: (0.6 - p).max(0.0),
                    ..standing((p - 0.2).abs())
                });
                tried.push(p);
            }
        }
        let best = tried[search.best().unwrap()];
        assert!((0.6..0.61).contains(&best), "{best}");
    }

    #[test]
    fn equal_seeds_try_equal_points_and_others_do_not() {
        let points = |seed| {
            search(
                vec![None; 3],
                20,
                seed,
                |c| if *c == Candidate::Start { 2.0 } else { 1.0 },
            )
            .0
        };
        assert_eq!(points(5), points(5));
        assert_ne!(points(5)[1], points(6)[1]);
    }

    /// Whatever the budget, it is spent to the last evaluation, and every point is inside the cube.
    #[test]
    fn the_budget_is_kept() {
        for budget in 1..=30 {
            let (tried, _) = search(vec![Some(0.0), None], budget, 1, |c| match c {
                Candidate::Start => 1.0,
                Candidate::Point(p) => p[0] + p[1],
            });
            assert_eq!(tried.len(), budget);
            assert_eq!(tried[0].0, Candidate::Start);
            let inside = |c: &Candidate| match c {
                Candidate::Start => true,
                Candidate::Point(p) => p.iter().all(|x| (0.0..=1.0).contains(x)),
            };
            assert!(tried.iter().all(|(c, _)| inside(c)));
            assert_eq!(tried.iter().filter(|(c, _)| *c == Candidate::Start).count(), 1);
        }
        assert!(Search::new(Vec::new(), 0, 1).next_round().is_none());
        let mut alone = Search::new(Vec::new(), 9, 1);
        assert_eq!(alone.next_round().unwrap().candidates, [Candidate::Start]);
        assert!(alone.next_round().is_none());
    }

    /// The starting point wins; where its coordinate is known the boxes lie around it, else around the best that is.
    #[test]
    fn the_search_goes_on_around_a_start_that_is_known() {
        for (start, centre) in [(Some(0.9), 0.9), (None, 0.3)] {
            let (tried, best) = search(vec![start], 40, 2, |c| match c {
                Candidate::Start => 0.0,
                Candidate::Point(p) => 1.0 + (p[0] - 0.3).abs(),
            });
            assert_eq!(best, 0);
            for (candidate, _) in &tried[20..] {
                let Candidate::Point(p) = candidate else { unreachable!() };
                // Half of the first box, and the distance from the best known point to 0.3.
                assert!((p[0] - centre).abs() < 0.1, "{start:?}: {p:?}");
            }
        }
    }
}
