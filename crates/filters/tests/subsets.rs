//! Any subset of sensors, each at its own period: what a filter makes of them in a world of its own assumptions.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod common;

use astro::{Cr3bp, Lvlh, TargetOrbit, frames};
use common::OwnWorld;
use filters::dynamics::{TwoVehicles, initial_covariance};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Gravity, Navigator, Reading, Sample, Settings, Status, Units};
use interface::Navigation;
use interface::mission::{InitialSigma, KnownCamera, KnownLidar, KnownMetrology, KnownRadio, embedded};
use nalgebra::{Matrix3, Vector2, Vector3, Vector6};
use numerics::{Generator, Source, stream};
use rand_distr::{Distribution, StandardNormal};

const SIGMA_CAMERA: f64 = 2e-4;
const SIGMA_RADIO: [f64; 2] = [0.5, 2e-3];
const SIGMA_METROLOGY: [f64; 2] = [0.05, 1e-3];

/// Sensors on board with their periods in seconds.
#[derive(Clone, Copy)]
struct Aboard {
    lidar: Option<u32>,
    camera: Option<u32>,
    radio: Option<u32>,
    metrology: Option<u32>,
}

fn told(mission: &str, aboard: &Aboard) -> Navigation {
    Navigation {
        lidar: aboard.lidar.map(|period| KnownLidar {
            period_s: f64::from(period),
            sigma_range_m: 0.08,
            sigma_angle_rad: 0.04_f64.to_radians(),
        }),
        camera: aboard.camera.map(|period| KnownCamera {
            period_s: f64::from(period),
            sigma_angle_rad: SIGMA_CAMERA,
        }),
        radio: aboard.radio.map(|period| KnownRadio {
            period_s: f64::from(period),
            sigma_range_m: SIGMA_RADIO[0],
            sigma_range_rate_m_s: SIGMA_RADIO[1],
        }),
        metrology: aboard.metrology.map(|period| KnownMetrology {
            period_s: f64::from(period),
            sigma_position_m: SIGMA_METROLOGY[0],
            sigma_velocity_m_s: SIGMA_METROLOGY[1],
        }),
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

/// `value` when the sensor is aboard and due at this second.
fn due<T>(period: Option<u32>, second: u32, value: T) -> Reading<T> {
    match period {
        Some(period) if second.is_multiple_of(period) => Reading::Seen(value),
        _ => Reading::NotDue,
    }
}

/// Replaces what a sample sees by what the sensors on board do; the LiDAR stays as it is when it is due.
fn seen(sample: &Sample, x: &State, second: u32, aboard: &Aboard, g: &mut Generator) -> Sample {
    let part = |slot: usize| x.fixed_rows::<3>(slot).into_owned();
    let (r_tc, v_tc, r_t, v_t) = (part(0), part(3), part(0) + part(9), part(3) + part(12));
    let rho = frames::lidar_from_body() * sample.dcm_bc_n * r_tc;
    let angles = sensors::camera::measure(&rho) + Vector2::from_fn(|_, _| SIGMA_CAMERA * normal(g));
    let radio = sensors::radio::measure(&r_tc, &v_tc) + Vector2::from_fn(|i, _| SIGMA_RADIO[i] * normal(g));
    let lvlh = Lvlh::new(&r_t, &v_t, &astro::earth::FILTER.acceleration(&r_t));
    let (rho, rho_dot) = lvlh.relative(&part(9), &part(12));
    let metrology =
        sensors::metrology::measure(&rho, &rho_dot) + Vector6::from_fn(|i, _| SIGMA_METROLOGY[i / 3] * normal(g));
    Sample {
        lidar: match (due(aboard.lidar, second, ()), sample.lidar) {
            (Reading::Seen(()), lidar) => lidar,
            _ => Reading::NotDue,
        },
        camera: due(aboard.camera, second, angles),
        radio: due(aboard.radio, second, radio),
        metrology: due(aboard.metrology, second, metrology),
        ..sample.clone()
    }
}

/// fixed_q is told the truth about its world; whatever it sees with, NEES and NIS must be one.
#[test]
fn any_subset_of_sensors_keeps_the_filter_consistent() {
    let none = Aboard {
        lidar: None,
        camera: None,
        radio: None,
        metrology: None,
    };
    let subsets = [
        Aboard {
            camera: Some(1),
            radio: Some(1),
            ..none
        },
        Aboard {
            lidar: Some(10),
            radio: Some(3),
            ..none
        },
        Aboard {
            metrology: Some(2),
            ..none
        },
        Aboard {
            lidar: Some(1),
            camera: Some(2),
            radio: Some(5),
            metrology: Some(7),
        },
    ];
    let s = 3e-5;
    for (case, aboard) in subsets.iter().enumerate() {
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
                let expected = [
                    (sample.lidar.seen().is_some(), 3),
                    (sample.camera.seen().is_some(), 2),
                    (sample.radio.seen().is_some(), 2),
                    (sample.metrology.seen().is_some(), 6),
                ];
                let count: usize = expected.iter().filter(|(is, _)| *is).map(|(_, rows)| rows).sum();
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
    let aboard = Aboard {
        lidar: None,
        camera: Some(2),
        radio: Some(3),
        metrology: None,
    };
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
                count: second as i32,
                time: f64::from(second),
                lidar: Reading::NotDue,
                camera: Reading::NotDue,
                radio: Reading::NotDue,
                metrology: Reading::NotDue,
                target_orbit: TargetOrbit::from_vector(&Vector6::zeros()),
                accelerometer: None,
                dcm_bc_n: frames::los_body_axes(&part(0), &part(3), &Vector3::z()),
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
    let aboard = Aboard {
        lidar: Some(1),
        camera: Some(1),
        radio: None,
        metrology: None,
    };
    let told = told("leo_venting", &aboard);
    let (mut world, start) = OwnWorld::new(0, 1e-6);
    let mut nav = Navigator::new(&told, &settings("snc"), 0.0).unwrap();
    let mut next = |lidar: Reading<()>, camera: Reading<Vector2<f64>>, radio: Reading<Vector2<f64>>| {
        let mut sample = world.step();
        sample.lidar = match lidar {
            Reading::Seen(()) => sample.lidar,
            Reading::Lost => Reading::Lost,
            Reading::NotDue => Reading::NotDue,
        };
        (sample.camera, sample.radio) = (camera, radio);
        nav.process(&sample, &start).unwrap();
        (nav.status(), nav.innovation().rows)
    };
    use Reading::{Lost as Missed, NotDue, Seen as Measured};
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Initialising, 0), "nothing yet");
    assert_eq!(next(Measured(()), NotDue, NotDue), (Status::Tracking, 3));
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Tracking, 3), "nothing was due");
    assert_eq!(next(Missed, NotDue, NotDue), (Status::Coasting, 3));
    assert_eq!(next(NotDue, NotDue, NotDue), (Status::Coasting, 3), "still unseen");
    assert_eq!(next(Measured(()), Missed, NotDue), (Status::Tracking, 3), "one of two");
    assert_eq!(next(NotDue, NotDue, Missed), (Status::Tracking, 3), "no radio on board");
}

/// A window of all sensors' rows, some of which are absent at most epochs.
#[test]
fn laws_on_windows_go_on_with_any_sensors() {
    let aboard = Aboard {
        lidar: Some(1),
        camera: Some(2),
        radio: Some(3),
        metrology: Some(5),
    };
    let told = told("leo_venting", &aboard);
    for filter in ["milton", "constrained_q", "rbfnn_ekf", "rbfnn_aekf"] {
        let (mut world, start) = OwnWorld::new(2, 1e-6);
        let mut nav = Navigator::new(&told, &settings(filter), 0.0).unwrap();
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
    let aboard = Aboard {
        lidar: None,
        camera: None,
        radio: Some(1),
        metrology: None,
    };
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
