//! Rendezvous with a venting target in low Earth orbit: Mamich and Zanetti, Sec. IV.A.

use astro::{Elements, earth};
use nalgebra::Vector3;

use crate::initial::InitialSigma;
use crate::world::back_propagate;
use crate::{Event, Params, Push, Start, Surroundings, Timeline, TruthError, Vehicles, World, WorldEntry, vents};

/// The registry line.
pub(crate) const ENTRY: WorldEntry = WorldEntry {
    name: "leo_venting",
    about: "rendezvous with a venting target in low Earth orbit",
    duration: GRID * INTERVALS as f64,
    grid: GRID,
    world: &LeoVenting,
};

/// Interval of the time grid, s.
const GRID: f64 = 1.0;
/// The run ends with the rendezvous after this many intervals (Sec. IV.A: 5680 s).
const INTERVALS: u32 = 5680;

/// Final orbit of the target (Table 4). Deviation: the chaser's own row is not used; its rounded angles miss the rendezvous
/// by 28 km.
const FINAL_TARGET: Elements = Elements {
    a: 6.878e6,
    e: 0.0,
    inclination: 15.0 * DEGREE,
    node: 0.0,
    argument_of_periapsis: 0.0,
    mean_anomaly: 5.0e-6 * DEGREE,
};
const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// Final position of the target relative to the chaser, inertial axes, m; they are at rest to each other (Sec. IV.A).
const FINAL_R_TC: [f64; 3] = [-1.0, -1.0, -1.0];

/// The chaser's capture burn (Table 3): s, s, m/s2, and the direction in inertial axes (printed as -0.7071).
const BURN_START: f64 = 5560.0;
const BURN_DURATION: f64 = 30.0;
const BURN_MAGNITUDE: f64 = 1.0e-2;
const BURN_DIRECTION: [f64; 3] = [-1.0, -1.0, 0.0];

/// Axes N are inertial, Earth-centred, z along the spin axis. Both vehicles look at each other.
struct LeoVenting;

impl World for LeoVenting {
    fn start(&self, params: &Params) -> Result<Start, TruthError> {
        let mut events = vents::draw(params);
        events.push(burn());
        let timeline = Timeline { events };
        let state = back_propagate(self, params, &timeline, &rendezvous()?, INTERVALS, GRID);
        Ok(Start { state, timeline })
    }

    fn surroundings(&self, _params: &Params, _t: f64, state: &Vehicles) -> Surroundings {
        Surroundings::field(state, |r, _| earth::TRUTH.acceleration(r))
    }

    fn orbit_normal(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        r.cross(v)
    }

    fn initial_sigma(&self, _params: &Params) -> InitialSigma {
        // Eq. (35).
        InitialSigma {
            position: 25.0 / 3.0,
            velocity: 0.1,
            acceleration: 1e-9,
            bias: 1e-9,
        }
    }
}

fn burn() -> Event {
    let chaser_n = Vector3::from(BURN_DIRECTION).normalize() * BURN_MAGNITUDE;
    Event {
        start: BURN_START,
        duration: BURN_DURATION,
        push: Push {
            chaser_n,
            ..Push::default()
        },
    }
}

fn rendezvous() -> Result<Vehicles, TruthError> {
    let (r_t, v_t) = FINAL_TARGET.to_state(earth::MU)?;
    Ok(Vehicles {
        r_t,
        v_t,
        r_c: r_t - Vector3::from(FINAL_R_TC),
        v_c: v_t,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::step;
    use astro::frames;

    fn run_forward(params: &Params, mut each: impl FnMut(&Vehicles)) -> Vehicles {
        let start = LeoVenting.start(params).unwrap();
        (0..INTERVALS).fold(start.state, |state, k| {
            each(&state);
            let push = start.timeline.push_around(f64::from(k) + 0.5);
            step(&LeoVenting, params, f64::from(k), &state, &push, GRID)
        })
    }

    #[test]
    fn forward_run_returns_to_the_rendezvous() {
        let goal = rendezvous().unwrap();
        for run in 0..5 {
            let end = run_forward(
                &Params {
                    run,
                    vent_scale: 10.0,
                    ..Params::default()
                },
                |_| (),
            );
            // Rounding, 1e-9 m a step on 6.9e6 m, of 5680 steps there and back; it comes to about 1e-7 m and 4e-11 m/s.
            assert!((end.r_tc() - goal.r_tc()).amax() < 1e-6, "run {run}: {}", end.r_tc());
            assert!((end.v_tc() - goal.v_tc()).amax() < 1e-9, "run {run}: {}", end.v_tc());
            assert!((end.r_t - goal.r_t).amax() < 1e-6, "run {run}: {}", end.r_t);
            assert!((end.v_t - goal.v_t).amax() < 1e-9, "run {run}: {}", end.v_t);
        }
    }

    #[test]
    fn free_target_keeps_its_energy_and_axial_angular_momentum() {
        let invariants = |state: &Vehicles| {
            let energy = state.v_t.norm_squared() / 2.0 - earth::TRUTH.potential(&state.r_t);
            (energy, state.r_t.cross(&state.v_t).z)
        };
        let mut seen = Vec::new();
        run_forward(
            &Params {
                vent_scale: 0.0,
                ..Params::default()
            },
            |state| seen.push(invariants(state)),
        );
        let (energy, axial) = seen[0];
        for (e, h) in &seen {
            // Rounding of 5680 steps; leaving out J5, the smallest term, would move the energy by 1e-7.
            assert!(
                (e / energy - 1.0).abs() < 1e-13 && (h / axial - 1.0).abs() < 1e-13,
                "{e}, {h}"
            );
        }
    }

    #[test]
    fn approach_is_the_one_the_paper_plots() {
        let mut path = Vec::new();
        let params = Params::default();
        let end = run_forward(&params, |state| path.push(*state));
        // One metre off along every axis and at rest, on a circular orbit that has just crossed the node at 15 degrees.
        assert!((end.r_tc() + Vector3::repeat(1.0)).amax() < 1e-6, "{}", end.r_tc());
        assert!(end.v_tc().amax() < 1e-9, "{}", end.v_tc());
        let (sin, cos) = 15.0_f64.to_radians().sin_cos();
        let circular = Vector3::new(0.0, cos, sin) * (3.986e14_f64 / 6.878e6).sqrt();
        assert!((end.r_t - Vector3::new(6.878e6, 0.0, 0.0)).norm() < 1.0, "{}", end.r_t);
        assert!((end.v_t - circular).norm() < 1e-2, "{}", end.v_t);
        // The burn of 30 s at 1e-2 m/s2 takes out an approach speed of 0.3 m/s.
        assert!((path[5560].v_tc().norm() - 0.3).abs() < 1e-3, "{}", path[5560].v_tc());
        // After it the relative motion is what gravity gives two points 1.7 m apart: n^2 * 1.7 m * 90 s = 0.2 mm/s.
        let speed = path[5590].v_tc().norm();
        assert!((1e-4..4e-4).contains(&speed), "{speed}");
        for state in &path {
            let seen = frames::lidar_from_body() * LeoVenting.dcm_bc_n(state) * state.r_tc();
            assert!(
                seen.x.abs() + seen.y.abs() < 1e-11 * seen.z,
                "the target is on the boresight: {seen}"
            );
            let back = LeoVenting.dcm_bt_n(state) * -state.r_tc();
            assert!(
                back.x.abs() + back.z.abs() < 1e-11 * back.y,
                "the target looks back: {back}"
            );
        }
    }

    #[test]
    fn vent_pushes_along_its_body_direction() {
        let params = Params::default();
        let state = LeoVenting.start(&params).unwrap().state;
        let push = Push {
            target_bt: Vector3::new(-0.5, -0.866, 0.0),
            ..Push::default()
        };
        let quiet = LeoVenting.derivative(&params, 0.0, &state, &Push::default());
        let vented = LeoVenting.derivative(&params, 0.0, &state, &push);
        let felt = vented.v_t - quiet.v_t;
        // Body y points to the chaser, body z along the normal of the relative motion; x = y cross z.
        let y = -state.r_tc().normalize();
        let z = state.r_tc().cross(&state.v_tc()).normalize();
        let expected = y.cross(&z) * -0.5 + y * -0.866;
        // Gravity of 8 m/s2 was added and taken away again.
        assert!((felt - expected).amax() < 1e-14, "{felt}");
        assert_eq!(vented.v_c, quiet.v_c);
    }
}
