//! What pushes the target and no filter is told of, summed up: for filters that are bounds.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::world::World;
use crate::{Push, Vehicles};

/// Sums since the start of the run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Untold {
    /// Velocity that the target has been given, the integral of its acceleration as it stands in axes N, m/s: by vents, burns
    /// and inputs that no filter is told of, and by what never stops.
    pub dv_t_n: Vector3<f64>,
    /// Time in which a vent, or a burn or input that no filter is told of, pushed it, s. A grid interval of which an event has a
    /// part counts whole: over it the event's mean acts.
    pub event_time: f64,
}

impl Untold {
    /// The sums after a step.
    ///
    /// * `push`: what acts over it.
    /// * `begin`, `length`: of the step, s since the start of the run and s.
    /// * `path`: states at its begin and at its end.
    ///
    /// What acts in axes N is constant over a step and its sum exact; of what turns with the vehicle Simpson's rule, as
    /// [`crate::Simulation`] has it for the accelerometer.
    pub(crate) fn after(self, world: &World, push: &Push, begin: f64, length: f64, path: [&Vehicles; 2]) -> Self {
        if length <= 0.0 {
            return self;
        }
        let [from, to] = path;
        let at = |t: f64, state: &Vehicles| world.untold_on_target(t, state, push);
        let turns = push.target.turning.is_some() || push.announced.turning.is_some();
        let mean = if turns {
            let half = at(begin + 0.5 * length, &from.half_way(to, length));
            (at(begin, from) + half * 4.0 + at(begin + length, to)) / 6.0
        } else {
            push.target.n - push.announced.n
        };
        Self {
            dv_t_n: self.dv_t_n + mean * length,
            event_time: self.event_time + if push.unannounced { length } else { 0.0 },
        }
    }
}
