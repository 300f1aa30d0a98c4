//! "The velocity changed by some amount at some time", kept open until the data decide.
//!
//! A vent is over before it can be seen: its effect grows out of the noise tens to hundreds of seconds later. So a quiet filter is
//! accompanied by hypotheses, one for each of a set of past times t_j and sizes c: the velocity changed at t_j by D ~ N(0, c^2 I).
//! Under a hypothesis the quiet filter's estimate is off by E D, its innovations by G D, with
//!
//! ```text
//!     E <- F E,  G = H E,  C <- C + G' S^-1 G,  d <- d + G' S^-1 v,  E <- E - K G,   E = [0; I] at t_j,
//! ```
//!
//! so that given the data D ~ N(V d, V), V = (C + I / c^2)^-1, and its weight against "no change" is
//! rate_c * slot * exp(d' V d / 2) / sqrt(det(I + c^2 C)). The quiet filter is never run again.

use super::centre::{Shared, white};
use super::member::Member;
use super::mixture::{Mixture, Moments};
use crate::units::Units;
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// Sizes of a change, m/s.
pub(in crate::laws) const SIZES: [f64; 5] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// Changes of each size that are expected in [`PRIOR_TIME`] before any has been seen.
const PRIOR_COUNT: [f64; 5] = [0.3, 0.06, 0.012, 0.0024, 0.00048];
/// s.
const PRIOR_TIME: f64 = 600.0;
/// Ages at which hypotheses are thinned, and the distance that they then keep, s.
const THINNED: [(f64, f64); 3] = [(0.0, 5.0), (30.0, 10.0), (80.0, 40.0)];
/// Age at which a hypothesis is folded into the quiet filter, s.
const OLDEST: f64 = 320.0;
/// Time after the first sample in which no change is looked for, s: the first estimate is too far off for the slopes that it is
/// updated with, and what it leaves is none of the target's doing.
const SETTLING: f64 = 30.0;
/// Weight of "no change" below which the mixture takes the place of the quiet filter.
const DECIDED: f64 = 0.02;
/// Weights below this share of the largest count for nothing.
const NEGLIGIBLE: f64 = 1e-9;

/// What a user may set; SI.
#[derive(Clone, Copy, Debug)]
pub(in crate::laws) struct Parameters {
    /// Square root of the quiet filter's white acceleration density, m/s^1.5.
    pub quiet: f64,
    /// Factor on the rates at which changes are expected.
    pub rate: f64,
}

/// The quiet filter and its hypotheses; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::laws) struct VelocityChanges {
    second: f64,
    sizes: [f64; 5],
    density: f64,
    prior: [f64; 5],
    quiet: Member<6>,
    /// The oldest first.
    open: Vec<Hypothesis>,
    /// Changes that have been found, by size.
    found: [f64; 5],
    /// Time since the first sample, s.
    elapsed: f64,
    /// Time since the last was opened, s.
    since: f64,
    decisions: i32,
    /// Weights, means and second moments of the hypotheses; of the newest sample.
    weighed: Weighed,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Hypothesis {
    /// E, 6x3.
    e: Matrix6x3<f64>,
    /// C, 3x3, and d.
    c: Matrix3<f64>,
    d: Vector3<f64>,
    /// s.
    age: f64,
    /// Time from the start to its own, in units of the closest spacing.
    slot: u64,
    /// Time to the next one opened, s.
    span: f64,
    /// What the data say for each size, as [`Hypothesis::given`] has it.
    ln_data: [f64; 5],
}

/// A change of one size, given the data.
#[derive(Clone, Copy, Debug)]
struct Posterior {
    /// Logarithm of the likelihood against "no change".
    ln_likelihood: f64,
    /// V d.
    mean: Vector3<f64>,
    /// V, 3x3.
    v: Matrix3<f64>,
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

/// All sizes of one hypothesis.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Part {
    /// Weights by size, of all.
    weights: [f64; 5],
    /// Weighted sum of D.
    first: Vector3<f64>,
    /// Weighted sum of V + D D'.
    second: Matrix3<f64>,
}

impl VelocityChanges {
    pub(in crate::laws) fn new(parameters: &Parameters, units: &Units) -> Self {
        let unit = units.velocity() / units.time.sqrt();
        Self {
            second: 1.0 / units.time,
            sizes: SIZES.map(|c| c / units.velocity()),
            density: (parameters.quiet / unit).powi(2),
            prior: PRIOR_COUNT.map(|n| n * parameters.rate),
            quiet: Member {
                dx: Vector6::zeros(),
                p: Matrix6::zeros(),
            },
            open: Vec::new(),
            found: [0.0; 5],
            elapsed: 0.0,
            since: f64::INFINITY,
            decisions: 0,
            weighed: Weighed {
                quiet: 1.0,
                ..Weighed::default()
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
        self.elapsed += dt;
        self.since += dt;
        for hypothesis in &mut self.open {
            hypothesis.age += dt;
            hypothesis.e = shared.f * hypothesis.e;
        }
        shared.predict(&mut self.quiet, &shared.f, &white(self.density, shared.dt), 0.0);
        self.thin();
        let before = self.ln_total();
        let mut log_likelihood = 0.0;
        for row in shared.seen.iter() {
            let taken = self.quiet.take(row);
            log_likelihood += taken.log_likelihood();
            for hypothesis in &mut self.open {
                let g = (row.h * hypothesis.e).transpose();
                hypothesis.c.ger(1.0 / taken.s, &g, &g, 1.0);
                hypothesis.d.axpy(taken.innovation / taken.s, &g, 1.0);
                hypothesis.e.ger(-1.0, &taken.gain, &g, 1.0);
            }
        }
        shared.follow(&mut self.quiet);
        self.weigh();
        log_likelihood += self.weighed.ln_total - before;
        if self.weighed.quiet < DECIDED {
            self.decide();
        }
        self.open_next();
        log_likelihood
    }

    /// The quiet filter and every hypothesis, by their weights.
    pub(in crate::laws) fn mixture(&self) -> Mixture {
        let mut mixture = Mixture::default();
        mixture.add(self.weighed.quiet, &self.quiet.dx, &self.quiet.p);
        for (hypothesis, part) in self.open.iter().zip(&self.weighed.parts) {
            let weight: f64 = part.weights.iter().sum();
            if weight > NEGLIGIBLE {
                let off = hypothesis.e * part.first / weight;
                let mean = self.quiet.dx + off;
                let spread = hypothesis.e * (part.second / weight) * hypothesis.e.transpose();
                // About zero: the quiet filter's own, and off as if the quiet filter's mean were zero.
                let mut second = self.quiet.p + spread;
                second.ger(1.0, &self.quiet.dx, &self.quiet.dx, 1.0);
                second.ger(1.0, &self.quiet.dx, &off, 1.0);
                second.ger(1.0, &off, &self.quiet.dx, 1.0);
                mixture.add_second(weight, &mean, &second);
            }
        }
        mixture
    }

    /// Deviations are from another mean now.
    pub(in crate::laws) fn shift(&mut self, shift: &Vector6<f64>) {
        self.quiet.dx -= shift;
    }

    /// Logarithms of the rates at which changes of each size are expected, 1/s.
    fn ln_rates(&self) -> [f64; 5] {
        std::array::from_fn(|i| ((self.prior[i] + self.found[i]) / (PRIOR_TIME + self.elapsed)).ln())
    }

    /// Logarithm of the sum of all weights, "no change" being 1, with what the data have said so far.
    fn ln_total(&self) -> f64 {
        let rates = self.ln_rates();
        let weights = self.open.iter().map(|hypothesis| {
            let ln_slot = hypothesis.ln_slot();
            let of_size = |i: usize| (rates[i] + ln_slot + hypothesis.ln_data[i]).exp();
            (0..5).map(of_size).sum::<f64>()
        });
        (1.0 + weights.sum::<f64>()).ln()
    }

    /// What the data now say of every hypothesis.
    fn weigh(&mut self) {
        let rates = self.ln_rates();
        let posteriors: Vec<[Posterior; 5]> = self.open.iter().map(|h| self.sizes.map(|c| h.given(c))).collect();
        for (hypothesis, of_size) in self.open.iter_mut().zip(&posteriors) {
            hypothesis.ln_data = std::array::from_fn(|i| of_size[i].ln_likelihood);
        }
        let ln_total = self.ln_total();
        self.weighed.ln_total = ln_total;
        self.weighed.quiet = (-ln_total).exp();
        self.weighed.parts.clear();
        for (hypothesis, of_size) in self.open.iter().zip(&posteriors) {
            let ln_slot = hypothesis.ln_slot();
            let mut part = Part::default();
            for (i, posterior) in of_size.iter().enumerate() {
                let weight = (rates[i] + ln_slot + posterior.ln_likelihood - ln_total).exp();
                part.weights[i] = weight;
                if weight > NEGLIGIBLE {
                    part.first += posterior.mean * weight;
                    part.second += posterior.v * weight;
                    part.second.ger(weight, &posterior.mean, &posterior.mean, 1.0);
                }
            }
            self.weighed.parts.push(part);
        }
    }

    /// The mixture takes the place of the quiet filter.
    fn decide(&mut self) {
        let Moments { mean, p } = self.mixture().moments();
        let counts: Vec<[f64; 5]> = self.weighed.parts.iter().map(|part| part.weights).collect();
        counts.iter().for_each(|weights| self.count(weights));
        self.quiet = Member { dx: mean, p };
        self.open.clear();
        self.weighed = Weighed {
            quiet: 1.0,
            ..Weighed::default()
        };
        self.decisions += 1;
    }

    fn count(&mut self, weights: &[f64; 5]) {
        for (found, weight) in self.found.iter_mut().zip(weights) {
            *found += weight;
        }
    }

    /// Drops what stands closer than its age allows, and folds in what is too old.
    fn thin(&mut self) {
        while let Some(oldest) = self.open.first()
            && oldest.age > OLDEST
        {
            self.fold_oldest();
        }
        let first = spacing(0.0);
        self.open.retain(|hypothesis| {
            let every = (spacing(hypothesis.age) / first).round().max(1.0) as u64;
            hypothesis.slot.is_multiple_of(every)
        });
    }

    /// The oldest hypothesis and "no change" become one.
    fn fold_oldest(&mut self) {
        let oldest = self.open.remove(0);
        if self.weighed.parts.is_empty() {
            return;
        }
        let part = self.weighed.parts.remove(0);
        let weight: f64 = part.weights.iter().sum();
        if weight > NEGLIGIBLE {
            self.count(&part.weights);
            let share = weight / (weight + self.weighed.quiet);
            let off = oldest.e * part.first / weight;
            self.quiet.dx += off * share;
            self.quiet.p += oldest.e * (part.second * (share / weight)) * oldest.e.transpose();
            self.quiet.p.ger(-share * share, &off, &off, 1.0);
        }
    }

    fn open_next(&mut self) {
        // What the first estimate leaves would be taken for changes, and their rates be learnt from it.
        if self.elapsed < SETTLING || self.since < spacing(0.0) - 1e-9 {
            return;
        }
        if let Some(last) = self.open.last_mut() {
            last.span = self.since;
        }
        let mut e = Matrix6x3::zeros();
        e.fixed_view_mut::<3, 3>(3, 0).fill_with_identity();
        self.open.push(Hypothesis {
            e,
            c: Matrix3::zeros(),
            d: Vector3::zeros(),
            age: 0.0,
            slot: (self.elapsed / spacing(0.0)).round() as u64,
            span: 0.0,
            ln_data: [0.0; 5],
        });
        self.weighed.parts.push(Part::default());
        self.since = 0.0;
    }
}

impl Hypothesis {
    /// Logarithm of the time for which it stands, s.
    fn ln_slot(&self) -> f64 {
        spacing(self.age).max(self.span).min(self.age).ln()
    }

    /// A change of this size, given the data.
    fn given(&self, size: f64) -> Posterior {
        let precision = self.c + Matrix3::from_diagonal_element(1.0 / (size * size));
        // By cofactors, which give inverse and determinant at once; the sum of a covariance and a multiple of I is far from singular.
        let m = |i: usize, j: usize| precision[(i, j)];
        let cofactor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (others(i), others(j));
            m(a, c) * m(b, d) - m(a, d) * m(b, c)
        };
        let cofactors = Matrix3::from_fn(cofactor);
        let det = precision.row(0).dot(&cofactors.row(0));
        let v = cofactors / det;
        let mean = v * self.d;
        // det(I + c^2 C) = c^6 det(C + I / c^2).
        let ln_det = (det * size.powi(6)).ln();
        Posterior {
            ln_likelihood: 0.5 * (self.d.dot(&mean) - ln_det),
            mean,
            v,
        }
    }
}

/// The other two of three places, in the order that makes cofactors of them.
fn others(place: usize) -> [usize; 2] {
    [(place + 1) % 3, (place + 2) % 3]
}

/// How far apart hypotheses of this age stand, s.
fn spacing(age: f64) -> f64 {
    let reached = THINNED.iter().take_while(|(from, _)| age >= *from);
    reached.last().map_or(THINNED[0].1, |(_, spacing)| *spacing)
}

#[cfg(test)]
mod tests {
    use super::super::rows::{Row, Seen};
    use super::*;
    use interface::mission::Units as Told;
    use nalgebra::RowVector6;
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn changes() -> VelocityChanges {
        let told = interface::mission::embedded("leo_venting").unwrap().mission().unwrap();
        let units: Told = told.navigation().units;
        let mut changes = VelocityChanges::new(&Parameters { quiet: 1e-3, rate: 1.0 }, &Units::of(&units));
        changes.elapsed = SETTLING;
        for i in 0..6 {
            changes.quiet.p[(i, i)] = if i < 3 { 1.0 } else { 1e-4 };
        }
        changes
    }

    fn step(g: &mut Generator) -> Shared {
        let mut f = Matrix6::identity();
        f.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(1.0);
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
        Shared::of(1.0, f, Seen::of(&rows))
    }

    /// A hypothesis against a filter that is really run with it: at t_j its velocity becomes unsure by c, and from there on mean,
    /// covariance and likelihood of every sample are its own.
    #[test]
    fn a_hypothesis_is_the_filter_that_was_never_run() {
        let g = &mut stream(5, 0, Source::Lidar);
        let mut changes = changes();
        changes.take(&step(g));
        // The first sample opens a hypothesis.
        assert_eq!(changes.open.len(), 1);
        let size = changes.sizes[2];
        let mut run = changes.quiet.clone();
        (3..6).for_each(|i| run.p[(i, i)] += size * size);
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
        let Posterior { ln_likelihood, mean, v } = hypothesis.given(size);
        let off = hypothesis.e * mean;
        let covariance = quiet.p + hypothesis.e * v * hypothesis.e.transpose();
        assert!(off.amax() > 1e-4, "there is something to compare");
        assert!((quiet.dx + off - run.dx).amax() < 1e-10);
        assert!((covariance - run.p).amax() < 1e-10);
        assert!((ln_likelihood - (of_run - of_quiet)).abs() < 1e-9);
    }

    /// After an hour of samples without news there are no more hypotheses than the spacings allow, and they stand as these say.
    #[test]
    fn hypotheses_are_thinned_with_age() {
        let g = &mut stream(6, 0, Source::Lidar);
        let mut changes = changes();
        for _ in 0..3600 {
            changes.take(&step(g));
        }
        assert_eq!(changes.decisions(), 0);
        let ages: Vec<f64> = changes.open.iter().map(|h| h.age).collect();
        assert!(ages.len() <= 20, "{ages:?}");
        for pair in ages.windows(2) {
            let apart = pair[0] - pair[1];
            let allowed = spacing(pair[1]);
            assert!(apart >= allowed - 1e-9 && apart <= 2.0 * spacing(pair[0]), "{ages:?}");
        }
        assert!(ages[0] <= OLDEST && ages[0] > OLDEST - 45.0, "{ages:?}");
    }
}
