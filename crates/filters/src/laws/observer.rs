//! A full-state observer of constant gain with the learning network (Pesce, Silvestrini and Lavagna, Sec. III.B.1).

use super::learner::Learner;
use super::network::{self, Disturbance};
use super::{AccelerationModel, Adaptation, FilterEntry, Law, Only, Search, Setup, Step};
use crate::FilterError;
use crate::scenarios::Measures;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Tunable};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "observer",
    about: "constant-gain observer with a learning radial-basis network, no covariance (Pesce, Silvestrini and Lavagna)",
    tunables: &network::with::<2, 11>([
        Tunable {
            name: "k_position",
            about: "gain on position, K_h of Eq. (33)",
            kind: Kind::Real {
                start: Some(0.42),
                unit: "1/s",
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "k_velocity",
            about: "gain on velocity, K_h of Eq. (33)",
            kind: Kind::Real {
                start: Some(0.025),
                unit: "1/s",
                bound: Bound::NonNegative,
            },
        },
    ]),
    presets: &[Preset {
        name: "paper",
        about: "gains that fit the paper's Table 3",
        sets: &[],
    }],
    search: &[
        network::SEARCH_LEARNING_RATE,
        network::SEARCH_SHAPE,
        Search {
            tunable: "k_position",
            low: 1e-4,
            high: 10.0,
        },
        Search {
            tunable: "k_velocity",
            low: 1e-4,
            high: 10.0,
        },
    ],
    only: Some(Only {
        measures: Measures::RelativeState,
        why: "its gain multiplies a measurement of the whole state (H = I), which range and angles are not",
    }),
    build,
};

fn build(setup: &Setup<'_>) -> Result<Law, FilterError> {
    let gain = |name: &str| Ok::<f64, FilterError>(setup.tunables.real(name)? * setup.off_nominal * setup.units.time);
    Ok(Observer {
        learner: Learner::new(setup)?,
        k_position: gain("k_position")?,
        k_velocity: gain("k_velocity")?,
    }
    .into())
}

/// The law and its memory; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Observer {
    learner: Learner,
    k_position: f64,
    k_velocity: f64,
}

impl Adaptation for Observer {
    fn acceleration(&self) -> AccelerationModel {
        AccelerationModel::Absent
    }

    fn process_noise(&self, _dt: f64) -> TargetMatrix {
        TargetMatrix::zeros()
    }

    /// 1 - exp(-k h), which is what Eq. (33) does to a held measurement over the interval h; Euler's k h diverges when large.
    fn gain(&self, dt: f64) -> Option<Vector6<f64>> {
        let (position, velocity) = (-(-self.k_position * dt).exp_m1(), -(-self.k_velocity * dt).exp_m1());
        Some(Vector6::from_fn(|i, _| if i < 3 { position } else { velocity }))
    }

    fn observe(&mut self, step: Step) -> Result<(), FilterError> {
        self.learner.observe(&step);
        Ok(())
    }

    fn look_ahead(&mut self, x: &Vector6<f64>) {
        self.learner.look_ahead(x);
    }

    fn disturbance(&self) -> Option<&Disturbance> {
        Some(self.learner.disturbance())
    }
}
