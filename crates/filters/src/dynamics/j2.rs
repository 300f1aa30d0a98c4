//! Nonlinear relative motion with J2, about the target's orbit as it is handed over with each sample.

use super::acceleration::AccelerationModel;
use super::relative::{RelativeMotion, part, transition};
use crate::error::FilterError;
use crate::state::{Target, TargetMatrix};
use astro::{ClohessyWiltshire, J2RelativeMotion, TargetOrbit};
use nalgebra::{SVector, Vector3};
use numerics::rk4;
use serde::{Deserialize, Serialize};

/// Relative motion with J2.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct J2 {
    /// The motion.
    pub model: J2RelativeMotion,
    /// What it is compared with to say what the simpler model leaves out.
    pub circular: ClohessyWiltshire,
}

impl RelativeMotion for J2 {
    fn check(&self, orbit: &TargetOrbit, t_s: f64) -> Result<(), FilterError> {
        let (r, h) = (orbit.r, orbit.h);
        if r > 0.0 && h > 0.0 && orbit.to_vector().iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        Err(FilterError::NoTargetOrbit { t_s, r, h })
    }

    fn orbit_before(&self, orbit: &TargetOrbit, gap: f64, parts: u32) -> TargetOrbit {
        let dt = -gap / f64::from(parts);
        (0..parts).fold(*orbit, |orbit, _| {
            let x = rk4::step(0.0, &orbit.to_vector(), dt, |_, x| {
                self.model.orbit_rate(&TargetOrbit::from_vector(x))
            });
            TargetOrbit::from_vector(&x)
        })
    }

    fn step(
        &mut self,
        x: &Target,
        dt: f64,
        orbit: &mut TargetOrbit,
        acceleration: AccelerationModel,
    ) -> (Target, TargetMatrix) {
        let j2 = self.model;
        let f = transition(&j2.partials(orbit, &part(x, 0)), acceleration, dt);
        let mut together = SVector::<f64, 15>::zeros();
        together.fixed_rows_mut::<9>(0).copy_from(x);
        together.fixed_rows_mut::<6>(9).copy_from(&orbit.to_vector());
        let decay = acceleration.decay();
        let end = rk4::step(0.0, &together, dt, |_, y| {
            let orbit = TargetOrbit::from_vector(&y.fixed_rows::<6>(9).into_owned());
            let y = y.fixed_rows::<9>(0).into_owned();
            let (rho, rho_dot, d) = (part(&y, 0), part(&y, 3), part(&y, 6));
            let mut dy = SVector::<f64, 15>::zeros();
            dy.fixed_rows_mut::<3>(0).copy_from(&rho_dot);
            dy.fixed_rows_mut::<3>(3)
                .copy_from(&(j2.acceleration(&orbit, &rho, &rho_dot) + d));
            dy.fixed_rows_mut::<3>(6).copy_from(&(d * -decay));
            dy.fixed_rows_mut::<6>(9).copy_from(&j2.orbit_rate(&orbit));
            dy
        });
        *orbit = TargetOrbit::from_vector(&end.fixed_rows::<6>(9).into_owned());
        (end.fixed_rows::<9>(0).into_owned(), f)
    }

    fn beyond(&self, orbit: &TargetOrbit, x: &Target) -> Vector3<f64> {
        let (rho, rho_dot) = (part(x, 0), part(x, 3));
        self.model.acceleration(orbit, &rho, &rho_dot) - self.circular.acceleration(&rho, &rho_dot)
    }
}
