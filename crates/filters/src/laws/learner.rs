//! How a law with a network learns (Pesce, Silvestrini and Lavagna, Sec. II.A.2 and Algorithm 1), in any world.

use super::network::{Disturbance, Network};
use super::{Setup, Step};
use crate::FilterError;
use crate::scenarios::Measures;
use crate::units::Units;
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// A network, the error it has yet to learn from, and what it says at the newest estimate.
///
/// Algorithm 1 takes the disturbance from the old weights and then learns from the error of the previous step; so the error
/// of one sample changes the weights at the next, with the basis at the estimate that lies between them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Learner {
    network: Network,
    learning_rate: f64,
    source: ErrorSource,
    units: Units,
    /// Velocity error of the newest sample, m/s.
    error: Vector3<f64>,
    /// At the newest estimate, internal units.
    disturbance: Disturbance,
}

/// What stands for e in Eq. (17).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum ErrorSource {
    /// z - H x-, velocity rows.
    Innovation,
    /// z - H x+, velocity rows.
    Residual,
    /// K (z - H x-), where no row measures the velocity.
    Correction,
}

impl Learner {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        Ok(Self {
            network: Network::new(setup)?,
            learning_rate: t.real("learning_rate")?,
            source: match (setup.measures, t.choice("error")?) {
                (Measures::RangeAndBearing, _) => ErrorSource::Correction,
                (Measures::RelativeState, 0) => ErrorSource::Innovation,
                (Measures::RelativeState, _) => ErrorSource::Residual,
            },
            units: setup.units,
            error: Vector3::zeros(),
            disturbance: Disturbance::default(),
        })
    }

    /// Learns from the error of the sample before this one and keeps this one's.
    pub(super) fn observe(&mut self, step: &Step) {
        let seconds = step.dt * self.units.time;
        self.network.learn(&(self.error * (seconds * self.learning_rate)));
        let corrected = step.correction.fixed_rows::<3>(3);
        let innovation = step.innovation.fixed_rows::<3>(3);
        self.error = match self.source {
            ErrorSource::Innovation => innovation.into_owned(),
            // Nothing was measured where the innovation is zero, and nothing corrected.
            ErrorSource::Residual => innovation - corrected,
            ErrorSource::Correction => corrected * self.units.velocity(),
        };
    }

    /// Evaluates the network at the newest estimate.
    ///
    /// * `x`: relative position and velocity, internal units.
    pub(super) fn look_ahead(&mut self, x: &Vector6<f64>) {
        let unit = Vector6::from_fn(|i, _| self.units.of_state(i));
        let Disturbance { d, by_x } = self.network.evaluate(&x.component_mul(&unit));
        let acceleration = self.units.acceleration();
        self.disturbance = Disturbance {
            d: d / acceleration,
            by_x: by_x.map_with_location(|_, j, v| v * unit[j] / acceleration),
        };
    }

    /// What the network says at the newest estimate, internal units.
    pub(super) fn disturbance(&self) -> &Disturbance {
        &self.disturbance
    }
}
