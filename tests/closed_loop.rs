//! What a loop is closed with, through the FMUs: momentum of commands, and estimates that hold when they are used.
//!
//! The tables of `docs/closed_loop.md` are what is measured here; `UPDATE_EXPECT=1 cargo test --release --test closed_loop` rewrites them.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper is a failed test"
)]
#![allow(clippy::print_stdout, reason = "what is measured is shown with --nocapture")]
#![allow(clippy::float_cmp, reason = "what is handed on is handed on to the bit")]

mod common;

use common::fmi::{FROM_ZERO, bits, get, initialise, set, step};
use common::fmu;
use expect_test::expect_file;
use fmi2_import::{Causality, Fmu, Instance, Value};
use numerics::{Generator, Source, stream};
use rand::Rng;
use std::sync::{Mutex, PoisonError};

const SCENARIOS: [&str; 3] = ["leo_venting", "nrho_venting", "formation"];

fn real(instance: &mut Instance, name: &str) -> f64 {
    match get(instance, name) {
        Value::Real(value) => value,
        other => panic!("{name} is {other:?}"),
    }
}

fn vector(instance: &mut Instance, name: &str) -> [f64; 3] {
    [1, 2, 3].map(|i| real(instance, &format!("{name}[{i}]")))
}

fn push(instance: &mut Instance, name: &str, a: [f64; 3]) {
    for (i, value) in (1..).zip(a) {
        set(instance, &format!("{name}[{i}]"), &Value::Real(value)).unwrap();
    }
}

fn started(fmu: &Fmu, parameters: &[(&str, &str)]) -> Instance {
    let mut instance = fmu.instantiate("loop", false).unwrap();
    let parameters: Vec<_> = parameters
        .iter()
        .map(|(n, v)| ((*n).to_owned(), (*v).to_owned()))
        .collect();
    initialise(&mut instance, &parameters, &FROM_ZERO);
    instance
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Holds the table between two marks of the document to what was measured.
fn documented(mark: &str, heads: &[&str], rows: &[String]) {
    // Tests of other tables may rewrite the document at the same time.
    static DOCUMENT: Mutex<()> = Mutex::new(());
    let _guard = DOCUMENT.lock().unwrap_or_else(PoisonError::into_inner);
    let text = std::fs::read_to_string(common::root().join("docs/closed_loop.md")).unwrap();
    let (begin, end) = (format!("<!-- {mark}: begin -->\n"), format!("<!-- {mark}: end -->"));
    let (before, rest) = text.split_once(&begin).unwrap();
    let (_, after) = rest.split_once(&end).unwrap();
    let head = format!("| {} |\n|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    let table = format!("{head}{}", rows.concat());
    println!("{table}");
    expect_file!["../docs/closed_loop.md"].assert_eq(&format!("{before}{begin}{table}{end}{after}"));
}

/// A pulse of 30 % a second, for ten seconds: whatever its phase and the step, a communication point at each of its edges.
#[test]
fn a_modulated_thrust_has_its_momentum() {
    let truth = Fmu::open(fmu("fmu-truth")).unwrap();
    // On a grid of 0.025 s.
    let edge = |time: f64| (time / 0.025).round() as i64;
    let mut rows = Vec::new();
    for scenario in SCENARIOS {
        let flown = |width: f64, phase: f64, stride: f64| {
            let quiet = [("scenario", scenario), ("vent.scale", "0")];
            let mut world = started(&truth, &quiet);
            let on = |k: i64| (k - edge(phase)).rem_euclid(40) < edge(width) && k < 400;
            let mut k = 0;
            while k < 440 {
                let mut to = k + 1;
                while to < 440 && to % edge(stride) != 0 && on(to) == on(k) {
                    to += 1;
                }
                push(&mut world, "a_cmd_c_n", [if on(k) { 1e-2 } else { 0.0 }, 0.0, 0.0]);
                step(&mut world, 0.025 * k as f64, 0.025 * (to - k) as f64);
                k = to;
            }
            vector(&mut world, "truth.v_c_n")[0]
        };
        let free = flown(0.0, 0.0, 1.0);
        for stride in [0.025, 0.25, 1.0] {
            let shares = [0, 1, 2, 3, 4, 5, 6, 7].map(|eighth| {
                let gained = flown(0.3, 0.125 * f64::from(eighth), stride) - free;
                gained / 0.03
            });
            rows.push(format!(
                "| `{scenario}` | {stride} | {} |\n",
                shares.map(|s| format!("{s:.6}")).join(" | ")
            ));
            // Gravity turns the 0.15 m gained into 1e-6 m/s.
            assert!(
                shares.iter().all(|share| (share - 1.0).abs() < 1e-4),
                "{scenario}, {stride} s"
            );
        }
    }
    let phases = [0, 1, 2, 3, 4, 5, 6, 7].map(|eighth| format!("{} s", 0.125 * f64::from(eighth)));
    let mut heads = vec!["mission", "step [s]"];
    heads.extend(phases.iter().map(String::as_str));
    documented("momentum", &heads, &rows);
}

/// The same sequence of time and value is the same run, bit for bit, and in other steps the same to 1e-9 m.
#[test]
fn a_commanded_run_depends_on_its_commands_alone() {
    let truth = Fmu::open(fmu("fmu-truth")).unwrap();
    let outputs = common::fmi::names(&truth, &[Causality::Output]);
    for scenario in SCENARIOS {
        // Commands on a grid of 0.25 s, each with some of the inputs.
        let fly = |steps: [f64; 4]| {
            let mut draw: Generator = stream(5, 1, Source::Lidar);
            let mut world = started(&truth, &[("scenario", scenario), ("run", "2")]);
            let mut at_the_commands = Vec::new();
            for k in 0..200 {
                let mut one = || 1e-3 * (draw.next_u32() as f64 / f64::from(u32::MAX) - 0.5);
                push(&mut world, "a_cmd_c_n", [one(), one(), one()]);
                push(&mut world, "a_dist_t_n", [one(), 0.0, one()]);
                push(&mut world, "f_dist_t_bt", [one(), one(), 0.0]);
                if k % 50 == 0 {
                    push(&mut world, "impulse_c_n", [one(), one(), one()]);
                    set(&mut world, "impulse_count", &Value::Integer(k / 50)).unwrap();
                }
                let mut t = 0.25 * f64::from(k);
                for h in steps.into_iter().filter(|h| *h > 0.0) {
                    step(&mut world, t, h);
                    t += h;
                }
                at_the_commands.push((bits(&mut world, &outputs), vector(&mut world, "truth.r_tc_n")));
            }
            at_the_commands
        };
        let once = fly([0.25, 0.0, 0.0, 0.0]);
        assert_eq!(once, fly([0.25, 0.0, 0.0, 0.0]), "{scenario}");
        let parts = fly([0.0625; 4]);
        let worst = (once.iter().zip(&parts))
            .map(|((_, a), (_, b))| distance(*a, *b))
            .fold(0.0, f64::max);
        println!("{scenario}: in steps of 0.25 s and 0.0625 s the relative position differs by {worst:.1e} m at most");
        assert!(worst < 1e-9, "{scenario}: {worst}");
    }
}

/// Both FMUs, coupled by equal names.
struct Loop {
    truth: Instance,
    nav: Instance,
    wires: Vec<String>,
    jacobi: bool,
}

impl Loop {
    fn new(scenario: &str, filter: &str, jacobi: bool, more: &[(&str, &str)]) -> Self {
        let (truth, nav) = (Fmu::open(fmu("fmu-truth")).unwrap(), Fmu::open(fmu("fmu-nav")).unwrap());
        let outputs = common::fmi::names(&truth, &[Causality::Output]);
        let wires = common::fmi::names(&nav, &[Causality::Input]);
        let of_the_world = |name: &String| outputs.contains(name) && !name.starts_with("truth.");
        Self {
            wires: wires.into_iter().filter(of_the_world).collect(),
            truth: started(&truth, &[&[("scenario", scenario), ("run", "4")], more].concat()),
            nav: started(&nav, &[("scenario", scenario), ("filter", filter)]),
            jacobi,
        }
    }

    fn hand_over(&mut self) {
        for name in &self.wires {
            let value = get(&mut self.truth, name);
            set(&mut self.nav, name, &value).unwrap();
        }
    }

    fn step(&mut self, t: f64, h: f64) {
        if self.jacobi {
            self.hand_over();
        }
        step(&mut self.truth, t, h);
        if !self.jacobi {
            self.hand_over();
        }
        step(&mut self.nav, t, h);
    }
}

/// What guidance sees of the relative position at the time at which it uses it, from 300 to 1500 s: the root mean square of the error of
/// `est.*` and of `pred.*` in metres, and what the filter's own error is at its samples.
fn control_error(scenario: &str, jacobi: bool, h: f64, told: bool) -> [f64; 3] {
    let mut of = Loop::new(scenario, "snc", jacobi, &[("guidance.burn_enabled", "false")]);
    let mut sums = [0.0; 3];
    let (mut count, mut used, mut path) = (0.0, 0, Vec::new());
    let steps = (1500.0 / h).round() as i64;
    for k in 0..steps {
        let t = h * k as f64;
        // A thrust that is on for 3 s in 20, which an accelerometer says late; in formation to and fro, so that the chaser stays near.
        let (turn, within) = ((t / 20.0) as i64, k % (20.0 / h) as i64);
        let away = scenario == "formation" && !matches!(turn % 4, 0 | 3);
        let a = match (within * 4 < (12.0 / h) as i64, away) {
            (false, _) => 0.0,
            (true, false) => 5e-3,
            (true, true) => -5e-3,
        };
        push(&mut of.truth, "a_cmd_c_n", [0.0, a, 0.0]);
        if told {
            push(&mut of.nav, "a_cmd_c_n", [0.0, a, 0.0]);
        }
        of.step(t, h);
        let true_now = vector(&mut of.truth, "truth.r_tc_n");
        path.push(true_now);
        if t + h < 300.0 {
            continue;
        }
        assert!((real(&mut of.nav, "pred.time") - (t + h)).abs() < 1e-9);
        count += 1.0;
        sums[0] += distance(vector(&mut of.nav, "est.r_tc_n"), true_now).powi(2);
        sums[1] += distance(vector(&mut of.nav, "pred.r_tc_n"), true_now).powi(2);
        let epoch = real(&mut of.nav, "est.time");
        let then = path[(epoch / h).round() as usize - 1];
        sums[2] += distance(vector(&mut of.nav, "est.r_tc_n"), then).powi(2);
        used += 1;
    }
    assert!(used > 1000);
    sums.map(|sum: f64| (sum / count).sqrt())
}

#[test]
fn predictions_hold_when_guidance_uses_them() {
    let mut rows = Vec::new();
    for (scenario, late) in [("leo_venting", 3.0), ("nrho_venting", 3.0), ("formation", 5.0)] {
        for jacobi in [true, false] {
            for h in [1.0, 0.25] {
                let [est, untold, own_untold] = control_error(scenario, jacobi, h, false);
                let [_, pred, own] = control_error(scenario, jacobi, h, true);
                let scheme = if jacobi { "Jacobi" } else { "Gauss-Seidel" };
                rows.push(format!(
                    "| `{scenario}` | {scheme} | {h} | {est:.5} | {untold:.5} | {pred:.5} | {own:.5} |\n"
                ));
                // No worse than the filter itself.
                assert!(pred < 1.15 * own, "{scenario}, {scheme}, {h} s: {pred} of {own}");
                // Where nothing feels the thrust, one who is not told is worse. What telling is worth elsewhere has a test of its own.
                let felt = scenario != "formation";
                assert!(felt || untold > 2.0 * own, "{scheme}, {h} s: {untold} of {own}");
                assert!(
                    own < 1.05 * own_untold,
                    "{scenario}, {scheme}, {h} s: {own} of {own_untold}"
                );
                if jacobi {
                    assert!(est > late * pred, "{scenario}, {h} s: {est} of {pred}");
                }
            }
        }
    }
    let heads = [
        "mission",
        "master",
        "step [s]",
        "`est`, before [m]",
        "`pred`, untold [m]",
        "`pred`, told [m]",
        "own [m]",
    ];
    documented("errors", &heads, &rows);
}

/// What is done to a chaser, axes N.
#[derive(Clone, Copy, Debug)]
enum Order {
    Nothing,
    /// Acceleration between two times, m/s2 and s.
    Push([f64; 3], f64, f64),
    /// Change of velocity, m/s, at a time, s.
    Impulse([f64; 3], f64),
}

/// Predicted less true relative velocity at the end of each step, m/s.
fn flown(mission: &str, jacobi: bool, h: f64, until: f64, order: Order, told: bool) -> Vec<[f64; 3]> {
    // Noise stands in axes of the chaser, which turn with where its target moves to.
    let mut world = vec![("mission_file", mission), ("accelerometer.sigma", "0")];
    world.extend(if mission == "formation" {
        [("metrology.sigma_position", "0"), ("metrology.sigma_velocity", "0")]
    } else {
        [("lidar.sigma_range", "0"), ("lidar.sigma_angle", "0")]
    });
    let mut of = Loop::new("leo_venting", "snc", jacobi, &world);
    let nav = Fmu::open(fmu("fmu-nav")).unwrap();
    of.nav = started(&nav, &[("mission_file", mission), ("filter", "snc")]);
    let mut errors = Vec::new();
    for k in 0..(until / h).round() as i64 {
        let t = h * k as f64;
        let at = |time: f64| (t - time).abs() < 1e-6;
        let mut heard = vec![&mut of.truth];
        heard.extend(told.then_some(&mut of.nav));
        for instance in heard {
            match order {
                Order::Push(a, from, _) if at(from) => push(instance, "a_cmd_c_n", a),
                Order::Push(_, _, to) if at(to) => push(instance, "a_cmd_c_n", [0.0; 3]),
                Order::Impulse(dv, time) if at(time) => {
                    push(instance, "impulse_c_n", dv);
                    set(instance, "impulse_count", &Value::Integer(1)).unwrap();
                }
                _ => (),
            }
        }
        of.step(t, h);
        let (pred, truth) = (
            vector(&mut of.nav, "pred.v_tc_n"),
            vector(&mut of.truth, "truth.v_tc_n"),
        );
        errors.push([0, 1, 2].map(|i| pred[i] - truth[i]));
    }
    errors
}

/// Whatever the accelerometer reads and whenever sensors sample: a command that is told moves no prediction, and one that is not told
/// does.
#[test]
fn a_command_that_is_told_moves_no_prediction() {
    println!("prediction of velocity moved by at most, over the change that was commanded: told, untold");
    for (mission, h, begin) in [
        ("leo_venting", 1.0, 100.0),
        ("leo_venting", 0.25, 100.0),
        ("nrho_venting", 1.0, 100.0),
        ("formation", 1.0, 100.0),
        ("elliptic_rendezvous", 1.0, 604.0),
        ("fast_approach", 0.2, 60.0),
        ("fast_approach", 1.0, 60.0),
    ] {
        for jacobi in [true, false] {
            let pulse = Order::Push([1e-2, 0.0, -5e-3], begin, begin + 2.0);
            let impulse = Order::Impulse([0.0, 0.02, 0.01], begin + 1.0);
            for (order, dv) in [(pulse, 2.0 * 0.011_180_34), (impulse, 0.022_360_68)] {
                let by = |order: Order, told: bool| flown(mission, jacobi, h, begin + 17.0, order, told);
                let free = by(Order::Nothing, true);
                let moved = |told: bool| {
                    let pairs = by(order, told);
                    pairs
                        .iter()
                        .zip(&free)
                        .map(|(a, b)| distance(*a, *b))
                        .fold(0.0, f64::max)
                        / dv
                };
                let (told, untold) = (moved(true), moved(false));
                let scheme = if jacobi { "Jacobi" } else { "Gauss-Seidel" };
                println!("{mission:20} {scheme:12} {h:4}  {order:?}: {told:.1e} {untold:.1e}");
                assert!(told < 0.01, "{mission}, {scheme}, {h} s, {order:?}: {told}");
                // A mean that comes with each step tells all of an acceleration itself.
                let itself = mission == "fast_approach" && !jacobi && matches!(order, Order::Push(..));
                assert!(
                    itself || untold > 0.02,
                    "{mission}, {scheme}, {h} s, {order:?}: {untold}"
                );
            }
        }
    }
}

/// A burn that the filter is told of and that is switched off is in nobody's way; where it acts, the filter reckons with it.
#[test]
fn a_burn_that_is_switched_off_is_switched_off_in_the_filter_too() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("told.toml");
    let formation = include_str!("../missions/formation.toml");
    let burn = "[[burn]]\nname = \"away\"\nstart_s = 60.0\nduration_s = 10.0\nacceleration_m_s2 = 1.0e-3\n\
                direction = [0.0, 1.0, 0.0]\naxes = \"rtn\"\ntold = true\n";
    let (head, tail) = formation.split_once("[sensors.metrology]").unwrap();
    std::fs::write(&file, format!("{head}{burn}[sensors.metrology]{tail}")).unwrap();
    let file = file.display().to_string();
    let worst = |acts: &str, told: &str| {
        let mission = ("mission_file", file.as_str());
        let burns = |enabled| ("guidance.burn_enabled", enabled);
        let mut of = Loop::new("formation", "snc", false, &[mission, burns(acts)]);
        let nav = Fmu::open(fmu("fmu-nav")).unwrap();
        of.nav = started(&nav, &[mission, ("filter", "snc"), burns(told)]);
        let mut worst: f64 = 0.0;
        for k in 0..100 {
            of.step(f64::from(k), 1.0);
            let [est, truth] = [
                vector(&mut of.nav, "est.rho_dot_lvlh"),
                vector(&mut of.truth, "truth.rho_dot_lvlh"),
            ];
            if k >= 60 {
                worst = worst.max(distance(est, truth));
            }
        }
        worst
    };
    let (both, neither, odd) = (worst("true", "true"), worst("false", "false"), worst("false", "true"));
    println!(
        "largest error of velocity, burns on, off, off in the world alone: {both:.1e}, {neither:.1e}, {odd:.1e} m/s"
    );
    assert!(both < 3e-4 && neither < 3e-4 && odd > 1e-3);
    // The harness tells both at once.
    let out = folder.path().join("study");
    common::harness_ok(&[
        "compare",
        "--mission",
        &file,
        "--filters",
        "snc",
        "--runs",
        "1",
        "--duration",
        "100",
        "--set",
        "fmu-truth.guidance.burn_enabled=false",
        "--out",
        &out.display().to_string(),
    ]);
    let manifest = std::fs::read_to_string(out.join("manifest.json")).unwrap();
    let told = manifest.matches("\"guidance.burn_enabled\": \"false\"").count();
    assert_eq!(told, 2, "world and filter: {manifest}");
}

/// Before the first sample the estimate is the initial one, from initialization on, and the prediction goes on from there.
#[test]
fn an_estimate_is_there_from_the_beginning() {
    for (scenario, filter) in [
        ("leo_venting", "fixed_q"),
        ("nrho_venting", "hybrid"),
        ("formation", "snc"),
    ] {
        let nav = Fmu::open(fmu("fmu-nav")).unwrap();
        let mut of = Loop::new(scenario, filter, false, &[("sample_period", "10")]);
        of.nav = nav.instantiate("late", false).unwrap();
        for (name, text) in [("scenario", scenario), ("filter", filter)] {
            let value = of.nav.description().variable(name).unwrap().parse_value(text).unwrap();
            set(&mut of.nav, name, &value).unwrap();
        }
        of.nav.setup_experiment(&FROM_ZERO).unwrap();
        of.nav.enter_initialization().unwrap();
        assert_eq!(vector(&mut of.nav, "est.r_tc_n"), [0.0; 3], "nothing is known yet");
        of.hand_over();
        let known = vector(&mut of.nav, "est.r_tc_n");
        let started_at = vector(&mut of.truth, "truth.r_tc_n");
        of.nav.exit_initialization().unwrap();
        assert_eq!(vector(&mut of.nav, "est.r_tc_n"), known);
        assert_eq!(vector(&mut of.nav, "pred.r_tc_n"), known);
        let init: Vec<f64> = (1..=6)
            .map(|i| real(&mut of.truth, &format!("nav_init.x[{i}]")))
            .collect();
        if scenario == "formation" {
            assert_eq!(vector(&mut of.nav, "est.rho_lvlh"), init[..3]);
        } else {
            assert_eq!(known, init[..3]);
        }
        // Within five of its own standard deviations.
        let sigma = real(&mut of.nav, "pred.sigma[1]");
        assert!(
            sigma > 0.0 && distance(known, started_at) < 5.0 * 3.0_f64.sqrt() * sigma,
            "{known:?}"
        );
        for k in 0..8 {
            of.step(f64::from(k), 1.0);
            assert_eq!(get(&mut of.nav, "est.count"), Value::Integer(0));
            assert_eq!(vector(&mut of.nav, "est.r_tc_n"), known);
        }
        let (predicted, truth) = (
            vector(&mut of.nav, "pred.r_tc_n"),
            vector(&mut of.truth, "truth.r_tc_n"),
        );
        let (drift, expected) = (distance(predicted, truth), distance(known, started_at));
        let speed = real(&mut of.nav, "pred.sigma[4]");
        assert!(
            drift < expected + 8.0 * 5.0 * speed + 1e-2,
            "{scenario}: {drift} m after {expected} m"
        );
    }
}

#[test]
fn numbers_stand_for_enumerations() {
    let fly = |truth_set: &[(&str, &str)], nav_set: &[(&str, &str)]| {
        let (truth, nav) = (Fmu::open(fmu("fmu-truth")).unwrap(), Fmu::open(fmu("fmu-nav")).unwrap());
        let outputs = common::fmi::names(&nav, &[Causality::Output]);
        let mut of = Loop::new("leo_venting", "fixed_q", false, &[]);
        (of.truth, of.nav) = (started(&truth, truth_set), started(&nav, nav_set));
        for k in 0..20 {
            of.step(f64::from(k), 1.0);
            assert_eq!(get(&mut of.nav, "status"), get(&mut of.nav, "status_index"));
        }
        bits(&mut of.nav, &outputs)
    };
    let named = fly(
        &[("scenario", "formation")],
        &[("scenario", "formation"), ("filter", "dmc")],
    );
    let filters = Fmu::open(fmu("fmu-nav")).unwrap();
    let items = filters
        .description()
        .variable("filter")
        .unwrap()
        .enumeration_items()
        .unwrap();
    let dmc = items.iter().find(|item| item.name == "dmc").unwrap().value.to_string();
    let numbered = fly(
        &[("scenario", "leo_venting"), ("scenario_index", "3")],
        &[("scenario_index", "3"), ("filter", "milton"), ("filter_index", &dmc)],
    );
    assert_eq!(named, numbered);
    for (name, what) in [
        ("fmu-truth", "scenario_index"),
        ("fmu-nav", "scenario_index"),
        ("fmu-nav", "filter_index"),
    ] {
        let mut instance = Fmu::open(fmu(name)).unwrap().instantiate("beyond", true).unwrap();
        set(&mut instance, what, &Value::Integer(99)).unwrap();
        instance.setup_experiment(&FROM_ZERO).unwrap();
        let error = instance.enter_initialization().unwrap_err().to_string();
        assert!(error.contains("99") && error.contains("1 ("), "{name}: {error}");
    }
}
