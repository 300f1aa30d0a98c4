//! What every registered filter must do, in a world made of the filter's own assumptions: gravity of the filter, a
//! target driven by white jerk, sensors with exactly the noise that the filter expects.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod common;
mod formation;

use astro::{ClohessyWiltshire, TargetOrbit};
use common::{OwnWorld, navigation};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::{Kind, Value};
use filters::{FilterError, Navigator, Reading, Sample, Settings, Status, Untold};
use formation::{Formation, World};
use interface::Sensor;
use interface::mission::Frame;
use nalgebra::{Vector3, Vector6};
use numerics::{Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

fn settings(filter: &str, run: u64) -> Settings {
    let filter = FILTERS.iter().position(|f| f.name == filter).unwrap();
    Settings {
        filter,
        run,
        ..Settings::default()
    }
}

/// Every filter in a world of each kind in which it has a meaning: its name, a fresh filter, the world and a first estimate.
fn everywhere(run: u64, s: f64) -> impl Iterator<Item = (String, Navigator, Box<dyn World>, State)> {
    FILTERS.iter().flat_map(move |entry| {
        ["leo_venting", "formation"].into_iter().filter_map(move |name| {
            let (told, chosen) = (navigation(name), settings(entry.name, run));
            if entry.no_meaning_in(&told).is_some() {
                let refused = Navigator::new(&told, &chosen, 0.0).unwrap_err().to_string();
                assert!(refused.contains(entry.name) && refused.contains(name), "{refused}");
                return None;
            }
            let (world, start): (Box<dyn World>, State) = match told.frame {
                Frame::Inertial => {
                    let (world, start) = OwnWorld::new(run, s);
                    (Box::new(world), start)
                }
                Frame::Lvlh => {
                    let (world, start) = Formation::new(run);
                    (Box::new(world), start)
                }
            };
            let label = format!("{} in {name}", entry.name);
            Some((label, Navigator::new(&told, &chosen, 0.0).unwrap(), world, start))
        })
    })
}

fn nees(nav: &Navigator, truth: &State) -> f64 {
    let error = (nav.estimate().x - truth).fixed_rows::<9>(0).into_owned();
    let p = nav.estimate().p_target.cholesky().unwrap();
    error.dot(&p.solve(&error)) / 9.0
}

#[test]
fn every_filter_keeps_its_covariance_positive_and_follows_the_target() {
    for (label, mut nav, mut world, start) in everywhere(0, 1e-7) {
        assert_eq!(nav.status(), Status::Initialising);
        for k in 1..=900 {
            nav.process(&world.step(), &start).unwrap();
            let d = nav.dimension();
            let p = nav.estimate().p_target;
            assert!(
                d == 0 || p.view((0, 0), (d, d)).into_owned().cholesky().is_some(),
                "{label} at {k} s"
            );
            assert!(p.view((d, 0), (9 - d, 9)).iter().all(|v| *v == 0.0), "{label}");
        }
        assert_eq!((nav.status(), nav.estimate().count), (Status::Tracking, 900), "{label}");
        let miss = (nav.estimate().x.fixed_rows::<9>(0) - world.truth())
            .fixed_rows::<3>(0)
            .norm();
        // The observer claims nothing; one standard deviation of a measured position is its due.
        let sigma = if nav.dimension() == 0 {
            1e-2
        } else {
            nav.estimate().sigma.fixed_rows::<3>(0).norm()
        };
        assert!(miss < 5.0 * sigma, "{label}: {miss} m against sigma {sigma} m");
    }
}

/// The one law that is told the truth about its world must be consistent in it: mean NEES and NIS of one.
#[test]
fn fixed_q_is_consistent_in_its_own_world() {
    let (runs, s) = (40, 3e-5);
    let (mut nees_sum, mut nis_sum, mut bias_sum, mut samples) = (0.0, 0.0, 0.0, 0.0);
    for run in 0..runs {
        let (mut world, start) = OwnWorld::new(run, s);
        let mut chosen = settings("fixed_q", run);
        *chosen.tunable_mut("fixed_q", "s").unwrap() = Value::Real(s);
        let mut nav = Navigator::new(&navigation("leo_venting"), &chosen, 0.0).unwrap();
        for _ in 0..800 {
            nav.process(&world.step(), &start).unwrap();
            nis_sum += nav.innovation().nis / 3.0;
            samples += 1.0;
        }
        nees_sum += nees(&nav, &world.x);
        let bias = (nav.estimate().x - world.x).component_div(&nav.estimate().sigma);
        bias_sum += bias.fixed_rows::<3>(15).norm_squared() / 3.0;
    }
    // Chi-square with 9 and 3 degrees of freedom: three standard errors of the mean.
    let (nees, nis) = (nees_sum / runs as f64, nis_sum / samples);
    assert!(
        (nees - 1.0).abs() < 3.0 * (2.0 / 9.0 / runs as f64).sqrt(),
        "NEES {nees}"
    );
    assert!((nis - 1.0).abs() < 3.0 * (2.0_f64 / 3.0 / samples).sqrt(), "NIS {nis}");
    let bias = bias_sum / runs as f64;
    assert!(
        (bias - 1.0).abs() < 3.0 * (2.0_f64 / 3.0 / runs as f64).sqrt(),
        "bias {bias}"
    );
}

#[test]
fn a_saved_filter_goes_on_bit_for_bit() {
    for (label, mut nav, mut world, start) in everywhere(3, 1e-6) {
        for _ in 0..77 {
            nav.process(&world.step(), &start).unwrap();
        }
        let bytes = postcard::to_allocvec(&nav).unwrap();
        let mut restored: Navigator = postcard::from_bytes(&bytes).unwrap();
        for _ in 0..77 {
            let sample = world.step();
            nav.process(&sample, &start).unwrap();
            restored.process(&sample, &start).unwrap();
        }
        assert_eq!(
            postcard::to_allocvec(&nav).unwrap(),
            postcard::to_allocvec(&restored).unwrap(),
            "{label}"
        );
    }
}

#[test]
fn dropouts_coast_and_gaps_are_bridged() {
    for (label, mut nav, mut world, start) in everywhere(4, 1e-6) {
        for k in 1..=400 {
            let mut sample = world.step();
            if k % 7 == 0 {
                sample.sensors.fill(Reading::Lost);
            }
            if k % 50 == 20 {
                continue;
            }
            nav.process(&sample, &start).unwrap();
            // Handing the same sample over again changes nothing.
            let count = nav.estimate().clone();
            nav.process(&sample, &start).unwrap();
            assert_eq!(*nav.estimate(), count);
            assert_eq!(nav.status() == Status::Coasting, k % 7 == 0, "{label} at {k} s");
        }
        let miss = (nav.estimate().x.fixed_rows::<9>(0) - world.truth())
            .fixed_rows::<3>(0)
            .norm();
        let sigma = nav.estimate().sigma.fixed_rows::<3>(0).norm().max(1e-2);
        assert!(miss < 5.0 * sigma, "{label}: {miss} m");
    }
}

/// A master may hand over one sample in ten or sixty: the filter must cross the gaps, and not learn itself into ruin.
#[test]
fn long_intervals_are_survived() {
    for every in [10, 30, 60] {
        for (label, mut nav, mut world, start) in everywhere(6, 1e-7) {
            for k in 1..=6000 {
                let sample = world.step();
                if k % every == 0 {
                    nav.process(&sample, &start)
                        .unwrap_or_else(|e| panic!("{label}, every {every} s: {e}"));
                }
            }
            let miss = (nav.estimate().x.fixed_rows::<9>(0) - world.truth())
                .fixed_rows::<3>(0)
                .norm();
            assert!(miss < 20.0, "{label}, every {every} s: {miss} m");
        }
    }
}

/// The J2 filter is told the model of its world: with next to no process noise it must be consistent there.
#[test]
fn the_j2_filter_is_consistent_in_a_j2_world() {
    let (runs, samples) = (30, 400);
    let (mut nees, mut nis) = (0.0, 0.0);
    for run in 0..runs {
        let (mut world, start) = Formation::new(run);
        let mut chosen = settings("ekf_j2", run);
        for (tunable, q) in [("q_position", 0.0), ("q_velocity", 1e-20)] {
            *chosen.tunable_mut("ekf_j2", tunable).unwrap() = Value::Real(q);
        }
        let mut nav = Navigator::new(&navigation("formation"), &chosen, 0.0).unwrap();
        for _ in 0..samples {
            nav.process(&world.step(), &start).unwrap();
            nis += nav.innovation().nis / 6.0;
        }
        let error = (nav.estimate().x.fixed_rows::<9>(0) - world.truth())
            .fixed_rows::<6>(0)
            .into_owned();
        let p = nav.estimate().p_target.fixed_view::<6, 6>(0, 0).into_owned();
        nees += error.dot(&p.cholesky().unwrap().solve(&error)) / 6.0;
        // What it says of the acceleration beyond Clohessy-Wiltshire is the model's own.
        let d = (nav.estimate().x.fixed_rows::<9>(0) - world.truth())
            .fixed_rows::<3>(6)
            .norm();
        assert!(d < 1e-8, "{d} m/s2");
    }
    let (runs, samples) = (runs as f64, f64::from(samples));
    let (nees, nis) = (nees / runs, nis / (runs * samples));
    // Chi-square with six degrees of freedom: three standard errors of the mean.
    assert!((nees - 1.0).abs() < 3.0 * (2.0 / 6.0 / runs).sqrt(), "NEES {nees}");
    assert!(
        (nis - 1.0).abs() < 3.0 * (2.0_f64 / 6.0 / (runs * samples)).sqrt(),
        "NIS {nis}"
    );
}

/// In a world whose disturbance is constant the network must find it: learning integrates the velocity error.
#[test]
fn networks_learn_a_constant_disturbance() {
    for filter in ["rbfnn_aekf", "rbfnn_ekf", "observer"] {
        let chosen = settings(filter, 1);
        let mut nav = Navigator::new(&navigation("formation"), &chosen, 0.0).unwrap();
        assert!(nav.estimates_acceleration());
        let d = Vector3::new(2e-5, 0.0, 1e-5);
        let circular = ClohessyWiltshire::from_semi_major_axis(8.1431e6, astro::earth::FILTER.mu);
        // Where the tide balances d, so that the chaser stays among the centres of the network.
        let n_squared = circular.mean_motion.powi(2);
        let mut x = Vector6::new(-d.x / (3.0 * n_squared), -5.0, d.z / n_squared, 0.0, 0.0, 0.0);
        let start: State = x.fixed_resize(0.0);
        let g = &mut stream(5, 0, Source::Metrology);
        let (settled, samples) = (3000, 6000);
        let mut learnt = Vector3::zeros();
        for k in 1..=samples {
            x = rk4::step(0.0, &x, 1.0, |_, x| {
                let (rho, rho_dot) = (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned());
                let a = circular.acceleration(&rho, &rho_dot) + d;
                Vector6::new(rho_dot.x, rho_dot.y, rho_dot.z, a.x, a.y, a.z)
            });
            let noise = Vector6::from_fn(|i, _| {
                let w: f64 = StandardNormal.sample(g);
                if i < 3 { 1e-2 * w } else { 1e-4 * w }
            });
            let mut sample = Sample::blank(k, f64::from(k));
            sample[Sensor::Metrology] = Reading::of((x + noise).as_slice());
            nav.process(&sample, &start).unwrap();
            if k > settled {
                learnt += nav.estimate().x.fixed_rows::<3>(6) / f64::from(samples - settled);
            }
        }
        // The output scatters by 7e-7 m/s2 over some 400 s, so its mean over 3000 s by 4e-7: three of these.
        assert!((learnt - d).amax() < 1.2e-6, "{filter}: {learnt}");
    }
}

/// Nothing connected to `target_orbit.*` must be an error of the one filter that needs it, by name.
#[test]
fn the_j2_filter_asks_for_the_orbit() {
    let (mut world, start) = Formation::new(0);
    let chosen = settings("ekf_j2", 0);
    let mut nav = Navigator::new(&navigation("formation"), &chosen, 0.0).unwrap();
    let mut sample = world.step();
    sample.target_orbit = TargetOrbit::from_vector(&Vector6::zeros());
    let error = nav.process(&sample, &start).unwrap_err().to_string();
    assert!(error.contains("target_orbit.r = 0 m"), "{error}");
}

/// The observer has no process noise: the factor acts on its gain, K = 1 - exp(-f k h) with k = 0.42 and 0.025 per second.
#[test]
fn off_nominal_scales_the_gain_of_the_observer() {
    for factor in [0.1_f64, 1.0, 10.0] {
        let mut chosen = settings("observer", 0);
        chosen.beliefs.off_nominal = factor;
        let (mut world, start) = Formation::new(0);
        let mut nav = Navigator::new(&navigation("formation"), &chosen, 0.0).unwrap();
        let sample = world.step();
        nav.process(&sample, &start).unwrap();
        let left = sample[Sensor::Metrology].seen().unwrap() - nav.estimate().x.fixed_rows::<6>(0);
        for i in 0..6 {
            let k: f64 = if i < 3 { 0.42 } else { 0.025 };
            let expected = (-factor * k).exp() * nav.innovation().residual[Sensor::Metrology.channels().start + i];
            assert!(
                (left[i] - expected).abs() < 1e-12,
                "factor {factor}, row {i}: {} {expected}",
                left[i]
            );
        }
    }
}

/// One factor on the process noise, whatever the law calls it.
#[test]
fn off_nominal_scales_the_process_noise() {
    let sigma = |filter: &str, off_nominal: f64| {
        let mut chosen = settings(filter, 0);
        chosen.beliefs.off_nominal = off_nominal;
        let (mut world, start) = Formation::new(0);
        let mut nav = Navigator::new(&navigation("formation"), &chosen, 0.0).unwrap();
        (0..400).for_each(|_| assert!(nav.process(&world.step(), &start).unwrap()));
        nav.estimate().sigma[3]
    };
    // The adaptive filter starts with it and forgets it within a thousand samples.
    for filter in ["fixed_q", "snc", "dmc", "rbfnn_aekf", "rbfnn_ekf", "ekf_j2"] {
        let (less, as_said, more) = (sigma(filter, 0.1), sigma(filter, 1.0), sigma(filter, 10.0));
        assert!(
            less < 0.97 * as_said && as_said < 0.97 * more,
            "{filter}: {less} {as_said} {more}"
        );
    }
}

#[test]
fn a_filter_that_is_led_astray_says_so() {
    let (mut world, start) = OwnWorld::new(5, 1e-6);
    let mut nav = Navigator::new(&navigation("leo_venting"), &settings("fixed_q", 5), 0.0).unwrap();
    for k in 1..=600 {
        let mut sample = world.step();
        if k > 300 {
            // A second target that runs away faster than the filter can believe.
            let mut z = sample[Sensor::Lidar].seen().unwrap();
            z[0] += 0.5 * f64::from(k - 300).powi(2);
            sample[Sensor::Lidar] = Reading::Seen(z);
        }
        nav.process(&sample, &start).unwrap();
    }
    assert_eq!(nav.status(), Status::Diverged);
}

#[test]
fn senseless_samples_are_refused_by_name() {
    let fresh = || {
        (
            Navigator::new(&navigation("leo_venting"), &settings("fixed_q", 0), 0.0).unwrap(),
            OwnWorld::new(0, 1e-6),
        )
    };
    let (mut nav, (mut world, start)) = fresh();
    // The first that a filter sees need not be the world's first.
    let first = Sample {
        count: 7,
        ..world.step()
    };
    let said = nav.process(&first, &State::zeros()).unwrap_err().to_string();
    assert!(
        said.contains("nav_init.x is all zero when sample 7 at t = 1 s arrives"),
        "{said}"
    );

    let (mut nav, _) = fresh();
    let mut sample = world.step();
    sample.time = 0.0;
    assert!(matches!(
        nav.process(&sample, &start),
        Err(FilterError::TimeNotAdvancing { .. })
    ));
    sample.time = 1e9;
    assert!(matches!(
        nav.process(&sample, &start),
        Err(FilterError::GapTooLong { .. })
    ));
    sample.time = 1.0;
    sample.dcm_bc_n[(0, 0)] += 0.1;
    let error = nav.process(&sample, &start).unwrap_err();
    assert!(
        matches!(error, FilterError::NotARotation { .. }) && error.to_string().contains("connect dcm_bc_n"),
        "{error}"
    );

    // An estimate that puts the target beside the boresight axis: the angles have no partials there.
    let (mut nav, _) = fresh();
    let mut at_target = start;
    at_target.fixed_rows_mut::<9>(0).fill(0.0);
    let error = nav.process(
        &Sample {
            time: 1e-3,
            ..world.step()
        },
        &at_target,
    );
    assert!(
        matches!(error, Err(FilterError::LineOfSightUndefined { .. })),
        "{error:?}"
    );
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    type Change = fn(&mut Settings);
    let cases: [(&str, Change); 7] = [
        ("r.sigma_range", |s| s.beliefs.r_sigma_range = 0.0),
        ("r.sigma_angle", |s| s.beliefs.r_sigma_angle = -2.0),
        ("r.sigma_accelerometer", |s| s.beliefs.r_sigma_accelerometer = f64::NAN),
        ("p0.sigma_position", |s| s.beliefs.p0_sigma_position = 0.0),
        ("chaser.q_c", |s| s.beliefs.chaser_q_c = -2.0),
        ("gravity.mu", |s| s.beliefs.gravity_mu = 0.0),
        ("fixed_q.s", |s| {
            *s.tunable_mut("fixed_q", "s").unwrap() = Value::Real(0.0)
        }),
    ];
    for (name, change) in cases {
        let mut chosen = settings("fixed_q", 0);
        change(&mut chosen);
        match Navigator::new(&navigation("leo_venting"), &chosen, 0.0) {
            Err(FilterError::OutOfRange { name: named, .. }) => assert_eq!(named, name),
            other => panic!("{name}: {other:?}"),
        }
    }
    let unknown = Settings {
        filter: 99,
        ..Settings::default()
    };
    assert!(
        Navigator::new(&navigation("leo_venting"), &unknown, 0.0)
            .unwrap_err()
            .to_string()
            .contains("fixed_q, snc, dmc, milton, constrained_q")
    );
}

#[test]
fn registry_is_complete() {
    for entry in FILTERS {
        assert_eq!(entry.presets[0].name, "paper", "{}", entry.name);
        for preset in entry.presets {
            for (name, text) in preset.sets {
                let tunable = entry.tunables.iter().find(|t| t.name == *name).unwrap();
                let fits = match tunable.kind {
                    Kind::Real { .. } => text.parse::<f64>().is_ok(),
                    Kind::Integer { min, max, .. } => text.parse::<i32>().is_ok_and(|v| (min..=max).contains(&v)),
                    Kind::Boolean { .. } => text.parse::<bool>().is_ok(),
                    Kind::Choice { items, .. } => items.iter().any(|(item, _)| item == text),
                };
                assert!(fits, "{}@{}: {name} = {text}", entry.name, preset.name);
            }
        }
    }
}

/// Changes what the sensors of the target have seen.
fn spoil(sample: &mut Sample, how: impl Fn(&mut f64)) {
    for reading in &mut sample.sensors {
        if let Reading::Seen(z) = reading {
            how(&mut z[0]);
        }
    }
}

/// Whether a filter of [`everywhere`] looks for outliers.
fn edits(label: &str) -> bool {
    let name = label.split(' ').next().unwrap();
    FILTERS.iter().any(|entry| entry.name == name && entry.ours)
}

/// One sample that is off by a thousand kilometres or a radian, whatever the sensor and whenever it comes: a filter that edits stays
/// where it would be without it, and counts.
#[test]
fn a_wild_sample_moves_no_filter_that_edits() {
    let mut moved = 0.0_f64;
    for wild in [2, 3, 10, 29, 31, 100, 300] {
        for row in [0, 1] {
            for (label, mut nav, mut world, start) in everywhere(8, 1e-7) {
                let mut lost = Navigator::clone(&nav);
                for k in 1..=wild {
                    let mut sample = world.step();
                    let mut without = sample.clone();
                    if k == wild {
                        let off = if row == 0 { 1e6 } else { 1.0 };
                        for (z, none) in sample.sensors.iter_mut().zip(&mut without.sensors) {
                            if let Reading::Seen(z) = z {
                                z[row] += if label.ends_with("formation") { 1e6 } else { off };
                                *none = Reading::Lost;
                            }
                        }
                    }
                    nav.process(&sample, &start).unwrap();
                    lost.process(&without, &start).unwrap();
                }
                let off = (nav.estimate().x - lost.estimate().x).fixed_rows::<3>(0).norm();
                if edits(&label) {
                    assert!(off < 1e-9, "{label}: moved by {off} m at {wild} s");
                    assert_eq!(
                        (nav.status(), nav.outliers()),
                        (Status::Coasting, 1),
                        "{label} at {wild} s"
                    );
                } else {
                    assert_eq!(nav.outliers(), 0, "{label}");
                    moved = moved.max(off);
                }
            }
        }
    }
    assert!(moved > 1e3, "a filter that does not is moved: {moved} m");
}

/// A range that is not positive and a number that is none are never used, by any filter.
/// What a law is kept for, it does as it did: of the laws of constrained_q only the bank edits, unless told to.
#[test]
fn a_law_that_reproduces_edits_only_when_told_to() {
    for (law, mode, edits) in [(0, -1, true), (0, 0, false), (1, -1, false), (1, 1, true)] {
        let mut chosen = settings("constrained_q", 8);
        *chosen.tunable_mut("constrained_q", "law").unwrap() = Value::Choice(law);
        chosen.beliefs.editing_mode = mode;
        let (mut world, start) = OwnWorld::new(8, 1e-7);
        let mut nav = Navigator::new(&navigation("leo_venting"), &chosen, 0.0).unwrap();
        for k in 1..=100 {
            let mut sample = world.step();
            if k == 90 {
                spoil(&mut sample, |z| *z += 5000.0);
            }
            nav.process(&sample, &start).unwrap();
        }
        assert_eq!(nav.outliers(), i32::from(edits), "law {law}, editing.mode {mode}");
    }
}

#[test]
fn an_impossible_sample_is_a_dropout() {
    for (label, mut nav, mut world, start) in everywhere(9, 1e-7) {
        let mut passed_by = 0;
        for k in 1..=300 {
            let mut sample = world.step();
            match k {
                250 => spoil(&mut sample, |z| *z = f64::NAN),
                260 if label.ends_with("leo_venting") => spoil(&mut sample, |z| *z = -*z),
                _ => (),
            }
            nav.process(&sample, &start).unwrap();
            if nav.impossible() > passed_by {
                passed_by = nav.impossible();
                assert_eq!(nav.status(), Status::Coasting, "{label} at {k} s");
            }
        }
        assert_eq!(passed_by, if label.ends_with("leo_venting") { 2 } else { 1 }, "{label}");
        assert!(nav.estimate().x.iter().all(|v| v.is_finite()), "{label}");
    }
}

/// Whatever stands where a bound is told the truth: a filter does not read it, and a bound does not do without.
#[test]
fn only_bounds_hear_the_truth() {
    for (label, mut nav, mut world, start) in everywhere(5, 1e-6) {
        let name = label.split(' ').next().unwrap();
        if FILTERS.iter().any(|entry| entry.name == name && entry.bound) {
            let untold = Sample {
                untold: None,
                ..world.step()
            };
            let error = nav.process(&untold, &start).unwrap_err().to_string();
            assert!(error.contains("connect truth.dv_t_n"), "{label}: {error}");
            continue;
        }
        let mut lied_to = nav.clone();
        for k in 1..=200 {
            let sample = world.step();
            let lie = Untold {
                dv_t_n: Vector3::new(f64::from(k), -1e3, f64::NAN),
                event_time: 1e9,
            };
            let lie = Sample {
                untold: (k % 3 > 0).then_some(lie),
                ..sample.clone()
            };
            nav.process(&sample, &start).unwrap();
            lied_to.process(&lie, &start).unwrap();
            let [saved, other] = [&nav, &lied_to].map(|nav| postcard::to_allocvec(nav).unwrap());
            assert_eq!(saved, other, "{label} at {k} s");
        }
    }
}
