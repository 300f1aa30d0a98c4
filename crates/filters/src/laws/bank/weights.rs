//! Weights of the members of a bank that do not exchange states (multiple-model adaptive estimation).

use serde::{Deserialize, Serialize};

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
        let most = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        for ((now, prior), log) in self.now.iter_mut().zip(&self.prior).zip(log_likelihoods) {
            *now = (*now + (prior - *now) * back) * (log - most).exp();
            sum += *now;
        }
        self.now.iter_mut().for_each(|now| *now /= sum);
    }

    /// The weights, which sum to one.
    pub(in crate::laws) fn get(&self) -> &[f64] {
        &self.now
    }
}
