//! A bank of what each kind of disturbance asks for: velocity-change hypotheses for vents and burns, white accelerations by the
//! decade for what never stops, a walking acceleration for what lasts.

use super::adaptation::Setup;
use super::bank::velocity_change::VelocityChanges;
use super::bank::{Bank, CONSTANTS, Centre, LogLikelihoods, Member, Mixture, Shared, Weights};
use super::change_point::{DECIDED, DIRECTIONS, QUIET, RATE, SCHEDULE, WINDOW, velocity_changes};
use super::entry::{FilterEntry, Motion, Update};
use super::mmae::{self, Decades};
use crate::error::FilterError;
use crate::jerk;
use crate::state::{Target, TargetMatrix};
use crate::tunable::{Bound, Kind, Start, Tunable, Tunables};
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// White accelerations, square roots of the densities, m/s^1.5.
const WHITE: [f64; 5] = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1];
/// Walking accelerations, square roots of the jerk densities, m/s^2.5.
const WALKING: [f64; 2] = [1e-8, 1e-7];
/// Weight of the hypotheses at the start; the others share the rest.
const PRIOR_CHANGES: f64 = 0.7;
/// Weight of a white one over that of the one a decade quieter.
const LOUDER: f64 = 0.2;
/// Weight of a walking one over that of the quietest white one.
const PRIOR_WALKING: f64 = 1.0 / 32.0;

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "hybrid",
    about: "bank of velocity-change hypotheses, white accelerations by the decade and walking accelerations",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[
        QUIET,
        RATE,
        WINDOW,
        DECIDED,
        DIRECTIONS,
        SCHEDULE,
        MEMORY,
        CONTAMINATION,
    ],
    presets: &[CONSTANTS],
    search: &[],
};

/// Tunable `memory`.
const MEMORY: Tunable = Tunable {
    kind: Kind::Real {
        start: Start::Fixed(10_000.0),
        unit: "s",
        bound: Bound::Positive,
    },
    ..mmae::MEMORY
};

/// Tunable `contamination`.
const CONTAMINATION: Tunable = Tunable {
    name: "contamination",
    about: "share of samples of which no member is taken to know better than another; 1 over it is the most that one sample can say",
    kind: Kind::Real {
        start: Start::Fixed(0.01),
        unit: "1",
        bound: Bound::Fraction,
    },
};

/// The bank; its weights stand in the order: changes, white, walking.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Hybrid {
    centre: Centre,
    changes: VelocityChanges,
    white: Decades,
    walking: Vec<Walking>,
    weights: Weights,
    /// As [`CONTAMINATION`].
    contamination: f64,
    /// Variance of an acceleration at the start, internal units.
    acceleration: f64,
}

/// A filter whose acceleration walks.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Walking {
    /// Jerk density, internal units.
    density: f64,
    member: Member<9>,
}

impl Hybrid {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let Tunables { told, .. } = &setup.tunables;
        let mut prior = vec![PRIOR_CHANGES];
        let of_white = std::iter::successors(Some(1.0), |weight| Some(weight * LOUDER)).take(WHITE.len());
        let others: Vec<f64> = of_white.chain(WALKING.map(|_| PRIOR_WALKING)).collect();
        let sum: f64 = others.iter().sum();
        prior.extend(others.iter().map(|weight| (1.0 - PRIOR_CHANGES) * weight / sum));
        let walking = WALKING.map(|s| Walking {
            density: (s / setup.units.root_jerk_density()).powi(2) * setup.off_nominal,
            member: Member {
                dx: Target::zeros(),
                p: TargetMatrix::zeros(),
            },
        });
        let (changes, white) = (velocity_changes(setup)?, Decades::new(&WHITE, setup));
        let weights = Weights::new(&prior, setup.tunables.real(MEMORY.name)? / setup.units.time);
        let density = density(&changes, &white, weights.get());
        Ok(Self {
            centre: Centre::new(setup.r, density),
            changes,
            white,
            walking: walking.to_vec(),
            weights,
            contamination: setup.tunables.real(CONTAMINATION.name)?,
            acceleration: (told.p0.acceleration / setup.units.acceleration()).powi(2),
        })
    }
}

/// White acceleration density of the bank; what walks has none.
fn density(changes: &VelocityChanges, white: &Decades, weights: &[f64]) -> f64 {
    weights[0] * changes.density() + white.density(&weights[1..])
}

impl Bank for Hybrid {
    fn centre(&self) -> &Centre {
        &self.centre
    }

    fn centre_mut(&mut self) -> &mut Centre {
        &mut self.centre
    }

    fn take(&mut self, shared: &Shared) {
        let mut likelihoods = LogLikelihoods::new();
        likelihoods.push(self.changes.take(shared));
        self.white.take(shared, &mut likelihoods);
        let f = shared.with_acceleration();
        for Walking { density, member } in &mut self.walking {
            let noise = jerk::process_noise(&Vector3::repeat(*density), shared.dt);
            likelihoods.push(shared.take(member, &f, &noise, self.acceleration));
        }
        self.weights.update(shared.dt, &likelihoods, self.contamination);
    }

    fn mixture(&self) -> Mixture {
        let weights = self.weights.get();
        let (of_white, of_walking) = weights[1..].split_at(self.white.members.len());
        let mut mixture = Mixture::default();
        let changes = self.changes.mixture().moments();
        mixture.add(weights[0], &changes.mean, &changes.p);
        self.white.add_to(&mut mixture, of_white);
        for (Walking { member, .. }, weight) in self.walking.iter().zip(of_walking) {
            let dx = member.dx.fixed_rows::<6>(0).into_owned();
            mixture.add(*weight, &dx, &member.p.fixed_view::<6, 6>(0, 0).into_owned());
        }
        mixture
    }

    fn density(&self) -> f64 {
        density(&self.changes, &self.white, self.weights.get())
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        self.changes.shift(by);
        self.white.shift(by);
        for Walking { member, .. } in &mut self.walking {
            let mut deviation = member.dx.fixed_rows_mut::<6>(0);
            deviation -= by;
        }
    }

    fn decisions(&self) -> i32 {
        self.changes.decisions()
    }
}
