//! Weights of the members of a bank that do not exchange states (multiple-model adaptive estimation).

use arrayvec::ArrayVec;
use numerics::math;
use serde::{Deserialize, Serialize};

/// Members of a bank at most.
pub(in crate::laws) const MOST_MEMBERS: usize = 12;

/// A log-likelihood for each member, in the order of their weights; on the stack, since every step makes one.
pub(in crate::laws) type LogLikelihoods = ArrayVec<f64, MOST_MEMBERS>;

/// Multiplies weights by likelihoods, and makes them sum to one.
///
/// Of a share e of the samples no member knows better than any other (Huber's contamination): L becomes (1 - e) L + e max L, so that
/// no single sample makes one member more than 1 / e times as likely as another.
///
/// * `log_likelihoods`: one for each weight; `share`: e, between 0 and 1.
pub(in crate::laws) fn reweigh(weights: &mut [f64], log_likelihoods: &[f64], share: f64) {
    let most = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (weight, log) in weights.iter_mut().zip(log_likelihoods) {
        *weight *= (1.0 - share) * math::exp(log - most) + share;
    }
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
}

/// Weights that likelihoods move and that slowly return to what they were.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::laws) struct Weights {
    prior: Vec<f64>,
    now: Vec<f64>,
    /// Time in which a weight has returned to its prior by 1 - 1/e, internal units.
    memory: f64,
}

impl Weights {
    /// * `prior`: positive; made to sum to one.
    /// * `memory`: internal units of time.
    pub(in crate::laws) fn new(prior: &[f64], memory: f64) -> Self {
        let sum: f64 = prior.iter().sum();
        let prior: Vec<f64> = prior.iter().map(|p| p / sum).collect();
        Self {
            now: prior.clone(),
            prior,
            memory,
        }
    }

    /// Moves them over a step: mu <- [mu + (1 - exp(-dt / memory)) (prior - mu)] * likelihood.
    ///
    /// * `log_likelihoods`: of the sample, one for each member; all equal when nothing was measured.
    /// * `share`: of samples that say nothing, as in [`reweigh`].
    pub(in crate::laws) fn update(&mut self, dt: f64, log_likelihoods: &[f64], share: f64) {
        let back = -math::exp_m1(-dt / self.memory);
        for (now, prior) in self.now.iter_mut().zip(&self.prior) {
            *now += (prior - *now) * back;
        }
        reweigh(&mut self.now, log_likelihoods, share);
    }

    /// The weights, which sum to one.
    pub(in crate::laws) fn get(&self) -> &[f64] {
        &self.now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the formula, with likelihoods written out; one that is nothing beside the best is a hundredth of it, and none without a share.
    #[test]
    fn one_sample_makes_no_member_more_than_a_hundred_times_as_likely() {
        let likelihoods = [3.0_f64, 2.0, 0.4];
        let mut weights = [0.25, 0.25, 0.5];
        reweigh(&mut weights, &likelihoods.map(f64::ln), 0.01);
        let expected = [0.25 * 3.0, 0.25 * 2.01, 0.5 * 0.426];
        for (weight, expected) in weights.iter().zip(expected) {
            assert!((weight - expected / (0.75 + 0.5025 + 0.213)).abs() < 1e-15);
        }
        let mut weights = [0.5, 0.5];
        reweigh(&mut weights, &[-1e4, -2e6], 0.01);
        assert!((weights[1] / weights[0] - 0.01).abs() < 1e-16);
        let mut plain = [0.5, 0.5];
        reweigh(&mut plain, &[-1.0, -5.0], 0.0);
        assert!((plain[1] / plain[0] - (-4.0_f64).exp()).abs() < 1e-16);
    }

    #[test]
    fn weights_return_to_what_they_were() {
        let mut weights = Weights::new(&[3.0, 1.0], 10.0);
        weights.update(0.0, &[0.0, 100.0], 0.0);
        assert!(weights.get()[0] < 1e-40);
        (0..10).for_each(|_| weights.update(1.0, &[0.0, 0.0], 0.0));
        assert!((weights.get()[0] - 0.75 * (1.0 - (-1.0_f64).exp())).abs() < 1e-14);
        // In ten steps or in one.
        let mut at_once = Weights::new(&[3.0, 1.0], 10.0);
        at_once.update(0.0, &[0.0, 100.0], 0.0);
        at_once.update(10.0, &[0.0, 0.0], 0.0);
        assert!((weights.get()[0] - at_once.get()[0]).abs() < 1e-14);
        (0..1000).for_each(|_| weights.update(1.0, &[0.0, 0.0], 0.0));
        assert!((weights.get()[0] - 0.75).abs() < 1e-12);
    }
}
