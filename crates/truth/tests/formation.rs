//! The formation world through the public interface: its start, forces, relative truth and metrology.
// Bit equality is what is tested in places, and helpers outside of `#[test]` functions unwrap.
#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;

use astro::harmonics::EGM96;
use astro::{ClohessyWiltshire, J2RelativeMotion, TargetOrbit, ZonalGravity, frames};
use common::{numbered, samples, start, with};
use interface::Sensor;
use nalgebra::{SVector, Vector3};
use truth::{Forces, Inputs, Moment, Params, Relative, SensorSample, Simulation, Vehicles};

/// Three orbits.
const DURATION: u32 = 21_939;

fn full() -> Params {
    Params::of_scenario(3)
}

fn j2_only() -> Params {
    let mut params = full();
    params.formation_forces = Forces::J2;
    params
}

fn noise_free(params: Params) -> Params {
    with(
        &params,
        &[
            ("metrology.sigma_position", 0.0),
            ("metrology.sigma_velocity", 0.0),
            ("accelerometer.sigma", 0.0),
            ("accelerometer.bias0", 0.0),
            ("accelerometer.bias_sigma", 0.0),
        ],
    )
}

fn relative(moment: &Moment) -> Relative {
    moment.relative.unwrap()
}

/// The truth at every second, from the start on.
fn path(params: &Params, seconds: u32) -> Vec<Moment> {
    let mut run = start(params);
    let mut seen = vec![*run.now()];
    for k in 1..=seconds {
        run.advance_to(f64::from(k), &Inputs::default()).unwrap();
        seen.push(*run.now());
    }
    seen
}

fn oblate_earth() -> ZonalGravity {
    ZonalGravity {
        mu: EGM96.mu,
        r_ref: EGM96.r_ref,
        j: [EGM96.j2(), 0.0, 0.0, 0.0, 0.0],
    }
}

/// The reference that `d_lvlh` is held against, written out for the semi-major axis of Table 1.
fn linear_motion() -> ClohessyWiltshire {
    ClohessyWiltshire {
        mean_motion: (3.986004415e14 / 8143.1e3_f64.powi(3)).sqrt(),
    }
}

/// Position that the metrology measured.
fn rho(sample: &SensorSample) -> Vector3<f64> {
    Vector3::from_row_slice(&sample[Sensor::Metrology].z[..3])
}

/// Its rate.
fn rho_dot(sample: &SensorSample) -> Vector3<f64> {
    Vector3::from_row_slice(&sample[Sensor::Metrology].z[3..6])
}

#[test]
fn start_is_that_of_the_paper() {
    let run = start(&full());
    let Relative {
        rho_lvlh,
        rho_dot_lvlh,
        d_lvlh,
    } = relative(run.now());
    // Eqs. (34) and (35) to the digits printed; the components across are below the sensors' noise.
    assert!((rho_lvlh.y + 12.2042).abs() < 5e-5, "{rho_lvlh}");
    assert!(rho_lvlh.x.abs() < 2e-3 && rho_lvlh.z.abs() < 1e-3, "{rho_lvlh}");
    assert!((rho_dot_lvlh.x + 0.0017).abs() < 5e-5, "{rho_dot_lvlh}");
    assert!(rho_dot_lvlh.y.abs() + rho_dot_lvlh.z.abs() < 1e-5, "{rho_dot_lvlh}");
    // At the perigee, near the pole, by hand: y (w^2 - mu / r^3) - 2 (w - n) x_dot with w = h / r^2 = 1.1535e-3 / s is
    // -0.9845e-6 m/s2, and J2 adds (5 sin^2 phi - 1) 3/2 J2 mu R^2 / r^5 y = -0.0745e-6.
    let oblate = relative(start(&j2_only()).now()).d_lvlh;
    assert!((oblate.y + 1.059e-6).abs() < 0.001e-6, "{oblate}");
    // Air and light push the chaser by 1.45e-7 m/s2 and the target by a sixth of it.
    assert!(
        (0.5e-7..1.45e-7).contains(&(oblate - d_lvlh).norm()),
        "{}",
        oblate - d_lvlh
    );
    // Before the first sample the orbit is that of the start.
    let orbit = run.sample().target_orbit.unwrap();
    assert!((orbit.inclination.to_degrees() - 98.2).abs() < 1e-10);
    assert!((orbit.argument_of_latitude.to_degrees() - 85.9001).abs() < 1e-10);
    assert!((orbit.r - 8143.1e3 * (1.0 - 0.1413)).abs() < 1e-3, "{}", orbit.r);
    let parameter = 8143.1e3 * (1.0 - 0.1413_f64.powi(2));
    assert!((orbit.h / (3.986004415e14 * parameter).sqrt() - 1.0).abs() < 1e-14);
    assert!(orbit.r_dot > 0.0 && orbit.r_dot < 0.01, "just past the perigee");
}

#[test]
fn j2_truth_is_the_relative_model() {
    let model = J2RelativeMotion {
        mu: EGM96.mu,
        r_ref: EGM96.r_ref,
        j2: EGM96.j2(),
    };
    let seen = path(&j2_only(), DURATION);
    let start = &seen[0];
    let mut x = SVector::<f64, 12>::zeros();
    x.fixed_rows_mut::<3>(0).copy_from(&relative(start).rho_lvlh);
    x.fixed_rows_mut::<3>(3).copy_from(&relative(start).rho_dot_lvlh);
    let orbit = TargetOrbit::from_state(&start.state.r_t, &start.state.v_t);
    x.fixed_rows_mut::<6>(6).copy_from(&orbit.to_vector());
    let (mut position, mut velocity, mut disturbance) = (0.0_f64, 0.0_f64, 0.0_f64);
    for moment in &seen {
        let Relative {
            rho_lvlh,
            rho_dot_lvlh,
            d_lvlh,
        } = relative(moment);
        let part = |i| x.fixed_rows::<3>(i).into_owned();
        position = position.max((part(0) - rho_lvlh).norm());
        velocity = velocity.max((part(3) - rho_dot_lvlh).norm());
        let orbit = TargetOrbit::from_state(&moment.state.r_t, &moment.state.v_t);
        let left_out = model.acceleration(&orbit, &rho_lvlh, &rho_dot_lvlh)
            - linear_motion().acceleration(&rho_lvlh, &rho_dot_lvlh);
        disturbance = disturbance.max((left_out - d_lvlh).norm());
        for _ in 0..2 {
            x = numerics::rk4::step(0.0, &x, 0.5, |_, x| model.rate(x));
        }
    }
    // Rounding of positions of 1e7 m in 43 878 steps: it comes to 7e-6 m and 6e-9 m/s.
    assert!(position < 1e-4 && velocity < 1e-7, "{position} m, {velocity} m/s");
    // Rounding of an attraction of 8 m/s2; the disturbance itself is 1e-6 m/s2.
    assert!(disturbance < 2e-14, "{disturbance} m/s2");
}

#[test]
fn conservative_forces_keep_energy_and_axial_angular_momentum() {
    let invariants = |r: &Vector3<f64>, v: &Vector3<f64>| {
        let energy = v.norm_squared() / 2.0 - oblate_earth().potential(r);
        (energy, r.cross(v).z)
    };
    let seen = path(&j2_only(), DURATION);
    let of = |state: &Vehicles| [invariants(&state.r_t, &state.v_t), invariants(&state.r_c, &state.v_c)];
    let start = of(&seen[0].state);
    for moment in &seen {
        for (now, then) in of(&moment.state).iter().zip(start) {
            // Rounding and step error of three orbits; the tesseral terms alone would move either by 1e-6.
            assert!(
                (now.0 / then.0 - 1.0).abs() < 1e-12 && (now.1 / then.1 - 1.0).abs() < 1e-12,
                "{} s: {now:?} from {then:?}",
                moment.time
            );
        }
    }
}

#[test]
fn pushes_show_in_the_disturbance_and_the_path() {
    let quiet = start(&full());
    let state = quiet.now().state;
    let dcm = frames::rtn(&state.r_t, &state.v_t);
    let push = Vector3::new(3e-4, -2e-4, 1e-4);
    let commanded = Inputs {
        a_cmd_c_n: push,
        ..Inputs::default()
    };
    let disturbed = Inputs {
        a_dist_t_n: push,
        ..Inputs::default()
    };
    let d = |inputs: &Inputs| {
        let run = Simulation::new(&full(), 0.0, inputs).unwrap();
        relative(run.now()).d_lvlh - relative(quiet.now()).d_lvlh
    };
    assert!((d(&commanded) - dcm * push).amax() < 1e-15, "{}", d(&commanded));
    // The turning of the target's axes changes too, by a / r = 5e-11 rad/s2 over 12 m.
    assert!((d(&disturbed) + dcm * push).amax() < 2e-9, "{}", d(&disturbed));

    let burning = with(
        &full(),
        &[
            ("target_burn.start", 10.5),
            ("target_burn.duration", 5.0),
            ("target_burn.a_t_n[1]", push.x),
            ("target_burn.a_t_n[2]", push.y),
            ("target_burn.a_t_n[3]", push.z),
        ],
    );
    let [mut free, mut burnt] = [full(), burning].map(|params| start(&params));
    for (t, seconds) in [(10.5, 0.0), (13.0, 2.5), (15.5, 5.0), (20.0, 5.0)] {
        free.advance_to(t, &Inputs::default()).unwrap();
        burnt.advance_to(t, &Inputs::default()).unwrap();
        let gained = burnt.now().state.v_t - free.now().state.v_t;
        // Gravity changes by 1e-6 / s2 over centimetres.
        assert!((gained - push * seconds).amax() < 1e-7, "{gained} at {t} s");
        let acts = (10.5..15.5).contains(&t);
        assert_eq!(burnt.now().a_t_n, push * f64::from(u8::from(acts)));
        assert_eq!(burnt.now().state.r_c, free.now().state.r_c);
    }
}

#[test]
fn accelerometer_feels_air_light_and_command() {
    // The chaser of 1 kg gains this much against one that nothing but gravity moves.
    let heavy = with(&noise_free(full()), &[("chaser.mass", 1e12)]);
    let light = with(&heavy, &[("chaser.mass", 1.0)]);
    let command = Inputs {
        a_cmd_c_n: Vector3::new(0.0, 0.0, 3e-6),
        ..Inputs::default()
    };
    let mut readings = Vec::new();
    let mut velocity = |params: &Params, inputs: &Inputs| {
        let mut run = Simulation::new(params, 0.0, inputs).unwrap();
        run.advance_to(10.0, inputs).unwrap();
        readings.push(run.sample().dcm_bc_n.transpose() * run.sample().accelerometer.alpha_c_bc);
        run.now().state.v_c
    };
    let gained = velocity(&light, &command) - velocity(&heavy, &Inputs::default());
    assert!(readings[1].amax() < 1e-16, "{}", readings[1]);
    // At the perigee the air is thinned by a hundredth in 10 s, half of it on average.
    assert!(
        (readings[0] - gained / 10.0).amax() < 0.01 * readings[0].amax(),
        "{} and {}",
        readings[0],
        gained / 10.0
    );
    // Sunlight 7.1e-6 m/s2 and drag of the same order.
    assert!((5e-6..3e-5).contains(&readings[0].norm()), "{}", readings[0]);
}

#[test]
fn noise_free_metrology_tells_the_truth_at_the_epoch() {
    let params = with(&noise_free(full()), &[("sample_period", 2.0)]);
    let mut run = start(&params);
    assert!(!run.sample()[Sensor::Metrology].valid && rho(run.sample()) == Vector3::zeros());
    let mut at_epoch = *run.now();
    for t in [1.0, 2.0, 3.7, 4.0, 5.0] {
        run.advance_to(t, &Inputs::default()).unwrap();
        let (now, sample) = (run.now(), run.sample());
        if t == sample.time {
            at_epoch = *now;
            assert!(sample[Sensor::Metrology].valid);
            assert_eq!(rho(sample), relative(now).rho_lvlh);
            assert_eq!(rho_dot(sample), relative(now).rho_dot_lvlh);
        }
        // The orbit holds at the epoch; its elements lead back to the state.
        let (r, v) = sample.target_orbit.unwrap().to_state();
        assert!((r - at_epoch.state.r_t).amax() < 1e-7 && (v - at_epoch.state.v_t).amax() < 1e-10);
        assert_eq!((sample[Sensor::Lidar].valid, sample[Sensor::Lidar].z[0]), (false, 0.0));
        // The chaser looks at the target.
        let ahead = sample.dcm_bc_n * at_epoch.state.r_tc();
        assert!(
            (ahead.y - 12.2).abs() < 0.1 && ahead.x.abs() + ahead.z.abs() < 1e-6,
            "{ahead}"
        );
    }
}

#[test]
fn metrology_noise_has_its_deviation_and_outliers_their_multiple() {
    let count = 3000;
    let clean = samples(&noise_free(full()), 1.0, count);
    for (metrology_outlier_probability, scale) in [(0.0, 1.0), (1.0, 5.0)] {
        let params = with(
            &full(),
            &[
                ("metrology.outlier_probability", metrology_outlier_probability),
                ("metrology.outlier_scale", 5.0),
            ],
        );
        let mut squares = [0.0; 6];
        let mut product = 0.0;
        for (noisy, clean) in samples(&params, 1.0, count).iter().zip(&clean) {
            let position = (rho(noisy) - rho(clean)) / (1e-2 * scale);
            let velocity = (rho_dot(noisy) - rho_dot(clean)) / (1e-4 * scale);
            for (sum, error) in squares.iter_mut().zip(position.iter().chain(&velocity)) {
                *sum += error * error / f64::from(count);
            }
            product += position.dot(&velocity) / f64::from(3 * count);
        }
        for (channel, variance) in squares.iter().enumerate() {
            // A mean of n squares of normal draws scatters by sqrt(2 / n).
            assert!(
                (variance - 1.0).abs() < 3.0 * (2.0 / f64::from(count)).sqrt(),
                "channel {channel}: {variance}"
            );
        }
        assert!(
            product.abs() < 3.0 / f64::from(3 * count).sqrt(),
            "position and velocity are independent"
        );
    }
}

#[test]
fn one_fault_of_the_metrology_moves_no_other_draw() {
    let base = with(
        &full(),
        &[
            ("metrology.outlier_probability", 0.2),
            ("metrology.dropout_probability", 0.1),
            ("lidar.dropout_probability", 0.5),
            ("lidar.outlier_probability", 0.5),
        ],
    );
    let seen = samples(&base, 1.0, 400);
    let changes = [
        with(&base, &[("metrology.dropout_probability", 0.0)]),
        with(&base, &[("metrology.outlier_probability", 0.0)]),
        with(
            &base,
            &[("metrology.sigma_position", 0.0), ("accelerometer.sigma", 0.0)],
        ),
        with(
            &base,
            &[("lidar.dropout_probability", 0.0), ("lidar.outlier_probability", 0.0)],
        ),
    ];
    let [no_dropouts, no_outliers, exact_position, no_lidar_faults] = changes.map(|params| samples(&params, 1.0, 400));
    assert_eq!(seen, no_lidar_faults);
    let mut counts = [0; 2];
    for (k, sample) in seen.iter().enumerate() {
        let metrology = sample[Sensor::Metrology];
        assert!(no_dropouts[k][Sensor::Metrology].valid);
        assert_eq!((sample.count, sample.time), (k as u64 + 1, k as f64 + 1.0));
        assert_eq!(sample.accelerometer.alpha_c_bc, no_dropouts[k].accelerometer.alpha_c_bc);
        assert_eq!(sample.target_orbit, no_dropouts[k].target_orbit);
        if metrology.valid {
            assert_eq!(*sample, no_dropouts[k]);
        } else {
            counts[0] += 1;
            let held = if k == 0 {
                Default::default()
            } else {
                seen[k - 1][Sensor::Metrology]
            };
            assert_eq!(metrology.z, held.z);
        }
        // An outlier changes its own sample, all six numbers, and none after it.
        let plain = no_outliers[k][Sensor::Metrology];
        assert_eq!(metrology.valid, plain.valid);
        if metrology.valid && metrology != plain {
            counts[1] += 1;
            assert!(metrology.z.iter().zip(&plain.z).all(|(a, b)| a != b));
        }
        assert_eq!(rho_dot(sample), rho_dot(&exact_position[k]));
    }
    // Binomial counts of 400 at 0.1, and of the 360 received at 0.2, within 3 sigma.
    assert!((22..=58).contains(&counts[0]), "{} dropouts", counts[0]);
    assert!((49..=95).contains(&counts[1]), "{} outliers", counts[1]);
}

#[test]
fn initial_estimate_is_a_measurement_of_its_own() {
    let runs = 2000;
    let mut squares = [0.0; 6];
    let mut product = 0.0;
    for run in 0..runs {
        let mut world = start(&numbered(j2_only(), run));
        let Relative {
            rho_lvlh, rho_dot_lvlh, ..
        } = relative(world.now());
        let x = *world.initial_estimate();
        assert!(x.iter().skip(6).all(|x| *x == 0.0));
        let position = (x.fixed_rows::<3>(0) - rho_lvlh) / 1e-2;
        let velocity = (x.fixed_rows::<3>(3) - rho_dot_lvlh) / 1e-4;
        for (sum, error) in squares.iter_mut().zip(position.iter().chain(&velocity)) {
            *sum += error * error / f64::from(runs);
        }
        world.advance_to(1.0, &Inputs::default()).unwrap();
        let first = (rho(world.sample()) - relative(world.now()).rho_lvlh) / 1e-2;
        product += position.dot(&first) / f64::from(3 * runs);
    }
    for (channel, variance) in squares.iter().enumerate() {
        assert!(
            (variance - 1.0).abs() < 3.5 * (2.0 / f64::from(runs)).sqrt(),
            "channel {channel}: {variance}"
        );
    }
    assert!(product.abs() < 3.0 / f64::from(3 * runs).sqrt(), "{product}");

    let set = start(&with(
        &full(),
        &[("nav_init.sigma_position", 0.0), ("nav_init.sigma_velocity", 2e-4)],
    ));
    let own = start(&full());
    let truth = relative(own.now());
    let rows = |run: &Simulation, i: usize| run.initial_estimate().fixed_rows::<3>(i).into_owned();
    assert_eq!(rows(&set, 0), truth.rho_lvlh);
    let doubled = (rows(&own, 3) - truth.rho_dot_lvlh) * 2.0;
    assert!((rows(&set, 3) - truth.rho_dot_lvlh - doubled).amax() < 1e-18);
}

/// Steps that divide the grid, that do not, and that skip samples.
#[test]
fn samples_do_not_depend_on_the_communication_step() {
    for sample_period in [1.0, 0.25, 0.3] {
        let params = with(&full(), &[("sample_period", sample_period)]);
        let expected = samples(&params, sample_period, (60.0 / sample_period) as u32);
        for step in [1.0, 0.5, 0.25, 0.1, 0.7, 7.3] {
            let mut run = start(&params);
            let mut k = 0_u32;
            while run.now().time < 50.0 {
                k += 1;
                run.advance_to(f64::from(k) * step, &Inputs::default()).unwrap();
                if let Some(last) = run.sample().count.checked_sub(1) {
                    assert_eq!(*run.sample(), expected[last as usize], "steps of {step} s");
                }
            }
        }
    }
}

#[test]
fn worlds_have_one_instrument_each() {
    for ordinal in [1, 2] {
        let mut run = start(&Params::of_scenario(ordinal));
        run.advance_to(3.0, &Inputs::default()).unwrap();
        let sample = run.sample();
        assert!(sample[Sensor::Lidar].valid && !sample[Sensor::Metrology].valid);
        assert_eq!(rho(sample), Vector3::zeros());
        assert!(sample.target_orbit.is_none() && run.now().relative.is_none());
    }
    // Nothing vents in formation.
    let loud = with(&full(), &[("vent.scale", 1e6)]);
    let [quiet, loud] = [full(), loud].map(|params| {
        let mut run = start(&params);
        run.advance_to(400.0, &Inputs::default()).unwrap();
        (*run.now(), *run.sample())
    });
    assert_eq!(quiet, loud);
    assert_eq!(quiet.0.a_t_n, Vector3::zeros());
}
