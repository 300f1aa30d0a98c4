//! Weights of the members of a bank that do not exchange states (multiple-model adaptive estimation).

use serde::{Deserialize, Serialize};

/// Multiplies weights by likelihoods, and makes them sum to one.
///
/// * `log_likelihoods`: one for each weight.
pub(in crate::laws) fn reweigh(weights: &mut [f64], log_likelihoods: &[f64]) {
    let most = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (weight, log) in weights.iter_mut().zip(log_likelihoods) {
        *weight *= (log - most).exp();
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

    /// Moves them over a step: mu <- [(1 - dt / memory) mu + dt / memory prior] * likelihood.
    ///
    /// * `log_likelihoods`: of the sample, one for each member; all equal when nothing was measured.
    pub(in crate::laws) fn update(&mut self, dt: f64, log_likelihoods: &[f64]) {
        let back = (dt / self.memory).min(1.0);
        for (now, prior) in self.now.iter_mut().zip(&self.prior) {
            *now += (prior - *now) * back;
        }
        reweigh(&mut self.now, log_likelihoods);
    }

    /// The weights, which sum to one.
    pub(in crate::laws) fn get(&self) -> &[f64] {
        &self.now
    }
}
