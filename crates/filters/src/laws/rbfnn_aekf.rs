//! A network learns the unmodelled acceleration while the gain's own corrections adapt Q (Pesce, Silvestrini and Lavagna).
//!
//! Eq. (27), Q+ = alpha Q + (1 - alpha) K delta delta^T K^T, adds matrices of rank one. Taken in full as printed, Q loses rank
//! when alpha is small: the filter then trusts some combinations of states without reason, while errors and innovations still
//! look healthy and only the NEES shows it. `adaptation = diagonal` keeps the variances only, above a floor.

use super::adaptation::{Adaptation, Setup, Step};
use super::entry::{FilterEntry, Motion, Search, Update};
use super::learner::Learner;
use super::network;
use super::step_noise::{self, Q_POSITION, Q_VELOCITY};
use crate::disturbance::Disturbance;
use crate::dynamics::AccelerationModel;
use crate::error::FilterError;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Start, Tunable};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "rbfnn_aekf",
    about: "a radial-basis network learns the disturbance, innovations adapt Q (Pesce, Silvestrini and Lavagna)",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: false,
    bound: false,
    tunables: &network::with::<6, 15>([
        Q_POSITION,
        Q_VELOCITY,
        Tunable {
            name: "alpha",
            about: "forgetting factor of Q at each sample, Eq. (27)",
            kind: Kind::Real {
                start: Start::Fixed(0.999),
                unit: "1",
                bound: Bound::Fraction,
            },
        },
        Tunable {
            name: "adaptation",
            about: "all of K delta delta^T K^T as printed (full), or its variances above a floor (diagonal)",
            kind: Kind::Choice {
                type_name: "Adaptation",
                about: "how the innovations adapt Q",
                items: &[
                    ("full", "all of K delta delta^T K^T, as printed"),
                    ("diagonal", "its variances alone, above a floor"),
                ],
            },
        },
        Tunable {
            name: "floor_position",
            about: "smallest position variance per second under diagonal adaptation",
            kind: Kind::Real {
                start: Start::Fixed(1e-12),
                unit: "m2",
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "floor_velocity",
            about: "smallest velocity variance per second under diagonal adaptation",
            kind: Kind::Real {
                start: Start::Fixed(1e-16),
                unit: "m2/s2",
                bound: Bound::NonNegative,
            },
        },
    ]),
    presets: &[
        Preset {
            name: "paper",
            about: "as printed, with the tuning that fits the paper's Tables 2 and 3",
            other_reading: false,
            sets: &[],
        },
        Preset {
            name: "repaired",
            about: "diagonal adaptation that forgets faster, a wide and slow network without random start",
            other_reading: true,
            sets: &[
                ("adaptation", "diagonal"),
                ("shape", "0.01"),
                ("learning_rate", "0.009"),
                ("start_weights", "0"),
                ("alpha", "0.98"),
            ],
        },
        Preset {
            name: "fig4",
            about: "as paper, from start weights six orders of magnitude too large, which fade",
            other_reading: false,
            sets: &[("start_weights", "1"), ("relaxation", "0.98")],
        },
    ],
    search: &[
        network::SEARCH_LEARNING_RATE,
        network::SEARCH_SHAPE,
        step_noise::SEARCH_Q_POSITION,
        step_noise::SEARCH_Q_VELOCITY,
        // At 1 the filter does not adapt.
        Search {
            tunable: "alpha",
            low: 0.5,
            high: 1.0,
            only_with: None,
        },
    ],
};

/// The law and its memory; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RbfnnAekf {
    learner: Learner,
    /// Process noise per unit of time, 9x9.
    q: TargetMatrix,
    alpha: f64,
    /// Set when only variances are adapted: the least of them.
    floor: Option<TargetMatrix>,
    updates: i32,
}

impl RbfnnAekf {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        let floor = step_noise::diagonal(
            t.real("floor_position")? * setup.units.time / setup.units.length.powi(2),
            t.real("floor_velocity")? * setup.units.time / setup.units.velocity().powi(2),
        );
        Ok(Self {
            learner: Learner::new(setup)?,
            q: step_noise::rate(setup)?,
            alpha: t.real("alpha")?,
            floor: (t.choice("adaptation")? == 1).then_some(floor),
            updates: 0,
        })
    }
}

impl Adaptation for RbfnnAekf {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, dt: f64) -> TargetMatrix {
        self.q * dt
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        self.learner.observe(step);
        // A lost sample says nothing about Q.
        if step.measured.is_empty() {
            return Ok(());
        }
        // K delta is what the update added to position and velocity.
        let added = step.correction.fixed_rows::<6>(0).into_owned();
        let fresh = added * added.transpose() * ((1.0 - self.alpha) / step.dt);
        let mut q = self.q * self.alpha;
        let mut adapted = q.fixed_view_mut::<6, 6>(0, 0);
        adapted += fresh;
        self.q = match &self.floor {
            None => q,
            Some(floor) => TargetMatrix::from_diagonal(&q.diagonal().sup(&floor.diagonal())),
        };
        self.updates += 1;
        Ok(())
    }

    fn look_ahead(&mut self, x: &Vector6<f64>) {
        self.learner.look_ahead(x);
    }

    fn disturbance(&self) -> Option<&Disturbance> {
        Some(self.learner.disturbance())
    }

    fn updates(&self) -> i32 {
        self.updates
    }
}
