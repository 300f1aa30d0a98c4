//! What dynamics of the relative state in the target's LVLH frame offer: rho, rho_dot and d, nine states, SI.

use super::acceleration::AccelerationModel;
use super::transition::Flow;
use crate::error::FilterError;
use crate::state::{Target, TargetMatrix};
use astro::TargetOrbit;
use nalgebra::{Matrix3, Vector3};

/// Motion of a chaser about its target, LVLH.
pub(crate) trait RelativeMotion {
    /// Refuses an orbit of the target that the dynamics cannot use, given at `t_s`.
    ///
    /// # Errors
    /// When it is needed and makes no sense.
    fn check(&self, _orbit: &TargetOrbit, _t_s: f64) -> Result<(), FilterError> {
        Ok(())
    }

    /// The target's orbit `gap` before the one given, in `parts` equal steps; the given one where nobody reads it.
    fn orbit_before(&self, orbit: &TargetOrbit, _gap: f64, _parts: u32) -> TargetOrbit {
        *orbit
    }

    /// Mean after `dt` and the transition matrix.
    ///
    /// * `orbit`: the target's at the begin of the step; at its end afterwards.
    fn step(
        &mut self,
        x: &Target,
        dt: f64,
        orbit: &mut TargetOrbit,
        acceleration: AccelerationModel,
    ) -> (Target, TargetMatrix);

    /// Acceleration beyond that of Clohessy and Wiltshire that the dynamics hold without any state.
    fn beyond(&self, _orbit: &TargetOrbit, _x: &Target) -> Vector3<f64> {
        Vector3::zeros()
    }
}

/// Transition of the nine states for partials of the relative acceleration by rho and rho_dot, over `dt`.
pub(super) fn transition(
    partials: &(Matrix3<f64>, Matrix3<f64>),
    acceleration: AccelerationModel,
    dt: f64,
) -> TargetMatrix {
    let third = acceleration != AccelerationModel::Absent;
    Flow::new(&partials.0, &partials.1, acceleration.decay(), dt).nine(third, dt)
}

/// Three of the nine states.
pub(super) fn part(x: &Target, first: usize) -> Vector3<f64> {
    x.fixed_rows::<3>(first).into_owned()
}
