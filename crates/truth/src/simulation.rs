//! One run of a world: time grid, latched inputs, samples.

use astro::{Lvlh, TargetOrbit};
use nalgebra::{SVector, Vector3};
use numerics::{Generator, Source, stream};
use sensors::{accelerometer, metrology, normal3};
use serde::{Deserialize, Serialize};

use crate::initial::{draw_estimate, draw_measurement};
use crate::sampling::{Scene, Sensors, View};
use crate::world::step;
use crate::{Event, Instrument, Params, Push, Relative, SensorSample, Start, Timeline, TruthError, Vehicles, World};

/// A time this close to a grid point counts as on it, s.
const SNAP: f64 = 1e-6;

/// Most grid intervals in one step: a typo in a step size should not hang the host.
const MAX_INTERVALS: f64 = 1e7;

/// Accelerations from outside, m/s2, axes N.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// On the chaser; its accelerometer feels it.
    pub a_cmd_c_n: Vector3<f64>,
    /// On the target.
    pub a_dist_t_n: Vector3<f64>,
}

impl Inputs {
    fn push(&self) -> Push {
        Push {
            chaser_n: self.a_cmd_c_n,
            target_n: self.a_dist_t_n,
            ..Push::default()
        }
    }

    fn check(&self, t: f64) -> Result<(), TruthError> {
        for (name, vector) in [("a_cmd_c_n", &self.a_cmd_c_n), ("a_dist_t_n", &self.a_dist_t_n)] {
            for (axis, &value) in (1..).zip(vector) {
                if !value.is_finite() {
                    return Err(TruthError::Input { name, axis, value, t });
                }
            }
        }
        Ok(())
    }
}

/// The truth at a communication point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Communication point, s.
    pub time: f64,
    /// Both vehicles, axes N, SI.
    pub state: Vehicles,
    /// Acceleration of the target by vents, burns and input just after the communication point, N, m/s2.
    pub a_t_n: Vector3<f64>,
    /// Accelerometer bias, chaser body axes, m/s2.
    pub b_c_bc: Vector3<f64>,
    /// Motion in the axes of the target's orbit, in worlds with metrology.
    pub relative: Option<Relative>,
}

/// What holds at a place in time.
struct Instant {
    /// s since the start of the run.
    t: f64,
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

/// One run of a world. It is all state: a clone goes on exactly as the original does.
///
/// The world is integrated on a grid of fixed intervals counted from the start time. What pushes the vehicles is constant
/// over an interval; the inputs are latched when a communication step first enters one. Samples are taken in order as time
/// passes them. So a run does not depend on the communication points while its inputs do not change: one that is off the
/// grid is answered by a trial step from the last grid point, which is then forgotten and draws nothing at random.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    params: Params,
    start_time: f64,
    timeline: Timeline,
    /// Grid intervals completed; `state` and `bias` hold at their end.
    interval: u64,
    state: Vehicles,
    bias: Vector3<f64>,
    bias_walk: Generator,
    /// Inputs that act over the present interval, once it has been entered.
    latched: Option<Inputs>,
    sensors: Sensors,
    sample: SensorSample,
    initial_estimate: SVector<f64, 18>,
    now: Moment,
}

impl Simulation {
    /// A run at its start time, before its first sample.
    ///
    /// * `start_time`: s; the scenario's clock, on which its events stand, starts here.
    /// * `inputs`: as set at the start time; they only show in [`Moment::a_t_n`] and in the initial estimate.
    ///
    /// # Errors
    /// When a parameter is out of range, or the start time or an input is not finite.
    pub fn new(params: &Params, start_time: f64, inputs: &Inputs) -> Result<Self, TruthError> {
        params.check()?;
        if !start_time.is_finite() {
            return Err(TruthError::StartTime { start_time });
        }
        inputs.check(start_time)?;
        let world = params.scenario.entry().world;
        let Start { state, mut timeline } = world.start(params)?;
        if params.target_burn_duration > 0.0 {
            timeline.events.push(Event {
                start: params.target_burn_start,
                duration: params.target_burn_duration,
                push: Push {
                    target_n: params.target_burn_a_t_n,
                    ..Push::default()
                },
            });
        }
        let bias = Vector3::repeat(params.accelerometer_bias0);
        let begin = Instant {
            t: 0.0,
            state,
            push: push_over(&timeline, 0, params.scenario.entry().grid, inputs),
            b_c_bc: bias,
        };
        let now = moment(params, start_time, &begin);
        let sigma = world.initial_sigma(params);
        let initial_estimate = match &now.relative {
            None => draw_estimate(params, sigma, &state, &now.a_t_n, &bias),
            Some(relative) => draw_measurement(params, sigma, relative),
        };
        Ok(Self {
            params: *params,
            start_time,
            timeline,
            interval: 0,
            state,
            bias,
            bias_walk: stream(params.study_seed.into(), params.run.into(), Source::AccelerometerBias),
            latched: None,
            sensors: Sensors::new(params),
            sample: SensorSample::before_the_first(&scene(params, &begin)),
            initial_estimate,
            now,
        })
    }

    /// Goes on to the communication point `t`, s.
    ///
    /// * `inputs`: as set now; they act from the first grid interval that is entered here, and on no earlier one.
    ///
    /// # Errors
    /// When an input is not finite, `t` lies before the present or absurdly far ahead, or the motion leaves the numbers. The
    /// first three change nothing; after the last the run cannot go on.
    pub fn advance_to(&mut self, t: f64, inputs: &Inputs) -> Result<(), TruthError> {
        inputs.check(t)?;
        let t = self.checked_end(t)?;
        let end = self.locate(t - self.start_time);
        loop {
            let next = self.sample.count + 1;
            let elapsed = next as f64 * self.params.sample_period;
            let place = self.locate(elapsed);
            // The tolerance is for samples off the grid; those on it are equal to their communication point.
            let due =
                place.interval < end.interval || (place.interval == end.interval && place.offset <= end.offset + SNAP);
            if !due {
                break;
            }
            self.complete_intervals(place.interval, inputs)?;
            self.take_sample(self.start_time + elapsed, place.offset, inputs);
        }
        self.complete_intervals(end.interval, inputs)?;
        let instant = self.instant(end.offset, inputs);
        self.now = moment(&self.params, t, &instant);
        finite(&self.now.state, t)
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

    fn grid(&self) -> f64 {
        self.params.scenario.entry().grid
    }

    /// The end of a step, moved up by rounding at most.
    fn checked_end(&self, t: f64) -> Result<f64, TruthError> {
        let now = self.now.time;
        if t.is_nan() || t < now - SNAP {
            return Err(TruthError::Backwards { now, asked: t });
        }
        let limit = MAX_INTERVALS * self.grid();
        if t - now > limit {
            return Err(TruthError::TooFar { now, asked: t, limit });
        }
        Ok(t.max(now))
    }

    /// Where `elapsed`, s since the start time, lies on the grid.
    fn locate(&self, elapsed: f64) -> Place {
        let grid = self.grid();
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

    /// Integrates to the begin of `interval`.
    fn complete_intervals(&mut self, interval: u64, inputs: &Inputs) -> Result<(), TruthError> {
        let grid = self.grid();
        while self.interval < interval {
            let push = self.push(self.latched.as_ref().unwrap_or(inputs));
            let begin = self.interval as f64 * grid;
            self.state = step(world(&self.params), &self.params, begin, &self.state, &push, grid);
            let unit = normal3(&mut self.bias_walk);
            self.bias = self.bias_after(grid, self.params.accelerometer_bias_sigma, &unit);
            self.interval += 1;
            self.latched = None;
            finite(&self.state, self.start_time + begin + grid)?;
        }
        Ok(())
    }

    /// The world `offset` seconds into the present interval.
    fn instant(&mut self, offset: f64, inputs: &Inputs) -> Instant {
        let begin = self.interval as f64 * self.grid();
        if offset <= 0.0 {
            return Instant {
                t: begin,
                state: self.state,
                push: self.push(self.latched.as_ref().unwrap_or(inputs)),
                b_c_bc: self.bias,
            };
        }
        let latched = *self.latched.get_or_insert(*inputs);
        let push = self.push(&latched);
        Instant {
            t: begin + offset,
            state: step(world(&self.params), &self.params, begin, &self.state, &push, offset),
            push,
            b_c_bc: self.bias_after(offset, 0.0, &Vector3::zeros()),
        }
    }

    /// Takes the next sample, `offset` seconds into the present interval.
    fn take_sample(&mut self, time: f64, offset: f64, inputs: &Inputs) {
        let instant = self.instant(offset, inputs);
        let scene = scene(&self.params, &instant);
        self.sample = self.sensors.sample(&self.params, &self.sample, time, &scene);
    }

    /// What acts over the present interval, given the inputs that act.
    fn push(&self, inputs: &Inputs) -> Push {
        push_over(&self.timeline, self.interval, self.grid(), inputs)
    }

    fn bias_after(&self, dt: f64, sigma: f64, unit: &Vector3<f64>) -> Vector3<f64> {
        accelerometer::bias_step(
            &self.bias,
            dt,
            self.params.accelerometer_bias_time_constant,
            sigma,
            unit,
        )
    }
}

fn world(params: &Params) -> &'static dyn World {
    params.scenario.entry().world
}

/// What acts over a grid interval, given the inputs that act.
fn push_over(timeline: &Timeline, interval: u64, grid: f64, inputs: &Inputs) -> Push {
    timeline.push_around((interval as f64 + 0.5) * grid) + inputs.push()
}

/// What the outputs show of an instant.
fn moment(params: &Params, time: f64, instant: &Instant) -> Moment {
    let Instant { t, state, push, b_c_bc } = instant;
    let world = world(params);
    Moment {
        time,
        state: *state,
        a_t_n: world.push_on_target(state, push),
        b_c_bc: *b_c_bc,
        relative: match world.instrument() {
            Instrument::Lidar => None,
            Instrument::Metrology(reference) => Some(Relative::new(world, params, *t, state, push, &reference)),
        },
    }
}

/// What the sensors meet at an instant.
fn scene(params: &Params, instant: &Instant) -> Scene {
    let Instant { t, state, push, b_c_bc } = instant;
    let world = world(params);
    let surroundings = world.surroundings(params, *t, state);
    let view = match world.instrument() {
        Instrument::Lidar => View::Lidar { r_tc_n: state.r_tc() },
        Instrument::Metrology(_) => {
            let a_t_n = surroundings.target.sum() + world.push_on_target(state, push);
            let (rho, rho_dot) = Lvlh::new(&state.r_t, &state.v_t, &a_t_n).relative(&state.r_c, &state.v_c);
            View::Metrology {
                x_lvlh: metrology::measure(&rho, &rho_dot),
                target_orbit: TargetOrbit::from_state(&state.r_t, &state.v_t),
            }
        }
    };
    Scene {
        view,
        force_c_n: surroundings.chaser.surface + push.chaser_n,
        dcm_bc_n: world.dcm_bc_n(state),
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
