//! Interacting multiple models over constant white-acceleration densities (Blom and Bar-Shalom, 1988).

use super::adaptation::Setup;
use super::bank::{Bank, CONSTANTS, Centre, LogLikelihoods, MOST_MEMBERS, Mixture, Shared, reweigh};
use super::entry::{FilterEntry, Motion, Search, Update};
use super::mmae::{Decades, LOWEST, MEMBERS};
use crate::error::FilterError;
use crate::tunable::{Bound, Kind, Start, Tunable};
use arrayvec::ArrayVec;
use nalgebra::Vector6;
use numerics::math;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "imm",
    about: "interacting multiple models over snc filters a decade of q apart (Blom and Bar-Shalom)",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[LOWEST, MEMBERS, SOJOURN],
    presets: &[CONSTANTS],
    search: &[Search {
        tunable: SOJOURN.name,
        low: 1.0,
        high: 1e5,
        only_with: None,
    }],
};

const SOJOURN: Tunable = Tunable {
    name: "sojourn",
    about: "mean time that the target keeps to one of the models",
    kind: Kind::Real {
        start: Start::Fixed(10_000.0),
        unit: "s",
        bound: Bound::Positive,
    },
};

/// A bank whose members mix their states before every sample.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Imm {
    centre: Centre,
    decades: Decades,
    weights: Vec<f64>,
    sojourn: f64,
}

impl Imm {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let decades = Decades::as_tuned(setup)?;
        let count = decades.members.len();
        let weights = vec![1.0 / count as f64; count];
        Ok(Self {
            centre: Centre::new(setup.r, decades.density(&weights)),
            decades,
            weights,
            sojourn: setup.tunables.real(SOJOURN.name)? / setup.units.time,
        })
    }

    /// Mixes the members as a Markov chain would have moved between them over `dt`: it stays with probability e^(-dt / T), else
    /// it goes to any of the others alike.
    fn mix(&mut self, dt: f64) {
        let count = self.weights.len();
        if count == 1 {
            return;
        }
        let leave = -math::exp_m1(-dt / self.sojourn) / (count - 1) as f64;
        let from = |i: usize, j: usize| {
            let stay = if i == j { 1.0 - leave * count as f64 } else { 0.0 };
            self.weights[i] * (stay + leave)
        };
        let mut mixed = ArrayVec::<_, MOST_MEMBERS>::new();
        for to in 0..count {
            let into: ArrayVec<f64, MOST_MEMBERS> = (0..count).map(|i| from(i, to)).collect();
            mixed.push((into.iter().sum::<f64>(), self.decades.mixture(&into).moments()));
        }
        for ((member, weight), (sum, mixture)) in self.decades.members.iter_mut().zip(&mut self.weights).zip(mixed) {
            (member.dx, member.p, *weight) = (mixture.mean, mixture.p, sum);
        }
    }
}

impl Bank for Imm {
    fn centre(&self) -> &Centre {
        &self.centre
    }

    fn centre_mut(&mut self) -> &mut Centre {
        &mut self.centre
    }

    fn take(&mut self, shared: &Shared) {
        if self.centre.said().is_some() {
            self.mix(shared.dt);
        }
        let mut likelihoods = LogLikelihoods::new();
        self.decades.take(shared, &mut likelihoods);
        reweigh(&mut self.weights, &likelihoods, 0.0);
    }

    fn mixture(&self) -> Mixture {
        self.decades.mixture(&self.weights)
    }

    fn density(&self) -> f64 {
        self.decades.density(&self.weights)
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        self.decades.shift(by);
    }
}
