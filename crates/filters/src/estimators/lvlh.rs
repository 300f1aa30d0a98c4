//! A relative state measured in full in the target's LVLH frame: rho, rho_dot and d, nine states (Pesce, Silvestrini and
//! Lavagna).

use super::estimator::{Estimator, Gap, Reported, defect, stand_in};
use super::told::Manoeuvres;
use crate::commands::Commands;
use crate::dynamics::AccelerationModel;
use crate::dynamics::clohessy_wiltshire::Circular;
use crate::dynamics::j2::J2;
use crate::dynamics::relative::RelativeMotion;
use crate::error::FilterError;
use crate::gravity::Gravity;
use crate::innovation::Innovation;
use crate::laws::{Adaptation, Motion, Step};
use crate::layout::Layout;
use crate::sample::Sample;
use crate::state::{N_TARGET, Rows, State, Target, TargetMatrix, idx};
use crate::update::ConstantGain;
use crate::update::kalman::{self, Gaussian, Measurement};
use astro::{ClohessyWiltshire, J2RelativeMotion, LvlhAxes};
use interface::{Navigation, Sensor};
use nalgebra::{Matrix3, SMatrix, Vector3, Vector6};
use numerics::spd;
use serde::{Deserialize, Serialize};

/// The dynamics there are in this frame.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "a filter has one, in a box with all else")]
enum Relative {
    Circular(Circular),
    J2(J2),
}

impl Relative {
    fn get(&self) -> &dyn RelativeMotion {
        match self {
            Self::Circular(motion) => motion,
            Self::J2(motion) => motion,
        }
    }

    fn get_mut(&mut self) -> &mut dyn RelativeMotion {
        match self {
            Self::Circular(motion) => motion,
            Self::J2(motion) => motion,
        }
    }
}

/// The filter's knowledge of the relative state; SI.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct LvlhState {
    motion: Relative,
    told: Manoeuvres,
    acceleration: AccelerationModel,
    /// Set for a filter without a covariance.
    gain: Option<ConstantGain>,
    r: Vector6<f64>,
    initial_p: TargetMatrix,
    /// Mean and covariance of rho, rho_dot and d; `None` until the first sample.
    core: Option<Gaussian<N_TARGET>>,
    /// The same before the last update; of no use after the next propagation.
    #[serde(skip)]
    before: Option<Gaussian<N_TARGET>>,
}

impl LvlhState {
    /// # Errors
    /// When the mission has other sensors than a metrology, no reference orbit or no central body.
    pub(super) fn new(
        told: &Navigation,
        motion: Motion,
        gain: Option<ConstantGain>,
        acceleration: AccelerationModel,
    ) -> Result<Self, FilterError> {
        let unusable = |what: &str| FilterError::Unusable {
            mission: told.mission.clone(),
            what: what.into(),
        };
        if Layout::of(told) != Layout::new(&[Sensor::Metrology]) {
            return Err(unusable(
                "in the LVLH frame the target is seen by a metrology alone: other sensors need navigation.frame = \"inertial\"",
            ));
        }
        let zonal = Gravity::of(told)?
            .zonal()
            .ok_or_else(|| unusable("the LVLH frame needs one central body, which cr3bp is not"))?;
        let a = told
            .reference_orbit_a_m
            .ok_or_else(|| unusable("navigation.reference_orbit_a_m is missing: the LVLH frame needs it"))?;
        let circular = ClohessyWiltshire::from_semi_major_axis(a, zonal.mu);
        let p0 = [told.p0.position, told.p0.velocity, told.p0.acceleration];
        Ok(Self {
            motion: match motion {
                Motion::OfFrame => Relative::Circular(Circular::new(circular)),
                Motion::J2 => Relative::J2(J2 {
                    model: J2RelativeMotion {
                        mu: zonal.mu,
                        r_ref: zonal.r_ref,
                        j2: zonal.j[0],
                    },
                    circular,
                }),
            },
            told: Manoeuvres::of(told)?,
            acceleration,
            gain,
            r: super::sights::noise(told).fixed_rows::<6>(0).into_owned(),
            initial_p: TargetMatrix::from_diagonal(&Target::from_fn(|i, _| p0[i / 3].powi(2))),
            core: None,
            before: None,
        })
    }
}

/// Changes the chaser's velocity at once, by something in axes N.
fn kick(x: &mut Target, dv_c_n: &Vector3<f64>, axes: &LvlhAxes) {
    let mut rho_dot = x.fixed_rows_mut::<3>(3);
    rho_dot += axes.dcm_lvlh_n * dv_c_n;
}

impl Estimator for LvlhState {
    fn check(&self, sample: &Sample) -> Result<(), FilterError> {
        self.motion.get().check(&sample.target_orbit, sample.time)
    }

    fn start(&mut self, nav_init: &State, _t_s: f64) -> Result<(), FilterError> {
        let mut x: Target = nav_init.fixed_rows::<9>(0).into_owned();
        let mut p = self.initial_p;
        if self.acceleration == AccelerationModel::Absent {
            x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
            idx::A_T.for_each(|i| p[(i, i)] = 0.0);
        }
        if self.gain.is_some() {
            p.fill(0.0);
        }
        self.core = Some(Gaussian { x, p });
        Ok(())
    }

    fn started(&self) -> bool {
        self.core.is_some()
    }

    fn propagate(
        &mut self,
        gap: &Gap,
        sample: &Sample,
        law: &dyn Adaptation,
        commands: &Commands,
    ) -> Result<TargetMatrix, FilterError> {
        let mut total = TargetMatrix::identity();
        let Some(core) = &mut self.core else { return Ok(total) };
        let motion = self.motion.get_mut();
        let mut orbit = motion.orbit_before(&sample.target_orbit, gap.length_s, gap.parts());
        let mut t = gap.from_s - gap.start_s;
        // Nobody feels what the chaser does in this frame, so a command is all there is.
        let axes = sample.target_axes.filter(|_| !commands.is_silent());
        let cuts = axes.iter().flat_map(|_| commands.edges(gap.from_s, gap.length_s));
        for dt in self.told.steps(t, gap.length_s, gap.parts(), cuts) {
            let (begin_s, end_s) = (gap.start_s + t, gap.start_s + t + dt);
            // Half of what the acceleration gains at either end, in axes as they stand there.
            let half_n = axes.map(|_| commands.at(begin_s + dt / 2.0) * (dt / 2.0));
            if let (Some(axes), Some(half_n)) = (&axes, half_n) {
                let gained_n = commands.impulse(begin_s, end_s) + half_n;
                kick(&mut core.x, &gained_n, &axes.after(begin_s - sample.time));
            }
            let (x, mut f) = motion.step(&core.x, dt, &mut orbit, self.acceleration);
            core.x = x;
            if let (Some(axes), Some(half_n)) = (&axes, half_n) {
                kick(&mut core.x, &half_n, &axes.after(end_s - sample.time));
            }
            if !self.told.is_empty() {
                // Constant over the step; how the axes turn meanwhile, 1e-3 rad, is left out.
                let (target, chaser) = self.told.at(t + dt / 2.0, None, &Matrix3::identity());
                let a = chaser - target;
                let mut rho = core.x.fixed_rows_mut::<3>(0);
                rho += a * (dt * dt / 2.0);
                let mut rho_dot = core.x.fixed_rows_mut::<3>(3);
                rho_dot += a * dt;
            }
            if let Some(learnt) = law.disturbance() {
                learnt.act(&mut core.x, dt);
                let mut rows = f.fixed_view_mut::<3, 6>(3, 0);
                rows += learnt.by_x_over(dt);
            }
            if self.gain.is_none() {
                core.p = spd::carried(&f, &core.p).1 + law.process_noise(dt);
            }
            total = f * total;
            t += dt;
        }
        Ok(total)
    }

    fn update(&mut self, sample: &Sample, step: &mut Step) -> Result<Option<Innovation>, FilterError> {
        let Some(core) = &mut self.core else { return Ok(None) };
        step.p_prior = core.p;
        step.p_post = core.p;
        let Some(measured) = sample[Sensor::Metrology].seen() else {
            return Ok(None);
        };
        self.before = Some(core.clone());
        let prior = core.x;
        let residual = measured.fixed_rows::<6>(0) - core.x.fixed_rows::<6>(0);
        step.measured.mark(0..6);
        // The first six states themselves.
        step.h = Rows::from_fn(|i, j| f64::from(u8::from(i == j && i < 6)));
        step.innovation = residual.fixed_resize(0.0);
        let mut seen = Innovation {
            rows: 6,
            ..Innovation::default()
        };
        let channels = Layout::new(&[Sensor::Metrology]);
        seen.residual = channels.to_channels(&step.innovation);
        if let Some(gain) = self.gain {
            let mut observed = core.x.fixed_rows_mut::<6>(0);
            observed += gain.over(step.dt).component_mul(&residual);
        } else {
            let h = SMatrix::<f64, 6, N_TARGET>::identity();
            let m = Measurement {
                h,
                innovation: residual,
                r: self.r,
            };
            let found = kalman::update(core, &m, 0..0).map_err(|e| e.at(sample.time))?;
            (seen.nis, step.log_likelihood) = found.of_leading(&residual, 6);
            step.s.fixed_view_mut::<6, 6>(0, 0).copy_from(&found.s);
            seen.variance = channels.to_channels(&step.s.diagonal());
            step.p_post = core.p;
        }
        step.correction = core.x - prior;
        step.linear = step.correction;
        Ok(Some(seen))
    }

    fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.core = Some(before);
        }
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        if let Some(core) = &mut self.core {
            let mut mean = core.x.fixed_rows_mut::<6>(0);
            mean += by;
        }
    }

    fn dimension(&self) -> usize {
        if self.gain.is_some() {
            0
        } else {
            self.acceleration.states()
        }
    }

    fn knows_acceleration(&self) -> bool {
        matches!(self.motion, Relative::J2(_))
    }

    fn relative(&self) -> Vector6<f64> {
        let of = |core: &Gaussian<N_TARGET>| core.x.fixed_rows::<6>(0).into_owned();
        self.core.as_ref().map(of).unwrap_or_default()
    }

    fn report(&self, sample: &Sample, law: &dyn Adaptation, since: Option<&TargetMatrix>) -> Reported {
        let (mut x, mut p) = self
            .core
            .as_ref()
            .map_or_else(|| (Target::zeros(), TargetMatrix::zeros()), |core| (core.x, core.p));
        if let Some(learnt) = law.disturbance() {
            x.fixed_rows_mut::<3>(idx::A_T.start).copy_from(&learnt.d);
        }
        stand_in(&mut p, law, since);
        // What Clohessy-Wiltshire leaves out is what the better model has beyond it.
        let beyond = self.motion.get().beyond(&sample.target_orbit, &x);
        let mut d = x.fixed_rows_mut::<3>(idx::A_T.start);
        d += beyond;
        Reported {
            x: x.fixed_resize(0.0),
            p_target: p,
            sigma: p.diagonal().map(f64::sqrt).fixed_resize(0.0),
        }
    }

    fn defect(&self, t_s: f64) -> Option<FilterError> {
        let core = self.core.as_ref()?;
        defect(&core.x, &core.p, t_s)
    }
}
