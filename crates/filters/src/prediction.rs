//! The estimate as it will be at the end of a communication step, for whoever steers by it.

use astro::LvlhAxes;
use interface::mission::Frame;
use nalgebra::{Vector3, Vector6};

use crate::state::State;

/// The relative state ahead of the last sample, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// The time at which it holds, s: the end of the communication step, or the epoch of the estimate where it could not be propagated.
    pub time: f64,
    /// Position of the target relative to the chaser, axes N, m; zero in the LVLH frame where nobody says how that stands.
    pub r_tc_n: Vector3<f64>,
    /// Velocity likewise, m/s.
    pub v_tc_n: Vector3<f64>,
    /// Position of the chaser relative to the target, LVLH axes, m; zero in the inertial frame.
    pub rho_lvlh: Vector3<f64>,
    /// Velocity likewise, m/s.
    pub rho_dot_lvlh: Vector3<f64>,
    /// Standard deviations of the first six states of the estimate, m and m/s.
    pub sigma: Vector6<f64>,
}

impl Prediction {
    /// * `x`, `sigma`: the 18 states of the estimate, in its frame, and their standard deviations.
    /// * `axes`: of the target's orbit at `time`.
    pub(crate) fn new(time: f64, frame: Frame, x: &State, sigma: &State, axes: Option<&LvlhAxes>) -> Self {
        let (r_tc_n, v_tc_n) = relative_n(frame, x, axes);
        let (rho_lvlh, rho_dot_lvlh) = match frame {
            Frame::Inertial => Default::default(),
            Frame::Lvlh => halves(x),
        };
        Self {
            time,
            r_tc_n,
            v_tc_n,
            rho_lvlh,
            rho_dot_lvlh,
            sigma: sigma.fixed_rows::<6>(0).into_owned(),
        }
    }
}

/// Position and velocity of the target relative to the chaser, axes N, of an estimate in its frame.
pub(crate) fn relative_n(frame: Frame, x: &State, axes: Option<&LvlhAxes>) -> (Vector3<f64>, Vector3<f64>) {
    let (position, velocity) = halves(x);
    match (frame, axes) {
        (Frame::Inertial, _) => (position, velocity),
        (Frame::Lvlh, None) => Default::default(),
        (Frame::Lvlh, Some(axes)) => {
            let (r, v) = axes.to_n(&position, &velocity);
            (-r, -v)
        }
    }
}

fn halves(x: &State) -> (Vector3<f64>, Vector3<f64>) {
    let part = |first: usize| x.fixed_rows::<3>(first).into_owned();
    (part(0), part(3))
}
