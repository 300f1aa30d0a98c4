//! Any subset of sensors, each at its own period: what a filter makes of them in a world of its own assumptions.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod common;

use astro::{Cr3bp, Lvlh, frames};
use common::OwnWorld;
use filters::dynamics::{TwoVehicles, initial_covariance};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Gravity, Navigator, Reading, Sample, Settings, Status, Units};
use interface::mission::{InitialSigma, KnownSensor, Quantity, embedded};
use interface::{Navigation, Sensor};
use nalgebra::{Matrix3, Vector3};
use numerics::{Generator, Source, stream};
use rand_distr::{Distribution, StandardNormal};

/// Sensors on board with their periods in seconds.
type Aboard = [(Sensor, u32)];

/// Deviations of the noise of each sensor, SI and radians.
fn sigmas(sensor: Sensor) -> Vec<f64> {
    let of = |quantity| match (sensor, quantity) {
        // As the world has it.
        (Sensor::Lidar, Quantity::Length) => 0.08,
        (Sensor::Lidar, _) => 0.04_f64.to_radians(),
        (_, Quantity::Length) => 0.1,
        (_, Quantity::Angle) => 2e-4,
        (_, Quantity::Velocity) => 1e-3,
    };
    sensor.sigmas().iter().map(|sigma| of(sigma.quantity)).collect()
}

fn told(mission: &str, aboard: &Aboard) -> Navigation {
    let known = |&(sensor, period): &(Sensor, u32)| KnownSensor {
        sensor,
        period_s: f64::from(period),
        sigmas: sigmas(sensor),
    };
    Navigation {
        sensors: aboard.iter().map(known).collect(),
        ..embedded(mission).unwrap().mission().unwrap().navigation()
    }
}

fn settings(filter: &str) -> Settings {
    Settings {
        filter: FILTERS.iter().position(|f| f.name == filter).unwrap(),
        ..Settings::default()
    }
}

fn normal(g: &mut Generator) -> f64 {
    StandardNormal.sample(g)
}

/// Replaces what a sample sees by what the sensors on board do; the LiDAR stays as it is when it is due.
fn seen(sample: &Sample, x: &State, second: u32, aboard: &Aboard, g: &mut Generator) -> Sample {
    let part = |slot: usize| x.fixed_rows::<3>(slot).into_owned();
    let (r_t, v_t) = (part(0) + part(9), part(3) + part(12));
    let lvlh = Lvlh::new(&r_t, &v_t, &astro::earth::FILTER.acceleration(&r_t));
    let (rho, rho_dot) = lvlh.relative(&part(9), &part(12));
    let scene = sensors::Scene {
        r_tc_n: part(0),
        v_tc_n: part(3),
        dcm_l_n: frames::lidar_from_body() * sample.dcm_bc_n,
        lvlh: sensors::metrology::measure(&rho, &rho_dot),
    };
    let mut all = sample.clone();
    for sensor in Sensor::ALL {
        let due = |(of, period): &&(Sensor, u32)| *of == sensor && second.is_multiple_of(*period);
        let mut z = sensors::of(sensor).measure(&scene);
        for (z, sigma) in z.iter_mut().zip(sensor.by_row(&sigmas(sensor))) {
            *z += sigma * normal(g);
        }
        match (aboard.iter().find(due), sensor) {
            (None, _) => all[sensor] = Reading::NotDue,
            (Some(_), Sensor::Lidar) if sample[sensor].is_due() => (),
            (Some(_), _) => all[sensor] = Reading::Seen(z),
        }
    }
    all
}

/// fixed_q is told the truth about its world; whatever it sees with, NEES and NIS must be one.
#[test]
fn any_subset_of_sensors_keeps_the_filter_consistent() {
    let every: Vec<(Sensor, u32)> = Sensor::ALL.into_iter().zip([1, 2, 5, 7].into_iter().cycle()).collect();
    let subsets: [&Aboard; 4] = [
        &[(Sensor::Camera, 1), (Sensor::Radio, 1)],
        &[(Sensor::Lidar, 10), (Sensor::Radio, 3)],
        &[(Sensor::Metrology, 2)],
        &every,
    ];
    let s = 3e-5;
    for (case, aboard) in subsets.into_iter().enumerate() {
        let told = told("leo_venting", aboard);
        let runs = 30;
        let (mut nees, mut nis, mut rows) = (0.0, 0.0, 0.0);
        for run in 0..runs {
            let (mut world, start) = OwnWorld::new(run, s);
            let mut chosen = settings("fixed_q");
            *chosen.tunable_mut("fixed_q", "s").unwrap() = Value::Real(s);
            let mut nav = Navigator::new(&told, &chosen, 0.0).unwrap();
            let g = &mut stream(12, run, Source::Metrology);
            for second in 1..=600 {
                let sample = world.step();
                let sample = seen(&sample, &world.x, second, aboard, g);
                nav.process(&sample, &start).unwrap();
                let measured = Sensor::ALL
                    .into_iter()
                    .filter(|sensor| sample[*sensor].seen().is_some());
                let count: usize = measured.map(Sensor::rows).sum();
                if count > 0 {
                    assert_eq!((nav.innovation().rows, nav.status()), (count, Status::Tracking));
                    nis += nav.innovation().nis;
                    rows += count as f64;
                }
            }
            let error = (nav.estimate().x - world.x).fixed_rows::<9>(0).into_owned();
            nees += error.dot(&nav.estimate().p_target.cholesky().unwrap().solve(&error)) / 9.0;
        }
        let (nees, nis) = (nees / runs as f64, nis / rows);
        // Chi-square of nine: three standard errors over the runs. NIS: as many rows as there were.
        assert!(
            (nees - 1.0).abs() < 3.0 * (2.0 / 9.0 / runs as f64).sqrt(),
            "subset {case}: NEES {nees}"
        );
        assert!(
            (nis - 1.0).abs() < 3.0 * (2.0_f64 / rows).sqrt() + 0.02,
            "subset {case}: NIS {nis}"
        );
    }
}

/// Rotating axes and nondimensional units: bearings and a radio about the Moon, two vehicles that fly freely.
#[test]
fn camera_and_radio_are_consistent_in_rotating_axes() {
    let aboard = [(Sensor::Camera, 2), (Sensor::Radio, 3)];
    let mut told = told("nrho_venting", &aboard);
    told.p0 = InitialSigma {
        position: 5.0,
        velocity: 0.02,
        acceleration: 1e-9,
        bias: 1e-9,
    };
    let units = Units {
        length: told.units.length_m,
        time: told.units.time_s,
    };
    let world = TwoVehicles {
        gravity: Gravity::Cr3bp(Cr3bp {
            mass_ratio: astro::cr3bp::EARTH_MOON_MASS_RATIO,
        }),
        acceleration_decay: 0.0,
        beta: 0.0,
        q_c: 0.0,
        q_coupled: true,
        q_bias: 0.0,
    };
    let unit = State::from_fn(|i, _| units.of_state(i));
    let runs = 20;
    let mut nees = 0.0;
    for run in 0..runs {
        let g = &mut stream(13, run, Source::InitialError);
        let mut x = State::zeros();
        for (slot, part) in [
            (0, Vector3::new(300.0, -700.0, 400.0) / units.length),
            (3, Vector3::new(0.1, 0.4, -0.2) / units.velocity()),
            (9, Vector3::new(0.9879, 1.432e-2, 2.009e-3)),
            (12, Vector3::new(7.173e-2, 0.9238, -0.8528)),
        ] {
            x.fixed_rows_mut::<3>(slot).copy_from(&part);
        }
        let drawn = initial_covariance(&told.p0).cholesky().unwrap().unpack() * State::from_fn(|_, _| normal(g));
        let start = x.component_mul(&unit) + drawn;
        let mut chosen = settings("snc");
        *chosen.tunable_mut("snc", "q").unwrap() = Value::Real(1e-9);
        let mut nav = Navigator::new(&told, &chosen, 0.0).unwrap();
        for second in 1..=600_u32 {
            x = world.propagate_mean(&x, 1.0 / units.time, &filters::dynamics::Drive::default());
            let si = x.component_mul(&unit);
            let part = |slot: usize| si.fixed_rows::<3>(slot).into_owned();
            let blank = Sample {
                dcm_bc_n: frames::los_body_axes(&part(0), &part(3), &Vector3::z()),
                ..Sample::blank(second as i32, f64::from(second))
            };
            let sample = seen(&blank, &si, second, &aboard, g);
            nav.process(&sample, &start).unwrap();
        }
        let error = (nav.estimate().x - x.component_mul(&unit))
            .fixed_rows::<6>(0)
            .into_owned();
        let p = nav.estimate().p_target.fixed_view::<6, 6>(0, 0).into_owned();
        nees += error.dot(&p.cholesky().unwrap().solve(&error)) / 6.0 / runs as f64;
    }
    assert!(
        (nees - 1.0).abs() < 3.0 * (2.0 / 6.0 / runs as f64).sqrt(),
        "NEES {nees}"
    );
}

#[test]
fn only_a_sensor_that_was_due_can_be_missed() {
    let aboard = [(Sensor::Lidar, 1), (Sensor::Camera, 1)];
    let told = told("leo_venting", &aboard);
    let (mut world, start) = OwnWorld::new(0, 1e-6);
    let mut nav = Navigator::new(&told, &settings("snc"), 0.0).unwrap();
    let mut next = |lidar: Told, camera: Told, radio: Told| {
        let mut sample = world.step();
        for (sensor, told) in [(Sensor::Lidar, lidar), (Sensor::Camera, camera), (Sensor::Radio, radio)] {
            match told {
                Told::NotDue => sample[sensor] = Reading::NotDue,
                Told::Lost => sample[sensor] = Reading::Lost,
                Told::Seen => (),
            }
        }
        nav.process(&sample, &start).unwrap();
        (nav.status(), nav.innovation().rows)
    };
    use Told::{Lost, NotDue, Seen};
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Initialising, 0), "nothing yet");
    assert_eq!(next(Seen, NotDue, NotDue), (Status::Tracking, 3));
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Tracking, 3), "nothing was due");
    assert_eq!(next(Lost, NotDue, NotDue), (Status::Coasting, 3));
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Coasting, 3), "still unseen");
    assert_eq!(next(Seen, Lost, NotDue), (Status::Tracking, 3), "one of two");
    assert_eq!(next(NotDue, NotDue, Lost), (Status::Tracking, 3), "no radio on board");
}

/// What a sensor is made to say; `Seen` is what the world says.
#[derive(Clone, Copy)]
enum Told {
    NotDue,
    Lost,
    Seen,
}

/// A window of all sensors' rows, some of which are absent at most epochs.
#[test]
fn laws_on_windows_go_on_with_any_sensors() {
    let aboard: Vec<(Sensor, u32)> = Sensor::ALL.into_iter().zip([1, 2, 3, 5].into_iter().cycle()).collect();
    let told = told("leo_venting", &aboard);
    for filter in ["milton", "constrained_q", "rbfnn_ekf", "rbfnn_aekf"] {
        let (mut world, start) = OwnWorld::new(2, 1e-6);
        let mut chosen = settings(filter);
        if let Some(law) = chosen.tunable_mut(filter, "law") {
            *law = Value::Choice(1);
        }
        let mut nav = Navigator::new(&told, &chosen, 0.0).unwrap();
        let g = &mut stream(14, 0, Source::Metrology);
        for second in 1..=300 {
            let sample = world.step();
            let sample = seen(&sample, &world.x, second, &aboard, g);
            nav.process(&sample, &start).unwrap();
        }
        if filter != "rbfnn_ekf" {
            assert!(nav.updates() > 0, "{filter}");
        }
        let miss = (nav.estimate().x - world.x).fixed_rows::<3>(0).norm();
        assert!(miss < 1.0, "{filter}: {miss} m");
    }
}

#[test]
fn attitude_does_not_matter_to_a_radio() {
    let aboard = [(Sensor::Radio, 1)];
    let told = told("leo_venting", &aboard);
    let runs: Vec<State> = [true, false]
        .into_iter()
        .map(|turned| {
            let (mut world, start) = OwnWorld::new(3, 1e-6);
            let mut nav = Navigator::new(&told, &settings("snc"), 0.0).unwrap();
            let g = &mut stream(15, 0, Source::Metrology);
            for second in 1..=60 {
                let mut sample = seen(&world.step(), &world.x, second, &aboard, g);
                sample.accelerometer = None;
                if turned {
                    sample.dcm_bc_n = Matrix3::identity();
                }
                nav.process(&sample, &start).unwrap();
            }
            nav.estimate().x
        })
        .collect();
    assert_eq!(runs[0], runs[1]);
}
