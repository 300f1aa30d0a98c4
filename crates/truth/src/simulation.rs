//! One run of a world: time grid, inputs, samples.

use astro::frames::lidar_from_body;
use astro::{ClohessyWiltshire, Lvlh, TargetOrbit};
use interface::mission::{Frame, Mission};
use nalgebra::{SVector, Vector3, Vector6};
use numerics::{Generator, Source, stream};
use sensors::{accelerometer, metrology, normal3};
use serde::{Deserialize, Serialize};

use crate::disturbances::schedule;
use crate::disturbances::unmodelled::Unmodelled;
use crate::environment::Sky;
use crate::initial::{draw_estimate, draw_measurement};
use crate::inputs::Inputs;
use crate::overrides::Run;
use crate::sampling::{Scene, Sensors};
use crate::start::start;
use crate::untold::Untold;
use crate::world::World;
use crate::{Params, Push, Relative, SensorSample, Timeline, TruthError, Vehicles};

/// A time this close to a grid point counts as on it, s.
const SNAP: f64 = 1e-6;

/// Most grid intervals in one step: a typo in a step size should not hang the host.
const MAX_INTERVALS: f64 = 1e7;

/// The truth at a communication point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Communication point, s.
    pub time: f64,
    /// Both vehicles, axes N, SI.
    pub state: Vehicles,
    /// Acceleration of the target by vents, burns, input and what never stops just after the communication point, N, m/s2.
    pub a_t_n: Vector3<f64>,
    /// Whether a vent, or a burn or input that no filter is told of, pushes the target just after it.
    pub event_active: bool,
    /// Accelerometer bias, chaser body axes, m/s2.
    pub b_c_bc: Vector3<f64>,
    /// Motion in the axes of the target's orbit, in missions with metrology.
    pub relative: Option<Relative>,
}

/// What holds at a place in time.
struct Instant {
    sky: Sky,
    state: Vehicles,
    /// What acts just after it.
    push: Push,
    b_c_bc: Vector3<f64>,
}

/// A place in time: a grid interval and the seconds since its begin.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Place {
    interval: u64,
    offset: f64,
}

/// The accelerometer's bias: a walk that decays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Bias {
    now: Vector3<f64>,
    /// m/s2 per square root of a second.
    sigma: f64,
    time_constant: f64,
    walk: Generator,
}

impl Bias {
    fn new(run: &Run) -> Self {
        let sensor = run.mission.sensors.accelerometer;
        Self {
            now: sensor.map_or_else(Vector3::zeros, |s| s.bias0_m_s2.into()),
            sigma: sensor.map_or(0.0, |s| s.bias_sigma_m_s2),
            time_constant: sensor.map_or(1.0, |s| s.bias_time_constant_s),
            walk: stream(run.study_seed, run.run, Source::AccelerometerBias),
        }
    }

    fn step(&mut self, dt: f64) {
        let unit = normal3(&mut self.walk);
        self.now = accelerometer::bias_step(&self.now, dt, self.time_constant, self.sigma, &unit);
    }

    /// Where it will be, but for its walk.
    fn after(&self, dt: f64) -> Vector3<f64> {
        accelerometer::bias_step(&self.now, dt, self.time_constant, 0.0, &Vector3::zeros())
    }
}

/// Integral of the specific force in inertial axes since the accelerometer's last sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Felt {
    /// Epoch of the last sample, s since the start of the run.
    since: f64,
    /// How far the integral has come.
    until: f64,
    /// State at that time, where it lies within a grid interval.
    there: Option<Vehicles>,
    /// m/s.
    impulse: Vector3<f64>,
}

/// One run of a world. It is all state: a clone goes on exactly as the original does.
///
/// The world is integrated on a grid of fixed intervals counted from the start time. What the mission pushes the vehicles with is
/// constant over an interval. Inputs act from the communication point at which they were set for as long as they stay: a change
/// splits the interval there, so that no momentum is lost or added. Samples are taken in order as time passes them. So a run does
/// not depend on the communication points while its inputs do not change: one that is off the grid is answered by a trial step from
/// the last grid point or split, which is then forgotten and draws nothing at random.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    mission: String,
    notes: Vec<String>,
    world: World,
    /// What the true relative acceleration is told less of, in missions with metrology.
    reference: Option<ClohessyWiltshire>,
    start_time: f64,
    timeline: Timeline,
    /// Grid intervals completed; `bias` holds at their end.
    interval: u64,
    /// How far into the present interval the last change of the inputs lies, s; `sky` and `state` hold there.
    offset: f64,
    sky: Sky,
    state: Vehicles,
    bias: Bias,
    /// What acts over the present interval and never stops.
    unmodelled: Unmodelled,
    felt: Felt,
    untold: Untold,
    /// Inputs that act.
    inputs: Inputs,
    sensors: Sensors,
    sample: SensorSample,
    initial_estimate: SVector<f64, 18>,
    now: Moment,
}

impl Simulation {
    /// A run at its start time, before its first sample.
    ///
    /// * `start_time`: s; the mission's clock, on which its events stand, starts here.
    /// * `inputs`: as set at the start time; they show in [`Moment::a_t_n`] and in the initial estimate. Their `impulse_count` is
    ///   where counting begins, and no impulse.
    ///
    /// # Errors
    /// When the mission cannot be read, a parameter is out of range, or the start time or an input is not finite.
    pub fn new(params: &Params, start_time: f64, inputs: &Inputs) -> Result<Self, TruthError> {
        let run = params.run()?;
        if !start_time.is_finite() {
            return Err(TruthError::StartTime { start_time });
        }
        inputs.check(start_time)?;
        let world = World::new(&run.mission)?;
        let timeline = schedule(&run);
        let state = start(&run.mission, &world, &timeline)?;
        finite(&state, start_time)?;
        let sensors = Sensors::new(&run);
        let reference = reference(&run.mission, &world, &state, sensors.measure_in_lvlh());
        let bias = Bias::new(&run);
        let unmodelled = Unmodelled::new(&run, world.grid);
        let begin = Instant {
            sky: world.sky(0.0),
            state,
            push: inputs.add_to(unmodelled.add_to(world.push_over(&timeline, 0)), world.target_kg()),
            b_c_bc: bias.now,
        };
        let now = moment(&world, reference.as_ref(), start_time, &begin);
        let sigma = run.mission.initial_sigma();
        let initial_estimate = match &now.relative {
            Some(relative) if run.mission.navigation.frame == Frame::Lvlh => draw_measurement(&run, &sigma, relative),
            _ => draw_estimate(&run, &sigma, &state, &now.a_t_n, &bias.now),
        };
        let sample = SensorSample::before_the_first(&scene(&world, sensors.measure_in_lvlh(), &begin, None));
        Ok(Self {
            notes: run.mission.notes(),
            mission: run.mission.name,
            world,
            reference,
            start_time,
            timeline,
            interval: 0,
            offset: 0.0,
            sky: begin.sky,
            state,
            bias,
            unmodelled,
            felt: Felt::default(),
            untold: Untold::default(),
            inputs: *inputs,
            sensors,
            sample,
            initial_estimate,
            now,
        })
    }

    /// Goes on to the communication point `t`, s.
    ///
    /// * `inputs`: as set now; they act from the present communication point on.
    ///
    /// # Errors
    /// When an input makes no sense, `t` lies before the present or absurdly far ahead, or the motion leaves the numbers. The
    /// first three change nothing; after the last the run cannot go on.
    pub fn advance_to(&mut self, t: f64, inputs: &Inputs) -> Result<(), TruthError> {
        inputs.check(t)?;
        let t = self.checked_end(t)?;
        let end = self.locate(t - self.start_time);
        self.take_over(inputs);
        let mut sampled = None;
        loop {
            let elapsed = self.sensors.next();
            let place = self.locate(elapsed);
            // The tolerance is for samples off the grid; those on it are equal to their communication point.
            let due =
                place.interval < end.interval || (place.interval == end.interval && place.offset <= end.offset + SNAP);
            if !due {
                break;
            }
            self.complete_intervals(place.interval)?;
            let instant = self.instant(place.offset);
            self.take_sample(elapsed, place.offset, &instant);
            sampled = Some((place, instant));
        }
        self.complete_intervals(end.interval)?;
        let instant = match sampled {
            // The usual case: the communication point is that of a sample.
            Some((place, instant)) if place == end => instant,
            _ => self.instant(end.offset),
        };
        self.now = moment(&self.world, self.reference.as_ref(), t, &instant);
        finite(&self.now.state, t)
    }

    /// Whether [`advance_to`](Self::advance_to) goes as far as `t`, s, with these inputs.
    ///
    /// # Errors
    /// When an input makes no sense, or `t` lies before the present or absurdly far ahead.
    pub fn check(&self, t: f64, inputs: &Inputs) -> Result<(), TruthError> {
        inputs.check(t)?;
        self.checked_end(t).map(drop)
    }

    /// Name of the mission.
    pub fn mission(&self) -> &str {
        &self.mission
    }

    /// What a user should know of the mission.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The truth at the last communication point.
    pub fn now(&self) -> &Moment {
        &self.now
    }

    /// The newest sample.
    pub fn sample(&self) -> &SensorSample {
        &self.sample
    }

    /// Estimate drawn around the truth at the start time: r_tc, v_tc, a_t, r_c, v_c, b_c, SI.
    pub fn initial_estimate(&self) -> &SVector<f64, 18> {
        &self.initial_estimate
    }

    /// The events of this run.
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// The end of a step, moved up by rounding at most.
    fn checked_end(&self, t: f64) -> Result<f64, TruthError> {
        let now = self.now.time;
        if t.is_nan() || t < now - SNAP {
            return Err(TruthError::Backwards { now, asked: t });
        }
        let limit = MAX_INTERVALS * self.world.grid;
        if t - now > limit {
            return Err(TruthError::TooFar { now, asked: t, limit });
        }
        Ok(t.max(now))
    }

    /// Where `elapsed`, s since the start time, lies on the grid.
    fn locate(&self, elapsed: f64) -> Place {
        let grid = self.world.grid;
        let nearest = (elapsed / grid).round();
        if (elapsed - nearest * grid).abs() <= SNAP {
            return Place {
                interval: nearest as u64,
                offset: 0.0,
            };
        }
        let whole = (elapsed / grid).floor();
        Place {
            interval: whole as u64,
            offset: elapsed - whole * grid,
        }
    }

    /// Lets inputs act from the present communication point on.
    ///
    /// Where they push the vehicles otherwise than before, the motion up to here is kept and goes on from here. Where they do not,
    /// nothing is split, so that samples keep their bits.
    fn take_over(&mut self, inputs: &Inputs) {
        let fired = inputs.impulse_count != self.inputs.impulse_count;
        if fired || !inputs.push_as(&self.inputs) {
            let here = self.locate(self.now.time - self.start_time);
            self.go_to(here.offset);
        }
        if fired {
            self.state.v_c += inputs.impulse_c_n;
            if self.sensors.measure_the_mean() {
                self.felt.there = self.felt.there.map(|_| self.state);
                self.felt.impulse += self.world.axes.held_in_space(self.sky.t, &inputs.impulse_c_n);
            }
        }
        self.inputs = *inputs;
    }

    /// Integrates to the begin of `interval`.
    fn complete_intervals(&mut self, interval: u64) -> Result<(), TruthError> {
        let grid = self.world.grid;
        while self.interval < interval {
            let split = self.offset > 0.0;
            self.go_to(grid);
            self.felt.there = None;
            self.bias.step(grid);
            self.unmodelled.step();
            self.interval += 1;
            self.offset = 0.0;
            let begin = self.interval as f64 * grid;
            if split {
                // Parts of an interval do not add up to it exactly.
                self.sky = self.world.sky(begin);
            }
            finite(&self.state, self.start_time + begin)?;
        }
        Ok(())
    }

    /// Integrates to `offset` seconds into the present interval, or to its end, and stays there.
    fn go_to(&mut self, offset: f64) {
        let length = offset - self.offset;
        if length <= 0.0 {
            return;
        }
        let push = self.push();
        let begin = self.interval as f64 * self.world.grid + self.offset;
        let (felt_from, from) = (self.felt_from(), self.state);
        self.world.step(&mut self.sky, &mut self.state, &push, length);
        self.untold = (self.untold).after(&self.world, &push, begin, length, [&from, &self.state]);
        self.offset = offset;
        if let Some(from) = felt_from {
            let end = self.state;
            let until = if offset < self.world.grid {
                self.interval as f64 * self.world.grid + offset
            } else {
                (self.interval + 1) as f64 * self.world.grid
            };
            self.feel(&push, &from, until, &end);
            self.felt.there = Some(end);
        }
    }

    /// The world `offset` seconds into the present interval.
    fn instant(&self, offset: f64) -> Instant {
        let push = self.push();
        let (mut sky, mut state) = (self.sky, self.state);
        let length = offset - self.offset;
        if length > 0.0 {
            self.world.step(&mut sky, &mut state, &push, length);
        }
        Instant {
            sky,
            state,
            push,
            b_c_bc: if offset > 0.0 {
                self.bias.after(offset)
            } else {
                self.bias.now
            },
        }
    }

    /// Takes the next sample at an instant `offset` seconds into the present interval and `elapsed` after the start of the run.
    fn take_sample(&mut self, elapsed: f64, offset: f64, instant: &Instant) {
        // Another sensor's sample adds no point to the sum, so that readings do not know of it.
        let due = offset > 0.0 && self.sensors.accelerometer_due(elapsed);
        if let Some(begin) = self.felt_from().filter(|_| due) {
            self.feel(&instant.push, &begin, elapsed, &instant.state);
            self.felt.there = Some(instant.state);
        }
        let mean = self.mean_force(elapsed, instant);
        let scene = scene(&self.world, self.sensors.measure_in_lvlh(), instant, mean);
        let time = self.start_time + elapsed;
        self.sensors.sample(&mut self.sample, time, elapsed, &scene);
        let (length, path) = (offset - self.offset, [&self.state, &instant.state]);
        self.sample.untold = (self.untold).after(&self.world, &instant.push, elapsed - length, length, path);
    }

    /// State up to which the specific force has been summed, where the accelerometer measures its mean.
    fn felt_from(&self) -> Option<Vehicles> {
        let measured = self.sensors.measure_the_mean();
        measured.then(|| self.felt.there.unwrap_or(self.state))
    }

    /// What the accelerometer has felt since its last sample, in the mean and in body axes as they are now, if that is what it
    /// measures now: a strapdown unit turns what it felt earlier along with its axes.
    fn mean_force(&mut self, elapsed: f64, instant: &Instant) -> Option<Vector3<f64>> {
        if !(self.sensors.measure_the_mean() && self.sensors.accelerometer_due(elapsed)) {
            return None;
        }
        let mean = self.felt.impulse / (elapsed - self.felt.since);
        self.felt.since = elapsed;
        self.felt.impulse = Vector3::zeros();
        let mean_n = self.world.axes.held_in_n(elapsed, &mean);
        Some(self.world.dcm_bc_n(elapsed, &instant.state, &instant.push) * mean_n)
    }

    /// Goes on with the integral of the specific force to `until`, s since the start of the run and within the present interval
    /// or at its end.
    ///
    /// * `begin`, `end`: states where the integral stands and at `until`.
    ///
    /// Simpson's rule, with the state half way from the cubic through both ends: off by (turn on the way)^4 / 2880 of a force
    /// that is fixed in the body.
    fn feel(&mut self, push: &Push, begin: &Vehicles, until: f64, end: &Vehicles) {
        let from = self.felt.until;
        let length = until - from;
        if length <= 0.0 {
            return;
        }
        let felt = |t: f64, state: &Vehicles| self.world.specific_force(t, state, push);
        let half = felt(from + 0.5 * length, &begin.half_way(end, length));
        self.felt.impulse += (felt(from, begin) + half * 4.0 + felt(until, end)) * (length / 6.0);
        self.felt.until = until;
    }

    /// What acts over the present interval.
    fn push(&self) -> Push {
        let scheduled = self.world.push_over(&self.timeline, self.interval);
        self.inputs
            .add_to(self.unmodelled.add_to(scheduled), self.world.target_kg())
    }
}

/// The circular motion that the true relative acceleration is told less of.
fn reference(mission: &Mission, world: &World, state: &Vehicles, in_lvlh: bool) -> Option<ClohessyWiltshire> {
    let mu = world.environment.mu().filter(|_| in_lvlh)?;
    // Without elements, the osculating axis; on a hyperbola, its length.
    let osculating = || (2.0 / state.r_t.norm() - state.v_t.norm_squared() / mu).recip().abs();
    let a = mission.navigation().reference_orbit_a_m.unwrap_or_else(osculating);
    Some(ClohessyWiltshire::from_semi_major_axis(a, mu))
}

/// What the outputs show of an instant.
fn moment(world: &World, reference: Option<&ClohessyWiltshire>, time: f64, instant: &Instant) -> Moment {
    let Instant {
        sky,
        state,
        push,
        b_c_bc,
    } = instant;
    Moment {
        time,
        state: *state,
        a_t_n: world.push_on_target(sky.t, state, &push.target),
        event_active: push.unannounced,
        b_c_bc: *b_c_bc,
        relative: reference.map(|reference| Relative::new(world, sky, state, push, reference)),
    }
}

/// What the sensors meet at an instant.
fn scene(world: &World, in_lvlh: bool, instant: &Instant, mean_force_c_bc: Option<Vector3<f64>>) -> Scene {
    let Instant {
        sky,
        state,
        push,
        b_c_bc,
    } = instant;
    let dcm_bc_n = world.dcm_bc_n(sky.t, state, push);
    let mut target = sensors::Scene {
        r_tc_n: state.r_tc(),
        v_tc_n: state.v_tc(),
        dcm_l_n: lidar_from_body() * dcm_bc_n,
        lvlh: Vector6::repeat(f64::NAN),
    };
    let mut target_axes = None;
    if in_lvlh {
        let a_t_n = world.target_acceleration(sky, state, push);
        let lvlh = Lvlh::new(&state.r_t, &state.v_t, &a_t_n);
        let (rho, rho_dot) = lvlh.relative(&state.r_c, &state.v_c);
        target.lvlh = metrology::measure(&rho, &rho_dot);
        target_axes = Some(*lvlh.axes());
    }
    Scene {
        target,
        target_orbit: in_lvlh.then(|| TargetOrbit::from_state(&state.r_t, &state.v_t)),
        target_axes,
        force_c_n: world.force_on_chaser(sky, state, push),
        mean_force_c_bc,
        dcm_bc_n,
        b_c_bc: *b_c_bc,
    }
}

/// Refuses a state that is not finite, or so large that its norms are not.
fn finite(state: &Vehicles, t: f64) -> Result<(), TruthError> {
    if state.to_vector().norm_squared().is_finite() {
        Ok(())
    } else {
        Err(TruthError::StateNotFinite { t })
    }
}
