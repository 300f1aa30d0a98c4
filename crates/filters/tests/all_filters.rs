//! What every registered filter must do, in a world made of the filter's own assumptions: gravity of the filter, a
//! target driven by white jerk, sensors with exactly the noise that the filter expects.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod common;

use common::OwnWorld;
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::{Kind, Value};
use filters::{FilterError, Navigator, Sample, Settings, Status};
use nalgebra::Vector3;
use numerics::spd;

fn settings(filter: &str, run: u64) -> Settings {
    let filter = FILTERS.iter().position(|f| f.name == filter).unwrap();
    Settings {
        filter,
        run,
        ..Settings::default()
    }
}

fn nees(nav: &Navigator, truth: &State) -> f64 {
    let error = (nav.estimate().x - truth).fixed_rows::<9>(0).into_owned();
    let l = spd::cholesky(&nav.estimate().p_target).unwrap();
    spd::forward_substitution(&l, &error).norm_squared() / 9.0
}

#[test]
fn every_filter_keeps_its_covariance_positive_and_follows_the_target() {
    for entry in FILTERS {
        let (mut world, start) = OwnWorld::new(0, 1e-7);
        let mut nav = Navigator::new(&settings(entry.name, 0), 0.0).unwrap();
        assert_eq!(nav.status(), Status::Initialising);
        for k in 1..=900 {
            nav.process(&world.step(), &start).unwrap();
            let d = nav.dimension();
            let p = nav.estimate().p_target.view((0, 0), (d, d)).into_owned();
            assert!(p.cholesky().is_some(), "{} at {k} s", entry.name);
            assert!(
                nav.estimate()
                    .p_target
                    .view((d, 0), (9 - d, 9))
                    .iter()
                    .all(|v| *v == 0.0),
                "{}",
                entry.name
            );
        }
        assert_eq!(
            (nav.status(), nav.estimate().count),
            (Status::Tracking, 900),
            "{}",
            entry.name
        );
        let miss = (nav.estimate().x - world.x).fixed_rows::<3>(0).norm();
        let sigma = nav.estimate().sigma.fixed_rows::<3>(0).norm();
        assert!(miss < 5.0 * sigma, "{}: {miss} m against sigma {sigma} m", entry.name);
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
        let mut nav = Navigator::new(&chosen, 0.0).unwrap();
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
    for entry in FILTERS {
        let (mut world, start) = OwnWorld::new(3, 1e-6);
        let mut nav = Navigator::new(&settings(entry.name, 3), 0.0).unwrap();
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
            "{}",
            entry.name
        );
    }
}

#[test]
fn dropouts_coast_and_gaps_are_bridged() {
    for entry in FILTERS {
        let (mut world, start) = OwnWorld::new(4, 1e-6);
        let mut nav = Navigator::new(&settings(entry.name, 4), 0.0).unwrap();
        for k in 1..=400 {
            let mut sample = world.step();
            if k % 7 == 0 {
                sample.lidar = None;
            }
            if k % 50 == 20 {
                continue;
            }
            nav.process(&sample, &start).unwrap();
            // Handing the same sample over again changes nothing.
            let count = nav.estimate().clone();
            nav.process(&sample, &start).unwrap();
            assert_eq!(*nav.estimate(), count);
            assert_eq!(nav.status() == Status::Coasting, k % 7 == 0, "{} at {k} s", entry.name);
        }
        let miss = (nav.estimate().x - world.x).fixed_rows::<3>(0).norm();
        assert!(
            miss < 5.0 * nav.estimate().sigma.fixed_rows::<3>(0).norm(),
            "{}: {miss} m",
            entry.name
        );
    }
}

#[test]
fn a_filter_that_is_led_astray_says_so() {
    let (mut world, start) = OwnWorld::new(5, 1e-6);
    let mut nav = Navigator::new(&settings("fixed_q", 5), 0.0).unwrap();
    for k in 1..=600 {
        let mut sample = world.step();
        if k > 300 {
            // A second target that runs away faster than the filter can believe.
            sample.lidar = sample
                .lidar
                .map(|z| z + Vector3::new(0.5 * f64::from(k - 300).powi(2), 0.0, 0.0));
        }
        nav.process(&sample, &start).unwrap();
    }
    assert_eq!(nav.status(), Status::Diverged);
}

#[test]
fn senseless_samples_are_refused_by_name() {
    let fresh = || {
        (
            Navigator::new(&settings("fixed_q", 0), 0.0).unwrap(),
            OwnWorld::new(0, 1e-6),
        )
    };
    let (mut nav, (mut world, start)) = fresh();
    assert!(matches!(
        nav.process(&world.step(), &State::zeros()),
        Err(FilterError::NoInitialEstimate { .. })
    ));

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
    assert!(matches!(
        nav.process(&sample, &start),
        Err(FilterError::NotARotation { .. })
    ));

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
        ("r.sigma_angle", |s| s.beliefs.r_sigma_angle = -1.0),
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
        match Navigator::new(&chosen, 0.0) {
            Err(FilterError::OutOfRange { name: named, .. }) => assert_eq!(named, name),
            other => panic!("{name}: {other:?}"),
        }
    }
    let unknown = Settings {
        filter: 99,
        ..Settings::default()
    };
    assert!(
        Navigator::new(&unknown, 0.0)
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
                    Kind::Choice { items, .. } => items.contains(text),
                };
                assert!(fits, "{}@{}: {name} = {text}", entry.name, preset.name);
            }
        }
    }
}
