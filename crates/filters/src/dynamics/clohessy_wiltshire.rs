//! Linear relative motion about a circular orbit: Clohessy and Wiltshire.

use super::acceleration::AccelerationModel;
use super::relative::{RelativeMotion, transition};
use crate::state::{Target, TargetMatrix};
use astro::{ClohessyWiltshire, TargetOrbit};
use serde::{Deserialize, Serialize};

/// Clohessy-Wiltshire motion, with the transition matrix of the last interval.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Circular {
    model: ClohessyWiltshire,
    known: Option<(f64, TargetMatrix)>,
}

impl Circular {
    /// About this orbit.
    pub(crate) fn new(model: ClohessyWiltshire) -> Self {
        Self { model, known: None }
    }
}

impl RelativeMotion for Circular {
    fn step(
        &mut self,
        x: &Target,
        dt: f64,
        _orbit: &mut TargetOrbit,
        acceleration: AccelerationModel,
    ) -> (Target, TargetMatrix) {
        let known = self.known.filter(|(of, _)| of.to_bits() == dt.to_bits());
        let f = known.map_or_else(|| transition(&self.model.partials(), acceleration, dt), |(_, f)| f);
        self.known = Some((dt, f));
        (f * x, f)
    }
}
