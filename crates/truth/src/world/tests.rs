//! Runs of the papers' missions against their end, their invariants and what is written there; forces against potentials.
#![allow(clippy::unwrap_used, clippy::float_cmp)]

use astro::harmonics::EGM96;
use astro::{ClohessyWiltshire, Cr3bp, SphericalHarmonics, atmosphere, earth_rotation, epoch, frames, sun_moon};

use nalgebra::Rotation3;

use super::*;
use crate::disturbances::schedule;
use crate::start::start;
use crate::timeline::Turning;
use crate::{Forces, Inputs, Moment, Params, Relative, Simulation};

mod sky;

/// Three orbits of the formation.
const DURATION: u32 = 21_939;
/// Of Table 5, m and s.
const LENGTH: f64 = 3.844e8;
const TIME: f64 = 3.752e5;

/// The world of a mission, the state at its start and its events.
fn begin(params: &Params) -> (World, Vehicles, Timeline, Mission) {
    let run = params.run().unwrap();
    let world = World::new(&run.mission).unwrap();
    let timeline = schedule(&run);
    let state = start(&run.mission, &world, &timeline).unwrap();
    (world, state, timeline, run.mission)
}

/// Flies a mission without its simulation; returns the end.
fn run_forward(params: &Params, mut each: impl FnMut(&World, f64, &Vehicles)) -> Vehicles {
    let (world, mut state, timeline, mission) = begin(params);
    let mut sky = world.sky(0.0);
    for k in 0..(mission.time.duration_s / world.grid) as u64 {
        each(&world, sky.t, &state);
        let push = world.push_over(&timeline, k);
        world.step(&mut sky, &mut state, &push, world.grid);
    }
    state
}

/// The state that a mission gives for its end.
fn goal(params: &Params) -> Vehicles {
    let mut mission = params.run().unwrap().mission;
    // Of a run of no length the end is the start.
    mission.time.duration_s = 0.0;
    start(&mission, &World::new(&mission).unwrap(), &Timeline::default()).unwrap()
}

fn loud(ordinal: i32, run: u32) -> Params {
    let mut params = Params::of_scenario(ordinal);
    params.run = run;
    assert!(params.set("vent.scale", 10.0));
    params
}

fn calm(ordinal: i32) -> Params {
    let mut params = Params::of_scenario(ordinal);
    assert!(params.set("vent.scale", 0.0));
    params
}

#[test]
fn forward_run_returns_to_the_rendezvous() {
    for run in 0..5 {
        let params = loud(1, run);
        let (end, goal) = (run_forward(&params, |_, _, _| ()), goal(&params));
        // Rounding, 1e-9 m a step on 6.9e6 m, of 5680 steps there and back; it comes to about 1e-7 m and 4e-11 m/s.
        assert!((end.r_tc() - goal.r_tc()).amax() < 1e-6, "run {run}: {}", end.r_tc());
        assert!((end.v_tc() - goal.v_tc()).amax() < 1e-9, "run {run}: {}", end.v_tc());
        assert!((end.r_t - goal.r_t).amax() < 1e-6, "run {run}: {}", end.r_t);
        assert!((end.v_t - goal.v_t).amax() < 1e-9, "run {run}: {}", end.v_t);
    }
}

#[test]
fn free_target_keeps_its_energy_and_axial_angular_momentum() {
    let field = astro::earth::TRUTH;
    let mut seen = Vec::new();
    run_forward(&calm(1), |_, _, state| {
        let energy = state.v_t.norm_squared() / 2.0 - field.potential(&state.r_t);
        seen.push((energy, state.r_t.cross(&state.v_t).z));
    });
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
    let end = run_forward(&Params::of_scenario(1), |world, t, state| {
        path.push(*state);
        let seen = frames::lidar_from_body() * world.dcm_bc_n(t, state, &Push::default()) * state.r_tc();
        assert!(
            seen.x.abs() + seen.y.abs() < 1e-11 * seen.z,
            "the target is on the boresight: {seen}"
        );
        let back = world.dcm_bt_n(t, state) * -state.r_tc();
        assert!(
            back.x.abs() + back.z.abs() < 1e-11 * back.y,
            "the target looks back: {back}"
        );
    });
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
}

#[test]
fn vent_pushes_along_its_body_direction() {
    let (world, state, ..) = begin(&Params::of_scenario(1));
    let vent = Thrust {
        turning: Some(Turning {
            body: Vector3::new(-0.5, -0.866, 0.0),
            ..Turning::default()
        }),
        ..Thrust::default()
    };
    let push = Push {
        target: vent,
        ..Push::default()
    };
    let sky = world.sky(0.0);
    let quiet = world.derivative(&sky, &state, &Push::default());
    let vented = world.derivative(&sky, &state, &push);
    let felt = vented.v_t - quiet.v_t;
    // Body y points to the chaser, body z along the normal of the relative motion; x = y cross z.
    let y = -state.r_tc().normalize();
    let z = state.r_tc().cross(&state.v_tc()).normalize();
    let expected = y.cross(&z) * -0.5 + y * -0.866;
    // Gravity of 8 m/s2 was added and taken away again.
    assert!((felt - expected).amax() < 1e-14, "{felt}");
    assert_eq!(vented.v_c, quiet.v_c);
}

#[test]
fn forward_run_returns_to_table_7() {
    for run in 0..3 {
        let params = loud(2, run);
        let (end, goal) = (run_forward(&params, |_, _, _| ()), goal(&params));
        // Printed to four digits.
        let relative = (end.r_tc() / LENGTH, end.v_tc() * (TIME / LENGTH));
        let printed = (
            Vector3::new(-7.357e-9, -1.399e-10, -5.203e-9),
            Vector3::new(-1.399e-10, 7.357e-9, 0.0),
        );
        assert!((relative.0 - printed.0).amax() < 2e-12, "run {run}: {}", relative.0);
        assert!((relative.1 - printed.1).amax() < 2e-12, "run {run}: {}", relative.1);
        // Rounding of 4e8 m over 5500 steps there and back.
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
    let gravity = Cr3bp { mass_ratio: 1.215e-2 };
    let mut seen = Vec::new();
    run_forward(&calm(2), |_, _, s| {
        seen.push(gravity.jacobi_constant(&(s.r_t / LENGTH), &(s.v_t * (TIME / LENGTH))));
    });
    for c in &seen {
        assert!((c - seen[0]).abs() < 1e-12, "{c} {}", seen[0]);
    }
}

#[test]
fn burn_keeps_its_inertial_direction() {
    let (world, _, timeline, mission) = begin(&Params::of_scenario(2));
    let rotating = |t: f64| world.axes.dcm_n_i(t);
    // In inertial axes every second of the burn points along y.
    for k in 5470..5500 {
        let push = world.push_over(&timeline, k).chaser.n;
        let inertial = rotating(k as f64 + 0.5).transpose() * push;
        assert!((inertial - Vector3::y() * 1e-2).amax() < 1e-15);
    }
    // Table 7: c + s = 1.414, c - s = 0.02689 for the angle at the end, 43.9 deg.
    let at_end = rotating(mission.time.duration_s);
    assert!(
        (at_end[(0, 0)] - 0.7205).abs() < 1e-3 && (at_end[(0, 1)] - 0.6936).abs() < 1e-3,
        "{at_end}"
    );
}

/// Both vehicles at once feel, to the bit, what either feels alone.
#[test]
fn vehicles_do_not_feel_that_they_are_computed_together() {
    for (ordinal, seconds) in [(1, 5600), (2, 5400), (3, 5600)] {
        let params = loud(ordinal, 0);
        let world = World::new(&params.run().unwrap().mission).unwrap();
        let push = Push::default();
        for moment in path(&params, seconds).iter().step_by(100) {
            let (sky, state) = (world.sky(moment.time), &moment.state);
            let rate = world.derivative(&sky, state, &push);
            let chaser = world.environment.acceleration(&sky, &world.chaser_place(state));
            let (a_t, a_c) = (world.target_acceleration(&sky, state, &push), chaser);
            let bits = |a: [Vector3<f64>; 2]| a.map(|a| a.map(f64::to_bits));
            assert_eq!(
                bits([rate.v_t, rate.v_c]),
                bits([a_t, a_c]),
                "{ordinal} at {} s",
                moment.time
            );
        }
    }
}

fn relative(moment: &Moment) -> Relative {
    moment.relative.unwrap()
}

/// The reference that `d_lvlh` is held against, written out for the semi-major axis of Table 1.
fn linear_motion() -> ClohessyWiltshire {
    ClohessyWiltshire {
        mean_motion: (3.986004415e14 / 8143.1e3_f64.powi(3)).sqrt(),
    }
}

/// The truth at every second, from the start on.
fn path(params: &Params, seconds: u32) -> Vec<Moment> {
    let mut run = Simulation::new(params, 0.0, &Inputs::default()).unwrap();
    let mut seen = vec![*run.now()];
    for k in 1..=seconds {
        run.advance_to(f64::from(k), &Inputs::default()).unwrap();
        seen.push(*run.now());
    }
    seen
}

/// All forces again, from potentials and direct differences, at places around the orbit.
#[test]
fn forces_are_the_sum_of_their_parts() {
    let mut params = Params::of_scenario(3);
    assert!(params.set("target.mass", 40.0));
    let world = World::new(&params.run().unwrap().mission).unwrap();
    let field = SphericalHarmonics::new(EGM96.coefficients());
    let mut dark = 0;
    for moment in path(&params, DURATION).iter().step_by(1371) {
        let days = epoch::days_since_j2000(2_458_849.5, moment.time);
        let dcm_f_n = earth_rotation::dcm_f_n(days);
        let (sun, moon) = (sun_moon::sun(days), sun_moon::moon(days));
        let sky = world.sky(moment.time);
        let around = |craft: &Craft, r: &Vector3<f64>, v: &Vector3<f64>| {
            let place = Place {
                r,
                v,
                surface: &craft.surface,
            };
            (
                world.environment.pull(&sky, &place),
                world.environment.push(&sky, &place),
            )
        };
        let Vehicles { r_t, v_t, r_c, v_c } = moment.state;
        for (craft, r, v, area_per_mass) in [
            (&world.target, r_t, v_t, 0.2 / 40.0),
            (&world.chaser, r_c, v_c, 1.2 / 100.0),
        ] {
            let (pull, push) = around(craft, &r, &v);
            // Gradient along inertial axes of the potential, and of the tidal potential of Sun and Moon.
            let potential = |r: &Vector3<f64>| {
                let third = |mu: f64, body: &Vector3<f64>| {
                    let d = body.norm();
                    // 1 / |body - r| less its constant and uniform parts, by the next three Legendre terms.
                    let (q, u) = (r.norm() / d, r.dot(body) / (r.norm() * d));
                    let p2 = (3.0 * u * u - 1.0) / 2.0;
                    let p3 = (5.0 * u * u - 3.0) * u / 2.0;
                    let p4 = (35.0 * u.powi(4) - 30.0 * u * u + 3.0) / 8.0;
                    mu / d * (q.powi(2) * p2 + q.powi(3) * p3 + q.powi(4) * p4)
                };
                (
                    field.potential(&(dcm_f_n * r)),
                    third(sun_moon::SUN_MU, &sun) + third(sun_moon::MOON_MU, &moon),
                )
            };
            let h = 2e3;
            let gradient = Vector3::from_fn(|i, _| {
                let at = |d: f64| {
                    let mut place = r;
                    place[i] += d;
                    potential(&place)
                };
                let [a, b, c, d] = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)];
                let slope = |a: f64, b: f64, c: f64, d: f64| (a - b) * (2.0 / (3.0 * h)) - (c - d) / (12.0 * h);
                slope(a.0, b.0, c.0, d.0) + slope(a.1, b.1, c.1, d.1)
            });
            // Rounding of the potential, 1e-8 m2/s2, over 2 km, and what the Moon's series leaves out, (r / d)^3 of 1e-6
            // m/s2; the least force, of the Sun, is 5e-7 m/s2.
            assert!(
                (pull - gradient).amax() < 1e-10,
                "{} s: {}",
                moment.time,
                pull - gradient
            );
            let through_air = v - Vector3::new(0.0, 0.0, 7.292_116e-5).cross(&r);
            let density = atmosphere::density(atmosphere::altitude(&r));
            let drag = through_air.normalize() * (-density * through_air.norm_squared() * 2.2 * area_per_mass / 2.0);
            // Whether the Earth stands before the Sun: by angles, where the library has a cylinder.
            let angle = r.angle(&sun);
            let behind = angle.cos() < 0.0 && angle.sin() * r.norm() < 6378.1363e3;
            dark += u32::from(behind);
            let sunlight = if behind {
                Vector3::zeros()
            } else {
                let distance = (sun - r).norm() / 149_597_870_700.0;
                (r - sun).normalize() * (4.56e-6 * 1.3 * area_per_mass / (distance * distance))
            };
            let surface = drag + sunlight;
            assert!(
                (push - surface).amax() < 1e-6 * push.amax(),
                "{} s: {} and {surface}",
                moment.time,
                push
            );
        }
    }
    assert!((2..30).contains(&dark), "{dark} of 34 places lie in the dark");
}

/// Differences of order four, over 10 s, of the path itself.
#[test]
fn disturbance_is_what_the_path_shows() {
    let mut j2_only = Params::of_scenario(3);
    j2_only.formation_forces = Forces::J2;
    for params in [Params::of_scenario(3), j2_only] {
        let world = World::new(&params.run().unwrap().mission).unwrap();
        let seen = path(&params, DURATION);
        let surface: Vec<_> = seen
            .iter()
            .map(|m| {
                let (sky, target) = (world.sky(m.time), &world.target.surface);
                let on_target = Place {
                    r: &m.state.r_t,
                    v: &m.state.v_t,
                    surface: target,
                };
                world.force_on_chaser(&sky, &m.state, &Push::default()) - world.environment.push(&sky, &on_target)
            })
            .collect();
        let (mut worst, mut worst_rate, mut compared) = (0.0_f64, 0.0_f64, 0);
        for k in (20..seen.len() - 20).step_by(7) {
            // No difference is taken across the edge of the shadow.
            if (k - 20..k + 20).any(|i| (surface[i + 1] - surface[i]).norm() > 1e-9) {
                continue;
            }
            compared += 1;
            let at = |offset: i32| relative(&seen[(k as i32 + offset) as usize]);
            let (a, b, now, c, d) = (at(-20), at(-10), at(0), at(10), at(20));
            let second = ((b.rho_lvlh + c.rho_lvlh) * 16.0 - a.rho_lvlh - d.rho_lvlh - now.rho_lvlh * 30.0) / 1200.0;
            let slope = ((c.rho_dot_lvlh - b.rho_dot_lvlh) * 8.0 - (d.rho_dot_lvlh - a.rho_dot_lvlh)) / 120.0;
            let modelled = linear_motion().acceleration(&now.rho_lvlh, &now.rho_dot_lvlh);
            worst = worst.max((second - modelled - now.d_lvlh).norm());
            worst_rate = worst_rate.max((slope - modelled - now.d_lvlh).norm());
        }
        assert!(compared > 2500, "{compared}");
        // Rounding of positions, 4e-9 m over (10 s)^2, and of velocities, 4e-12 m/s over 10 s. The density of the air has
        // a kink wherever its scale height changes: (1/72 km - 1/89 km) * 500 m/s * 2e-8 m/s2 at 700 km, over seconds.
        let rate_bound = if params.formation_forces == Forces::J2 {
            3e-12
        } else {
            5e-11
        };
        assert!(
            worst < 3e-10 && worst_rate < rate_bound,
            "{:?}: {worst} and {worst_rate} m/s2",
            params.formation_forces
        );
    }
}

/// A mission from its text, with changes of the formation's environment.
fn surrounded(environment: &str, epoch: &str) -> World {
    let text = interface::mission::embedded("formation").unwrap().text;
    let (head, rest) = text.split_once("[environment]").unwrap();
    let (_, vehicles) = rest.split_once("# Table 1.").unwrap();
    let head = head.replace("epoch_utc = \"2020-01-01T00:00:00\"", epoch);
    let text = format!("{head}\n[environment]\n{environment}\n# {vehicles}");
    let mission = Mission::parse("surrounded", &text).unwrap_or_else(|e| panic!("{e}"));
    World::new(&mission).unwrap()
}

const R: Vector3<f64> = Vector3::new(1.2e6, -0.9e6, 0.7e6);
const V: Vector3<f64> = Vector3::new(900.0, 1100.0, -700.0);

fn at<'a>(world: &'a World) -> Place<'a> {
    Place {
        r: &R,
        v: &V,
        surface: &world.chaser.surface,
    }
}

const MOON: &str = "body = \"moon\"\ngravity = { model = \"two_body\", mu_m3_s2 = 4.9028e12, radius_m = 1.0e6 }";

/// From the Moon the Earth pulls with its tide, and the Sun's light comes from the Sun.
#[test]
fn moon_at_the_centre() {
    let epoch = "epoch_utc = \"2021-06-01T06:00:00\"";
    let world = surrounded(
        &format!("{MOON}\nthird_bodies = [\"earth\"]\nradiation = {{ shadow = \"none\" }}"),
        epoch,
    );
    let alone = surrounded(MOON, epoch);
    let (t, days) = (
        5000.0,
        epoch::days_since_j2000(epoch::julian_date("2021-06-01T06:00:00").unwrap(), 5000.0),
    );
    let pull = world.environment.pull(&world.sky(t), &at(&world)) - alone.environment.pull(&alone.sky(t), &at(&alone));
    // The tide is at most 2 mu r / d^3, along the line to the Earth, and half of it inwards across.
    let distance = sun_moon::moon(days).norm();
    let tide = 3.986e14 * R.norm() / distance.powi(3);
    assert!((0.95 * tide..2.05 * tide).contains(&pull.norm()), "{pull} and {tide}");
    let light = world.environment.push(&world.sky(t), &at(&world));
    let far = (sun_moon::sun(days) - sun_moon::moon(days)).norm();
    let expected = 4.56e-6 * 1.3 * 1.2 / 100.0 * (149_597_870_700.0 / far).powi(2);
    // The Sun's distance differs by the vehicle's, 2e6 m of 1.5e11.
    assert!((light.norm() / expected - 1.0).abs() < 1e-4, "{light}");
    // Once a year round: half a year later it comes from the other side.
    let later = surrounded(
        &format!("{MOON}\nradiation = {{ shadow = \"none\" }}"),
        "epoch_utc = 2021-12-01T06:00:00",
    );
    let opposite = later.environment.push(&later.sky(t), &at(&later));
    assert!(opposite.normalize().dot(&light.normalize()) < -0.9, "{opposite}");
}

#[test]
fn shadow_is_that_of_the_body_at_the_centre() {
    let of = |radius: &str| {
        let gravity =
            format!("body = \"moon\"\ngravity = {{ model = \"two_body\", mu_m3_s2 = 4.9e12, radius_m = {radius} }}");
        surrounded(
            &format!("{gravity}\nradiation = {{}}"),
            "epoch_utc = \"2021-06-01T06:00:00\"",
        )
    };
    // Behind the body, seen from the Sun.
    let lit = of("1.0");
    let sky = lit.sky(0.0);
    let sun = -lit.environment.push(&sky, &at(&lit)).normalize();
    let behind = sun * -2e6;
    let light = |world: &World| {
        let place = Place {
            r: &(behind + R.cross(&sun).normalize() * 0.9e6),
            v: &V,
            surface: &world.chaser.surface,
        };
        world.environment.push(&sky, &place).norm()
    };
    assert!(light(&of("0.8e6")) > 0.0 && light(&of("1.0e6")) == 0.0);
}

/// One layer over any body, and air that turns as the mission says or as the body does.
#[test]
fn air_of_one_layer_turns_with_its_body() {
    let layer = "drag = { density_kg_m3 = 1e-9, reference_altitude_m = 1e5, scale_height_m = 5e4 }";
    let drag = |extra: &str, epoch: &str| {
        let world = surrounded(&format!("{extra}\n{layer}"), epoch);
        world.environment.push(&world.sky(0.0), &at(&world))
    };
    let density = 1e-9 * f64::exp((1e5 - (R.norm() - 1.0e6)) / 5e4);
    let by_hand = |rate: f64| {
        let through = V - Vector3::new(0.0, 0.0, rate).cross(&R);
        through * (-0.5 * density * 2.2 * 1.2 / 100.0 * through.norm())
    };
    let close =
        |a: Vector3<f64>, b: Vector3<f64>, share: f64| assert!((a - b).norm() < share * b.norm(), "{a} and {b}");
    let epoch = "epoch_utc = \"2021-06-01T06:00:00\"";
    close(
        drag(MOON, epoch),
        by_hand(std::f64::consts::TAU / (27.321_661 * 86_400.0)),
        1e-4,
    );
    let stated = format!("{MOON}\nrotation = {{ rate_deg_s = 0.05 }}");
    close(drag(&stated, ""), by_hand(0.05_f64.to_radians()), 1e-14);
    let earth = MOON.replace("moon", "earth");
    close(drag(&earth, ""), by_hand(7.292_116e-5), 1e-7);
    let other = MOON.replace("moon", "other");
    close(drag(&other, ""), by_hand(0.0), 1e-14);
}

/// A field of degree and order 2 in axes that turn at a stated rate.
#[test]
fn harmonics_turn_as_the_mission_says() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("field.csv");
    let text = "mu_m3_s2 = 4.9e12\nradius_m = 1.0e6\ndegree,order,c,s\n2,0,-1e-3,0\n2,1,0,0\n2,2,3e-4,0\n";
    std::fs::write(&file, text).unwrap();
    let world = surrounded(
        &format!(
            "body = \"other\"\nrotation = {{ rate_deg_s = 0.1, angle_deg = 30.0 }}\ngravity = {{ model = \"harmonics\", file = '{}' }}",
            file.display()
        ),
        "",
    );
    let pull = |t: f64, r: Vector3<f64>| {
        let place = Place {
            r: &r,
            v: &V,
            surface: &world.chaser.surface,
        };
        world.environment.pull(&world.sky(t), &place)
    };
    // What stands over one meridian sees the same field at any time.
    let turned = |t: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), (30.0 + 0.1 * t).to_radians());
    let fixed = pull(0.0, turned(0.0) * R);
    for t in [100.0, 1000.0] {
        let seen = turned(t).inverse() * pull(t, turned(t) * R);
        assert!((seen - turned(0.0).inverse() * fixed).amax() < 1e-14, "{seen}");
    }
    // And what stands still does not.
    assert!((pull(0.0, R) - pull(900.0, R)).norm() > 1e-5);
}
