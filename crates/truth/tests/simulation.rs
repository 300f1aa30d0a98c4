//! Runs through the public interface: time grid and saved state of every world; inputs, samples and faults of the LEO
//! one.
// Bit equality is what is tested, and helpers outside of `#[test]` functions unwrap.
#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;

use common::{advance, numbered, samples, start, with};
use interface::Sensor;
use interface::mission::Embedded;
use nalgebra::Vector3;
use proptest::prelude::*;
use truth::{Inputs, Params, Simulation, TruthError};

fn noise_free() -> Params {
    with(
        &Params::default(),
        &[
            ("lidar.sigma_range", 0.0),
            ("lidar.sigma_angle", 0.0),
            ("accelerometer.sigma", 0.0),
            ("accelerometer.bias_sigma", 0.0),
        ],
    )
}

/// Inputs whose effects on the two vehicles can be told apart.
fn shove() -> Inputs {
    Inputs {
        a_cmd_c_n: Vector3::new(0.0, 1e-3, 0.0),
        a_dist_t_n: Vector3::new(0.0, 0.0, 2e-3),
        ..Inputs::default()
    }
}

/// Any of the missions of the enumeration.
fn scenario() -> impl Strategy<Value = i32> {
    1..=Embedded::scenarios().count() as i32
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn samples_do_not_depend_on_the_communication_points(
        steps in prop::collection::vec(
            prop_oneof![Just(1.0), Just(0.25), Just(0.1), Just(1e-16), Just(7.0), 1e-3..3.0_f64, 1e-9..1e-5_f64],
            1..300,
        ),
        period in prop_oneof![Just(1.0), Just(0.25), Just(0.3), Just(2.5), Just(0.1)],
        start_time in prop_oneof![Just(0.0), Just(-17.25), Just(1e5)],
        scenario in scenario(),
    ) {
        let params = with(&numbered(Params::of_scenario(scenario), 3), &[("sample_period", period), ("vent.scale", 1e3)]);
        let inputs = shove();
        let mut coarse = Simulation::new(&params, start_time, &inputs).unwrap();
        // A vent, where there are any, begins among the steps.
        let first_event = coarse.timeline().events().first().map_or(30.0, |event| event.start);
        let skip = start_time + first_event - 5.0;
        coarse.advance_to(skip, &inputs).unwrap();
        let mut reference = coarse.clone();
        let mut t = skip;
        for h in steps {
            t += h;
            coarse.advance_to(t, &inputs).unwrap();
            let seen = *coarse.sample();
            // The reference goes from sample to sample and stands on this one next.
            while reference.sample().count < seen.count {
                let next = start_time + (reference.sample().count + 1) as f64 * period;
                reference.advance_to(next, &inputs).unwrap();
            }
            prop_assert_eq!(&seen, reference.sample());
            prop_assert_eq!(seen.time, start_time + seen.count as f64 * period);
            prop_assert!(seen.time <= t + 2e-6 && t < seen.time + period + 2e-6, "{} at {}", seen.time, t);
        }
        // Back on a grid point both are the same world.
        let meet = start_time + (t - start_time).ceil() + 1.0;
        coarse.advance_to(meet, &inputs).unwrap();
        reference.advance_to(meet, &inputs).unwrap();
        prop_assert_eq!(coarse.now(), reference.now());
    }

    #[test]
    fn saved_runs_go_on_alike(
        before in 0.0..200.0_f64,
        steps in prop::collection::vec(0.01..3.0_f64, 1..50),
        scenario in scenario(),
    ) {
        let params = with(&Params::of_scenario(scenario), &[("vent.scale", 1e3), ("lidar.dropout_probability", 0.3), ("metrology.dropout_probability", 0.3)]);
        let inputs = shove();
        let mut run = start(&params);
        // Stops inside an interval, which the next step splits.
        run.advance_to(before, &inputs).unwrap();
        let mut copy = run.clone();
        let mut restored: Simulation = postcard::from_bytes(&postcard::to_stdvec(&run).unwrap()).unwrap();
        let mut t = before;
        for h in steps {
            t += h;
            for each in [&mut run, &mut copy, &mut restored] {
                each.advance_to(t, &Inputs::default()).unwrap();
            }
        }
        prop_assert_eq!(&run, &copy);
        prop_assert_eq!(&run, &restored);
    }
}

#[test]
fn state_between_grid_points_lies_on_the_path() {
    let mut run = start(&Params::default());
    let mut at = |t: f64| {
        advance(&mut run, t);
        run.now().state
    };
    let (a, between, b) = (at(40.0), at(40.3), at(41.0));
    // Cubic through both ends; its error is h^4 r''''/384 = 3e-8 m.
    let s = 0.3_f64;
    let cubic = a.r_t * (1.0 - 3.0 * s.powi(2) + 2.0 * s.powi(3))
        + b.r_t * (3.0 * s.powi(2) - 2.0 * s.powi(3))
        + a.v_t * (s - 2.0 * s.powi(2) + s.powi(3))
        + b.v_t * (s.powi(3) - s.powi(2));
    assert!((between.r_t - cubic).amax() < 1e-7, "{}", between.r_t - cubic);
}

#[test]
fn run_and_seed_select_the_world() {
    let base = Params::default();
    let of = |params: &Params| (start(params), samples(params, 1.0, 3));
    let (world, seen) = of(&base);
    assert_eq!((&world, &seen), (&of(&base).0, &of(&base).1));
    let (next, mut elsewhere) = (numbered(base.clone(), 1), base.clone());

    elsewhere.study_seed = 2;
    for other in [next, elsewhere] {
        let (other_world, other_seen) = of(&other);
        assert_ne!(world.timeline(), other_world.timeline());
        assert_ne!(world.now().state, other_world.now().state);
        assert!(
            world
                .initial_estimate()
                .iter()
                .zip(other_world.initial_estimate())
                .all(|(a, b)| a != b)
        );
        assert!(
            seen[2][Sensor::Lidar].z[0] != other_seen[2][Sensor::Lidar].z[0]
                && seen[2].accelerometer.alpha_c_bc != other_seen[2].accelerometer.alpha_c_bc
        );
    }
}

#[test]
fn nothing_is_measured_before_the_first_sample() {
    let mut run = start(&Params::default());
    assert_eq!(
        (run.sample().count, run.sample().time, run.sample()[Sensor::Lidar].valid),
        (0, 0.0, false)
    );
    assert_eq!(run.sample().accelerometer.alpha_c_bc, Vector3::zeros());
    advance(&mut run, 0.9);
    assert_eq!(run.sample().count, 0);
    advance(&mut run, 1.0);
    assert_eq!(
        (run.sample().count, run.sample().time, run.sample()[Sensor::Lidar].valid),
        (1, 1.0, true)
    );
}

#[test]
fn noise_free_sensors_tell_the_truth() {
    let mut run = start(&noise_free());
    for t in [1.0, 200.0, 5565.0, 5680.0] {
        advance(&mut run, t);
        let (now, sample) = (run.now(), run.sample());
        assert!((sample[Sensor::Lidar].z[0] - now.state.r_tc().norm()).abs() < 1e-9);
        assert!(sample[Sensor::Lidar].z[1].abs() + sample[Sensor::Lidar].z[2].abs() < 1e-12);
        // exp(-t / 3600 s) of the first bias.
        let bias = Vector3::repeat(2.943e-6 * f64::exp(-t / 3600.0));
        assert!((now.b_c_bc - bias).amax() < 1e-17);
        let burn = if (5560.0..5590.0).contains(&t) { 1e-2 } else { 0.0 };
        let along = Vector3::new(-1.0, -1.0, 0.0).normalize();
        let alpha_n = sample.dcm_bc_n.transpose() * (sample.accelerometer.alpha_c_bc - bias);
        assert!((alpha_n - along * burn).amax() < 1e-16, "{alpha_n} at {t} s");
    }
}

#[test]
fn readings_are_the_acceleration_just_after_the_epoch() {
    let mut run = start(&noise_free());
    let vent = run.timeline().events()[0];
    let mut alpha = |t: f64| {
        advance(&mut run, t);
        (
            run.sample().accelerometer.alpha_c_bc.norm() > 1e-3,
            run.now().a_t_n.norm() > 0.0,
        )
    };
    assert_eq!(alpha(vent.start - 1.0), (false, false));
    assert_eq!(alpha(vent.start), (false, true));
    assert_eq!(alpha(vent.start + 9.0), (false, true));
    assert_eq!(alpha(vent.start + 10.0), (false, false));
    assert_eq!(alpha(5559.0), (false, false));
    assert_eq!(alpha(5560.0), (true, false));
    assert_eq!(alpha(5589.0), (true, false));
    assert_eq!(alpha(5590.0), (false, false));
}

#[test]
fn noise_has_its_deviation_and_outliers_their_multiple() {
    let seconds = 3000.0;
    let clean = samples(&noise_free(), 1.0, seconds as u32);
    for (outlier_probability, scale) in [(0.0, 1.0), (1.0, 5.0)] {
        let params = with(
            &Params::default(),
            &[
                ("accelerometer.bias_sigma", 0.0),
                ("lidar.outlier_probability", outlier_probability),
                ("lidar.outlier_scale", 5.0),
            ],
        );
        let mut sums = [0.0; 6];
        let sigma_angle = 0.04_f64.to_radians();
        for (noisy, clean) in samples(&params, 1.0, seconds as u32).iter().zip(&clean) {
            let alpha = (noisy.accelerometer.alpha_c_bc - clean.accelerometer.alpha_c_bc) / 3.433e-6;
            let errors = [
                (noisy[Sensor::Lidar].z[0] - clean[Sensor::Lidar].z[0]) / (0.08 * scale),
                (noisy[Sensor::Lidar].z[1] - clean[Sensor::Lidar].z[1]) / (sigma_angle * scale),
                (noisy[Sensor::Lidar].z[2] - clean[Sensor::Lidar].z[2]) / (sigma_angle * scale),
                alpha.x,
                alpha.y,
                alpha.z,
            ];
            for (sum, error) in sums.iter_mut().zip(errors) {
                *sum += error * error / seconds;
            }
        }
        for (channel, variance) in sums.iter().enumerate() {
            // A mean of n squares of normal draws scatters by sqrt(2 / n).
            assert!(
                (variance - 1.0).abs() < 3.0 * (2.0 / seconds).sqrt(),
                "channel {channel}: {variance}"
            );
        }
    }
}

#[test]
fn one_fault_moves_no_other_draw() {
    let base = with(
        &Params::default(),
        &[("lidar.outlier_probability", 0.2), ("lidar.dropout_probability", 0.1)],
    );
    let seen = samples(&base, 1.0, 400);
    let changes = [
        with(&base, &[("lidar.dropout_probability", 0.0)]),
        with(&base, &[("lidar.outlier_probability", 0.0)]),
        with(&base, &[("accelerometer.sigma", 0.0)]),
        with(&base, &[("lidar.sigma_range", 0.0)]),
        with(&base, &[("accelerometer.bias_sigma", 0.0)]),
    ];
    let [no_dropouts, no_outliers, quiet_accelerometer, exact_range, steady_bias] =
        changes.map(|p| samples(&p, 1.0, 400));
    let mut counts = [0; 2];
    for (k, sample) in seen.iter().enumerate() {
        assert!(no_dropouts[k][Sensor::Lidar].valid);
        if sample[Sensor::Lidar].valid {
            assert_eq!(*sample, no_dropouts[k]);
        } else {
            counts[0] += 1;
            assert_eq!((sample.count, sample.time), (no_dropouts[k].count, no_dropouts[k].time));
            assert_eq!(sample.accelerometer.alpha_c_bc, no_dropouts[k].accelerometer.alpha_c_bc);
            let held = if k == 0 {
                Default::default()
            } else {
                seen[k - 1][Sensor::Lidar]
            };
            assert_eq!(sample[Sensor::Lidar].z[..2], held.z[..2]);
        }
        // An outlier changes its own sample and none after it.
        assert_eq!(sample[Sensor::Lidar].valid, no_outliers[k][Sensor::Lidar].valid);
        let outlier = sample[Sensor::Lidar].valid && sample[Sensor::Lidar] != no_outliers[k][Sensor::Lidar];
        if outlier {
            counts[1] += 1;
            assert!(
                sample[Sensor::Lidar].z[0] != no_outliers[k][Sensor::Lidar].z[0]
                    && sample[Sensor::Lidar].z[1] != no_outliers[k][Sensor::Lidar].z[1]
            );
        }
        assert_eq!(sample.accelerometer.alpha_c_bc, no_outliers[k].accelerometer.alpha_c_bc);
        assert_eq!(sample[Sensor::Lidar], quiet_accelerometer[k][Sensor::Lidar]);
        assert_eq!(sample[Sensor::Lidar].z[1], exact_range[k][Sensor::Lidar].z[1]);
        assert_eq!(sample.accelerometer.alpha_c_bc, exact_range[k].accelerometer.alpha_c_bc);
        assert_eq!(sample[Sensor::Lidar], steady_bias[k][Sensor::Lidar]);
    }
    // Binomial counts of 400 at 0.1, and of the 360 received at 0.2, within 3 sigma.
    assert!((22..=58).contains(&counts[0]), "{} dropouts", counts[0]);
    assert!((49..=95).contains(&counts[1]), "{} outliers", counts[1]);
}

#[test]
fn inputs_act_from_where_they_are_set() {
    let path = |switch: f64| {
        let mut run = start(&noise_free());
        advance(&mut run, 5.0);
        advance(&mut run, switch);
        run.advance_to(8.0, &shove()).unwrap();
        run.now().state
    };
    let free = {
        let mut run = start(&noise_free());
        advance(&mut run, 8.0);
        run.now().state
    };
    for switch in [5.0, 5.25, 6.0, 6.999, 7.0, 7.75] {
        let (pushed, seconds) = (path(switch), 8.0 - switch);
        // Gravity changes by 1e-6 / s2 times the few millimetres of displacement.
        let gained = (pushed.v_c - free.v_c, pushed.v_t - free.v_t);
        assert!(
            (gained.0 - shove().a_cmd_c_n * seconds).amax() < 1e-7,
            "{} from {switch} s",
            gained.0
        );
        assert!(
            (gained.1 - shove().a_dist_t_n * seconds).amax() < 1e-7,
            "{} from {switch} s",
            gained.1
        );
    }
}

/// 30 % of pulse width at any phase are 30 % of the momentum, in every world and in any communication step, and the same motion.
#[test]
fn a_pulse_has_its_momentum_at_any_phase_and_step() {
    let push = Inputs {
        a_cmd_c_n: Vector3::new(1e-2, 0.0, 0.0),
        ..Inputs::default()
    };
    for scenario in 1..=Embedded::scenarios().count() as i32 {
        let quiet = with(&Params::of_scenario(scenario), &[("vent.scale", 0.0)]);
        let flown = |width: f64, phase: f64, step: f64| {
            let mut run = start(&quiet);
            advance(&mut run, 2.0);
            // Ten periods of a second, all edges on a grid of 0.025 s.
            let edge = |time: f64| (time / 0.025).round() as i64;
            let stride = edge(step);
            let on = |k: i64| (k - edge(phase)).rem_euclid(40) < edge(width) && k < 400;
            let mut k = 0;
            while k < 440 {
                // As far as nothing changes, in steps of the master's; a change is a communication point.
                let mut to = k + 1;
                while to < 440 && to % stride != 0 && on(to) == on(k) {
                    to += 1;
                }
                let inputs = if on(k) { push } else { Inputs::default() };
                run.advance_to(2.0 + 0.025 * to as f64, &inputs).unwrap();
                k = to;
            }
            run.now().state
        };
        let free = flown(0.0, 0.0, 1.0);
        let gain = |state: &truth::Vehicles| (state.v_c - free.v_c).x;
        for step in [0.025, 0.25, 1.0] {
            for phase in (0..8).map(|i| 0.125 * f64::from(i)) {
                // Pulses within the ten seconds: those that begin before their end, and the rest of one that began before them.
                let state = flown(0.3, phase, step);
                // Gravity turns 0.15 m of displacement into 1e-6 m/s.
                assert!(
                    (gain(&state) / 0.03 - 1.0).abs() < 1e-4,
                    "{scenario}, step {step}, phase {phase}: {}",
                    gain(&state)
                );
                let fine = flown(0.3, phase, 0.025);
                assert!((state.r_c - fine.r_c).amax() < 1e-8 && (state.v_c - fine.v_c).amax() < 1e-9);
            }
        }
    }
    // The pulse [2.25, 2.75) s of 1e-2 m/s2 in steps of 0.25 s.
    let mut run = start(&noise_free());
    let mut free = run.clone();
    for k in 1..=16 {
        let on = k == 10 || k == 11;
        run.advance_to(0.25 * f64::from(k), &if on { push } else { Inputs::default() })
            .unwrap();
    }
    advance(&mut free, 4.0);
    let gained = (run.now().state.v_c - free.now().state.v_c).x;
    assert!((gained - 0.005).abs() < 1e-7, "{gained}");
}

#[test]
fn an_impulse_acts_once_and_at_once() {
    let fire = |count: i32| Inputs {
        impulse_c_n: Vector3::new(0.0, 0.25, -0.5),
        impulse_count: count,
        ..Inputs::default()
    };
    for scenario in 1..=Embedded::scenarios().count() as i32 {
        let params = Params::of_scenario(scenario);
        // What stands there at the start is where counting begins.
        let mut run = Simulation::new(&params, 0.0, &fire(7)).unwrap();
        let mut free = run.clone();
        for t in [3.3, 4.0, 5.7] {
            run.advance_to(t, &fire(7)).unwrap();
            free.advance_to(t, &fire(7)).unwrap();
        }
        assert_eq!(run, free);
        // It acts between this communication point and any later one.
        for (t, count) in [
            (5.700_001, 8),
            (6.0, 8),
            (6.5, 8),
            (8.0, 8),
            (8.25, 9),
            (9.0, 9),
            (9.001, 8),
        ] {
            run.advance_to(t, &fire(count)).unwrap();
            free.advance_to(t, &fire(7)).unwrap();
            let fired = match t {
                8.25.. if t > 9.0 => 3.0,
                8.25.. => 2.0,
                _ => 1.0,
            };
            let gained = run.now().state.v_c - free.now().state.v_c;
            assert!(
                (gained - fire(1).impulse_c_n * fired).amax() < 1e-5,
                "{scenario}, {t} s: {gained}"
            );
            // But for the rounding of a step in two parts.
            assert!((run.now().state.v_t - free.now().state.v_t).amax() < 1e-11);
        }
    }
}

/// An accelerometer that measures the mean feels an impulse; one that measures the instant after its epoch does not.
#[test]
fn the_mean_of_an_accelerometer_has_the_impulse() {
    let mission = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../missions/fast_approach.toml");
    let mut params = Params::default();
    params.choice.mission_file = mission.display().to_string();
    let mut run = start(&params);
    advance(&mut run, 1.0);
    let mut free = run.clone();
    let fire = Inputs {
        impulse_c_n: Vector3::new(1e-2, -2e-2, 3e-2),
        impulse_count: 1,
        ..Inputs::default()
    };
    run.advance_to(1.02, &fire).unwrap();
    advance(&mut free, 1.02);
    let sum = |run: &Simulation| run.sample().dcm_bc_n.transpose() * run.sample().accelerometer.alpha_c_bc * 0.02;
    assert!(run.sample().accelerometer.mean && run.sample().accelerometer.valid);
    let felt = sum(&run) - sum(&free);
    // The chaser turns by a milliradian at most.
    assert!((felt - fire.impulse_c_n).amax() < 1e-4, "{felt}");
}

#[test]
fn a_force_acts_on_the_targets_mass_in_its_body_axes() {
    let force = Inputs {
        f_dist_t_bt: Vector3::new(0.3, 0.0, 0.4),
        ..Inputs::default()
    };
    let params = with(&noise_free(), &[("target.mass", 50.0)]);
    let mut run = start(&params);
    advance(&mut run, 3.5);
    let mut free = run.clone();
    run.advance_to(4.0, &force).unwrap();
    advance(&mut free, 4.0);
    let gained = run.now().state.v_t - free.now().state.v_t;
    assert!((gained.norm() - 0.5 / 50.0 * 0.5).abs() < 1e-7, "{gained}");
    assert!(run.now().event_active && (run.now().a_t_n.norm() - 0.01).abs() < 1e-12);
    assert!((run.now().state.v_c - free.now().state.v_c).amax() < 1e-11);
}

/// A commanded attitude is what the sensors look from and what body axes are; without one the mission's own pointing goes on.
#[test]
fn an_attitude_is_held_as_commanded() {
    let mut run = start(&noise_free());
    advance(&mut run, 2.0);
    let own = run.sample().dcm_bc_n;
    // A tenth of a radian about the body's z axis, away from the line of sight.
    let off = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.02).into_inner() * own;
    let commanded = Inputs {
        dcm_cmd_bc_n: off,
        ..Inputs::default()
    };
    run.advance_to(3.0, &commanded).unwrap();
    assert_eq!(run.sample().dcm_bc_n, off);
    let sight = astro::frames::lidar_from_body() * off * run.now().state.r_tc();
    let seen = run.sample()[Sensor::Lidar];
    assert!(
        seen.valid && (seen.z[1] - (sight.x / sight.z).atan()).abs() < 1e-12,
        "{seen:?}"
    );
    assert!((seen.z[2] - (sight.y / sight.z).atan()).abs() < 1e-12 && seen.z[1].abs() + seen.z[2].abs() > 0.01);
    // Beyond 2.5 deg it sees nothing.
    let away = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.05).into_inner() * own;
    run.advance_to(
        4.0,
        &Inputs {
            dcm_cmd_bc_n: away,
            ..commanded
        },
    )
    .unwrap();
    assert!(!run.sample()[Sensor::Lidar].valid);
    advance(&mut run, 5.0);
    assert!((run.sample().dcm_bc_n - own).amax() < 1e-2 && run.sample()[Sensor::Lidar].valid);
    let skew = Inputs {
        dcm_cmd_bc_n: own * 1.001,
        ..commanded
    };
    let before = run.clone();
    assert!(matches!(
        run.advance_to(6.0, &skew),
        Err(TruthError::NotARotation { .. })
    ));
    assert_eq!(run, before);
}

#[test]
fn inputs_show_in_readings_and_truth() {
    let mut run = start(&noise_free());
    run.advance_to(10.0, &shove()).unwrap();
    let alpha_n = run.sample().dcm_bc_n.transpose() * (run.sample().accelerometer.alpha_c_bc - run.now().b_c_bc);
    assert!((alpha_n - shove().a_cmd_c_n).amax() < 1e-17, "{alpha_n}");
    assert_eq!(run.now().a_t_n, shove().a_dist_t_n);
    run.advance_to(10.5, &shove()).unwrap();
    assert_eq!(run.now().a_t_n, shove().a_dist_t_n);
    advance(&mut run, 10.75);
    assert_eq!(run.now().a_t_n, Vector3::zeros());
    let at_start = Simulation::new(&noise_free(), 0.0, &shove()).unwrap();
    assert_eq!(at_start.now().a_t_n, shove().a_dist_t_n);
}

#[test]
fn target_burn_leaves_the_prepared_path() {
    let start_time = 50.0;
    let burning = with(
        &Params::default(),
        &[
            ("target_burn.start", 20.0),
            ("target_burn.duration", 10.0),
            ("target_burn.a_t_n[3]", 1e-3),
        ],
    );
    let mut plain = Simulation::new(&Params::default(), start_time, &Inputs::default()).unwrap();
    let mut burnt = Simulation::new(&burning, start_time, &Inputs::default()).unwrap();
    assert_eq!(plain.now(), burnt.now(), "the start does not know of the burn");
    for (t, seconds) in [(70.0, 0.0), (75.0, 5.0), (80.0, 10.0), (90.0, 10.0)] {
        advance(&mut plain, t);
        advance(&mut burnt, t);
        let gained = burnt.now().state.v_t - plain.now().state.v_t;
        assert!(
            (gained - Vector3::new(0.0, 0.0, 1e-3) * seconds).amax() < 3e-6,
            "{gained} at {t} s"
        );
        assert_eq!(burnt.now().state.v_c, plain.now().state.v_c);
        let acts = (70.0..80.0).contains(&t);
        assert_eq!(
            burnt.now().a_t_n - plain.now().a_t_n,
            Vector3::new(0.0, 0.0, 1e-3) * f64::from(u8::from(acts))
        );
    }
}

#[test]
fn world_goes_on_quietly_after_its_nominal_end() {
    let mut run = start(&noise_free());
    advance(&mut run, 5680.0);
    for k in 1..=10 {
        advance(&mut run, 5680.0 + 100.0 * f64::from(k));
        assert_eq!(run.now().a_t_n, Vector3::zeros());
        assert!((run.sample().accelerometer.alpha_c_bc - run.now().b_c_bc).amax() < 1e-20);
    }
    assert_eq!(run.sample().count, 6680);
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let fresh = |params: &Params, start_time| Simulation::new(params, start_time, &Inputs::default());
    let bad = with(&Params::default(), &[("lidar.sigma_range", -0.08)]);
    assert!(matches!(fresh(&bad, 0.0), Err(TruthError::Parameter { name, .. }) if name == "lidar.sigma_range"));
    assert!(matches!(
        fresh(&Params::default(), f64::NAN),
        Err(TruthError::StartTime { .. })
    ));

    let mut run = start(&Params::default());
    advance(&mut run, 10.5);
    let before = run.clone();
    let nan = Inputs {
        a_dist_t_n: Vector3::new(0.0, f64::NAN, 0.0),
        ..Inputs::default()
    };
    let error = run.advance_to(12.0, &nan).unwrap_err();
    assert_eq!(
        error.to_string(),
        "input a_dist_t_n[2] is NaN m/s2 at 12 s: it must be a finite number"
    );
    for t in [9.0, f64::NAN, f64::NEG_INFINITY] {
        assert!(matches!(
            run.advance_to(t, &Inputs::default()),
            Err(TruthError::Backwards { now: 10.5, .. })
        ));
    }
    for t in [1e300, f64::INFINITY] {
        assert!(matches!(
            run.advance_to(t, &Inputs::default()),
            Err(TruthError::TooFar { now: 10.5, .. })
        ));
    }
    assert_eq!(run, before);
}

#[test]
fn motion_beyond_the_numbers_is_an_error() {
    let huge = Inputs {
        a_cmd_c_n: Vector3::repeat(1e300),
        ..Inputs::default()
    };
    let mut run = start(&Params::default());
    assert_eq!(run.advance_to(5.0, &huge), Err(TruthError::StateNotFinite { t: 1.0 }));
}

/// Vents are events, the chaser's burns and an acceleration that never stops are none, and an input is one.
#[test]
fn what_no_filter_is_told_of_is_said_while_it_pushes_the_target() {
    let params = with(
        &Params::default(),
        &[("unmodelled.wander_sigma", 1e-6), ("vent.scale", 10.0)],
    );
    let quiet = Inputs::default();
    let mut run = start(&params);
    let vents: Vec<(f64, f64)> = run
        .timeline()
        .events()
        .iter()
        .filter(|e| !e.told && e.side == truth::Side::Target)
        .map(|e| (e.start, e.start + e.duration))
        .collect();
    assert!(vents.len() > 5);
    let mut active = 0;
    for t in 1..2000 {
        let t = f64::from(t);
        run.advance_to(t, &quiet).unwrap();
        let expected = vents.iter().any(|(begin, end)| *begin < t + 1.0 && *end > t);
        assert_eq!(run.now().event_active, expected, "{t} s");
        assert!(run.now().a_t_n.norm() > 0.0, "it wanders");
        active += u32::from(expected);
    }
    assert!(active > 20, "{active}");
    // From the grid point at which the input is taken over.
    run.advance_to(2001.0, &shove()).unwrap();
    assert!(run.now().event_active);
}

/// Sums of what the truth itself says acts, in steps of a tenth of a grid interval: by another rule than the sums that bounds are
/// told, which follow what turns with the vehicle by Simpson's.
#[test]
fn a_bound_is_told_the_velocity_that_was_given_and_how_long_it_took() {
    for scenario in [1, 2] {
        let set = [
            ("vent.scale", 1e3),
            ("unmodelled.wander_sigma", 1e-5),
            ("sample_period", 0.5),
            ("target_burn.start", 20.3),
            ("target_burn.duration", 7.0),
            ("target_burn.a_t_n[2]", 1e-2),
        ];
        let mut run = start(&with(&numbered(Params::of_scenario(scenario), 4), &set));
        let quiet = Inputs::default();
        let first_vent = (run.timeline().events().iter())
            .find(|e| !e.told && e.side == truth::Side::Target && e.duration < 100.0)
            .unwrap()
            .start;
        let (mut given, mut time, mut sampled) = (Vector3::zeros(), 0.0, 0);
        let steps = 10 * (first_vent.max(30.0).ceil() as u32 + 40);
        for k in 0..steps {
            let input = if k >= 300 { shove() } else { quiet };
            // The middle of a step; inputs act from the middle on which they are set.
            let middle = 0.1 * f64::from(k) + 0.05;
            run.advance_to(middle, &input).unwrap();
            given += run.now().a_t_n * 0.1;
            time += if run.now().event_active { 0.1 } else { 0.0 };
            if k % 5 == 4 {
                run.advance_to(middle + 0.05, &input).unwrap();
                let untold = run.sample().untold;
                let miss = (untold.dv_t_n - given).amax();
                // The direction of a vent follows the line of sight, which turns by less than 1e-2 rad/s.
                assert!(
                    miss < 1e-6 * given.amax().max(1e-3),
                    "{scenario}, {middle} s: {miss} of {given}"
                );
                assert!(
                    (untold.event_time - time).abs() < 1e-9,
                    "{scenario}, {middle} s: {untold:?}, {time} s"
                );
                sampled += 1;
            }
        }
        assert!(given.norm() > 0.05 && sampled * 5 == steps, "{given}");
    }
}
