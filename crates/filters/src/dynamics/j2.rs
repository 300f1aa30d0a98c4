//! Nonlinear relative motion with J2, about the target's orbit as it is handed over with each sample.

use super::acceleration::AccelerationModel;
use super::decay::{self, Answer, Dying, is_slow};
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

impl J2 {
    /// Mean after `dt` where d dies away within a step.
    fn step_dying(&self, x: &Target, dt: f64, orbit: &mut TargetOrbit, decay: f64) -> Target {
        let d = part(x, 6);
        // Relative state, then the orbit, which d leaves alone.
        let mut start = SVector::<f64, 12>::zeros();
        start.fixed_rows_mut::<6>(0).copy_from(&x.fixed_rows::<6>(0));
        start.fixed_rows_mut::<6>(6).copy_from(&orbit.to_vector());
        let dying = Dying {
            row: 0,
            start: d,
            rate: decay,
        };
        let end = decay::step(&start, dt, &[dying], |y| self.model.rate(y));
        *orbit = TargetOrbit::from_vector(&end.fixed_rows::<6>(6).into_owned());
        let mut out = Target::zeros();
        out.fixed_rows_mut::<6>(0).copy_from(&end.fixed_rows::<6>(0));
        out.fixed_rows_mut::<3>(6)
            .copy_from(&(d * Answer::after(dt, decay).left));
        out
    }
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
        if !is_slow(decay, dt) {
            return (self.step_dying(x, dt, orbit, decay), f);
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_dies_away_within_a_step_does_what_many_short_steps_of_it_do() {
        let earth = astro::earth::FILTER;
        let mut j2 = J2 {
            model: J2RelativeMotion {
                mu: earth.mu,
                r_ref: earth.r_ref,
                j2: earth.j[0],
            },
            circular: ClohessyWiltshire::from_semi_major_axis(7e6, earth.mu),
        };
        let (r, v) = (Vector3::new(7e6, 0.0, 0.0), Vector3::new(10.0, 5e3, 5.6e3));
        let before = TargetOrbit::from_state(&r, &v);
        let x = Target::from_column_slice(&[30.0, -50.0, 20.0, 0.1, 0.2, -0.3, 2e-4, -1e-4, 3e-4]);
        for decay in [0.1001, 2.0, 50.0] {
            let law = AccelerationModel::GaussMarkov(decay);
            let count = 2000;
            let (mut short, mut orbit) = (x, before);
            for _ in 0..count {
                short = j2.step(&short, 1.0 / f64::from(count), &mut orbit, law).0;
            }
            let mut once_orbit = before;
            let once = j2.step(&x, 1.0, &mut once_orbit, law).0;
            // What the frame's turn of 1e-3 rad/s makes of a velocity that rises within the step: 1e-3 of d / decay / 6.
            let difference = once - short;
            assert!(difference.amax() < 2e-9, "decay {decay}: {difference}");
            assert!(part(&difference, 6).amax() < 1e-16, "decay {decay}: {difference}");
            // The orbit does not know d.
            let mut undisturbed = before;
            j2.step(&x, 1.0, &mut undisturbed, AccelerationModel::RandomWalk);
            assert_eq!(once_orbit, undisturbed);
        }
    }
}
