//! What a world decides, and the list of worlds.

use astro::{ClohessyWiltshire, frames};
use nalgebra::{Matrix3, SVector, Vector3};
use numerics::rk4;
use serde::{Deserialize, Serialize};

use crate::initial::InitialSigma;
use crate::{Params, Push, Timeline, TruthError, Vehicles, worlds};

/// Every world, in the order of the FMU's `scenario` enumeration. To add one: a file under `worlds/` and a line here.
pub const WORLDS: &[WorldEntry] = &[
    worlds::leo_venting::ENTRY,
    worlds::nrho_venting::ENTRY,
    worlds::formation::ENTRY,
];

/// One line of [`WORLDS`].
#[derive(Clone, Copy)]
pub struct WorldEntry {
    /// Name in the `scenario` enumeration.
    pub name: &'static str,
    /// What it simulates, one line.
    pub about: &'static str,
    /// Nominal length of a run, s; the world goes on after it, without further events.
    pub duration: f64,
    /// Interval of the time grid, s.
    pub grid: f64,
    /// Its physics.
    pub world: &'static dyn World,
}

/// The physics of one world. It keeps no state: the simulation owns the run.
pub trait World: Sync {
    /// Events of the run and the state at its start.
    ///
    /// # Errors
    /// When the world's orbit cannot be computed.
    fn start(&self, params: &Params) -> Result<Start, TruthError>;

    /// What the surroundings do to the vehicles.
    ///
    /// * `t`: s since the start of the run.
    fn surroundings(&self, params: &Params, t: f64, state: &Vehicles) -> Surroundings;

    /// Normal of a vehicle's orbit, axes N, any length.
    fn orbit_normal(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64>;

    /// Rate of change of the state.
    ///
    /// * `t`: s since the start of the run.
    /// * `push`: what acts beside the surroundings.
    /// * returns: velocities and accelerations in the places of positions and velocities.
    fn derivative(&self, params: &Params, t: f64, state: &Vehicles, push: &Push) -> Vehicles {
        let Surroundings { target, chaser } = self.surroundings(params, t, state);
        Vehicles {
            r_t: state.v_t,
            v_t: target.sum() + self.push_on_target(state, push),
            r_c: state.v_c,
            v_c: chaser.sum() + push.chaser_n,
        }
    }

    /// Acceleration of the target by `push`, axes N, m/s2.
    fn push_on_target(&self, state: &Vehicles, push: &Push) -> Vector3<f64> {
        // The attitude costs as much as gravity and matters only to vents.
        if push.target_bt == Vector3::zeros() {
            return push.target_n;
        }
        push.target_n + self.dcm_bt_n(state).tr_mul(&push.target_bt)
    }

    /// Attitude of the target, which looks at the chaser: `dcm_bt_n`, maps N to target body axes.
    fn dcm_bt_n(&self, state: &Vehicles) -> Matrix3<f64> {
        frames::los_body_axes(
            &-state.r_tc(),
            &-state.v_tc(),
            &self.orbit_normal(&state.r_t, &state.v_t),
        )
    }

    /// Attitude of the chaser, which looks at the target: `dcm_bc_n`, maps N to chaser body axes.
    fn dcm_bc_n(&self, state: &Vehicles) -> Matrix3<f64> {
        frames::los_body_axes(&state.r_tc(), &state.v_tc(), &self.orbit_normal(&state.r_c, &state.v_c))
    }

    /// With what the chaser measures where the target is.
    fn instrument(&self) -> Instrument {
        Instrument::Lidar
    }

    /// Standard deviations of the initial estimate where the parameters leave them to the scenario.
    fn initial_sigma(&self, params: &Params) -> InitialSigma;
}

/// Accelerations of both vehicles by their surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// Of the target.
    pub target: Ambient,
    /// Of the chaser.
    pub chaser: Ambient,
}

impl Surroundings {
    /// A field of gravity, a function of position and velocity (axes N, m and m/s), and nothing else.
    pub fn field(state: &Vehicles, gravity: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Vector3<f64>) -> Self {
        let of = |r, v| Ambient {
            gravity: gravity(r, v),
            surface: Vector3::zeros(),
        };
        Self {
            target: of(&state.r_t, &state.v_t),
            chaser: of(&state.r_c, &state.v_c),
        }
    }
}

/// Accelerations of a vehicle by its surroundings, axes N, m/s2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ambient {
    /// By fields that pull on every part alike; an accelerometer does not feel them.
    pub gravity: Vector3<f64>,
    /// By air and light on the surface; an accelerometer feels it.
    pub surface: Vector3<f64>,
}

impl Ambient {
    /// Both together.
    pub fn sum(&self) -> Vector3<f64> {
        self.gravity + self.surface
    }
}

/// The chaser's instrument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instrument {
    /// Range and angles to the target; the initial estimate is an inertial state.
    Lidar,
    /// The whole state relative to the target, in the axes of the target's orbit, beside that orbit itself; the initial
    /// estimate is such a measurement. The true relative acceleration is told less that of this model.
    Metrology(ClohessyWiltshire),
}

/// How a run begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// State at the start time.
    pub state: Vehicles,
    /// What will push the vehicles.
    pub timeline: Timeline,
}

/// An entry of [`WORLDS`] by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "i32", into = "i32")]
pub struct Scenario(usize);

impl Scenario {
    /// The entry.
    pub fn entry(self) -> &'static WorldEntry {
        // In range by construction: both ways to make one check it.
        &WORLDS[self.0]
    }
}

impl TryFrom<i32> for Scenario {
    type Error = TruthError;

    /// From the FMU's enumeration, which counts from 1.
    fn try_from(ordinal: i32) -> Result<Self, TruthError> {
        match usize::try_from(i64::from(ordinal) - 1) {
            Ok(place) if place < WORLDS.len() => Ok(Self(place)),
            _ => {
                let names = WORLDS
                    .iter()
                    .enumerate()
                    .map(|(place, entry)| format!("{} ({})", place + 1, entry.name));
                Err(TruthError::Scenario {
                    ordinal,
                    known: names.collect::<Vec<_>>().join(", "),
                })
            }
        }
    }
}

impl From<Scenario> for i32 {
    fn from(scenario: Scenario) -> i32 {
        scenario.0 as i32 + 1
    }
}

/// State at the end of a step of length `h` (negative: backwards) that begins at `t`, s since the start of the run.
pub(crate) fn step(world: &dyn World, params: &Params, t: f64, state: &Vehicles, push: &Push, h: f64) -> Vehicles {
    let end = rk4::step(t, &state.to_vector(), h, |t, x| -> SVector<f64, 12> {
        world.derivative(params, t, &Vehicles::from_vector(x), push).to_vector()
    });
    Vehicles::from_vector(&end)
}

/// State at the start of the run that leads to `last` when nothing but `timeline` acts.
///
/// * `last`: state at the end of grid interval `intervals - 1`.
/// * `grid`: interval of the time grid, s.
pub(crate) fn back_propagate(
    world: &dyn World,
    params: &Params,
    timeline: &Timeline,
    last: &Vehicles,
    intervals: u32,
    grid: f64,
) -> Vehicles {
    (0..intervals).rev().fold(*last, |state, k| {
        let push = timeline.push_around((f64::from(k) + 0.5) * grid);
        step(world, params, f64::from(k + 1) * grid, &state, &push, -grid)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenarios_are_the_entries_counted_from_one() {
        for (place, entry) in (1..).zip(WORLDS) {
            let scenario = Scenario::try_from(place).unwrap();
            assert_eq!(scenario.entry().name, entry.name);
            assert_eq!(i32::from(scenario), place);
        }
        for ordinal in [0, -1, i32::MIN, WORLDS.len() as i32 + 1] {
            let error = Scenario::try_from(ordinal).unwrap_err().to_string();
            assert!(
                error.contains(&ordinal.to_string()) && error.contains("1 (leo_venting)"),
                "{error}"
            );
        }
    }
}
