//! The physics of one mission: environment, vehicles and axes, made once for a run. It keeps no state of the motion.

use astro::frames;
use interface::mission::{self, Mission};
use nalgebra::{Matrix3, Rotation3, SVector, Vector3};
use numerics::rk4;
use serde::{Deserialize, Serialize};

use crate::attitude::{Attitude, Sight};
use crate::environment::{Environment, Surface, Surroundings};
use crate::timeline::{Push, Thrust, Timeline};
use crate::{TruthError, Vehicles};

/// Surroundings, vehicles and axes of a mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct World {
    pub(crate) environment: Environment,
    pub(crate) axes: Axes,
    target: Craft,
    chaser: Craft,
    /// Interval of the time grid, s.
    pub(crate) grid: f64,
}

/// A vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Craft {
    surface: Surface,
    attitude: Attitude,
}

impl Craft {
    fn of(vehicle: &mission::Vehicle) -> Self {
        Self {
            surface: Surface::of(vehicle),
            attitude: Attitude::of(vehicle.attitude),
        }
    }
}

/// Axes N: inertial ones, or those that turn with the two bodies of the three-body problem about z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) enum Axes {
    Inertial,
    Rotating {
        /// Inverse of the rate of turning, s.
        time: f64,
        /// Angle by which N has turned from the inertial axes at `end`, rad.
        angle_at_end: f64,
        /// s since the start of the run.
        end: f64,
        /// Place of the smaller body, m.
        secondary: Vector3<f64>,
    },
}

impl Axes {
    fn of(mission: &Mission) -> Self {
        match mission.environment.gravity.cr3bp() {
            None => Self::Inertial,
            Some(problem) => Self::Rotating {
                time: problem.time_s,
                angle_at_end: problem.inertial_angle_at_end_rad,
                end: mission.time.duration_s,
                secondary: astro::Cr3bp {
                    mass_ratio: problem.mass_ratio,
                }
                .secondary()
                    * problem.length_m,
            },
        }
    }

    /// Maps inertial axes to N at `t`, s since the start of the run.
    pub(crate) fn dcm_n_i(&self, t: f64) -> Matrix3<f64> {
        match self {
            Self::Inertial => Matrix3::identity(),
            Self::Rotating {
                time,
                angle_at_end,
                end,
                ..
            } => {
                let angle = angle_at_end + (t - end) / time;
                Rotation3::from_axis_angle(&Vector3::z_axis(), -angle).into_inner()
            }
        }
    }

    /// Velocity relative to inertial axes of something at `r` (any origin) that moves with `v` in N.
    pub(crate) fn inertial_velocity(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Inertial => *v,
            Self::Rotating { time, .. } => v + Vector3::z().cross(r) / *time,
        }
    }

    /// Velocity in N of something at `r` (any origin) whose inertial velocity is `v`; undoes [`Axes::inertial_velocity`].
    pub(crate) fn velocity_in_n(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Inertial => *v,
            Self::Rotating { time, .. } => v - Vector3::z().cross(r) / *time,
        }
    }

    /// Position and inertial velocity relative to the body that is orbited.
    pub(crate) fn about_body(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        match self {
            Self::Inertial => (*r, *v),
            Self::Rotating { secondary, .. } => {
                let r = r - secondary;
                (r, self.inertial_velocity(&r, v))
            }
        }
    }
}

impl World {
    /// The world of a mission.
    ///
    /// # Errors
    /// When a field of gravity cannot be read or a date makes no sense.
    pub(crate) fn new(mission: &Mission) -> Result<Self, TruthError> {
        Ok(Self {
            environment: Environment::of(mission)?,
            axes: Axes::of(mission),
            target: Craft::of(&mission.target),
            chaser: Craft::of(&mission.chaser),
            grid: mission.time.grid_s,
        })
    }

    /// What the surroundings do to the vehicles at `t`, s since the start of the run.
    pub(crate) fn surroundings(&self, t: f64, state: &Vehicles) -> Surroundings {
        self.environment
            .act(t, state, &self.target.surface, &self.chaser.surface)
    }

    /// Rate of change of the state: velocities and accelerations in the places of positions and velocities.
    ///
    /// * `t`: s since the start of the run.
    /// * `push`: what acts beside the surroundings.
    pub(crate) fn derivative(&self, t: f64, state: &Vehicles, push: &Push) -> Vehicles {
        let Surroundings { target, chaser } = self.surroundings(t, state);
        Vehicles {
            r_t: state.v_t,
            v_t: target.sum() + self.push_on_target(t, state, &push.target),
            r_c: state.v_c,
            v_c: chaser.sum() + self.push_on_chaser(t, state, &push.chaser),
        }
    }

    /// Acceleration of the target by `thrust`, axes N, m/s2.
    pub(crate) fn push_on_target(&self, t: f64, state: &Vehicles, thrust: &Thrust) -> Vector3<f64> {
        resolved(
            thrust,
            || self.dcm_bt_n(t, state),
            || self.about(&state.r_t, &state.v_t),
        )
    }

    /// Acceleration of the chaser by `thrust`, axes N, m/s2.
    pub(crate) fn push_on_chaser(&self, t: f64, state: &Vehicles, thrust: &Thrust) -> Vector3<f64> {
        resolved(
            thrust,
            || self.dcm_bc_n(t, state),
            || self.about(&state.r_c, &state.v_c),
        )
    }

    /// Attitude of the target: maps N to target body axes.
    pub(crate) fn dcm_bt_n(&self, t: f64, state: &Vehicles) -> Matrix3<f64> {
        let sight = self.sight(t, &state.r_t, &state.v_t, -state.r_tc(), -state.v_tc());
        self.target.attitude.dcm_b_n(&sight)
    }

    /// Attitude of the chaser: maps N to chaser body axes.
    pub(crate) fn dcm_bc_n(&self, t: f64, state: &Vehicles) -> Matrix3<f64> {
        let sight = self.sight(t, &state.r_c, &state.v_c, state.r_tc(), state.v_tc());
        self.chaser.attitude.dcm_b_n(&sight)
    }

    fn about(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        self.axes.about_body(r, v)
    }

    fn sight(&self, t: f64, r: &Vector3<f64>, v: &Vector3<f64>, r_other: Vector3<f64>, v_other: Vector3<f64>) -> Sight {
        let (r, v) = self.about(r, v);
        Sight {
            t,
            r,
            v,
            r_other,
            v_other,
            normal: r.cross(&v),
            dcm_n_i: self.axes.dcm_n_i(t),
        }
    }

    /// What the timeline does over a grid interval.
    pub(crate) fn push_over(&self, timeline: &Timeline, interval: u64) -> Push {
        let begin = interval as f64 * self.grid;
        timeline.push_over(begin, self.grid, |a| self.axes.dcm_n_i(begin + 0.5 * self.grid) * a)
    }

    /// State at the end of a step of length `h` (negative: backwards) that begins at `t`, s since the start of the run.
    pub(crate) fn step(&self, t: f64, state: &Vehicles, push: &Push, h: f64) -> Vehicles {
        let end = rk4::step(t, &state.to_vector(), h, |t, x| -> SVector<f64, 12> {
            self.derivative(t, &Vehicles::from_vector(x), push).to_vector()
        });
        Vehicles::from_vector(&end)
    }

    /// State at the start of the run that leads to `last` when nothing but `timeline` acts.
    ///
    /// * `last`: state at the end of grid interval `intervals - 1`.
    pub(crate) fn back_propagate(&self, timeline: &Timeline, last: &Vehicles, intervals: u64) -> Vehicles {
        (0..intervals).rev().fold(*last, |state, k| {
            let push = self.push_over(timeline, k);
            self.step((k + 1) as f64 * self.grid, &state, &push, -self.grid)
        })
    }
}

/// A thrust in axes N. Attitudes cost as much as gravity and are asked for only where they matter.
fn resolved(
    thrust: &Thrust,
    dcm_b_n: impl FnOnce() -> Matrix3<f64>,
    orbit: impl FnOnce() -> (Vector3<f64>, Vector3<f64>),
) -> Vector3<f64> {
    let mut a = thrust.n;
    if thrust.body != Vector3::zeros() {
        a += dcm_b_n().tr_mul(&thrust.body);
    }
    if thrust.rtn != Vector3::zeros() {
        let (r, v) = orbit();
        a += frames::rtn(&r, &v).tr_mul(&thrust.rtn);
    }
    a
}
