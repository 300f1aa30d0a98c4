//! Accelerations of the target that never stop: one that wanders, and white noise.

use interface::mission;
use nalgebra::Vector3;
use numerics::{Generator, Source, math, stream};
use sensors::normal3;
use serde::{Deserialize, Serialize};

use crate::overrides::Run;
use crate::timeline::Push;

/// Both, constant over each interval of the time grid; each draws from a stream of its own, and only where it is there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Unmodelled {
    wander: Option<Wander>,
    white: Option<White>,
}

/// A first-order Gauss-Markov process.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Wander {
    /// Axes N, m/s2.
    now: Vector3<f64>,
    /// What is left of it after an interval.
    decay: f64,
    /// Standard deviation of what is new after one, m/s2.
    fresh: f64,
    draws: Generator,
}

/// Its integral over an interval is that of white noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct White {
    /// Axes N, m/s2.
    now: Vector3<f64>,
    /// m/s2.
    sigma: f64,
    draws: Generator,
}

impl Unmodelled {
    /// Over the first interval, the wandering acceleration drawn from its steady state.
    ///
    /// * `grid`: length of an interval, s.
    pub(crate) fn new(run: &Run, grid: f64) -> Self {
        let mission::Unmodelled {
            wander_sigma_m_s2: sigma,
            wander_time_constant_s: time,
            white_m_s1_5: white,
        } = run.mission.unmodelled;
        let draws = |source| stream(run.study_seed, run.run, source);
        let wander = (sigma > 0.0).then(|| {
            let mut draws = draws(Source::Wander);
            let decay = math::exp(-grid / time);
            Wander {
                now: normal3(&mut draws) * sigma,
                decay,
                fresh: sigma * (1.0 - decay * decay).sqrt(),
                draws,
            }
        });
        let white = (white > 0.0).then(|| {
            let mut draws = draws(Source::WhiteAcceleration);
            let sigma = white / grid.sqrt();
            White {
                now: normal3(&mut draws) * sigma,
                sigma,
                draws,
            }
        });
        Self { wander, white }
    }

    /// Goes on to the next interval.
    pub(crate) fn step(&mut self) {
        if let Some(wander) = &mut self.wander {
            wander.now = wander.now * wander.decay + normal3(&mut wander.draws) * wander.fresh;
        }
        if let Some(white) = &mut self.white {
            white.now = normal3(&mut white.draws) * white.sigma;
        }
    }

    /// Adds what acts over the present interval.
    pub(crate) fn add_to(&self, mut push: Push) -> Push {
        let wander = self.wander.iter().map(|wander| wander.now);
        let white = self.white.iter().map(|white| white.now);
        wander.chain(white).for_each(|a| push.target.n += a);
        push
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Params;

    fn series(set: &[(&str, f64)], grid: f64, steps: u32) -> Vec<Vector3<f64>> {
        let mut params = Params::of_scenario(1);
        assert!(set.iter().all(|(name, value)| params.set(name, *value)));
        let mut unmodelled = Unmodelled::new(&params.run().unwrap(), grid);
        let mut found = Vec::new();
        for _ in 0..steps {
            found.push(unmodelled.add_to(Push::default()).target.n);
            unmodelled.step();
        }
        found
    }

    /// Mean of the product of an axis with itself `lag` steps later.
    fn correlation(series: &[Vector3<f64>], lag: usize) -> f64 {
        let products = series.iter().zip(&series[lag..]).map(|(a, b)| a.dot(b) / 3.0);
        products.sum::<f64>() / (series.len() - lag) as f64
    }

    /// Variance and correlation of a first-order Gauss-Markov process, whatever the grid.
    #[test]
    fn it_wanders_with_its_size_and_time_constant() {
        for grid in [1.0, 4.0] {
            let (sigma, time) = (5e-6, 40.0);
            let set = [
                ("unmodelled.wander_sigma", sigma),
                ("unmodelled.wander_time_constant", time),
            ];
            let found = series(&set, grid, 400_000);
            let lag = (time / grid) as usize;
            let share = correlation(&found, lag) / correlation(&found, 0);
            // Four standard errors from 3 axes and as many independent values as there are time constants.
            let error = 4.0 * (2.0 / (3.0 * 400_000.0 * grid / time)).sqrt();
            assert!((correlation(&found, 0) / sigma.powi(2) - 1.0).abs() < error, "{grid} s");
            assert!((share - (-1.0_f64).exp()).abs() < error, "{grid} s: {share}");
        }
    }

    /// The velocity that it adds in a time does not depend on the grid.
    #[test]
    fn white_noise_adds_velocity_with_the_root_of_time() {
        for grid in [0.25, 1.0, 4.0] {
            let found = series(&[("unmodelled.white", 1e-4)], grid, 100_000);
            let density = correlation(&found, 0) * grid;
            let error = 4.0 * (2.0_f64 / 300_000.0).sqrt();
            assert!((density / 1e-8 - 1.0).abs() < error, "{grid} s: {density}");
            assert!((correlation(&found, 1) * grid / 1e-8).abs() < error);
        }
    }

    #[test]
    fn without_any_nothing_is_added() {
        assert!(series(&[], 1.0, 10).iter().all(|a| *a == Vector3::zeros()));
    }
}
