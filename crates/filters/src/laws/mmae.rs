//! Multiple-model adaptive estimation over constant white-acceleration densities.

use super::adaptation::Setup;
use super::bank::{Bank, CONSTANTS, Centre, LogLikelihoods, MOST_MEMBERS, Member, Mixture, Shared, Weights, white};
use super::entry::{FilterEntry, Motion, Update};
use crate::error::FilterError;
use crate::tunable::{Bound, Kind, Start, Tunable};
use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "mmae",
    about: "multiple-model adaptive estimation over snc filters a decade of q apart (Magill)",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[LOWEST, MEMBERS, MEMORY],
    presets: &[CONSTANTS],
    search: &[],
};

/// Tunable `lowest`.
pub(super) const LOWEST: Tunable = Tunable {
    name: "lowest",
    about: "square root of the acceleration density of the quietest member; each other is a decade above the one before",
    kind: Kind::Real {
        start: Start::Fixed(1e-6),
        unit: "m/s^1.5",
        bound: Bound::Positive,
    },
};

/// Tunable `members`.
pub(super) const MEMBERS: Tunable = Tunable {
    name: "members",
    about: "number of members",
    kind: Kind::Integer {
        start: 6,
        min: 1,
        max: MOST_MEMBERS as i32,
    },
};

/// Tunable `memory`.
pub(super) const MEMORY: Tunable = Tunable {
    name: "memory",
    about: "time in which the weights of the members return to what they were at the start",
    kind: Kind::Real {
        start: Start::Fixed(3000.0),
        unit: "s",
        bound: Bound::Positive,
    },
};

/// State-noise filters of constant density.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Decades {
    /// White acceleration densities, internal units.
    pub densities: Vec<f64>,
    /// One for each.
    pub members: Vec<Member<6>>,
}

impl Decades {
    /// The members that [`LOWEST`] and [`MEMBERS`] say.
    ///
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn as_tuned(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let lowest = setup.tunables.real(LOWEST.name)?;
        let members = setup.tunables.integer(MEMBERS.name)?;
        let roots: Vec<f64> = (0..members).map(|k| lowest * 10_f64.powi(k)).collect();
        Ok(Self::new(&roots, setup))
    }

    /// * `roots`: square roots of the densities, m/s^1.5.
    pub(super) fn new(roots: &[f64], setup: &Setup<'_>) -> Self {
        let unit = setup.units.root_acceleration_density();
        let member = Member {
            dx: Vector6::zeros(),
            p: Matrix6::zeros(),
        };
        Self {
            densities: roots.iter().map(|q| (q / unit).powi(2) * setup.off_nominal).collect(),
            members: vec![member; roots.len()],
        }
    }

    /// Takes a sample in; log-likelihoods are added to `into`.
    pub(super) fn take(&mut self, shared: &Shared, into: &mut LogLikelihoods) {
        for (member, density) in self.members.iter_mut().zip(&self.densities) {
            into.push(shared.take(member, &shared.f, &white(*density, shared.dt), 0.0));
        }
    }

    /// Adds the members to a mixture.
    pub(super) fn add_to(&self, mixture: &mut Mixture, weights: &[f64]) {
        for (member, weight) in self.members.iter().zip(weights) {
            mixture.add(*weight, &member.dx, &member.p);
        }
    }

    /// The members alone, with these weights.
    pub(super) fn mixture(&self, weights: &[f64]) -> Mixture {
        let mut mixture = Mixture::default();
        self.add_to(&mut mixture, weights);
        mixture
    }

    /// Mean density with these weights.
    pub(super) fn density(&self, weights: &[f64]) -> f64 {
        self.densities.iter().zip(weights).map(|(q, w)| q * w).sum()
    }

    /// Deviations are from another mean now.
    pub(super) fn shift(&mut self, shift: &Vector6<f64>) {
        self.members.iter_mut().for_each(|member| member.dx -= shift);
    }
}

/// A bank whose members keep their states to themselves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Mmae {
    centre: Centre,
    decades: Decades,
    weights: Weights,
}

impl Mmae {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let decades = Decades::as_tuned(setup)?;
        let alike = vec![1.0; decades.members.len()];
        let weights = Weights::new(&alike, setup.tunables.real(MEMORY.name)? / setup.units.time);
        Ok(Self {
            centre: Centre::new(setup.r, decades.density(weights.get())),
            decades,
            weights,
        })
    }
}

impl Bank for Mmae {
    fn centre(&self) -> &Centre {
        &self.centre
    }

    fn centre_mut(&mut self) -> &mut Centre {
        &mut self.centre
    }

    fn take(&mut self, shared: &Shared) {
        let mut likelihoods = LogLikelihoods::new();
        self.decades.take(shared, &mut likelihoods);
        self.weights.update(shared.dt, &likelihoods, 0.0);
    }

    fn mixture(&self) -> Mixture {
        self.decades.mixture(self.weights.get())
    }

    fn density(&self) -> f64 {
        self.decades.density(self.weights.get())
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        self.decades.shift(by);
    }
}
