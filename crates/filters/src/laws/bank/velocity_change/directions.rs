//! Where changes have pointed so far.
//!
//! A vent blows from a fixed place: its direction is the same each time in axes of the body that carries it. That body is held along
//! the line of sight, or fixed in the axes of the estimate; in which, the changes themselves tell. In either set of axes directions
//! that were found gather in *lobes* (von Mises-Fisher): the sum of unit vectors, each by its precision, points to the middle of a
//! lobe, and its length is the precision of that.

use numerics::math;

use super::axes::Axes;
use super::prior::{MOST_LOBES, Prior, Priors, SIZES};
use arrayvec::ArrayVec;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// How far single changes scatter about the middle of a lobe, rad.
const SCATTER: f64 = 0.03;
/// Directions less well known than this say nothing, rad.
const LEAST_KNOWN: f64 = 0.5;
/// Number of changes after which one more is as likely from a known direction as from a new one.
const NEW: f64 = 0.25;
/// Sizes of a lobe with less than this share of its changes are left to the hypotheses of any direction.
const LEAST_SHARE: f64 = 0.05;

/// A change that has been found and watched: what the data say of it, whatever was known of its direction before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Mean of the change, axes of the estimate, 3.
    pub d: Vector3<f64>,
    /// Its covariance, 3x3.
    pub v: Matrix3<f64>,
    /// Probability that there was one, by size.
    pub weights: [f64; SIZES],
    /// Axes at its time.
    pub axes: Axes,
}

/// What has been learnt.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Directions {
    /// In each set of [`Axes`].
    sets: [Set; 2],
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Set {
    lobes: ArrayVec<Lobe, MOST_LOBES>,
    /// How well it has foretold the directions that came, as a log-likelihood.
    ln_evidence: f64,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Lobe {
    /// Unit vectors by their precision about the middle, 1/rad^2, summed.
    resultant: Vector3<f64>,
    /// Changes that it has been found in, by size.
    found: [f64; SIZES],
}

impl Directions {
    /// Learns from a change.
    pub(super) fn learn(&mut self, found: &Found) {
        let size = found.d.norm();
        let along = found.d / size;
        let across = (found.v.trace() - along.dot(&(found.v * along))) / 2.0;
        let variance = across / (size * size);
        if !variance.is_finite() || variance > LEAST_KNOWN * LEAST_KNOWN {
            return;
        }
        for (set, axes) in self.sets.iter_mut().zip(&found.axes.0) {
            set.learn(&(axes * along), variance.max(1e-12), &found.weights);
        }
    }

    /// Rates at which changes are expected, by direction and size.
    ///
    /// * `sizes`: m/s in internal units; `rates`: of each size in any direction, 1/s.
    /// * `per_found`: rate for each change that has been found, 1/s.
    pub(super) fn priors(&self, axes: &Axes, sizes: &[f64; SIZES], rates: &[f64; SIZES], per_found: f64) -> Priors {
        let better = usize::from(self.sets[1].ln_evidence > self.sets[0].ln_evidence);
        let (set, axes) = (&self.sets[better], &axes.0[better]);
        let all: f64 = set.lobes.iter().map(Lobe::count).sum();
        let known = all / (all + NEW);
        let mut open = *rates;
        let mut priors = Priors::new();
        for lobe in &set.lobes {
            for (place, found) in lobe.found.iter().enumerate() {
                let rate = (known * found * per_found).min(open[place]);
                if *found > LEAST_SHARE * all && rate > 0.0 {
                    open[place] -= rate;
                    let along = axes.transpose() * lobe.middle();
                    priors.push(Prior::along(place, sizes[place], rate, &along, lobe.variance().sqrt()));
                }
            }
        }
        priors.extend((0..SIZES).map(|place| Prior::anywhere(place, sizes[place], open[place])));
        priors
    }
}

impl Set {
    /// * `along`: unit vector in the axes of the set; `variance`: of its angle, rad^2.
    fn learn(&mut self, along: &Vector3<f64>, variance: f64, weights: &[f64; SIZES]) {
        let all: f64 = self.lobes.iter().map(Lobe::count).sum();
        let total = all + NEW;
        let mut shares: ArrayVec<f64, MOST_LOBES> = self
            .lobes
            .iter()
            .map(|lobe| lobe.count() / total * von_mises_fisher(lobe.middle().dot(along), lobe.variance() + variance))
            .collect();
        let fresh = NEW / total / (4.0 * PI);
        let sum = shares.iter().sum::<f64>() + fresh;
        let weight: f64 = weights.iter().sum();
        self.ln_evidence += weight * math::ln(4.0 * PI * sum);
        shares.iter_mut().for_each(|share| *share /= sum);
        if fresh / sum > 0.5 {
            if self.lobes.len() < MOST_LOBES || self.give_way(weight) {
                let mut fresh = Lobe::default();
                fresh.take(along, variance, 1.0, weights);
                self.lobes.push(fresh);
            }
            return;
        }
        let known: f64 = shares.iter().sum();
        for (lobe, share) in self.lobes.iter_mut().zip(&shares) {
            lobe.take(along, variance, share / known, weights);
        }
    }

    /// The lobe that was found least often loses this weight to a direction that is in none; what lasts outlives strays.
    ///
    /// * returns: whether nothing was left of it, and there is place for another.
    fn give_way(&mut self, weight: f64) -> bool {
        let counts = self.lobes.iter().map(Lobe::count).enumerate();
        let Some((least, count)) = counts.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return true;
        };
        let left = 1.0 - weight / count;
        if left > 0.0 {
            self.lobes[least].scale(left);
            false
        } else {
            self.lobes.remove(least);
            true
        }
    }
}

impl Lobe {
    /// Takes a share of a change in; as [`Set::learn`].
    fn take(&mut self, along: &Vector3<f64>, variance: f64, share: f64, weights: &[f64; SIZES]) {
        let weight: f64 = weights.iter().sum();
        self.resultant += along * (weight * share / (variance + SCATTER * SCATTER));
        for (found, weight) in self.found.iter_mut().zip(weights) {
            *found += share * weight;
        }
    }

    fn scale(&mut self, by: f64) {
        self.resultant *= by;
        self.found.iter_mut().for_each(|found| *found *= by);
    }

    fn count(&self) -> f64 {
        self.found.iter().sum()
    }

    /// Unit vector to the middle.
    fn middle(&self) -> Vector3<f64> {
        self.resultant.normalize()
    }

    /// Of the angle of the next change to the middle, rad^2.
    fn variance(&self) -> f64 {
        SCATTER * SCATTER + 1.0 / self.resultant.norm()
    }
}

/// Density of a direction on the sphere, 1/sr.
///
/// * `cosine`: of its angle to the middle; `variance`: of that angle where it is small, rad^2: the inverse of the concentration.
fn von_mises_fisher(cosine: f64, variance: f64) -> f64 {
    let k = 1.0 / variance;
    k * math::exp(k * (cosine - 1.0)) / (2.0 * PI * (1.0 - math::exp(-2.0 * k)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    /// Changes along `fixed` in the first set of axes or the second, each known to 0.1 rad.
    fn learnt(g: &mut Generator, fixed: &Vector3<f64>, set: usize, count: usize) -> Directions {
        let mut directions = Directions::default();
        for k in 0..count {
            let sight = Rotation3::from_euler_angles(0.4 * k as f64, 0.3, 1.1 * k as f64).into_inner();
            let axes = Axes([sight, Matrix3::identity()]);
            let size = 1e-3 * (1.0 + normal(g).abs());
            let noise = Vector3::from_fn(|_, _| 0.1 * size * normal(g));
            directions.learn(&Found {
                d: axes.0[set].transpose() * fixed * size + noise,
                v: Matrix3::from_diagonal_element((0.1 * size).powi(2)),
                weights: [0.0, 1.0, 0.0, 0.0, 0.0],
                axes,
            });
        }
        directions
    }

    #[test]
    fn a_fixed_direction_is_found_in_the_axes_in_which_it_is_fixed() {
        let fixed = Vector3::new(0.5, -0.6, 0.3).normalize();
        for set in [0, 1] {
            let runs = 40;
            let mut square = 0.0;
            for run in 0..runs {
                let g = &mut stream(9, run, Source::Lidar);
                let directions = learnt(g, &fixed, set, 8);
                let [here, there] = [&directions.sets[set], &directions.sets[1 - set]];
                assert!(here.ln_evidence > 3.0 && there.ln_evidence < here.ln_evidence - 5.0);
                let lobe = &here.lobes[0];
                square += lobe.middle().angle(&fixed).powi(2) / runs as f64;
                let middle = (SCATTER.powi(2) + 0.1_f64.powi(2)) / 8.0;
                assert!((lobe.variance() - (SCATTER.powi(2) + middle)).abs() < 4e-4);
            }
            // Eight directions of 0.1 rad in each of two angles; the sampling error of the mean square is a sixth.
            let expected = 2.0 * 0.1_f64.powi(2) / 8.0;
            assert!((square / expected - 1.0).abs() < 0.5, "{square} {expected}");
        }
    }

    /// Known exactly a hundred times, each off by the scatter: the middle is known to a tenth of it, and no better.
    #[test]
    fn a_middle_is_known_no_better_than_its_changes_scatter() {
        let g = &mut stream(13, 0, Source::Lidar);
        let mut set = Set::default();
        for _ in 0..100 {
            let along = Vector3::new(1.0, SCATTER * normal(g), SCATTER * normal(g)).normalize();
            set.learn(&along, 1e-12, &[1.0, 0.0, 0.0, 0.0, 0.0]);
        }
        assert_eq!(set.lobes.len(), 1);
        let expected = SCATTER.powi(2) * 1.01;
        assert!((set.lobes[0].variance() / expected - 1.0).abs() < 1e-3);
    }

    #[test]
    fn two_directions_are_two_lobes_and_what_is_not_known_is_none() {
        let g = &mut stream(10, 0, Source::Lidar);
        let (one, other) = (Vector3::x(), Vector3::new(0.0, 0.8, 0.6));
        let mut directions = learnt(g, &one, 1, 3);
        for _ in 0..3 {
            directions.learn(&Found {
                d: other * 1e-2,
                v: Matrix3::from_diagonal_element(1e-8),
                weights: [0.0, 0.0, 1.0, 0.0, 0.0],
                axes: Axes([Matrix3::identity(); 2]),
            });
        }
        let lobes = &directions.sets[1].lobes;
        assert_eq!(lobes.len(), 2);
        assert!(lobes[1].middle().angle(&other) < 1e-6 && lobes[1].found[2] > 2.9);
        directions.learn(&Found {
            d: -other * 1e-4,
            v: Matrix3::from_diagonal_element(1e-8),
            weights: [1.0, 0.0, 0.0, 0.0, 0.0],
            axes: Axes([Matrix3::identity(); 2]),
        });
        assert_eq!(directions.sets[1].lobes.len(), 2);
    }

    /// Three that come again and again, and strays from one place: each takes from the one that came least. What has come often
    /// outlives two of them, and gives way when they have come as often as it.
    #[test]
    fn what_lasts_outlives_strays() {
        let fixed = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut set = Set::default();
        let one = [0.0, 1.0, 0.0, 0.0, 0.0];
        for along in fixed.iter().flat_map(|along| [along; 4]) {
            set.learn(along, 1e-4, &one);
        }
        let counts = |set: &Set| set.lobes.iter().map(Lobe::count).collect::<Vec<_>>();
        assert_eq!(counts(&set), [4.0; 3]);
        let stray = -Vector3::new(1.0, 1.0, 1.0).normalize();
        set.learn(&stray, 1e-4, &one);
        assert_eq!(counts(&set), [3.0, 4.0, 4.0]);
        assert!((set.lobes[0].middle() - fixed[0]).norm() < 1e-12);
        set.learn(&fixed[0], 1e-4, &one);
        for _ in 0..2 {
            set.learn(&stray, 1e-4, &one);
        }
        assert!(
            set.lobes.iter().all(|lobe| lobe.middle().angle(&stray) > 0.5),
            "{:?}",
            counts(&set)
        );
        for _ in 0..12 {
            set.learn(&stray, 1e-4, &one);
        }
        assert!(
            set.lobes.iter().any(|lobe| lobe.middle().angle(&stray) < 0.1),
            "{:?}",
            counts(&set)
        );
    }

    /// However a rate is shared out between directions, it is all there.
    #[test]
    fn rates_are_shared_and_not_made() {
        let g = &mut stream(11, 0, Source::Lidar);
        let directions = learnt(g, &Vector3::x(), 1, 4);
        let (sizes, rates) = ([1e-4, 1e-3, 1e-2, 1e-1, 1.0], [3e-3, 5e-3, 1e-4, 1e-5, 1e-6]);
        for per_found in [1e-4, 1e-3] {
            let axes = Axes([Matrix3::identity(); 2]);
            let priors = directions.priors(&axes, &sizes, &rates, per_found);
            assert_eq!(priors.len(), SIZES + 1);
            for (place, rate) in rates.iter().enumerate() {
                let of_size = priors.iter().filter(|prior| prior.size == place);
                let sum: f64 = of_size.map(|prior| prior.rate).sum();
                assert!((sum - rate).abs() < 1e-9 * rate, "{sum} {rate}");
            }
            let along = priors.iter().find(|prior| !prior.anywhere).unwrap();
            let expected = (4.0 / (4.0 + NEW) * 4.0 * per_found).min(rates[1]);
            assert!((along.rate - expected).abs() < 1e-9 * expected);
        }
    }

    /// Its integral over the sphere, by the midpoint rule in the cosine.
    #[test]
    fn a_density_on_the_sphere_sums_to_one() {
        for variance in [100.0, 1.0, 0.03] {
            let steps = 20_000;
            let cosine = |k: i32| -1.0 + (2.0 * f64::from(k) + 1.0) / f64::from(steps);
            let sum: f64 = (0..steps).map(|k| von_mises_fisher(cosine(k), variance)).sum();
            let integral = sum * 2.0 / f64::from(steps) * 2.0 * PI;
            assert!((integral - 1.0).abs() < 1e-5, "{variance}: {integral}");
        }
    }
}
