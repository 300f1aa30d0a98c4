//! Rendezvous with a venting target on a near-rectilinear halo orbit: Mamich and Zanetti, Sec. IV.B.

use astro::Cr3bp;
use astro::cr3bp::{EARTH_MOON_LENGTH as LENGTH, EARTH_MOON_MASS_RATIO, EARTH_MOON_TIME as TIME};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::initial::InitialSigma;
use crate::world::back_propagate;
use crate::{Event, Params, Push, Start, Surroundings, Timeline, TruthError, Vehicles, World, WorldEntry, vents};

/// The registry line.
pub(crate) const ENTRY: WorldEntry = WorldEntry {
    name: "nrho_venting",
    about: "rendezvous with a venting target on a near-rectilinear halo orbit of the Moon",
    duration: GRID * INTERVALS as f64,
    grid: GRID,
    world: &NrhoVenting,
};

/// Interval of the time grid, s.
const GRID: f64 = 1.0;
/// The run ends with the rendezvous after this many intervals (Sec. IV.B: 5500 s).
const INTERVALS: u32 = 5500;

const GRAVITY: Cr3bp = Cr3bp {
    mass_ratio: EARTH_MOON_MASS_RATIO,
};

/// Final position and velocity of the chaser, nondimensional, rotating axes (Table 7).
const FINAL_CHASER: [[f64; 3]; 2] = [[0.9879, 1.432e-2, 2.009e-3], [7.173e-2, 0.9238, -0.8528]];
/// Final position of the target relative to the chaser, inertial axes, m; in those they are at rest to each other.
const FINAL_R_TC: [f64; 3] = [-2.0, -2.0, -2.0];
/// Its first two components in rotating axes, nondimensional, as Table 7 prints them; they fix the angle of the axes.
const FINAL_R_TC_ROTATING: [f64; 2] = [-7.357e-9, -1.399e-10];

/// The chaser's capture burn (Table 6): s, s, m/s2; along y of the inertial axes.
const BURN_START: f64 = 5470.0;
const BURN_SECONDS: u32 = 30;
const BURN_MAGNITUDE: f64 = 1.0e-2;

/// Axes N rotate with Earth and Moon about their barycentre; velocities are relative to them; both scaled to SI.
struct NrhoVenting;

/// Rotating from inertial axes, `t` s since the start of the run.
fn rotating_from_inertial(t: f64) -> Matrix3<f64> {
    let [x, y] = FINAL_R_TC_ROTATING;
    let [fx, fy, _] = FINAL_R_TC;
    // The rotation that takes the direction (fx, fy) to (x, y) turns by the difference of their angles.
    let at_end = fy.atan2(fx) - y.atan2(x);
    let angle = at_end + (t - ENTRY.duration) / TIME;
    Rotation3::from_axis_angle(&Vector3::z_axis(), -angle).into_inner()
}

impl World for NrhoVenting {
    fn start(&self, params: &Params) -> Result<Start, TruthError> {
        let mut events = vents::draw(params);
        events.extend(burn());
        let timeline = Timeline { events };
        let state = back_propagate(self, params, &timeline, &rendezvous(), INTERVALS, GRID);
        Ok(Start { state, timeline })
    }

    fn surroundings(&self, _params: &Params, _t: f64, state: &Vehicles) -> Surroundings {
        Surroundings::field(state, |r, v| {
            GRAVITY.acceleration(&(r / LENGTH), &(v * (TIME / LENGTH))) * (LENGTH / (TIME * TIME))
        })
    }

    /// Of the orbit about the Moon.
    fn orbit_normal(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        let from_moon = r - GRAVITY.secondary() * LENGTH;
        from_moon.cross(&(v + Vector3::z().cross(&from_moon) / TIME))
    }

    fn initial_sigma(&self, _params: &Params) -> InitialSigma {
        // Eq. (37), nondimensional.
        InitialSigma {
            position: 2.5e-8 * LENGTH,
            velocity: 2.5e-11 * LENGTH / TIME,
            acceleration: 3.5e-7 * LENGTH / (TIME * TIME),
            bias: 3.5e-7 * LENGTH / (TIME * TIME),
        }
    }
}

/// The burn, second by second: its direction stands still in inertial axes and so turns in ours.
fn burn() -> impl Iterator<Item = Event> {
    (0..BURN_SECONDS).map(|second| {
        let start = BURN_START + f64::from(second);
        let chaser_n = rotating_from_inertial(start + 0.5) * Vector3::y() * BURN_MAGNITUDE;
        Event {
            start,
            duration: 1.0,
            push: Push {
                chaser_n,
                ..Push::default()
            },
        }
    })
}

fn rendezvous() -> Vehicles {
    let [r_c, v_c] = FINAL_CHASER.map(Vector3::from);
    let (r_c, v_c) = (r_c * LENGTH, v_c * (LENGTH / TIME));
    let r_tc = rotating_from_inertial(ENTRY.duration) * Vector3::from(FINAL_R_TC);
    // At rest in inertial axes is moving against the rotation in ours.
    let v_tc = -Vector3::z().cross(&r_tc) / TIME;
    Vehicles {
        r_t: r_c + r_tc,
        v_t: v_c + v_tc,
        r_c,
        v_c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::step;

    fn run_forward(params: &Params, mut each: impl FnMut(&Vehicles)) -> Vehicles {
        let start = NrhoVenting.start(params).unwrap();
        (0..INTERVALS).fold(start.state, |state, k| {
            each(&state);
            let push = start.timeline.push_around(f64::from(k) + 0.5);
            step(&NrhoVenting, params, f64::from(k), &state, &push, GRID)
        })
    }

    #[test]
    fn forward_run_returns_to_table_7() {
        for run in 0..3 {
            let params = Params {
                run,
                vent_scale: 10.0,
                ..Params::default()
            };
            let end = run_forward(&params, |_| ());
            // Printed to four digits.
            let relative = (end.r_tc() / LENGTH, end.v_tc() * (TIME / LENGTH));
            let printed = (
                Vector3::new(-7.357e-9, -1.399e-10, -5.203e-9),
                Vector3::new(-1.399e-10, 7.357e-9, 0.0),
            );
            assert!((relative.0 - printed.0).amax() < 2e-12, "run {run}: {}", relative.0);
            assert!((relative.1 - printed.1).amax() < 2e-12, "run {run}: {}", relative.1);
            // Rounding of 4e8 m over 5500 steps there and back.
            let goal = rendezvous();
            assert!((end.r_c - goal.r_c).amax() < 1e-3, "run {run}: {}", end.r_c - goal.r_c);
            assert!(
                (end.r_tc() - goal.r_tc()).amax() < 1e-4,
                "run {run}: {}",
                end.r_tc() - goal.r_tc()
            );
            assert!((end.v_c - goal.v_c).amax() < 1e-8, "run {run}: {}", end.v_c - goal.v_c);
        }
    }

    #[test]
    fn free_target_keeps_its_jacobi_constant() {
        let params = Params {
            vent_scale: 0.0,
            ..Params::default()
        };
        let mut seen = Vec::new();
        run_forward(&params, |s| {
            seen.push(GRAVITY.jacobi_constant(&(s.r_t / LENGTH), &(s.v_t * (TIME / LENGTH))));
        });
        for c in &seen {
            assert!((c - seen[0]).abs() < 1e-12, "{c} {}", seen[0]);
        }
    }

    #[test]
    fn burn_keeps_its_inertial_direction() {
        // In inertial axes every second of the burn points along y.
        for event in burn() {
            let inertial = rotating_from_inertial(event.start + 0.5).transpose() * event.push.chaser_n;
            assert!((inertial - Vector3::y() * 1e-2).amax() < 1e-15);
        }
        // Table 7: c + s = 1.414, c - s = 0.02689 for the angle at the end, 43.9 deg.
        let at_end = rotating_from_inertial(ENTRY.duration);
        assert!(
            (at_end[(0, 0)] - 0.7205).abs() < 1e-3 && (at_end[(0, 1)] - 0.6936).abs() < 1e-3,
            "{at_end}"
        );
    }
}
