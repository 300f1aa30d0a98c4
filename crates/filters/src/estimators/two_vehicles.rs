//! A target seen from a chaser that knows itself roughly: 18 states, axes N (Mamich and Zanetti).

use super::accelerometer::{Accelerometer, Bias, Blur};
use super::estimator::{Estimator, Gap, Reported, defect, stand_in};
use super::sights::{self, InLvlh};
use super::told::{Manoeuvres, Place};
use crate::beliefs::Beliefs;
use crate::commands::Commands;
use crate::dynamics::{AccelerationModel, Drive, TwoVehicles, initial_covariance};
use crate::editing::wrapped;
use crate::error::FilterError;
use crate::gravity::Gravity;
use crate::innovation::Innovation;
use crate::laws::{Adaptation, Step};
use crate::layout::Layout;
use crate::sample::{NOT_A_ROTATION, Sample};
use crate::state::{MAX_ROWS, N, N_TARGET, RowVector, State, StateMatrix, TargetMatrix, idx};
use crate::units::Units;
use crate::update::kalman::{self, Gaussian, Measurement, NotSpd};
use astro::relative_axes::{AxesN, Reference};
use astro::{AstroError, Cr3bpSystem, frames};
use interface::mission::InitialSigma;
use interface::{Navigation, Sensor};
use nalgebra::{SMatrix, SVector, Vector3, Vector6};
use numerics::rotation;
use sensors::Scene;
use serde::{Deserialize, Serialize};

/// The filter's knowledge of both vehicles, internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct InertialState {
    units: Units,
    /// Set where axes N turn.
    rotating: Option<Cr3bpSystem>,
    dynamics: TwoVehicles,
    acceleration: AccelerationModel,
    layout: Layout,
    /// Noise variances of the sensors of the target.
    r: RowVector,
    /// SI size of their rows.
    si: RowVector,
    accelerometer: Option<Accelerometer>,
    told: Manoeuvres,
    initial_p: InitialSigma,
    /// Most passes of an update beyond the first.
    passes: u32,
    /// Mean and covariance; `None` until the first sample.
    core: Option<Gaussian>,
    /// The same before the last update; of no use after the next propagation.
    #[serde(skip)]
    before: Option<Gaussian>,
}

/// Most rows of an update: those of the target and three of the bias.
const MOST: usize = MAX_ROWS + 3;

/// Measurements of one epoch, one below the other.
struct Stack {
    h: SMatrix<f64, MOST, N>,
    innovation: SVector<f64, MOST>,
    r: SVector<f64, MOST>,
    /// Place of each row in the layout of the mission; of the target's rows alone.
    places: [usize; MAX_ROWS],
    target_rows: usize,
    rows: usize,
    /// Whether every prediction and its partials are finite.
    sound: bool,
}

impl Stack {
    fn new() -> Self {
        Self {
            h: SMatrix::zeros(),
            innovation: SVector::zeros(),
            r: SVector::zeros(),
            places: [0; MAX_ROWS],
            target_rows: 0,
            rows: 0,
            sound: true,
        }
    }

    fn push(&mut self, innovation: f64, r: f64) -> usize {
        let row = self.rows;
        self.innovation[row] = innovation;
        self.r[row] = r;
        self.rows += 1;
        row
    }
}

fn part(x: &State, slot: std::ops::Range<usize>) -> Vector3<f64> {
    x.fixed_rows::<3>(slot.start).into_owned()
}

/// [`update`] with as many rows as a stack has.
fn update_all(core: &mut Gaussian, stack: &Stack, step: &mut Step) -> Result<f64, NotSpd> {
    macro_rules! by_rows {
        ($($rows:literal)*) => {
            match stack.rows {
                $($rows => update::<$rows>(core, stack, step),)*
                _ => Ok(0.0),
            }
        };
    }
    by_rows!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24)
}

impl InertialState {
    /// * `ours`: as of [`crate::laws::FilterEntry`].
    ///
    /// # Errors
    /// When the mission tells of something that cannot be used, or a belief is out of range.
    pub(super) fn new(
        told: &Navigation,
        beliefs: &Beliefs,
        ours: bool,
        acceleration: AccelerationModel,
    ) -> Result<Self, FilterError> {
        let (units, layout) = (Units::of(&told.units), Layout::of(told));
        let rotating = told
            .gravity
            .cr3bp()
            .map(|p| Cr3bpSystem::new(p.mass_ratio, p.length_m, p.time_s));
        let (beta, bias_walk) = told
            .accelerometer
            .map_or((0.0, 0.0), |s| (1.0 / s.bias_time_constant_s, s.bias_sigma_m_s2));
        let noise_enters = beliefs.accelerometer_noise_enters;
        let noise_enters = Beliefs::switched("accelerometer.noise_enters", noise_enters, ours)?;
        Ok(Self {
            units,
            rotating: rotating.transpose()?,
            dynamics: TwoVehicles {
                gravity: Gravity::of(told)?,
                acceleration_decay: acceleration.decay(),
                beta: beta * units.time,
                q_c: told.chaser_q_c_m2_s3 / (units.velocity().powi(2) / units.time),
                q_coupled: beliefs.chaser_q_coupled,
                // A standard deviation per 1 s step, as a variance rate.
                q_bias: (bias_walk / units.acceleration()).powi(2) * units.time,
            },
            acceleration,
            layout,
            r: sights::noise(told),
            si: sights::si(&layout, &units),
            accelerometer: told
                .accelerometer
                .as_ref()
                .map(|known| Accelerometer::new(known, told, noise_enters, units)),
            told: Manoeuvres::of(told)?,
            initial_p: InitialSigma {
                position: told.p0.position / units.length,
                velocity: told.p0.velocity / units.velocity(),
                acceleration: told.p0.acceleration / units.acceleration(),
                bias: told.p0.bias / units.acceleration(),
            },
            passes: told.update_passes,
            core: None,
            before: None,
        })
    }

    /// Adds what one sensor measured to a stack.
    ///
    /// * `z`: SI.
    /// * `lvlh`: the relative state in LVLH axes, for a sensor that measures in them.
    fn add(&self, stack: &mut Stack, sensor: Sensor, z: &sensors::Rows, scene: &Scene, lvlh: Option<&InLvlh>) {
        let model = sensors::of(sensor);
        let (predicted, mut h) = (model.measure(scene), model.jacobian(scene));
        let mut by_target = None;
        if let Some(lvlh) = lvlh.filter(|_| model.in_lvlh()) {
            by_target = Some(h * lvlh.by_target);
            h *= lvlh.by_relative;
        }
        let places = self.layout.of_sensor(sensor).into_iter().flatten();
        for ((row, place), quantity) in places.enumerate().zip(sensor.quantities()) {
            let difference = wrapped(z[row] / self.si[place] - predicted[row], quantity);
            let at = stack.push(difference, self.r[place]);
            stack.places[at] = place;
            stack.h.fixed_view_mut::<1, 6>(at, 0).copy_from(&h.fixed_rows::<1>(row));
            // r_t = r_tc + r_c: the axes hang on both alike.
            for states in [idx::R_TC.start, idx::R_C.start] {
                if let Some(by_target) = &by_target {
                    let mut of_axes = stack.h.fixed_view_mut::<1, 6>(at, states);
                    of_axes += by_target.fixed_rows::<1>(row);
                }
            }
        }
        stack.target_rows = stack.rows;
        stack.sound &= h.iter().chain(&predicted).all(|v| v.is_finite());
    }

    /// What the sensors of the target say at the estimate `x`.
    fn seen(&self, x: &State, sample: &Sample) -> Result<Stack, FilterError> {
        let (r_tc, v_tc) = (part(x, idx::R_TC), part(x, idx::V_TC));
        let mut scene = Scene {
            r_tc_n: r_tc,
            v_tc_n: v_tc,
            dcm_l_n: frames::lidar_from_body() * sample.dcm_bc_n,
            lvlh: Vector6::repeat(f64::NAN),
        };
        let measured = Sensor::ALL.into_iter().filter_map(|sensor| {
            self.layout.of_sensor(sensor)?;
            Some((sensor, sample[sensor].seen()?))
        });
        let mut lvlh = None;
        let mut stack = Stack::new();
        for (sensor, z) in measured {
            if sensors::of(sensor).in_lvlh() && lvlh.is_none() {
                let in_lvlh = self.in_lvlh(x)?;
                scene.lvlh = in_lvlh.state;
                lvlh = Some(in_lvlh);
            }
            self.add(&mut stack, sensor, &z, &scene, lvlh.as_ref());
        }
        if stack.sound {
            return Ok(stack);
        }
        Err(FilterError::LineOfSightUndefined {
            t_s: sample.time,
            range_m: r_tc.norm() * self.units.length,
        })
    }

    /// What all sensors say at the estimate `x`: those of the target, and the accelerometer where it observes the bias.
    fn measured(&self, x: &State, sample: &Sample) -> Result<Stack, FilterError> {
        let mut stack = self.seen(x, sample)?;
        if let Some(accelerometer) = &self.accelerometer
            && let Some(alpha) = accelerometer.of_bias(sample)
        {
            // An identity under b_c (Eq. 11 prints extra zeros).
            for (axis, slot) in idx::B_C.enumerate() {
                let row = stack.push(alpha[axis] - x[slot], accelerometer.variance());
                stack.h[(row, slot)] = 1.0;
            }
        }
        Ok(stack)
    }

    /// Goes on from an update that moved the target too far for the slopes at the prior to hold: Gauss-Newton passes about the
    /// estimate that the last one found, each from the prior (the iterated Kalman filter).
    ///
    /// Slopes go with the inverse of the range: a move by less than a twentieth of it leaves them right to 5 %, and no pass follows.
    ///
    /// * returns: the estimate after the last pass; `None` where the first was enough.
    fn relinearised(&self, prior: &State, sample: &Sample, step: &Step) -> Result<Option<Gaussian>, FilterError> {
        let (Some(start), Some(first)) = (&self.before, &self.core) else {
            return Ok(None);
        };
        let (mut from, mut to, mut last) = (*prior, first.x, None);
        for _ in 0..self.passes {
            let (before, after) = (part(&from, idx::R_TC), part(&to, idx::R_TC));
            let near = before.norm().min(after.norm());
            // A distance that is no number is not large either.
            let far = (after - before).norm() > near / 20.0;
            if !far {
                break;
            }
            from = to;
            let mut stack = self.measured(&from, sample)?;
            // From where the prior is: z - h(x) - H (x_prior - x).
            stack.innovation += stack.h * (from - prior);
            let (mut again, mut unused) = (start.clone(), step.clone());
            update_all(&mut again, &stack, &mut unused).map_err(|e| e.at(sample.time))?;
            to = again.x;
            last = Some(again);
        }
        Ok(last)
    }

    /// The relative state in the LVLH axes of the estimated target.
    fn in_lvlh(&self, x: &State) -> Result<InLvlh, AstroError> {
        let six = |r: Vector3<f64>, v: Vector3<f64>| Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
        let (r_tc, v_tc) = (part(x, idx::R_TC), part(x, idx::V_TC));
        let target = six(r_tc + part(x, idx::R_C), v_tc + part(x, idx::V_C));
        let axes = |target: &Vector6<f64>| self.target_axes(target, &part(x, idx::A_T));
        InLvlh::new(&six(r_tc, v_tc), &target, &self.units, axes)
    }

    /// Axes of the target's orbit, for a target at this position with this velocity.
    fn target_axes(&self, target: &Vector6<f64>, a_t: &Vector3<f64>) -> Reference {
        let (r_t, v_t) = (
            target.fixed_rows::<3>(0).into_owned(),
            target.fixed_rows::<3>(3).into_owned(),
        );
        let a_t = self.dynamics.gravity.acceleration(&r_t, &v_t) + a_t;
        let axes_n = self
            .rotating
            .map_or(AxesN::Inertial, |system| AxesN::Rotating { system, angle: 0.0 });
        let units = &self.units;
        Reference::new(
            axes_n,
            &(r_t * units.length),
            &(v_t * units.velocity()),
            &(a_t * units.acceleration()),
        )
    }
}

/// Changes the chaser's velocity at once.
fn kick(x: &mut State, dv_c_n: &Vector3<f64>) {
    let mut v_c = x.fixed_rows_mut::<3>(idx::V_C.start);
    v_c += dv_c_n;
    let mut v_tc = x.fixed_rows_mut::<3>(idx::V_TC.start);
    v_tc -= dv_c_n;
}

/// Places of target and chaser, the velocities inertial.
///
/// * `rotating`: set where axes N turn.
fn places(x: &State, units: &Units, rotating: Option<&Cr3bpSystem>) -> (Place, Place) {
    let of = |r: Vector3<f64>, v: Vector3<f64>| {
        let (r_n, v_n) = (r * units.length, v * units.velocity());
        let (r_n, v_n) = rotating.map_or((r_n, v_n), |s| s.about_secondary(&r_n, &v_n));
        Place { r_n, v_n }
    };
    let (r_c, v_c) = (part(x, idx::R_C), part(x, idx::V_C));
    (of(part(x, idx::R_TC) + r_c, part(x, idx::V_TC) + v_c), of(r_c, v_c))
}

/// Lets the covariance grow by what is not known of the chaser's thrust; the relative states have its opposite.
fn blur(p: &mut StateMatrix, blur: &Blur) {
    let t = blur.interval;
    let mut add = |position: &Vector3<f64>, velocity: &Vector3<f64>| {
        let mut error = State::zeros();
        error.fixed_rows_mut::<3>(idx::R_C.start).copy_from(position);
        error.fixed_rows_mut::<3>(idx::V_C.start).copy_from(velocity);
        error.fixed_rows_mut::<3>(idx::R_TC.start).copy_from(&-position);
        error.fixed_rows_mut::<3>(idx::V_TC.start).copy_from(&-velocity);
        p.ger(1.0, &error, &error, 1.0);
    };
    add(&blur.position_n, &Vector3::zeros());
    add(&Vector3::zeros(), &blur.velocity_n);
    for axis in 0..3 {
        let mut a = Vector3::zeros();
        a[axis] = blur.acceleration;
        add(&(a * (t * t / 2.0)), &(a * t));
    }
}

/// The update with the first M rows of a stack, and what a law shall see of it.
fn update<const M: usize>(core: &mut Gaussian, stack: &Stack, step: &mut Step) -> Result<f64, NotSpd> {
    let m = Measurement::<M> {
        h: stack.h.fixed_rows::<M>(0).into_owned(),
        innovation: stack.innovation.fixed_rows::<M>(0).into_owned(),
        r: stack.r.fixed_rows::<M>(0).into_owned(),
    };
    let found = kalman::update(core, &m, idx::CONSIDER)?;
    if stack.target_rows == 0 {
        return Ok(0.0);
    }
    let places = &stack.places[..stack.target_rows];
    for (i, to_i) in places.iter().enumerate() {
        for (j, to_j) in places.iter().enumerate() {
            step.s[(*to_i, *to_j)] = found.s[(i, j)];
        }
    }
    let (nis, log_likelihood) = found.of_leading(&m.innovation, stack.target_rows);
    step.log_likelihood = log_likelihood;
    Ok(nis)
}

/// Every number of rows has its update: those of the sensors, and three of the accelerometer's bias. Whoever adds a sensor beyond
/// this makes the list in `update_all` longer.
const _: () = assert!(MOST <= 24);

impl Estimator for InertialState {
    fn check(&self, sample: &Sample) -> Result<(), FilterError> {
        let defect = rotation::defect(&sample.dcm_bc_n);
        if defect.is_nan() || defect > NOT_A_ROTATION {
            let t_s = sample.time;
            return Err(FilterError::NotARotation { t_s, defect });
        }
        Ok(())
    }

    fn check_start(&self, nav_init: &State, t_s: f64) -> Result<(), FilterError> {
        if nav_init.fixed_rows::<3>(idx::R_C.start).iter().all(|v| *v == 0.0) {
            return Err(FilterError::NoChaserPosition { t_s });
        }
        Ok(())
    }

    fn start(&mut self, nav_init: &State, t_s: f64) -> Result<(), FilterError> {
        self.check_start(nav_init, t_s)?;
        let mut core = Gaussian {
            x: State::from_fn(|i, _| nav_init[i] / self.units.of_state(i)),
            p: initial_covariance(&self.initial_p),
        };
        if self.acceleration == AccelerationModel::Absent {
            core.x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
            idx::A_T.for_each(|i| core.p[(i, i)] = 0.0);
        }
        self.core = Some(core);
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
        let Some(core) = &mut self.core else {
            return Ok(TargetMatrix::identity());
        };
        let mut total: Option<TargetMatrix> = None;
        let commands = Some(commands).filter(|told| !told.is_silent());
        let bias = Bias {
            mean: part(&core.x, idx::B_C),
            variance: idx::B_C.map(|slot| core.p[(slot, slot)]).fold(0.0, f64::max),
        };
        let driven = self
            .accelerometer
            .as_mut()
            .map(|accelerometer| accelerometer.over(gap, sample, &bias, commands))
            .unwrap_or_default();
        let mut drive = Drive {
            thrust: driven.thrust,
            told_t_n: law.announced(),
            ..Drive::default()
        };
        let mut t = gap.from_s - gap.start_s;
        let cuts = commands
            .into_iter()
            .flat_map(|told| told.edges(gap.from_s, gap.length_s));
        for length in self.told.steps(t, gap.length_s, gap.parts(), cuts) {
            let middle = t + length / 2.0;
            self.dynamics.gravity.turn_to(middle)?;
            let mut commanded_c_n = Vector3::zeros();
            if let Some(told) = commands {
                let begin_s = gap.start_s + t;
                let impulse = told.impulse(begin_s, begin_s + length) / self.units.velocity();
                kick(&mut core.x, &impulse);
                commanded_c_n = told.at(begin_s + length / 2.0) / self.units.acceleration();
            }
            drive.told_c_n = commanded_c_n;
            if !self.told.is_empty() {
                let (target, chaser) = places(&core.x, &self.units, self.rotating.as_ref());
                let dcm_n_bc = sample.dcm_bc_n.transpose();
                let (target, chaser) = self.told.at(middle, Some((&target, &chaser)), &dcm_n_bc);
                drive.told_t_n = law.announced() + target / self.units.acceleration();
                drive.told_c_n = commanded_c_n + chaser / self.units.acceleration();
            }
            let dt = length / self.units.time;
            let f = self
                .dynamics
                .predict(core, dt, &drive, law.disturbance(), &law.process_noise(dt));
            total = Some(total.map_or(f, |before| f * before));
            t += length;
        }
        if let Some(unknown) = &driven.blur {
            blur(&mut core.p, unknown);
        }
        Ok(total.unwrap_or_else(TargetMatrix::identity))
    }

    fn update(&mut self, sample: &Sample, step: &mut Step) -> Result<Option<Innovation>, FilterError> {
        let Some(prior) = self.core.as_ref().map(|core| core.x) else {
            return Ok(None);
        };
        if let Some(accelerometer) = &mut self.accelerometer {
            accelerometer.take(sample);
        }
        let stack = self.measured(&prior, sample)?;
        self.before.clone_from(&self.core);
        let Some(core) = &mut self.core else {
            return Ok(None);
        };
        step.p_prior.copy_from(&core.p.fixed_view::<9, 9>(0, 0));
        let nis = update_all(core, &stack, step).map_err(|e| e.at(sample.time))?;
        step.linear = (core.x - prior).fixed_rows::<9>(0).into_owned();
        if stack.target_rows > 0
            && let Some(again) = self.relinearised(&prior, sample, step)?
        {
            self.core = Some(again);
        }
        let Some(core) = &self.core else { return Ok(None) };
        for (row, place) in stack.places[..stack.target_rows].iter().enumerate() {
            step.measured.mark(*place..place + 1);
            step.innovation[*place] = stack.innovation[row];
            step.h
                .fixed_view_mut::<1, 9>(*place, 0)
                .copy_from(&stack.h.fixed_view::<1, 9>(row, 0));
        }
        step.correction = (core.x - prior).fixed_rows::<9>(0).into_owned();
        step.p_post.copy_from(&core.p.fixed_view::<9, 9>(0, 0));
        if stack.target_rows == 0 {
            return Ok(None);
        }
        let (residual, variance) = (
            step.innovation.component_mul(&self.si),
            step.s.diagonal().component_mul(&self.si).component_mul(&self.si),
        );
        Ok(Some(Innovation {
            residual: self.layout.to_channels(&residual),
            variance: self.layout.to_channels(&variance),
            nis,
            rows: stack.target_rows,
        }))
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

    fn reads_since(&self, start_s: f64) -> Option<f64> {
        self.accelerometer.as_ref()?.reads_since(start_s)
    }

    fn dimension(&self) -> usize {
        self.acceleration.states()
    }

    fn relative(&self) -> Vector6<f64> {
        let of = |core: &Gaussian| core.x.fixed_rows::<6>(0).into_owned();
        self.core.as_ref().map(of).unwrap_or_default()
    }

    fn report(&self, _sample: &Sample, law: &dyn Adaptation, since: Option<&TargetMatrix>) -> Reported {
        let unit = SVector::<f64, N>::from_fn(|i, _| self.units.of_state(i));
        let Some(core) = &self.core else {
            return Reported {
                x: State::zeros(),
                p_target: TargetMatrix::zeros(),
                sigma: State::zeros(),
            };
        };
        let mut x = core.x;
        if let Some(learnt) = law.disturbance() {
            x.fixed_rows_mut::<3>(idx::A_T.start).copy_from(&learnt.d);
        }
        let mut p: TargetMatrix = core.p.fixed_view::<9, 9>(0, 0).into_owned();
        stand_in(&mut p, law, since);
        let variance = |i: usize| if i < N_TARGET { p[(i, i)] } else { core.p[(i, i)] };
        Reported {
            x: x.component_mul(&unit),
            p_target: TargetMatrix::from_fn(|i, j| p[(i, j)] * (unit[i] * unit[j])),
            sigma: State::from_fn(|i, _| variance(i).sqrt() * unit[i]),
        }
    }

    fn defect(&self, t_s: f64) -> Option<FilterError> {
        let core = self.core.as_ref()?;
        defect(&core.x, &core.p, t_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// r_t = r_tc + r_c and v_t likewise carry nothing of what is not known of the chaser's thrust.
    #[test]
    fn an_unsure_thrust_leaves_the_target_alone() {
        let mut p = StateMatrix::zeros();
        let unknown = Blur {
            position_n: Vector3::new(0.3, -0.1, 0.2),
            velocity_n: Vector3::new(0.01, 0.03, -0.02),
            acceleration: 0.5,
            interval: 2.0,
        };
        blur(&mut p, &unknown);
        let mut to_target = SMatrix::<f64, 6, N>::zeros();
        to_target.fixed_view_mut::<6, 6>(0, 0).fill_with_identity();
        to_target.fixed_view_mut::<6, 6>(0, idx::R_C.start).fill_with_identity();
        assert!((to_target * p).amax() < 1e-15);
        // (a t)^2 and the square of what is added along x; with position a t^2 / 2 times a t.
        assert!((p[(idx::V_C.start, idx::V_C.start)] - 1.0001).abs() < 1e-12);
        assert!((p[(idx::R_C.start, idx::V_C.start)] - 1.0).abs() < 1e-12);
    }
}
