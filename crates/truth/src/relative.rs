//! The true motion of the chaser in the axes of the target's orbit.

use astro::{ClohessyWiltshire, Lvlh};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::environment::Sky;
use crate::world::World;
use crate::{Push, Vehicles};

/// Half the interval over which the target's jerk is a difference, s.
///
/// The difference is off by (n h)^2 = 1e-8 of the jerk and by rounding of 1e-14 m/s3; over 10 m both change the
/// relative acceleration by less than 1e-13 m/s2.
const JERK_STEP: f64 = 0.1;

/// Chaser minus target, LVLH axes of `astro::relative`: x along the target's position, z along its angular momentum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Relative {
    /// Position, m.
    pub rho_lvlh: Vector3<f64>,
    /// Its rate in the turning axes, m/s.
    pub rho_dot_lvlh: Vector3<f64>,
    /// Acceleration in the turning axes that the reference model leaves out, m/s2.
    pub d_lvlh: Vector3<f64>,
}

impl Relative {
    /// The relative motion under this sky, just after which `push` acts.
    pub(crate) fn new(world: &World, sky: &Sky, state: &Vehicles, push: &Push, reference: &ClohessyWiltshire) -> Self {
        let rate = world.derivative(sky, state, push);
        let lvlh = Lvlh::new(&state.r_t, &state.v_t, &rate.v_t);
        let (rho, rho_dot) = lvlh.relative(&state.r_c, &state.v_c);
        let target_acceleration =
            |h: f64| world.target_acceleration(&world.sky(sky.t + h), &moved(state, &rate, h), push);
        let jerk = (target_acceleration(JERK_STEP) - target_acceleration(-JERK_STEP)) / (2.0 * JERK_STEP);
        let alpha = lvlh.angular_acceleration(&jerk);
        let rho_ddot = lvlh.relative_acceleration(&rho, &rho_dot, &(rate.v_c - rate.v_t), &alpha);
        Self {
            rho_lvlh: rho,
            rho_dot_lvlh: rho_dot,
            d_lvlh: rho_ddot - reference.acceleration(&rho, &rho_dot),
        }
    }
}

/// State `h` seconds along the path, to second order in position.
fn moved(state: &Vehicles, rate: &Vehicles, h: f64) -> Vehicles {
    let along = |r: &Vector3<f64>, v: &Vector3<f64>, a: &Vector3<f64>| r + (v + a * (0.5 * h)) * h;
    Vehicles {
        r_t: along(&state.r_t, &state.v_t, &rate.v_t),
        v_t: state.v_t + rate.v_t * h,
        r_c: along(&state.r_c, &state.v_c, &rate.v_c),
        v_c: state.v_c + rate.v_c * h,
    }
}
