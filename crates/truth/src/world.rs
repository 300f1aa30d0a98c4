//! The physics of one mission: environment, vehicles and axes, made once for a run. It keeps no state of the motion.

use astro::frames;
use interface::mission::{self, Mission};
use nalgebra::{Matrix3, Vector3};
use numerics::rk4::{Stage, step_in_stages};
use serde::{Deserialize, Serialize};

use crate::attitude::{Attitude, Sight};
use crate::axes::Axes;
use crate::environment::{Environment, Place, Sky, Surface};
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
    mass_kg: f64,
    surface: Surface,
    attitude: Attitude,
}

impl Craft {
    fn of(vehicle: &mission::Vehicle) -> Self {
        Self {
            mass_kg: vehicle.mass_kg,
            surface: Surface::of(vehicle),
            attitude: Attitude::of(vehicle.attitude),
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
            axes: Axes::of(mission)?,
            target: Craft::of(&mission.target),
            chaser: Craft::of(&mission.chaser),
            grid: mission.time.grid_s,
        })
    }

    /// Mass of the target, kg.
    pub(crate) fn target_kg(&self) -> f64 {
        self.target.mass_kg
    }

    /// What depends on time alone at `t`, s since the start of the run.
    pub(crate) fn sky(&self, t: f64) -> Sky {
        self.environment.sky(t)
    }

    /// Rate of change of the state: velocities and accelerations in the places of positions and velocities.
    ///
    /// * `push`: what acts beside the surroundings.
    #[inline]
    pub(crate) fn derivative(&self, sky: &Sky, state: &Vehicles, push: &Push) -> Vehicles {
        let target = Place {
            r: &state.r_t,
            v: &state.v_t,
            surface: &self.target.surface,
        };
        let [a_t, a_c] = (self.environment).accelerations(sky, &[target, self.chaser_place(state)]);
        Vehicles {
            r_t: state.v_t,
            v_t: a_t + self.push_on_target(sky.t, state, &push.target),
            r_c: state.v_c,
            v_c: a_c + self.push_on_chaser(sky.t, state, push),
        }
    }

    /// Acceleration of the target by everything, axes N, m/s2.
    #[inline]
    pub(crate) fn target_acceleration(&self, sky: &Sky, state: &Vehicles, push: &Push) -> Vector3<f64> {
        self.free_target(sky, &state.r_t, &state.v_t) + self.push_on_target(sky.t, state, &push.target)
    }

    /// Acceleration of a target in this state by its surroundings, axes N, m/s2.
    #[inline]
    pub(crate) fn free_target(&self, sky: &Sky, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        let surface = &self.target.surface;
        self.environment.acceleration(sky, &Place { r, v, surface })
    }

    /// Acceleration of the chaser beside gravity, which its accelerometer feels, axes N, m/s2.
    pub(crate) fn force_on_chaser(&self, sky: &Sky, state: &Vehicles, push: &Push) -> Vector3<f64> {
        self.environment.push(sky, &self.chaser_place(state)) + self.push_on_chaser(sky.t, state, push)
    }

    /// The same in axes that are fixed in space.
    ///
    /// * `t`: s since the start of the run.
    pub(crate) fn specific_force(&self, t: f64, state: &Vehicles, push: &Push) -> Vector3<f64> {
        let force = self.force_on_chaser(&self.sky(t), state, push);
        self.axes.held_in_space(t, &force)
    }

    fn chaser_place<'a>(&'a self, state: &'a Vehicles) -> Place<'a> {
        Place {
            r: &state.r_c,
            v: &state.v_c,
            surface: &self.chaser.surface,
        }
    }

    /// Acceleration of the target by `thrust`, axes N, m/s2.
    ///
    /// * `t`: s since the start of the run.
    #[inline]
    pub(crate) fn push_on_target(&self, t: f64, state: &Vehicles, thrust: &Thrust) -> Vector3<f64> {
        match &thrust.turning {
            None => thrust.n,
            Some(turning) => {
                let rtn = || self.dcm_rtn_n(&state.r_t, &state.v_t);
                thrust.n + turning.resolved(|| self.dcm_bt_n(t, state), rtn)
            }
        }
    }

    /// Acceleration of the target that no filter is told of, axes N, m/s2.
    ///
    /// * `t`: s since the start of the run.
    pub(crate) fn untold_on_target(&self, t: f64, state: &Vehicles, push: &Push) -> Vector3<f64> {
        self.push_on_target(t, state, &push.target) - self.push_on_target(t, state, &push.announced)
    }

    /// Acceleration of the chaser by what pushes it, axes N, m/s2.
    ///
    /// * `t`: s since the start of the run.
    #[inline]
    pub(crate) fn push_on_chaser(&self, t: f64, state: &Vehicles, push: &Push) -> Vector3<f64> {
        let thrust = &push.chaser;
        match &thrust.turning {
            None => thrust.n,
            Some(turning) => {
                let rtn = || self.dcm_rtn_n(&state.r_c, &state.v_c);
                thrust.n + turning.resolved(|| self.dcm_bc_n(t, state, push), rtn)
            }
        }
    }

    /// Attitude of the target: maps N to target body axes.
    ///
    /// * `t`: s since the start of the run.
    pub(crate) fn dcm_bt_n(&self, t: f64, state: &Vehicles) -> Matrix3<f64> {
        self.target.attitude.dcm_b_n(&Sight {
            t,
            axes: &self.axes,
            r: &state.r_t,
            v: &state.v_t,
            r_other: -state.r_tc(),
            v_other: -state.v_tc(),
        })
    }

    /// Attitude of the chaser: maps N to chaser body axes; as commanded, or as the mission has it.
    ///
    /// * `t`: s since the start of the run.
    pub(crate) fn dcm_bc_n(&self, t: f64, state: &Vehicles, push: &Push) -> Matrix3<f64> {
        if let Some(commanded) = push.dcm_cmd_bc_n {
            return commanded;
        }
        self.chaser.attitude.dcm_b_n(&Sight {
            t,
            axes: &self.axes,
            r: &state.r_c,
            v: &state.v_c,
            r_other: state.r_tc(),
            v_other: state.v_tc(),
        })
    }

    /// Maps N to radial, transverse, normal of an orbit.
    fn dcm_rtn_n(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Matrix3<f64> {
        let (r, v) = self.axes.about_body(r, v);
        frames::rtn(&r, &v)
    }

    /// What the timeline does over a grid interval.
    pub(crate) fn push_over(&self, timeline: &Timeline, interval: u64) -> Push {
        let begin = interval as f64 * self.grid;
        let middle = begin + 0.5 * self.grid;
        timeline.push_over(begin, self.grid, |a| self.axes.held_in_n(middle, a))
    }

    /// Goes on by a step of length `h`, s; negative: backwards.
    ///
    /// * `sky`, `state`: at its begin, and then at its end.
    pub(crate) fn step(&self, sky: &mut Sky, state: &mut Vehicles, push: &Push, h: f64) {
        let (middle, end) = (self.sky(sky.t + 0.5 * h), self.sky(sky.t + h));
        let x = step_in_stages(&state.to_vector(), h, |stage, x| {
            let sky = match stage {
                Stage::Begin => &*sky,
                Stage::Middle => &middle,
                Stage::End => &end,
            };
            self.derivative(sky, &Vehicles::from_vector(x), push).to_vector()
        });
        (*sky, *state) = (end, Vehicles::from_vector(&x));
    }

    /// State at the start of the run that leads to `last` when nothing but `timeline` acts.
    ///
    /// * `last`: state at the end of grid interval `intervals - 1`.
    pub(crate) fn back_propagate(&self, timeline: &Timeline, last: &Vehicles, intervals: u64) -> Vehicles {
        let (mut sky, mut state) = (self.sky(intervals as f64 * self.grid), *last);
        for k in (0..intervals).rev() {
            let push = self.push_over(timeline, k);
            self.step(&mut sky, &mut state, &push, -self.grid);
        }
        state
    }
}

#[cfg(test)]
mod tests;
