//! A relative state measured in full in the target's LVLH frame: rho, rho_dot and d, nine states (Pesce, Silvestrini and
//! Lavagna).

use super::{Estimator, Reported, Updated, defect, sigma};
use crate::beliefs::Beliefs;
use crate::ekf::{self, Measurement};
use crate::error::FilterError;
use crate::gravity;
use crate::laws::{AccelerationModel, Adaptation, Law, RelativeModel};
use crate::navigator::Innovation;
use crate::sample::Sample;
use crate::scenarios::ScenarioEntry;
use crate::state::{N_TARGET, Rows, State, Target, TargetMatrix, idx};
use crate::tunable::Bound;
use astro::{ClohessyWiltshire, J2RelativeMotion, TargetOrbit};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};
use numerics::{expm, rk4, spd};
use serde::{Deserialize, Serialize};

/// The filter's knowledge of the relative state; SI.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct RelativeState {
    cw: ClohessyWiltshire,
    /// Set when the law asks for it in place of Clohessy-Wiltshire.
    j2: Option<J2RelativeMotion>,
    /// Transition matrix of Clohessy-Wiltshire over the last interval.
    transition: Option<(f64, TargetMatrix)>,
    acceleration: AccelerationModel,
    r: Vector6<f64>,
    initial_p: TargetMatrix,
    /// Mean and covariance of rho, rho_dot and d; `None` until the first sample.
    core: Option<ekf::Gaussian<N_TARGET>>,
}

/// Metrology variances, SI.
pub(super) fn noise(b: &Beliefs) -> Result<Vector6<f64>, FilterError> {
    let position = Bound::Positive.check("r.sigma_position", b.r_sigma_position, "m")?;
    let velocity = Bound::Positive.check("r.sigma_velocity", b.r_sigma_velocity, "m/s")?;
    Ok(sensors::metrology::covariance(position, velocity).diagonal())
}

impl RelativeState {
    pub(super) fn new(scenario: &ScenarioEntry, b: &Beliefs, law: &Law) -> Result<Self, FilterError> {
        let zonal = gravity::zonal(b)?;
        let name = "reference_orbit.semi_major_axis";
        let a = Bound::Positive.check(name, b.reference_orbit_semi_major_axis, "m")?;
        let cw = ClohessyWiltshire::from_semi_major_axis(a, zonal.mu);
        let j2 = J2RelativeMotion {
            mu: zonal.mu,
            r_ref: zonal.r_ref,
            j2: zonal.j[0],
        };
        let p0 = [
            sigma(scenario, "p0.sigma_position", b.p0_sigma_position, "m")?,
            sigma(scenario, "p0.sigma_velocity", b.p0_sigma_velocity, "m/s")?,
            sigma(scenario, "p0.sigma_acceleration", b.p0_sigma_acceleration, "m/s2")?,
        ];
        Ok(Self {
            cw,
            j2: (law.relative_model() == RelativeModel::J2).then_some(j2),
            transition: None,
            acceleration: law.acceleration(),
            r: noise(b)?,
            initial_p: TargetMatrix::from_diagonal(&Target::from_fn(|i, _| p0[i / 3].powi(2))),
            core: None,
        })
    }

    /// Transition of the nine states for partials of the relative acceleration, over `dt`.
    fn transition_of(&self, partials: &(Matrix3<f64>, Matrix3<f64>), dt: f64) -> TargetMatrix {
        let mut a = TargetMatrix::zeros();
        a.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        a.fixed_view_mut::<3, 3>(3, 0).copy_from(&partials.0);
        a.fixed_view_mut::<3, 3>(3, 3).copy_from(&partials.1);
        if self.acceleration != AccelerationModel::Absent {
            a.fixed_view_mut::<3, 3>(3, 6).fill_with_identity();
            a.fixed_view_mut::<3, 3>(6, 6).fill_diagonal(-self.acceleration.decay());
        }
        expm(&(a * dt))
    }

    /// Mean after `dt` and the transition matrix, without what a law adds.
    ///
    /// * `orbit`: the target's at the begin of the step; at its end afterwards. Read by the nonlinear model only.
    fn step(&mut self, x: &Target, dt: f64, orbit: &mut TargetOrbit) -> (Target, TargetMatrix) {
        let Some(j2) = self.j2 else {
            let known = self.transition.filter(|(of, _)| of.to_bits() == dt.to_bits());
            let f = known.map_or_else(|| self.transition_of(&self.cw.partials(), dt), |(_, f)| f);
            self.transition = Some((dt, f));
            return (f * x, f);
        };
        let f = self.transition_of(&j2.partials(orbit, &part(x, 0)), dt);
        let mut together = SVector::<f64, 15>::zeros();
        together.fixed_rows_mut::<9>(0).copy_from(x);
        together.fixed_rows_mut::<6>(9).copy_from(&orbit.to_vector());
        let decay = self.acceleration.decay();
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

    /// The target's orbit `gap_s` before a sample; the sample's own when nobody reads it.
    fn orbit_before(&self, sample: &Sample, gap_s: f64, parts: u32) -> TargetOrbit {
        let Some(j2) = &self.j2 else {
            return sample.target_orbit;
        };
        let dt = -gap_s / f64::from(parts);
        (0..parts).fold(sample.target_orbit, |orbit, _| {
            let x = rk4::step(0.0, &orbit.to_vector(), dt, |_, x| {
                j2.orbit_rate(&TargetOrbit::from_vector(x))
            });
            TargetOrbit::from_vector(&x)
        })
    }
}

fn part(x: &Target, first: usize) -> Vector3<f64> {
    x.fixed_rows::<3>(first).into_owned()
}

/// Rows of the metrology: the first six states themselves.
fn rows() -> Rows {
    Rows::from_fn(|i, j| f64::from(u8::from(i == j)))
}

impl Estimator for RelativeState {
    fn check(&self, sample: &Sample) -> Result<(), FilterError> {
        let orbit = &sample.target_orbit;
        let sound = orbit.r > 0.0 && orbit.h > 0.0 && orbit.to_vector().iter().all(|v| v.is_finite());
        if self.j2.is_none() || sound {
            return Ok(());
        }
        Err(FilterError::NoTargetOrbit {
            t_s: sample.time,
            r: orbit.r,
            h: orbit.h,
        })
    }

    fn start(&mut self, nav_init: &State, law: &Law, _t_s: f64) -> Result<(), FilterError> {
        let mut x: Target = nav_init.fixed_rows::<9>(0).into_owned();
        let mut p = self.initial_p;
        if self.acceleration == AccelerationModel::Absent {
            x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
            idx::A_T.for_each(|i| p[(i, i)] = 0.0);
        }
        if law.gain(1.0).is_some() {
            p.fill(0.0);
        }
        self.core = Some(ekf::Gaussian { x, p });
        Ok(())
    }

    fn started(&self) -> bool {
        self.core.is_some()
    }

    fn propagate(&mut self, gap_s: f64, parts: u32, sample: &Sample, law: &Law) -> TargetMatrix {
        let dt = gap_s / f64::from(parts);
        let mut orbit = self.orbit_before(sample, gap_s, parts);
        let mut total = TargetMatrix::identity();
        let Some(mut core) = self.core.take() else { return total };
        for _ in 0..parts {
            let (x, mut f) = self.step(&core.x, dt, &mut orbit);
            core.x = x;
            if let Some(learnt) = law.disturbance() {
                learnt.act(&mut core.x, &mut f, dt);
            }
            if law.gain(dt).is_none() {
                core.p = spd::symmetrised(&(f * core.p * f.transpose())) + law.process_noise(dt);
            }
            total = f * total;
        }
        self.core = Some(core);
        total
    }

    fn update(&mut self, sample: &Sample, dt: f64, law: &Law) -> Result<Updated, FilterError> {
        let mut updated = Updated {
            h: Rows::zeros(),
            innovation: Vector6::zeros(),
            correction: Target::zeros(),
            seen: None,
        };
        let (Some(core), Some(measured)) = (&mut self.core, sample.metrology) else {
            return Ok(updated);
        };
        let prior = core.x;
        updated.h = rows();
        updated.innovation = measured - core.x.fixed_rows::<6>(0);
        if let Some(gain) = law.gain(dt) {
            let mut observed = core.x.fixed_rows_mut::<6>(0);
            observed += gain.component_mul(&updated.innovation);
            updated.seen = Some(Innovation {
                residual: updated.innovation,
                ..Innovation::default()
            });
        } else {
            let m = Measurement {
                h: updated.h,
                innovation: updated.innovation,
                r: self.r,
            };
            let found = ekf::update(core, &m, 0..0).map_err(|e| e.at(sample.time))?;
            updated.seen = Some(Innovation {
                residual: updated.innovation,
                variance: found.s.diagonal(),
                nis: found.normalised(&updated.innovation),
            });
        }
        updated.correction = core.x - prior;
        Ok(updated)
    }

    fn relative(&self) -> Vector6<f64> {
        let of = |core: &ekf::Gaussian<N_TARGET>| core.x.fixed_rows::<6>(0).into_owned();
        self.core.as_ref().map(of).unwrap_or_default()
    }

    fn report(&self, sample: &Sample, law: &Law) -> Reported {
        let (mut x, p) = self
            .core
            .as_ref()
            .map_or_else(|| (Target::zeros(), TargetMatrix::zeros()), |core| (core.x, core.p));
        if let Some(learnt) = law.disturbance() {
            x.fixed_rows_mut::<3>(idx::A_T.start).copy_from(&learnt.d);
        }
        // What Clohessy-Wiltshire leaves out is what the better model has beyond it.
        if let Some(j2) = &self.j2 {
            let (rho, rho_dot) = (part(&x, 0), part(&x, 3));
            let beyond = j2.acceleration(&sample.target_orbit, &rho, &rho_dot) - self.cw.acceleration(&rho, &rho_dot);
            let mut d = x.fixed_rows_mut::<3>(idx::A_T.start);
            d += beyond;
        }
        Reported {
            x: x.fixed_resize(0.0),
            p_target: p,
            sigma: p.diagonal().map(f64::sqrt).fixed_resize(0.0),
        }
    }

    fn defect(&self, t_s: f64) -> Option<FilterError> {
        let core = self.core.as_ref()?;
        defect(core.x.iter(), core.p.iter(), core.p.diagonal().iter().copied(), t_s)
    }
}
