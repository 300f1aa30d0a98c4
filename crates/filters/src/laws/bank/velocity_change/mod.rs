//! "The velocity changed by some amount at some time", kept open until the data decide.
//!
//! A vent is over before it can be seen: its effect grows out of the noise tens to hundreds of seconds later. So a quiet filter is
//! accompanied by hypotheses, one for each of a set of past times: the velocity changed then, by D. Under one the quiet filter's estimate
//! is off by E D, its innovations by G D, and C and d gather what these say of D. docs/laws.md derives it; the quiet filter is never run
//! again.

mod axes;
mod directions;
mod hypothesis;
mod prior;
mod schedule;
mod watched;

use super::centre::Shared;
use super::member::Member;
use super::mixture::{Mixture, Moments};
use crate::units::Units;
use axes::Axes;
use directions::Directions;
use hypothesis::{Hypothesis, NEGLIGIBLE, Part};
use nalgebra::{Matrix6, Vector6};
use numerics::{math, spd};
use prior::SIZES;
use schedule::Schedule;
use serde::{Deserialize, Serialize};
use watched::{Said, Watched, found};

/// Sizes of a change, m/s.
const CHANGES: [f64; SIZES] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// Changes of each size that are expected in [`PRIOR_TIME`] before any has been seen.
const PRIOR_COUNT: [f64; SIZES] = [0.15, 0.03, 0.006, 0.0012, 0.00024];
/// Time after the first sample in which no change is looked for, s: the first estimate is too far off for the slopes that it is
/// updated with, and what it leaves is none of the target's doing.
const SETTLING: f64 = 30.0;
/// s.
const PRIOR_TIME: f64 = 600.0;
/// Ages at which hypotheses are thinned, and the distance that they then keep, s.
const THINNED: [(f64, f64); 3] = [(0.0, 5.0), (30.0, 10.0), (80.0, 40.0)];
/// Nothing is learnt of when and where to from a change less probable than this.
const LEAST_LEARNT: f64 = 0.2;
/// A time is no time of a change where it is less likely than the likeliest by this factor.
const NOT_MUCH_LESS: f64 = 0.1;
/// Rounding of times, s.
const TICK: f64 = 1e-9;

/// What a user may set; SI.
#[derive(Clone, Copy, Debug)]
pub(in crate::laws) struct Parameters {
    /// Square root of the quiet filter's white acceleration density, m/s^1.5.
    pub quiet: f64,
    /// Factor on the rates at which changes are expected.
    pub rate: f64,
    /// Age at which a hypothesis is folded into the quiet filter, s.
    pub window: f64,
    /// Weight of "no change" below which the mixture takes the place of the quiet filter.
    pub decided: f64,
    /// Whether it learns where to.
    pub directions: bool,
    /// Whether it learns when.
    pub schedule: bool,
}

/// The quiet filter and its hypotheses; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::laws) struct VelocityChanges {
    second: f64,
    /// Unit of velocity, m/s.
    speed: f64,
    sizes: [f64; SIZES],
    density: f64,
    prior: [f64; SIZES],
    /// As [`Parameters::window`].
    window: f64,
    /// As [`Parameters::decided`].
    decided: f64,
    quiet: Member<6>,
    /// The oldest first.
    open: Vec<Hypothesis>,
    /// Changes that have been found, by size.
    found: [f64; SIZES],
    /// Where they pointed, and when they came; `None` where that is not to be learnt.
    directions: Option<Directions>,
    schedule: Option<Schedule>,
    /// The last that was decided upon, while it tells where it pointed.
    watched: Option<Watched>,
    /// Room for the next one's record while none is watched; what is in it means nothing.
    #[serde(skip)]
    room: Vec<Said>,
    /// Time since something was measured first, s; `None` before.
    elapsed: Option<f64>,
    /// Time since the last was opened, s; infinite before the first.
    since: f64,
    decisions: i32,
    /// Weights, means and second moments of the hypotheses; of the newest sample.
    weighed: Weighed,
}

/// Every hypothesis against "no change", whose weight is 1.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Weighed {
    /// Logarithm of the sum of all weights.
    ln_total: f64,
    /// Weight of "no change", of all.
    quiet: f64,
    /// One for each hypothesis.
    parts: Vec<Part>,
}

impl VelocityChanges {
    pub(in crate::laws) fn new(parameters: &Parameters, units: &Units) -> Self {
        let unit = units.root_acceleration_density();
        Self {
            second: 1.0 / units.time,
            speed: units.velocity(),
            sizes: CHANGES.map(|c| c / units.velocity()),
            density: (parameters.quiet / unit).powi(2),
            prior: PRIOR_COUNT.map(|n| n * parameters.rate),
            window: parameters.window,
            decided: parameters.decided,
            quiet: Member {
                dx: Vector6::zeros(),
                p: Matrix6::zeros(),
            },
            open: Vec::with_capacity(most_open(parameters.window)),
            found: [0.0; SIZES],
            directions: parameters.directions.then(Directions::default),
            schedule: parameters.schedule.then(Schedule::default),
            watched: None,
            room: watched::room(parameters.window),
            elapsed: None,
            since: f64::INFINITY,
            decisions: 0,
            weighed: Weighed {
                ln_total: 0.0,
                quiet: 1.0,
                parts: Vec::with_capacity(most_open(parameters.window)),
            },
        }
    }

    /// White acceleration density of the quiet filter.
    pub(in crate::laws) fn density(&self) -> f64 {
        self.density
    }

    /// How often the mixture has taken the place of the quiet filter.
    pub(in crate::laws) fn decisions(&self) -> i32 {
        self.decisions
    }

    /// Takes a sample in.
    ///
    /// * returns: its log-likelihood under the whole mixture, as [`Member::update`] has it.
    pub(in crate::laws) fn take(&mut self, shared: &Shared) -> f64 {
        let dt = shared.dt / self.second;
        self.elapsed = match self.elapsed {
            Some(elapsed) => Some(elapsed + dt),
            None => shared.seen.iter().next().map(|_| 0.0),
        };
        self.since += dt;
        self.watch(shared, dt);
        hypothesis::predict(&mut self.quiet, &mut self.open, shared, self.density, dt);
        if let Some(newest) = self.open.last_mut() {
            newest.span = newest.age;
        }
        self.thin();
        let before = self.ln_total();
        let of_quiet = hypothesis::update(&mut self.quiet, &mut self.open, shared);
        self.weigh();
        let log_likelihood = of_quiet + (self.weighed.ln_total - before);
        if self.weighed.quiet < self.decided {
            self.decide();
        }
        self.open_next(&shared.relative);
        log_likelihood
    }

    /// The quiet filter and every hypothesis, by their weights.
    pub(in crate::laws) fn mixture(&self) -> Mixture {
        let Member { dx, p } = &self.quiet;
        // What hypotheses add, as if the quiet filter's mean were zero.
        let (mut weight, mut off, mut spread) = (self.weighed.quiet, Vector6::zeros(), Matrix6::zeros());
        for (hypothesis, part) in self.open.iter().zip(&self.weighed.parts) {
            let of_part = part.weight();
            if of_part > NEGLIGIBLE {
                weight += of_part;
                off += hypothesis.e * part.first;
                spread += spd::carried(&hypothesis.e, &part.second).1;
            }
        }
        let mut second = p * weight + spread;
        second.ger(weight, dx, dx, 1.0);
        second.ger(1.0, dx, &off, 1.0);
        second.ger(1.0, &off, dx, 1.0);
        Mixture::of_sums(weight, dx * weight + off, second)
    }

    /// Deviations are from another mean now.
    pub(in crate::laws) fn shift(&mut self, shift: &Vector6<f64>) {
        self.quiet.dx -= shift;
        self.watched.iter_mut().for_each(|watched| watched.shift(shift));
    }

    /// Logarithm of the sum of all weights, "no change" being 1, with what the data have said so far.
    fn ln_total(&self) -> f64 {
        let most = self.ln_most();
        let weight = |hypothesis: &Hypothesis| hypothesis.mass * hypothesis.factor(most);
        let sum: f64 = self.open.iter().map(weight).sum();
        most + math::ln(math::exp(-most) + sum)
    }

    /// Largest of the logarithms of likelihoods, that of "no change" among them.
    fn ln_most(&self) -> f64 {
        let exponent = |hypothesis: &Hypothesis| hypothesis.exponent - hypothesis.ln_base;
        self.open.iter().map(exponent).fold(0.0, f64::max)
    }

    /// What the data now say of every hypothesis.
    fn weigh(&mut self) {
        self.weighed.parts.clear();
        let parts = self.open.iter_mut().map(Hypothesis::weigh);
        self.weighed.parts.extend(parts);
        let most = self.ln_most();
        let mut sum = 0.0;
        for (part, hypothesis) in self.weighed.parts.iter_mut().zip(&self.open) {
            let factor = hypothesis.factor(most);
            sum += hypothesis.mass * factor;
            part.scale(factor);
        }
        let ln_total = most + math::ln(math::exp(-most) + sum);
        self.weighed.ln_total = ln_total;
        self.weighed.quiet = math::exp(-ln_total);
        let of_total = math::exp(most - ln_total);
        self.weighed.parts.iter_mut().for_each(|part| part.scale(of_total));
    }

    /// The mixture takes the place of the quiet filter. Of a change at the first hypothesis nothing is learnt.
    fn decide(&mut self) {
        let Moments { mean, p } = self.mixture().moments();
        let begun = self.begun();
        self.remember_watched(begun);
        let mut parts = std::mem::take(&mut self.weighed.parts);
        let mut open = std::mem::take(&mut self.open);
        let likeliest = (0..parts.len()).max_by(|a, b| parts[*a].weight().total_cmp(&parts[*b].weight()));
        let tells = likeliest.filter(|place| self.directions.is_some() && !open[*place].first);
        let watched = tells.map(|place| open[place].clone());
        if open.first().is_some_and(|oldest| oldest.first) {
            open.remove(0);
            parts.remove(0);
        }
        self.remember_time(&open, &parts);
        let mut weights = [0.0; SIZES];
        for part in &parts {
            weights
                .iter_mut()
                .zip(&part.weights)
                .for_each(|(sum, weight)| *sum += weight);
        }
        self.count(&weights);
        self.watched = watched.map(|hypothesis| {
            let room = std::mem::take(&mut self.room);
            Watched::new(self.quiet.clone(), hypothesis, weights, room)
        });
        self.quiet = Member { dx: mean, p };
        // Both begin anew in the memory that they have.
        open.clear();
        parts.clear();
        self.open = open;
        self.weighed = Weighed {
            ln_total: 0.0,
            quiet: 1.0,
            parts,
        };
        self.decisions += 1;
    }

    /// The change last decided upon, a sample further.
    fn watch(&mut self, shared: &Shared, dt: f64) {
        if let Some(watched) = &mut self.watched {
            watched.take(shared, dt, self.density);
            if watched.hypothesis.age > self.window {
                self.remember_watched(0.0);
            }
        }
    }

    /// For how long, s, the change that is being decided upon may have been there: the oldest hypothesis that is not much less likely
    /// than the likeliest.
    fn begun(&self) -> f64 {
        let weights = || self.weighed.parts.iter().map(Part::weight);
        let enough = weights().fold(0.0, f64::max) * NOT_MUCH_LESS;
        let oldest = weights().zip(&self.open).find(|(weight, _)| *weight >= enough);
        oldest.map_or(0.0, |(_, hypothesis)| hypothesis.age)
    }

    /// Learns where the change pointed that was watched.
    ///
    /// * `spoilt_s`: for how long the data have spoken of something else, too.
    fn remember_watched(&mut self, spoilt_s: f64) {
        let Some(watched) = self.watched.take() else { return };
        if let (Some(found), Some(directions)) = (watched.found(spoilt_s), &mut self.directions) {
            directions.learn(&found);
        }
        self.room = watched.into_room();
    }

    /// Learns when a change came of which these hypotheses speak.
    fn remember_time(&mut self, hypotheses: &[Hypothesis], parts: &[Part]) {
        let (Some(schedule), Some(now)) = (&mut self.schedule, self.elapsed) else {
            return;
        };
        let all: f64 = parts.iter().map(Part::weight).sum();
        let (mut age, mut square) = (0.0, 0.0);
        for (hypothesis, part) in hypotheses.iter().zip(parts) {
            let share = part.weight() / all;
            let middle = hypothesis.age - hypothesis.span / 2.0;
            age += share * middle;
            square += share * (middle * middle + hypothesis.span.powi(2) / 12.0);
        }
        if all > LEAST_LEARNT {
            schedule.learn(now - age, (square - age * age).max(0.0), all.min(1.0));
        }
    }

    fn count(&mut self, weights: &[f64; SIZES]) {
        for (found, weight) in self.found.iter_mut().zip(weights) {
            *found += weight;
        }
    }

    /// Drops what stands closer to an older one than its age allows, and folds in what is too old.
    fn thin(&mut self) {
        // One that stands for a time within the window stays: the newest in any case, however long ago its sample.
        while let Some(oldest) = self.open.first()
            && oldest.age - oldest.span > self.window
        {
            self.fold_oldest();
        }
        self.open.dedup_by(|next, older| {
            let goes = older.age - next.age < spacing(next.age) - TICK;
            if goes {
                older.stand_for(next);
            }
            goes
        });
    }

    /// The oldest hypothesis and "no change" become one: weights stay as they are, and so does the mean of the whole mixture. The
    /// others are told from "no change" and move with it.
    fn fold_oldest(&mut self) {
        let oldest = self.open.remove(0);
        if self.weighed.parts.is_empty() {
            return;
        }
        let part = self.weighed.parts.remove(0);
        let weight = part.weight();
        let tells = !oldest.first;
        if weight > LEAST_LEARNT && tells {
            self.remember_time(std::slice::from_ref(&oldest), std::slice::from_ref(&part));
            if let Some(directions) = &mut self.directions {
                directions.learn(&found(&oldest, &part.weights));
            }
        }
        if weight > NEGLIGIBLE {
            if tells {
                self.count(&part.weights);
            }
            let by = oldest.e * part.first;
            self.quiet.dx += by;
            self.quiet.p += spd::carried(&oldest.e, &part.second).1;
            self.quiet.p.ger(-1.0, &by, &by, 1.0);
            let more = math::ln_1p(weight / self.weighed.quiet);
            self.open.iter_mut().for_each(|hypothesis| hypothesis.ln_base += more);
            self.weighed.quiet += weight;
        }
    }

    /// Opens a hypothesis when it is time to.
    ///
    /// * `relative`: position and velocity of the estimate, 6.
    fn open_next(&mut self, relative: &Vector6<f64>) {
        // What the first estimate leaves would be taken for changes.
        let Some(elapsed) = self.elapsed.filter(|elapsed| *elapsed >= SETTLING) else {
            return;
        };
        if self.since < spacing(0.0) - TICK {
            return;
        }
        let per_found = 1.0 / (PRIOR_TIME + elapsed);
        let rates: [f64; SIZES] = std::array::from_fn(|i| (self.prior[i] + self.found[i]) * per_found);
        let axes = Axes::of(relative, self.speed);
        let nothing_learnt = Directions::default();
        let directions = self.directions.as_ref().unwrap_or(&nothing_learnt);
        let priors = directions.priors(&axes, &self.sizes, &rates, per_found);
        let schedule = self.schedule.as_ref();
        let expected = schedule.map_or(0.0, |schedule| {
            schedule.expected(elapsed + spacing(0.0) / 2.0, spacing(0.0), self.window)
        });
        let due = expected / rates.iter().sum::<f64>();
        let first = self.since.is_infinite();
        self.open.push(Hypothesis::new(due, priors, axes, first));
        self.weighed.parts.push(Part::default());
        self.since = 0.0;
    }
}

/// Hypotheses at most: as many as stand between the ages at which they are thinned, one more at each of these, and one that stands
/// for a time within the window though it is older.
fn most_open(window: f64) -> usize {
    let ends = THINNED[1..].iter().map(|(from, _)| *from).chain([window]);
    let between = |((from, spacing), to): (&(f64, f64), f64)| ((to - from).max(0.0) / spacing) as usize + 1;
    THINNED.iter().zip(ends).map(between).sum::<usize>() + 1
}

/// How far apart hypotheses of this age stand, s.
fn spacing(age: f64) -> f64 {
    let reached = THINNED.iter().take_while(|(from, _)| age >= *from);
    reached.last().map_or(THINNED[0].1, |(_, spacing)| *spacing)
}

#[cfg(test)]
mod tests {
    use super::super::centre::white;
    use super::super::rows::{Row, Seen};
    use super::hypothesis::Posterior;
    use super::prior::Prior;
    use super::*;
    use interface::mission::Units as Told;
    use nalgebra::{Matrix3, RowVector6, Vector3};
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn changes() -> VelocityChanges {
        let told = interface::mission::embedded("leo_venting").unwrap().mission().unwrap();
        let units: Told = told.navigation().units;
        let mut changes = VelocityChanges::new(
            &Parameters {
                quiet: 1e-3,
                rate: 1.0,
                window: 320.0,
                decided: 0.02,
                directions: true,
                schedule: true,
            },
            &Units::of(&units),
        );
        changes.elapsed = Some(SETTLING);
        // As if the first hypothesis had long gone.
        changes.since = spacing(0.0);
        for i in 0..6 {
            changes.quiet.p[(i, i)] = if i < 3 { 1.0 } else { 1e-4 };
        }
        changes
    }

    fn step(g: &mut Generator) -> Shared {
        step_of(g, 1.0)
    }

    /// * `dt`: s.
    fn step_of(g: &mut Generator, dt: f64) -> Shared {
        let mut f = Matrix6::identity();
        f.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(dt);
        let rows: [Row; 3] = std::array::from_fn(|i| {
            let mut h = RowVector6::zeros();
            h[i] = 1.0;
            h[(i + 1) % 3] = 0.2;
            let normal: f64 = StandardNormal.sample(g);
            // As small as its noise, so that nothing is decided.
            Row {
                place: i,
                h,
                innovation: 0.2 * normal,
                r: 0.04,
            }
        });
        Shared::of(dt, f, Seen::of(&rows))
    }

    /// After so many samples of a second.
    fn after(g: &mut Generator, samples: usize) -> VelocityChanges {
        let mut changes = changes();
        for _ in 0..samples {
            changes.take(&step(g));
        }
        changes
    }

    /// A hypothesis against a filter that is really run with it: at t_j its velocity becomes unsure by S, and from there on mean,
    /// covariance and likelihood of every sample are its own.
    #[test]
    fn a_hypothesis_is_the_filter_that_was_never_run() {
        let size = changes().sizes[2];
        let along = Vector3::new(0.6, 0.0, -0.8);
        let axis = along * along.transpose();
        let narrow = (axis + (Matrix3::identity() - axis) * 0.01) * (size * size);
        for (prior, unsure) in [
            (
                Prior::anywhere(2, size, 1.0),
                Matrix3::from_diagonal_element(size * size),
            ),
            (Prior::along(2, size, 1.0, &along, 0.1), narrow),
        ] {
            let g = &mut stream(5, 0, Source::Lidar);
            let mut changes = changes();
            changes.take(&step(g));
            // The first sample opens a hypothesis.
            assert_eq!(changes.open.len(), 1);
            let mut run = changes.quiet.clone();
            let mut velocity = run.p.fixed_view_mut::<3, 3>(3, 3);
            velocity += unsure;
            let (mut quiet, mut of_quiet, mut of_run) = (changes.quiet.clone(), 0.0, 0.0);
            for _ in 0..25 {
                let shared = step(g);
                let noise = white(changes.density, 1.0);
                of_quiet += shared.take(&mut quiet, &shared.f, &noise, 0.0);
                of_run += shared.take(&mut run, &shared.f, &noise, 0.0);
                changes.take(&shared);
                assert_eq!(changes.decisions(), 0);
            }
            assert!((changes.quiet.dx - quiet.dx).amax() < 1e-12);
            let hypothesis = &changes.open[0];
            let Posterior { exponent, det, mean, v } = hypothesis.given(&prior);
            let ln_likelihood = exponent - 0.5 * det.ln();
            let off = hypothesis.e * mean;
            let covariance = quiet.p + hypothesis.e * v * hypothesis.e.transpose();
            assert!(off.amax() > 1e-5, "there is something to compare");
            assert!((quiet.dx + off - run.dx).amax() < 1e-10);
            assert!((covariance - run.p).amax() < 1e-10);
            assert!((ln_likelihood - (of_run - of_quiet)).abs() < 1e-9);
        }
    }

    /// What a decision has taken in is still told by the data alone: as by the hypothesis of a twin that decides nothing.
    #[test]
    fn a_change_is_watched_as_if_nothing_had_been_decided() {
        let g = &mut stream(7, 0, Source::Lidar);
        let mut changes = after(g, 12);
        let mut open = changes.clone();
        changes.decide();
        let age = changes.watched.as_ref().unwrap().hypothesis.age;
        let place = open.open.iter().position(|h| (h.age - age).abs() < TICK).unwrap();
        let mut hypothesis = open.open.swap_remove(place);
        for _ in 0..20 {
            let shared = step(g);
            changes.take(&shared);
            // Nothing moves the deviation of either, so both may take the same step.
            hypothesis.predict(1.0, &shared.f);
            shared.predict(&mut open.quiet, &shared.f, &white(open.density, 1.0), 0.0);
            for row in shared.seen.iter() {
                let taken = open.quiet.take(row);
                hypothesis.take(row, &taken);
            }
            assert_eq!(changes.decisions(), 1);
        }
        let prior = Prior::anywhere(1, open.sizes[1], 1.0);
        let expected = hypothesis.given(&prior);
        let mut watched = changes.watched.unwrap();
        watched.weights = [0.0, 1.0, 0.0, 0.0, 0.0];
        let found = watched.found(0.0).unwrap();
        assert!((found.d - expected.mean).amax() < 1e-12 * expected.mean.amax());
        assert!((found.v - expected.v).amax() < 1e-12 * expected.v.amax());
    }

    /// A change that comes while the last is watched: of that one counts what the data had said before.
    #[test]
    fn a_change_is_not_learnt_from_what_the_next_one_did() {
        let g = &mut stream(8, 0, Source::Lidar);
        let mut changes = after(g, 12);
        changes.decide();
        let mut early = None;
        for k in 1..=45 {
            changes.take(&step(g));
            if k == 20 {
                early = changes.watched.clone();
            }
        }
        let said = |watched: &Option<Watched>, spoilt: f64| watched.clone().unwrap().found(spoilt);
        let expected = said(&early, 0.0).unwrap();
        // It is kept at once, after 20 s and after 40 s, and now is 45 s.
        for (spoilt, after_20) in [(0.0, false), (4.0, false), (6.0, true), (25.0, true), (26.0, false)] {
            let found = said(&changes.watched, spoilt).unwrap();
            assert_eq!(found.d == expected.d && found.v == expected.v, after_20, "{spoilt}");
        }
        assert!(said(&changes.watched, 46.0).is_none());
    }

    /// Weights and mean of the whole mixture before and after; its covariance but for the product of the two moves.
    #[test]
    fn folding_moves_neither_weights_nor_mean() {
        let g = &mut stream(12, 0, Source::Lidar);
        let mut changes = changes();
        changes.prior = [3.0; SIZES];
        changes.decided = 0.0;
        (0..40).for_each(|_| {
            changes.take(&step(g));
        });
        changes.weigh();
        let (before, quiet, oldest) = (
            changes.mixture().moments(),
            changes.weighed.quiet,
            changes.weighed.parts[0],
        );
        let weights: Vec<f64> = changes.weighed.parts.iter().map(Part::weight).collect();
        assert!(
            weights[0] > 0.01 && quiet > 0.01 && weights.len() > 4,
            "{weights:?} {quiet}"
        );
        let by = changes.open[0].e * oldest.first;
        changes.fold_oldest();
        let after = changes.mixture().moments();
        assert!((after.mean - before.mean).amax() < 1e-14 * before.mean.amax().max(1.0));
        let others = before.mean - by - (changes.quiet.dx - by);
        let cross = others * by.transpose() + by * others.transpose();
        assert!((after.p - (before.p + cross)).amax() < 1e-12 * before.p.amax());
        assert!((changes.weighed.quiet - (quiet + weights[0])).abs() < 1e-15);
        changes.weigh();
        for (part, weight) in changes.weighed.parts.iter().zip(&weights[1..]) {
            assert!((part.weight() - weight).abs() < 1e-13, "{} {weight}", part.weight());
        }
        assert!((changes.weighed.quiet - (quiet + weights[0])).abs() < 1e-13);
    }

    /// An hour of samples without news, at any pace: no more hypotheses than the spacings allow, and every time has one.
    #[test]
    fn hypotheses_are_thinned_with_age() {
        for period in [1.0, 3.0, 7.0, 25.0, 60.0] {
            let g = &mut stream(6, 0, Source::Lidar);
            let mut changes = changes();
            for _ in 0..(3600.0 / period) as u32 {
                changes.take(&step_of(g, period));
            }
            assert_eq!(changes.decisions(), 0);
            let ages: Vec<f64> = changes.open.iter().map(|h| h.age).collect();
            assert!(ages.len() <= 20 && ages.len() <= most_open(changes.window), "{ages:?}");
            for (pair, older) in ages.windows(2).zip(&changes.open) {
                let apart = pair[0] - pair[1];
                assert!(apart >= spacing(pair[1]) - TICK, "{ages:?}");
                assert!(apart < 2.0 * spacing(pair[0]).max(period), "{ages:?}");
                assert!((older.span - apart).abs() < TICK, "{} {ages:?}", older.span);
            }
            let newest = changes.open.last().unwrap();
            assert!((newest.span - newest.age).abs() < TICK, "{} {ages:?}", newest.span);
            assert!(
                ages[0] - changes.open[0].span <= changes.window && ages[0] > changes.window - 40.0 - 2.0 * period,
                "{ages:?}"
            );
        }
    }

    /// Ten minutes without a sample: what may have happened in them is asked when the next one comes.
    #[test]
    fn a_gap_longer_than_the_window_is_no_proof_of_quiet() {
        let g = &mut stream(14, 0, Source::Lidar);
        let mut changes = after(g, 60);
        let newest = changes.open.last().unwrap().age;
        changes.take(&step_of(g, 600.0));
        let oldest = &changes.open[0];
        assert!((oldest.age - newest - 600.0).abs() < TICK && (oldest.span - oldest.age).abs() < TICK);
        let ln_weight = (oldest.mass * oldest.factor(0.0)).ln();
        assert!(ln_weight > -20.0 && changes.weighed.parts[0].weight() > 1e-9);
    }

    /// Innovations of a velocity that is off by 0.5 m/s: a change to the first hypothesis as to any other, and decided alike, but no
    /// news of what the target does.
    #[test]
    fn what_the_start_has_left_is_not_counted() {
        let g = &mut stream(16, 0, Source::Lidar);
        for (since, counted) in [(f64::INFINITY, false), (spacing(0.0), true)] {
            let mut changes = changes();
            changes.since = since;
            changes.take(&step(g));
            assert_eq!(changes.open[0].first, !counted);
            let mut off = 0.0;
            while changes.decisions() == 0 {
                off += 0.5 / changes.speed;
                assert!(off < 30.0 / changes.speed, "it is never decided");
                let Shared { dt, f, seen, .. } = step(g);
                let rows: Vec<Row> = seen.iter().copied().collect();
                let moved: [Row; 3] = std::array::from_fn(|i| Row {
                    innovation: rows[i].innovation + if i == 0 { off } else { 0.0 },
                    ..rows[i]
                });
                changes.take(&Shared::of(dt, f, Seen::of(&moved)));
            }
            let count: f64 = changes.found.iter().sum();
            assert!(if counted { count > 0.9 } else { count < 1e-2 }, "{:?}", changes.found);
            assert_eq!(changes.watched.is_some(), counted);
            let empty = format!("{:?}", Some(Schedule::default()));
            assert_eq!(format!("{:?}", changes.schedule) != empty, counted);
        }
        // Nor when it is folded in.
        for first in [true, false] {
            let mut changes = after(g, 40);
            changes.open[0].first = first;
            changes.weighed.parts[0].weights[2] = 0.5;
            changes.fold_oldest();
            assert_eq!(changes.found.iter().sum::<f64>() > 0.4, !first);
        }
    }

    /// A minute in which nothing is seen of the target is no time in which the first estimate settles.
    #[test]
    fn no_change_is_looked_for_before_the_first_estimate_has_settled() {
        let g = &mut stream(15, 0, Source::Lidar);
        let mut changes = changes();
        changes.elapsed = None;
        let nothing = || Shared::of(1.0, step(&mut stream(15, 1, Source::Lidar)).f, Seen::of(&[]));
        for _ in 0..60 {
            changes.take(&nothing());
        }
        for _ in 0..30 {
            assert!(changes.open.is_empty());
            changes.take(&step(g));
        }
        changes.take(&step(g));
        assert_eq!(changes.open.len(), 1);
    }
}
