//! Missions written as files: where vehicles begin, what pushes them, and how finely time must be cut.
#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;

use astro::{Elements, Lvlh, frames};
use common::{File, advance, changed, quiet, scenarios, start};
use interface::mission::{EMBEDDED, embedded};
use nalgebra::Vector3;
use truth::{Params, SensorSample, Simulation, Untold, Vehicles};

const RADIO: &str = "[sensors.radio]\nperiod_s = 10.0\n";
const MU: f64 = 3.986e14;

/// The quiet mission with the chaser's place given in these axes, at the start.
fn placed(axes: &str, r: [f64; 3], v: [f64; 3]) -> Vehicles {
    let text = quiet(RADIO)
        .replace("axes = \"rtn\"", &format!("axes = \"{axes}\""))
        .replace("r_tc_m = [3.0, 100.0, -2.0]", &format!("r_tc_m = {r:?}"))
        .replace("v_tc_m_s = [0.01, -0.2, 0.03]", &format!("v_tc_m_s = {v:?}"));
    File::new(&text).simulation().now().state
}

#[test]
fn relative_places_are_those_of_their_axes() {
    let (r, v) = (Vector3::new(3.0, 100.0, -2.0), Vector3::new(0.01, -0.2, 0.03));
    let elements = Elements {
        a: 7e6,
        e: 0.01,
        inclination: 40_f64.to_radians(),
        node: 10_f64.to_radians(),
        argument_of_periapsis: 20_f64.to_radians(),
        mean_anomaly: Elements::mean_from_true_anomaly(30_f64.to_radians(), 0.01),
    };
    let (r_t, v_t) = elements.to_state(MU).unwrap();
    let close = |a: Vector3<f64>, b: Vector3<f64>, bound: f64| assert!((a - b).amax() < bound, "{a} and {b}");
    for axes in ["n", "inertial"] {
        let state = placed(axes, r.into(), v.into());
        assert_eq!((state.r_t, state.v_t), (r_t, v_t));
        // Rounding of 7e6 m and 7.5e3 m/s.
        close(state.r_tc(), r, 2e-9);
        close(state.v_tc(), v, 2e-12);
    }
    let dcm = frames::rtn(&r_t, &v_t);
    let still = placed("rtn", r.into(), v.into());
    close(dcm * still.r_tc(), r, 3e-9);
    close(dcm * still.v_tc(), v, 3e-12);
    // What LVLH says is what metrology measures, with the sign of chaser minus target.
    let turning = placed("lvlh", r.into(), v.into());
    let a_t = -turning.r_t * (MU / turning.r_t.norm().powi(3));
    let lvlh = Lvlh::new(&turning.r_t, &turning.v_t, &a_t);
    let (rho, rho_dot) = lvlh.relative(&turning.r_c, &turning.v_c);
    close(rho, -r, 3e-9);
    close(rho_dot, -v, 5e-12);
    assert!(
        (turning.v_tc() - still.v_tc()).norm() > 0.09,
        "n r = 1e-3 / s times 100 m"
    );
}

/// Beside a chaser whose orbit is given the axes are still those of the target.
#[test]
fn axes_are_those_of_the_target_whoever_has_the_orbit() {
    for axes in ["n", "rtn", "lvlh"] {
        let (r, v) = ([3e3, 1e5, -2e3], [0.1, -2.0, 0.3]);
        let one = placed(axes, r, v);
        let text = quiet(RADIO).split_once("[target.orbit]").unwrap().0.to_owned();
        let other = File::new(&format!(
            "{text}[chaser.orbit]\nstate = {{ r_m = {:?}, v_m_s = {:?} }}\n[target.relative]\naxes = \"{axes}\"\nr_tc_m = {r:?}\nv_tc_m_s = {v:?}\n{RADIO}",
            one.r_c.as_slice(),
            one.v_c.as_slice()
        ));
        let other = other.simulation().now().state;
        assert!((other.r_t - one.r_t).amax() < 1e-7, "{axes}: {}", other.r_t - one.r_t);
        assert!((other.v_t - one.v_t).amax() < 1e-10, "{axes}: {}", other.v_t - one.v_t);
    }
}

#[test]
fn relative_axes_of_the_three_body_problem() {
    // At rest in LVLH of the orbit about the Moon: seen there, the motion is none.
    let text = changed(
        "nrho_venting",
        &[
            (
                "[target]\n[target.relative]                # at rest to each other in inertial axes",
                "[target]\n[target.relative]",
            ),
            (
                "axes = \"inertial\"\nr_tc_m = [-2.0, -2.0, -2.0]",
                "axes = \"lvlh\"\nr_tc_m = [-2.0, -20.0, 2.0]",
            ),
            ("at = \"end\"\nstate", "at = \"start\"\nstate"),
            ("at = \"end\"\naxes", "at = \"start\"\naxes"),
        ],
    );
    let state = File::new(&text).simulation().now().state;
    let system = astro::Cr3bpSystem::EARTH_MOON;
    let at = |h: f64| {
        let moved = |r: &Vector3<f64>, v: &Vector3<f64>| {
            let a = system.acceleration(r, v);
            system.about_secondary(&(r + (v + a * (0.5 * h)) * h), &(v + a * h))
        };
        let ((r_t, v_t), (r_c, _)) = (moved(&state.r_t, &state.v_t), moved(&state.r_c, &state.v_c));
        // Inertial directions: N has turned by h / time.
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), h / system.time);
        let dcm = frames::rtn(&(turn * r_t), &(turn * v_t));
        dcm * (turn * (r_t - r_c))
    };
    assert!((at(0.0) - Vector3::new(-2.0, -20.0, 2.0)).amax() < 1e-6, "{}", at(0.0));
    let rate = (at(1.0) - at(-1.0)) / 2.0;
    assert!(rate.amax() < 1e-6, "{rate}: at rest but for rounding of 1e-7 m");
}

/// A burn of 2 s at 0.5 m/s2, written with these keys, and nothing else.
fn burnt(keys: &str, t: f64) -> (Vehicles, Vehicles) {
    let burn = format!("[[burn]]\nname = \"b\"\nstart_s = 10.0\nduration_s = 2.0\nacceleration_m_s2 = 0.5\n{keys}\n");
    let at = |text: &str| {
        let mut run = File::new(text).simulation();
        advance(&mut run, t);
        run.now().state
    };
    (at(&quiet(RADIO)), at(&quiet(&format!("{burn}{RADIO}"))))
}

#[test]
fn burns_act_on_their_vehicle_along_their_axes() {
    // Turning with the orbit by 1e-3 rad in 1 s, and gravity of the displacement.
    let bound = 3e-3;
    for (vehicle, other) in [("chaser", "target"), ("target", "chaser")] {
        let pick = |name: &str, s: &Vehicles| {
            if name == "chaser" {
                (s.r_c, s.v_c)
            } else {
                (s.r_t, s.v_t)
            }
        };
        for (axes, direction) in [
            ("n", [0.0, 3.0, 4.0]),
            ("inertial", [1.0, 0.0, 0.0]),
            ("rtn", [0.0, 1.0, 0.0]),
            ("body", [0.0, -2.0, 0.0]),
        ] {
            let keys = format!("vehicle = \"{vehicle}\"\naxes = \"{axes}\"\ndirection = {direction:?}");
            let (quiet, burnt) = burnt(&keys, 12.0);
            assert_eq!(pick(other, &quiet), pick(other, &burnt));
            let (r, v) = pick(vehicle, &quiet);
            let gained = pick(vehicle, &burnt).1 - v;
            let along = Vector3::from(direction).normalize();
            let expected = match axes {
                "rtn" => frames::rtn(&r, &v).tr_mul(&along),
                // Body y looks at the other vehicle.
                "body" => (r - pick(other, &quiet).0).normalize(),
                _ => along,
            };
            assert!(
                (gained - expected).norm() < bound,
                "{vehicle} {axes}: {gained} and {expected}"
            );
            assert!((gained.norm() - 1.0).abs() < 1e-4, "{vehicle} {axes}: {gained}");
        }
    }
}

/// A mission of the quiet orbit that says where it ends.
fn ending(burn: &str) -> Simulation {
    let text = quiet(&format!("{burn}\n{RADIO}"))
        .replace("[target.orbit]", "[target.orbit]\nat = \"end\"")
        .replace("[chaser.relative]", "[chaser.relative]\nat = \"end\"");
    let mut run = File::new(&text).simulation();
    advance(&mut run, 600.0);
    run
}

#[test]
fn burns_take_part_in_finding_the_start_or_not() {
    let burn = |keys: &str| {
        format!(
            "[[burn]]\nname = \"b\"\nstart_s = 100.0\nduration_s = 3.0\nacceleration_m_s2 = 0.01\ndirection = [0, 1, 0]\n{keys}"
        )
    };
    let goal = ending("").now().state;
    let missed = |keys: &str| (ending(&burn(keys)).now().state.r_tc() - goal.r_tc()).norm();
    // 0.03 m/s over 500 s are some 15 m; coming back is a matter of rounding.
    for (keys, hit) in [
        ("vehicle = \"chaser\"", true),
        ("vehicle = \"chaser\"\nback_propagated = false", false),
        ("vehicle = \"target\"", false),
        ("vehicle = \"target\"\nback_propagated = true", true),
        ("vehicle = \"target\"\ntold = true", false),
    ] {
        let distance = missed(keys);
        assert!(
            if hit {
                distance < 1e-5
            } else {
                (10.0..20.0).contains(&distance)
            },
            "{keys}: {distance}"
        );
    }
}

#[test]
fn told_burns_are_told_to_the_filter_and_fly_alike() {
    let of = |told: bool| {
        let burn = format!(
            "[[burn]]\nvehicle = \"target\"\nname = \"b\"\nstart_s = 100.0\nduration_s = 3.0\nacceleration_m_s2 = 0.01\ndirection = [0, 1, 0]\ntold = {told}"
        );
        let file = File::new(&quiet(&format!("{burn}\n{RADIO}")));
        let mission = interface::mission::Mission::read(file.params().choice.mission_file.as_ref()).unwrap();
        let mut run = file.simulation();
        advance(&mut run, 200.0);
        (mission.navigation().told.len(), *run.now(), *run.sample())
    };
    let (told, silent) = (of(true), of(false));
    assert_eq!((told.0, silent.0), (1, 0));
    // But for what is said of it to whom.
    let given = silent.2.untold;
    let sample = SensorSample {
        untold: given,
        ..told.2
    };
    assert_eq!((told.1, sample), (silent.1, silent.2));
    assert_eq!(told.2.untold, Untold::default());
    assert!(
        (given.dv_t_n - Vector3::new(0.0, 0.03, 0.0)).amax() < 1e-15 && given.event_time == 3.0,
        "{given:?}"
    );
}

#[test]
fn guidance_can_be_switched_off_and_leaves_burns_of_the_target() {
    let burn = |vehicle: &str| {
        format!(
            "[[burn]]\nvehicle = \"{vehicle}\"\nname = \"{vehicle}\"\nstart_s = 5.0\nduration_s = 3.0\nacceleration_m_s2 = 0.1\ndirection = [0, 1, 0]\n"
        )
    };
    let file = File::new(&quiet(&format!("{}{}{RADIO}", burn("chaser"), burn("target"))));
    let only_target = File::new(&quiet(&format!("{}{RADIO}", burn("target"))));
    let mut off = file.params();
    off.burn_enabled = false;
    let at = |params: &Params| {
        let mut run = start(params);
        advance(&mut run, 30.0);
        run.now().state
    };
    assert_eq!(at(&off), at(&only_target.params()));
    assert_ne!(at(&off), at(&file.params()));
}

/// Vents of each profile on grids that do not fit them: the target gains the integral of the profile.
#[test]
fn profiles_keep_their_momentum_on_any_grid() {
    for (profile, impulse) in [
        ("\"on_off\"", 7.3),
        ("{ decay_s = 3.0 }", 3.0 * (1.0 - f64::exp(-7.3 / 3.0))),
        ("{ ramp_s = 2.0 }", 5.3),
    ] {
        for grid in ["1.0", "0.7", "0.25"] {
            let vent = format!(
                "[[vent]]\nname = \"v\"\nfirst_s = 10.37\nduration_s = 7.3\nmagnitude_m_s2 = 1e-3\ndirection_body = [0, 0, -1]\nprofile = {profile}\n"
            );
            let text = quiet(&format!("{vent}{RADIO}")).replace("grid_s = 1.0", &format!("grid_s = {grid}"));
            let text = text.replace("[target.orbit]", "[target]\nattitude = \"inertial\"\n[target.orbit]");
            let calm = text.replace("magnitude_m_s2 = 1e-3", "magnitude_m_s2 = 0.0");
            let at = |text: &str| {
                let mut run = File::new(text).simulation();
                advance(&mut run, 21.0);
                run.now().state.v_t
            };
            let gained = at(&text) - at(&calm);
            // Gravity gradient 1e-6 / s2 of centimetres.
            assert!(
                (gained + Vector3::z() * (impulse * 1e-3)).amax() < 3e-7,
                "{profile} {grid}: {gained}"
            );
        }
    }
}

#[test]
fn vehicles_point_as_their_mission_says() {
    let dcm = |attitude: &str, t: f64| {
        let text = quiet(RADIO).replace(
            "[chaser.relative]",
            &format!("[chaser]\nattitude = {attitude}\n[chaser.relative]"),
        );
        let mut run = File::new(&text).simulation();
        advance(&mut run, t);
        let state = run.now().state;
        (run.sample().dcm_bc_n, state)
    };
    let (sight, state) = dcm("\"line_of_sight\"", 300.0);
    assert!((sight * state.r_tc().normalize() - Vector3::y()).amax() < 1e-12);
    let (rtn, state) = dcm("\"rtn\"", 300.0);
    assert!((rtn * state.r_c.normalize() - Vector3::x()).amax() < 1e-12);
    assert!((rtn * state.r_c.cross(&state.v_c).normalize() - Vector3::z()).amax() < 1e-12);
    assert_eq!(dcm("\"inertial\"", 300.0).0, nalgebra::Matrix3::identity());
    // 0.3 deg/s about body x: a right angle in 300 s, when body y lies on inertial z.
    let spun = dcm("{ spin_deg_s = [0.3, 0, 0] }", 300.0).0;
    assert!((spun * Vector3::z() - Vector3::y()).amax() < 1e-12, "{spun}");
}

#[test]
fn a_mission_file_stands_for_the_scenario() {
    for (ordinal, entry) in scenarios() {
        let file = File::new(entry.text);
        let (mut named, mut read) = (start(&Params::of_scenario(ordinal)), file.simulation());
        for t in [0.5, 20.0] {
            advance(&mut named, t);
            advance(&mut read, t);
        }
        assert_eq!(named, read, "{}", entry.name);
        assert_eq!(read.mission(), entry.name);
    }
    let mut forces = Params::of_scenario(3);
    forces.formation_forces = truth::Forces::J2;
    let file = File::new(embedded("formation_j2").unwrap().text);
    let (mut set, mut read) = (start(&forces), file.simulation());
    advance(&mut set, 20.0);
    advance(&mut read, 20.0);
    assert_eq!((set.now(), set.sample()), (read.now(), read.sample()));
}

#[test]
fn files_that_cannot_be_used_are_named_with_their_place() {
    let refused = |params: &Params| {
        Simulation::new(params, 0.0, &truth::Inputs::default())
            .unwrap_err()
            .to_string()
    };
    let none = refused(&Params::of_file("no/such/mission.toml"));
    assert!(
        none.contains("no/such/mission.toml") && none.contains("cannot be read"),
        "{none}"
    );
    let slip = File::new(&quiet(RADIO).replace("duration_s = 600.0", "duration = 600.0"));
    let error = refused(&slip.params());
    assert!(
        error.contains("mission.toml:5:1:") && error.contains("unknown key `duration`"),
        "{error}"
    );
    // A coefficient file: missing, malformed, and too short for what is asked.
    let field = |degree: &str| {
        quiet(RADIO).replace(
            "gravity = { model = \"two_body\", mu_m3_s2 = 3.986e14, radius_m = 6.378e6 }",
            &format!("rotation = {{ rate_deg_s = 0.004 }}\ngravity = {{ model = \"harmonics\", file = \"field.csv\"{degree} }}"),
        )
    };
    let error = refused(&File::new(&field("")).params());
    assert!(error.contains("field.csv"), "{error}");
    let good = "mu_m3_s2 = 3.986e14\nradius_m = 6.378e6\ndegree,order,c,s\n2,0,-4.84e-4,0\n2,1,0,0\n2,2,2e-6,1e-6\n";
    let broken = good.replace("2,1,0,0", "2,1,zero,0");
    let error = refused(&File::new(&field("")).beside("field.csv", &broken).params());
    assert!(error.contains("field.csv:5:5") && error.contains("\"zero\""), "{error}");
    let error = refused(&File::new(&field(", degree = 4")).beside("field.csv", good).params());
    assert!(error.contains("field.csv"), "{error}");
    let whole = File::new(&field("")).beside("field.csv", good);
    advance(&mut whole.simulation(), 10.0);
}

/// The largest difference of relative position over a run on the mission's grid and on half of it, m.
fn cut_in_half(text: &str, grid: f64) -> f64 {
    let key = |g: f64| format!("grid_s = {g:?}");
    assert!(text.contains(&key(grid)));
    let half = text.replacen(&key(grid), &key(grid / 2.0), 1);
    let (coarse, fine) = (File::new(text), File::new(&half));
    let duration = interface::mission::Mission::read(coarse.params().choice.mission_file.as_ref())
        .unwrap()
        .time
        .duration_s;
    let (mut coarse, mut fine) = (coarse.simulation(), fine.simulation());
    let mut worst = 0.0_f64;
    let mut t = 0.0;
    while t < duration {
        t += 10.0 * grid;
        advance(&mut coarse, t);
        advance(&mut fine, t);
        worst = worst.max((coarse.now().state.r_tc() - fine.now().state.r_tc()).norm());
    }
    worst
}

const ELLIPTIC: &str = r#"
mission = 1
name = "elliptic"
[time]
duration_s = 40000.0
grid_s = 2.0
[environment]
gravity = { model = "zonal", mu_m3_s2 = 3.986004418e14, radius_m = 6378137.0, j = [1.08263e-3, -2.532e-6] }
[target.orbit]
elements = { a_m = 24.4e6, e = 0.725, i_deg = 63.4, raan_deg = 30.0, argp_deg = 270.0, true_anomaly_deg = 200.0 }
[chaser.relative]
axes = "lvlh"
r_tc_m = [0.0, 2000.0, 0.0]
[[vent]]
name = "water"
first_s = 3601.3
count = 4
period_s = 9000.0
duration_s = 60.5
magnitude_m_s2 = 2e-5
direction_body = [1, 1, 0]
profile = { decay_s = 20.0 }
[sensors.lidar]
period_s = 10.0
"#;

#[test]
fn half_the_grid_moves_nothing_by_a_millimetre() {
    for entry in EMBEDDED {
        let grid = entry.mission().unwrap().time.grid_s;
        let moved = cut_in_half(entry.text, grid);
        assert!(moved < 1e-3, "{}: {moved} m", entry.name);
    }
    // Through a perigee 330 km above the ground, over more than a revolution.
    let moved = cut_in_half(ELLIPTIC, 2.0);
    assert!(moved < 1e-3, "elliptic: {moved} m");
}
