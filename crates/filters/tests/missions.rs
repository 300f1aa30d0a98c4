//! Filters in missions of other people: sensors of any kind and period, means of an accelerometer, told manoeuvres, fields of
//! harmonics. The truth is a small one of its own.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod flight;

use filters::laws::FILTERS;
use filters::tunable::{Kind, Start, Value};
use filters::{Navigation, Navigator, Reading, Settings, Status};
use flight::{Flight, Push};
use interface::Sensor;
use interface::mission::EMBEDDED;
use nalgebra::{Vector3, Vector6};

/// A low orbit; `sensors` and `navigation` are the rest of the file.
fn low_orbit(sensors: &str, navigation: &str) -> Navigation {
    flight::orbit([6.878e6, 0.001], [5.0, 0.05], sensors, navigation)
}

fn zonal(r: &Vector3<f64>) -> Vector3<f64> {
    astro::earth::FILTER.acceleration(r)
}

fn fly(told: &Navigation, run: u64) -> (Flight, filters::state::State) {
    let target = Vector6::new(6.871e6, 0.0, 0.0, 0.0, 7357.0, 1971.0);
    let relative = Vector6::new(300.0, -900.0, 250.0, 0.1, 0.5, -0.2);
    Flight::new(told, Box::new(|_, r, _| zonal(r)), &target, &relative, run)
}

fn navigator(told: &Navigation, filter: &str, tunable: &str, value: f64) -> Navigator {
    let mut settings = Settings {
        filter: FILTERS.iter().position(|f| f.name == filter).unwrap(),
        ..Settings::default()
    };
    *settings.tunable_mut(filter, tunable).unwrap() = Value::Real(value);
    Navigator::new(told, &settings, 0.0).unwrap()
}

/// NEES of relative position and velocity over six.
fn nees(nav: &Navigator, flight: &Flight) -> f64 {
    let error = nav.estimate().x.fixed_rows::<6>(0) - flight.relative();
    let p = nav.estimate().p_target.fixed_view::<6, 6>(0, 0).into_owned();
    (error.transpose() * p.cholesky().unwrap().solve(&error))[0] / 6.0
}

/// Mean NEES from `from` s on, of some runs of 900 s with the filter that knows its world but for `q`.
fn mean_nees(told: &Navigation, q: f64, from: f64, arrange: impl Fn(&mut Flight, u64)) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for run in 0..12 {
        let (mut flight, start) = fly(told, run);
        arrange(&mut flight, run);
        let mut nav = navigator(told, "snc", "q", q);
        loop {
            let sample = flight.next();
            if sample.time > 900.0 {
                break;
            }
            nav.process(&sample, &start).unwrap();
            if sample.time >= from {
                sum += nees(&nav, &flight);
                count += 1.0;
            }
        }
    }
    sum / count
}

/// Fourteen metres from the target, with a first estimate that is off by as much, the first update goes far astray, and what the
/// sensors say then is far beyond what the filter believes. It mostly finds back by itself, and must not be kept from it: of range
/// and angles a target straight behind has the same, and there a filter ended that had taken the truth for outliers.
#[test]
fn a_filter_that_began_astray_does_not_take_the_truth_for_outliers() {
    let sensors =
        "[sensors.lidar]\nsigma_range_m = 0.08\nsigma_angle_deg = 0.04\n[sensors.accelerometer]\nsigma_m_s2 = 3.4e-6";
    let mut told = low_orbit(sensors, "chaser_q_c_m2_s3 = 1e-12");
    (told.p0.position, told.p0.velocity) = (25.0 / 3.0, 0.1);
    let target = Vector6::new(6.871e6, 0.0, 0.0, 0.0, 7357.0, 1971.0);
    let relative = Vector6::new(5.0, -12.0, 5.0, 0.0, 0.0, 0.0);
    let mut astray = 0;
    for run in 0..20 {
        let (mut flight, start) = Flight::new(&told, Box::new(|_, r, _| zonal(r)), &target, &relative, run);
        let mut nav = navigator(&told, "snc", "q", 3e-5);
        for k in 1..=300 {
            nav.process(&flight.next(), &start).unwrap();
            if k == 30 {
                astray += i32::from(nav.innovation().nis > 1e3);
            }
        }
        assert!(nav.outliers() <= 2, "run {run}: {} passed by", nav.outliers());
    }
    assert!(astray > 3, "{astray} runs began astray");
}

/// A target that gains 0.2 m/s in ten seconds leaves a quiet filter behind for minutes.
#[test]
fn a_filter_that_lags_does_not_take_the_truth_for_outliers() {
    let sensors =
        "[sensors.lidar]\nsigma_range_m = 0.08\nsigma_angle_deg = 0.04\n[sensors.accelerometer]\nsigma_m_s2 = 3.4e-6";
    let told = low_orbit(sensors, "chaser_q_c_m2_s3 = 1e-12");
    for q in [2e-6, 1e-5, 1e-4] {
        let (mut flight, start) = fly(&told, 5);
        flight.on_target.push(Push {
            from: 300.0,
            to: 310.0,
            a_n: Vector3::new(0.015, -0.01, 0.008),
        });
        let mut nav = navigator(&told, "snc", "q", q);
        let mut behind = 0.0_f64;
        for _ in 0..600 {
            nav.process(&flight.next(), &start).unwrap();
            behind = behind.max(nav.innovation().nis);
        }
        assert!(behind > 100.0, "q {q}: never behind");
        assert!(nav.outliers() <= 3, "q {q}: {} passed by", nav.outliers());
    }
}

fn burn(run: u64) -> Push {
    // Its edges fall on every phase of the sample periods.
    let from = 400.0 + run as f64 * 1.0;
    Push {
        from,
        to: from + 30.0,
        a_n: Vector3::new(-0.7071e-2, -0.7071e-2, 0.0),
    }
}

/// The mean fixes the velocity gained at any period, and what it leaves open of the position is in the covariance.
#[test]
fn means_of_the_accelerometer_are_right_at_every_period() {
    let mut found = Vec::new();
    for period in [1.0, 2.0, 3.0, 4.0, 7.0, 10.0, 20.0] {
        let sensors = format!(
            "[sensors.lidar]\nperiod_s = {period:.1}\n[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = {period:.1}\nbias_sigma_m_s2 = 0.0"
        );
        let told = low_orbit(&sensors, "chaser_q_c_m2_s3 = 1e-12");
        let during = mean_nees(&told, 1e-6, 380.0, |flight, run| flight.on_chaser.push(burn(run)));
        found.push((period, during));
    }
    assert!(found.iter().all(|(_, nees)| (0.5..1.5).contains(nees)), "{found:?}");
}

/// A thrust below the gate, and a burn that fills so little of an interval that its mean lies below it: neither its velocity is
/// lost nor is the bias taken for it.
#[test]
fn means_below_the_gate_count_where_no_noise_can_account_for_them() {
    let sensors = "[sensors.lidar]\nperiod_s = 10.0\n[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = 10.0\nbias_sigma_m_s2 = 0.0";
    let told = low_orbit(sensors, "chaser_q_c_m2_s3 = 1e-12");
    let weak = |flight: &mut Flight, run: u64| {
        let from = 400.0 + run as f64;
        let a_n = Vector3::new(5e-5, -5e-5, 0.0);
        flight.on_chaser.push(Push {
            from,
            to: from + 200.0,
            a_n,
        });
    };
    let short = |flight: &mut Flight, run: u64| {
        flight.grid = 0.1;
        let a_n = Vector3::new(0.0, 9e-3, 0.0);
        let from = 400.0 + 10.0 * run as f64;
        flight.on_chaser.push(Push {
            from,
            to: from + 0.1,
            a_n,
        });
    };
    let found = [
        mean_nees(&told, 1e-6, 380.0, weak),
        mean_nees(&told, 1e-6, 380.0, short),
    ];
    assert!(found.iter().all(|nees| (0.5..1.5).contains(nees)), "{found:?}");
}

/// Where the accelerometer is the fastest sensor, a bank of one is its member at every epoch, not only at those of the LiDAR.
#[test]
fn a_bank_knows_between_the_samples_how_unsure_it_is() {
    let sensors = "[sensors.lidar]\nperiod_s = 10.0\n[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = 1.0\nbias_sigma_m_s2 = 0.0";
    let told = low_orbit(sensors, "chaser_q_c_m2_s3 = 1e-12");
    let mut snc = navigator(&told, "snc", "q", 1e-3);
    let mut bank = Settings {
        filter: FILTERS.iter().position(|f| f.name == "mmae").unwrap(),
        ..Settings::default()
    };
    for (name, value) in [("lowest", Value::Real(1e-3)), ("members", Value::Integer(1))] {
        *bank.tunable_mut("mmae", name).unwrap() = value;
    }
    let mut bank = Navigator::new(&told, &bank, 0.0).unwrap();
    let (mut flight, start) = fly(&told, 3);
    let mut grown = 0.0_f64;
    for k in 0..300 {
        let sample = flight.next();
        let before = bank.estimate().sigma[0];
        for nav in [&mut snc, &mut bank] {
            nav.process(&sample, &start).unwrap();
        }
        let ratio = bank
            .estimate()
            .sigma
            .fixed_rows::<6>(0)
            .component_div(&snc.estimate().sigma.fixed_rows::<6>(0));
        if k > 30 {
            assert!(ratio.iter().all(|ratio| (ratio - 1.0).abs() < 1e-3), "{k}: {ratio}");
            grown = grown.max(bank.estimate().sigma[0] / before);
        }
    }
    assert!(grown > 1.02, "{grown}: there is something to compare");
}

/// Where the accelerometer is the slowest sensor, its means are held and made good when they come.
#[test]
fn a_slow_accelerometer_loses_no_velocity() {
    let mut found = Vec::new();
    for period in [5.0, 10.0] {
        let sensors = format!(
            "[sensors.lidar]\n[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = {period:.1}\nbias_sigma_m_s2 = 0.0"
        );
        let told = low_orbit(&sensors, "chaser_q_c_m2_s3 = 1e-12");
        found.push(mean_nees(&told, 3e-5, 600.0, |flight, run| {
            flight.on_chaser.push(burn(run))
        }));
    }
    assert!(found.iter().all(|nees| (0.3..2.0).contains(nees)), "{found:?}");
}

/// Where the first estimate is as uncertain as the target is near, the slopes of one pass lead astray; those of several do not.
#[test]
fn an_update_goes_on_until_its_slopes_hold() {
    let found = |passes: u32| {
        let mut told = low_orbit("[sensors.lidar]", "chaser_q_c_m2_s3 = 1e-12");
        told.update_passes = passes;
        (told.p0.position, told.p0.velocity) = (0.4, 1e-3);
        let (target, relative) = (
            Vector6::new(6.871e6, 0.0, 0.0, 0.0, 7357.0, 1971.0),
            Vector6::new(1.5, -1.0, 0.8, 1e-3, 5e-3, -2e-3),
        );
        let runs = 200;
        let mut sum = 0.0;
        for run in 0..runs {
            let (mut flight, start) = Flight::new(&told, Box::new(|_, r, _| zonal(r)), &target, &relative, run);
            let mut nav = navigator(&told, "snc", "q", 1e-6);
            nav.process(&flight.next(), &start).unwrap();
            sum += nees(&nav, &flight) / runs as f64;
        }
        sum
    };
    let (one, many) = (found(0), found(8));
    assert!(one > 3.0 && (0.8..1.3).contains(&many), "{one} {many}");
}

/// What is told of the target's burn is not lost, wherever its edges fall, and in whatever axes it is told.
#[test]
fn told_burns_are_in_the_dynamics() {
    let (from, to) = (400.3, 430.6);
    let told = |told: bool, axes: &str, direction: &str| -> Navigation {
        let burn = format!(
            "[[burn]]\nvehicle = \"target\"\nname = \"avoid\"\nstart_s = {from}\nduration_s = {}\nacceleration_m_s2 = 1e-2\ndirection = {direction}\naxes = \"{axes}\"\ntold = {told}\n",
            to - from
        );
        low_orbit(&format!("{burn}[sensors.lidar]"), "chaser_q_c_m2_s3 = 1e-12")
    };
    let along = |a_n: Vector3<f64>| {
        move |flight: &mut Flight, _: u64| {
            flight.grid = 0.1;
            flight.on_target.push(Push { from, to, a_n });
        }
    };
    let x = Vector3::new(1e-2, 0.0, 0.0);
    let without = mean_nees(&told(false, "n", "[1.0, 0.0, 0.0]"), 1e-6, 380.0, along(x));
    assert!(without > 10.0, "{without}");
    for axes in ["n", "inertial"] {
        let with = mean_nees(&told(true, axes, "[1.0, 0.0, 0.0]"), 1e-6, 380.0, along(x));
        assert!((0.5..1.5).contains(&with), "{axes}: {with}");
    }
    // The orbit's normal barely moves in the time, so that its direction in N is known: (0, -sin i, cos i).
    let (r, v) = (Vector3::new(6.871e6, 0.0, 0.0), Vector3::new(0.0, 7357.0, 1971.0));
    let with = mean_nees(
        &told(true, "rtn", "[0.0, 0.0, 1.0]"),
        1e-6,
        380.0,
        along(r.cross(&v).normalize() * 1e-2),
    );
    assert!((0.5..1.5).contains(&with), "rtn: {with}");
    // The mission file refuses it first.
    let mut body = told(true, "n", "[1.0, 0.0, 0.0]");
    body.told[0].axes = interface::mission::Axes::Body;
    let error = Navigator::new(&body, &Settings::default(), 0.0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("attitude is not known"), "{error}");
}

/// Camera and radio at periods of their own: consistent, and an epoch without either of them is no dropout.
#[test]
fn any_subset_of_sensors_at_any_period() {
    let subsets = [
        "[sensors.camera]\nperiod_s = 2.0\n[sensors.radio]\nperiod_s = 10.0\nsigma_range_rate_m_s = 2e-3",
        "[sensors.lidar]\nperiod_s = 5.0\n[sensors.radio]\nperiod_s = 1.0\n[sensors.camera]\nperiod_s = 3.0",
        "[sensors.metrology]\nperiod_s = 4.0\n[sensors.camera]\nperiod_s = 1.0",
    ];
    for sensors in subsets {
        let told = low_orbit(sensors, "chaser_q_c_m2_s3 = 1e-12");
        let found = mean_nees(&told, 1e-6, 100.0, |_, _| ());
        assert!((0.5..1.5).contains(&found), "{sensors}: {found}");
        for filter in FILTERS.iter().filter(|f| f.no_meaning_in(&told).is_none()) {
            let settings = Settings {
                filter: FILTERS.iter().position(|f| f.name == filter.name).unwrap(),
                ..Settings::default()
            };
            let (mut flight, start) = fly(&told, 1);
            let mut nav = Navigator::new(&told, &settings, 0.0).unwrap();
            for _ in 0..200 {
                nav.process(&flight.next(), &start).unwrap();
            }
            let miss = (nav.estimate().x.fixed_rows::<6>(0) - flight.relative())
                .fixed_rows::<3>(0)
                .norm();
            assert!(miss < 30.0, "{} with {sensors}: {miss} m", filter.name);
        }
    }
}

#[test]
fn due_and_lost_is_a_dropout_and_not_due_is_none() {
    let told = low_orbit(
        "[sensors.lidar]\nperiod_s = 2.0\n[sensors.accelerometer]\noutput = \"mean\"",
        "",
    );
    let (mut flight, start) = fly(&told, 0);
    let mut nav = navigator(&told, "snc", "q", 1e-6);
    let mut next = |nav: &mut Navigator, lost: bool| {
        let mut sample = flight.next();
        if lost {
            sample[Sensor::Lidar] = Reading::Lost;
        }
        nav.process(&sample, &start).unwrap();
        (sample[Sensor::Lidar].is_due(), nav.status(), nav.innovation().rows)
    };
    assert_eq!(next(&mut nav, false), (false, Status::Initialising, 0));
    assert_eq!(next(&mut nav, false), (true, Status::Tracking, 3));
    assert_eq!(next(&mut nav, false), (false, Status::Tracking, 3));
    assert_eq!(next(&mut nav, true), (true, Status::Coasting, 3));
    assert_eq!(next(&mut nav, false), (false, Status::Coasting, 3));
    assert_eq!(next(&mut nav, false), (true, Status::Tracking, 3));
}

/// The field of harmonics with its turning: a filter told of it is consistent over half an orbit's worth of its pull.
#[test]
fn harmonics_are_in_the_filters_gravity() {
    let told = low_orbit(
        "[sensors.lidar]",
        "chaser_q_c_m2_s3 = 1e-14\ngravity = { model = \"harmonics\", field = \"egm96_3x3\" }",
    );
    let epoch = astro::epoch::julian_date("2020-01-01T00:00:00").unwrap();
    let earth = astro::CentralBody::new("earth", epoch).unwrap();
    let field = astro::SphericalHarmonics::new(astro::harmonics::EGM96.coefficients());
    let gravity = move |t: f64, r: &Vector3<f64>| {
        let dcm = earth.dcm_f_n(t);
        dcm.tr_mul(&field.acceleration(&(dcm * r)))
    };
    let target = Vector6::new(6.871e6, 0.0, 0.0, 0.0, 7357.0, 1971.0);
    let relative = Vector6::new(300.0, -900.0, 250.0, 0.1, 0.5, -0.2);
    let (mut flight, start) = Flight::new(&told, Box::new(move |t, r, _| gravity(t, r)), &target, &relative, 0);
    // Nothing is seen: what is left is how the model carries an estimate that begins without error.
    let mut exact = start;
    exact.fixed_rows_mut::<6>(0).copy_from(&relative);
    exact.fixed_rows_mut::<6>(9).copy_from(&(target - relative));
    let mut nav = navigator(&told, "snc", "q", 1e-9);
    for _ in 0..90 {
        let mut sample = flight.next();
        sample[Sensor::Lidar] = Reading::Lost;
        nav.process(&sample, &exact).unwrap();
    }
    let miss = (nav.estimate().x.fixed_rows::<3>(0) - flight.relative().fixed_rows::<3>(0)).norm();
    // The field is held over each second: 7e-5 rad of the tesseral part, 1e-5 g, of a kilometre's difference.
    assert!(miss < 1e-5, "{miss} m");
    let mut without = told.clone();
    without.epoch_utc = None;
    let error = Navigator::new(&without, &Settings::default(), 0.0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("time.epoch_utc"), "{error}");
}

/// Every start value that a mission states is one that a law takes from it, and differs from what would be derived.
#[test]
fn exceptions_are_declared_and_are_exceptions() {
    for entry in EMBEDDED {
        let told = entry.mission().unwrap().navigation();
        assert!(
            Navigator::new(&told, &Settings::default(), 0.0).is_ok(),
            "{}",
            entry.name
        );
        for (name, stated) in &told.law {
            let (law, tunable) = name.split_once('.').unwrap();
            let filter = FILTERS.iter().find(|f| f.name == law).unwrap();
            let declared = filter.tunables.iter().find(|t| t.name == tunable).unwrap();
            let Kind::Real {
                start: Start::Derived(rule),
                ..
            } = declared.kind
            else {
                panic!("{name} starts at the same value in every mission");
            };
            let derived = rule(&filters::tunable::Scales::of(&told));
            assert!(
                (derived / stated - 1.0).abs() > 1e-12,
                "{}: {name} would be derived",
                entry.name
            );
        }
        let mut wrong = told.clone();
        wrong.law.insert("snc.qq".into(), 1.0);
        let error = Navigator::new(&wrong, &Settings::default(), 0.0)
            .unwrap_err()
            .to_string();
        assert!(error.contains("\"snc.qq\"") && error.contains("snc.q,"), "{error}");
    }
}

/// A mission that states its scales and nothing else gives every law a start that it accepts, and that moves with the scales.
#[test]
fn scales_alone_start_every_law() {
    for (sensors, frame) in [
        ("[sensors.lidar]\n[sensors.accelerometer]", ""),
        ("[sensors.camera]\n[sensors.radio]", ""),
        ("[sensors.metrology]", "frame = \"lvlh\""),
    ] {
        for (disturbance, time) in [(1e-8, 1.0), (5e-6, 10.0), (1e-3, 1e4)] {
            let scale = format!(
                "{frame}\n[navigation.scale]\ndisturbance_m_s2 = {disturbance:e}\ndisturbance_time_s = {time:.1}"
            );
            let told = low_orbit(sensors, &scale);
            assert!(told.law.is_empty());
            for (filter, entry) in FILTERS.iter().enumerate() {
                if entry.no_meaning_in(&told).is_some() {
                    continue;
                }
                let settings = Settings {
                    filter,
                    ..Settings::default()
                };
                let built = Navigator::new(&told, &settings, 0.0);
                assert!(built.is_ok(), "{}: {:?}", entry.name, built.err());
            }
        }
    }
}

/// The mission file refuses it first; whoever builds a filter by hand is told as well.
#[test]
fn the_lvlh_frame_takes_a_metrology_alone() {
    let mut told = low_orbit("[sensors.lidar]", "");
    told.frame = interface::mission::Frame::Lvlh;
    let error = Navigator::new(&told, &Settings::default(), 0.0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("metrology alone"), "{error}");
}

/// A push that a quiet filter is thrown off by leaves the error of the one that is told of it where it was.
#[test]
fn a_clairvoyant_filter_errs_as_if_nothing_pushed() {
    let told = low_orbit("[sensors.lidar]", "chaser_q_c_m2_s3 = 1e-12");
    let push = Push {
        from: 400.0,
        to: 430.0,
        a_n: Vector3::new(1e-3, -2e-3, 1e-3),
    };
    let error = |filter: &str, tunable: &str, pushes: &[Push]| {
        let (mut flight, start) = fly(&told, 2);
        flight.on_target.extend(pushes);
        let mut nav = navigator(&told, filter, tunable, 1e-7);
        for _ in 0..600 {
            nav.process(&flight.next(), &start).unwrap();
        }
        let error = nav.estimate().x.fixed_rows::<6>(0) - flight.relative();
        error.component_div(&nav.estimate().sigma.fixed_rows::<6>(0))
    };
    let moved = |filter, tunable| (error(filter, tunable, &[push]) - error(filter, tunable, &[])).amax();
    // The target is some metres elsewhere, of hundreds: it is seen as much differently.
    let (clairvoyant, snc) = (moved("clairvoyant", "q"), moved("snc", "q"));
    assert!(clairvoyant < 0.1 && snc > 10.0, "{clairvoyant} and {snc} sigma");
}

/// Between samples that see nothing the variance of velocity grows by the high density for as long as the push lasts, whatever part
/// of an interval that is.
#[test]
fn the_density_is_high_for_as_long_as_something_pushes() {
    let told = low_orbit("[sensors.lidar]\nperiod_s = 5.0", "");
    let (mut flight, start) = fly(&told, 1);
    flight.on_target.push(Push {
        from: 307.0,
        to: 315.0,
        a_n: Vector3::new(0.0, 1e-4, 0.0),
    });
    let mut nav = navigator(&told, "times_known", "q_active", 0.1);
    let mut variances = [0.0; 2];
    for _ in 0..64 {
        let mut sample = flight.next();
        if sample.time > 300.0 {
            sample.sensors.fill(Reading::Lost);
        }
        nav.process(&sample, &start).unwrap();
        variances[usize::from(sample.time > 300.0)] = nav.estimate().p_target[(4, 4)];
    }
    let growth = variances[1] - variances[0];
    assert!((growth / (0.01 * 8.0) - 1.0).abs() < 1e-3, "{growth}");
}
