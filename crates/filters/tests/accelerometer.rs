//! Closed loop with an accelerometer that reports means: two bodies, burns that begin and end on any second, a target pushed by
//! exactly the white acceleration that the filter expects.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

use astro::frames;
use filters::dynamics::initial_covariance;
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Navigator, Reading, Sample, Settings, SpecificForce, jerk};
use interface::mission::embedded;
use interface::{Navigation, Sensor};
use nalgebra::{Matrix3, SVector, Vector2, Vector3, Vector6};
use numerics::{Generator, Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

/// Square root of the target's acceleration density, m/s^1.5.
const Q: f64 = 3e-5;
const SIGMA_ACCELEROMETER: f64 = 3.433e-6;
const BIAS: f64 = 2.943e-6;
/// First second and length of each burn, s, and its force, N, m/s2.
const BURNS: [(u32, u32, [f64; 3]); 3] = [
    (313, 30, [-7e-3, -7e-3, 0.0]),
    (505, 3, [0.0, 8e-3, 5e-3]),
    (701, 47, [4e-3, 0.0, -2e-3]),
];

fn normal(g: &mut Generator) -> f64 {
    StandardNormal.sample(g)
}

/// Low Earth orbit, but with a first estimate good enough for angles to be linear at 150 m.
fn leo() -> Navigation {
    let mut told = embedded("leo_venting").unwrap().mission().unwrap().navigation();
    (told.p0.position, told.p0.velocity) = (1.0, 0.02);
    told
}

/// Target, then chaser: position and velocity each.
struct Truth {
    x: SVector<f64, 12>,
    second: u32,
    /// Body-axes specific force summed over seconds since the last reading.
    felt: Vector3<f64>,
    seconds: f64,
    g: Generator,
}

impl Truth {
    fn new(run: u64) -> (Self, State) {
        let mut x = SVector::<f64, 12>::zeros();
        let r_c = Vector3::new(6.878e6, 0.0, 0.0);
        let v_c = Vector3::new(0.0, 7350.0, 1970.0);
        for (slot, part) in [
            (0, r_c + Vector3::new(80.0, -120.0, 50.0)),
            (3, v_c + Vector3::new(0.1, 0.3, -0.05)),
            (6, r_c),
            (9, v_c),
        ] {
            x.fixed_rows_mut::<3>(slot).copy_from(&part);
        }
        let mut g = stream(7, run, Source::InitialError);
        let truth = Self {
            x,
            second: 0,
            felt: Vector3::zeros(),
            seconds: 0.0,
            g: stream(7, run, Source::Lidar),
        };
        let p0 = initial_covariance(&leo().p0);
        let error = p0.cholesky().unwrap().unpack() * State::from_fn(|_, _| normal(&mut g));
        let start = truth.state() + error;
        (truth, start)
    }

    fn part(&self, slot: usize) -> Vector3<f64> {
        self.x.fixed_rows::<3>(slot).into_owned()
    }

    /// As a filter orders it.
    fn state(&self) -> State {
        let mut x = State::zeros();
        for (slot, part) in [
            (0, self.part(0) - self.part(6)),
            (3, self.part(3) - self.part(9)),
            (9, self.part(6)),
            (12, self.part(9)),
            (15, Vector3::repeat(BIAS)),
        ] {
            x.fixed_rows_mut::<3>(slot).copy_from(&part);
        }
        x
    }

    fn attitude(&self) -> Matrix3<f64> {
        let normal = self.part(6).cross(&self.part(9));
        frames::los_body_axes(&(self.part(0) - self.part(6)), &(self.part(3) - self.part(9)), &normal)
    }

    /// A second of motion in quarters, so that the turn within it counts.
    fn step(&mut self) {
        let burning = |burn: &&(u32, u32, [f64; 3])| (burn.0..burn.0 + burn.1).contains(&self.second);
        let force: Vector3<f64> = BURNS.iter().filter(burning).map(|burn| Vector3::from(burn.2)).sum();
        for _ in 0..4 {
            self.x = rk4::step(0.0, &self.x, 0.25, |_, x| {
                let mut rate = SVector::<f64, 12>::zeros();
                for (slot, push) in [(0, Vector3::zeros()), (6, force)] {
                    let r = x.fixed_rows::<3>(slot).into_owned();
                    rate.fixed_rows_mut::<3>(slot).copy_from(&x.fixed_rows::<3>(slot + 3));
                    rate.fixed_rows_mut::<3>(slot + 3)
                        .copy_from(&(astro::earth::FILTER.acceleration(&r) + push));
                }
                rate
            });
            self.felt += force * 0.25;
        }
        let q = jerk::white_acceleration(Q * Q, 1.0)
            .fixed_view::<6, 6>(0, 0)
            .into_owned();
        let pushed = q.cholesky().unwrap().unpack() * Vector6::from_fn(|_, _| normal(&mut self.g));
        let mut target = self.x.fixed_rows_mut::<6>(0);
        target += pushed;
        self.seconds += 1.0;
        self.second += 1;
    }

    /// The mean since the last call, in body axes as they are now.
    fn reading(&mut self) -> SpecificForce {
        let mean = self.attitude() * self.felt / self.seconds;
        (self.felt, self.seconds) = (Vector3::zeros(), 0.0);
        let noise = Vector3::from_fn(|_, _| SIGMA_ACCELEROMETER * normal(&mut self.g));
        SpecificForce::Mean(mean + Vector3::repeat(BIAS) + noise)
    }

    fn sample(&mut self, count: i32) -> Sample {
        let dcm_bc_n = self.attitude();
        let rho = frames::lidar_from_body() * dcm_bc_n * (self.part(0) - self.part(6));
        let sigma = Vector3::new(0.08, 0.04_f64.to_radians(), 0.04_f64.to_radians());
        let noise = Vector3::from_fn(|i, _| sigma[i] * normal(&mut self.g));
        let mut sample = Sample {
            dcm_bc_n,
            ..Sample::blank(count, f64::from(self.second))
        };
        sample[Sensor::Lidar] = Reading::of((sensors::lidar::measure(&rho) + noise).as_slice());
        sample
    }
}

fn tuned() -> Settings {
    let mut settings = Settings {
        filter: FILTERS.iter().position(|f| f.name == "snc").unwrap(),
        ..Settings::default()
    };
    *settings.tunable_mut("snc", "q").unwrap() = Value::Real(Q);
    settings
}

/// Mean NEES of position and velocity over six, at epochs with a reading: from 100 s on, and in the 40 s after the begin of each
/// burn.
fn nees(lidar: u32, accelerometer: u32, runs: u64) -> (f64, f64) {
    nees_without(lidar, accelerometer, runs, |_| false)
}

/// The same, some samples lost on their way.
///
/// * `lost`: whether that of this second is.
fn nees_without(lidar: u32, accelerometer: u32, runs: u64, lost: impl Fn(u32) -> bool) -> (f64, f64) {
    let (mut all, mut near) = (Vector2::zeros(), Vector2::zeros());
    for run in 0..runs {
        let (mut truth, start) = Truth::new(run);
        let mut nav = Navigator::new(&leo(), &tuned(), 0.0).unwrap();
        let mut count = 0;
        for second in 1..=900 {
            truth.step();
            let reads = second % accelerometer == 0;
            if second % lidar != 0 && !reads {
                continue;
            }
            count += 1;
            let mut sample = truth.sample(count);
            if second % lidar != 0 {
                sample[Sensor::Lidar] = Reading::NotDue;
            }
            sample.accelerometer = reads.then(|| truth.reading());
            if lost(second) {
                continue;
            }
            nav.process(&sample, &start).unwrap();
            let error = (nav.estimate().x - truth.state()).fixed_rows::<6>(0).into_owned();
            let p = nav.estimate().p_target.fixed_view::<6, 6>(0, 0).into_owned();
            let nees = error.dot(&p.cholesky().unwrap().solve(&error)) / 6.0;
            if reads && second > 100 {
                all += Vector2::new(nees, 1.0);
            }
            if reads && BURNS.iter().any(|burn| (burn.0..burn.0 + 40).contains(&second)) {
                near += Vector2::new(nees, 1.0);
            }
        }
    }
    (all.x / all.y, near.x / near.y)
}

/// Whatever the period, and wherever in it a burn begins and ends.
#[test]
fn mean_readings_keep_the_filter_consistent_at_any_period() {
    for period in [1, 2, 3, 4, 7, 10, 20] {
        let (all, near) = nees(period, period, 20);
        assert!((0.5..1.5).contains(&all), "{period} s: NEES {all}");
        assert!((0.3..1.7).contains(&near), "{period} s: NEES about the burns {near}");
    }
}

#[test]
fn an_accelerometer_of_another_period_than_the_lidar_is_used_as_well() {
    for (lidar, accelerometer) in [(1, 2), (1, 5), (2, 3), (5, 1), (10, 3)] {
        let (all, near) = nees(lidar, accelerometer, 20);
        let label = format!("LiDAR {lidar} s, accelerometer {accelerometer} s");
        assert!((0.5..1.5).contains(&all), "{label}: NEES {all}");
        assert!((0.3..1.7).contains(&near), "{label}: NEES about the burns {near}");
    }
}

/// A mean covers its own period, not the samples that were lost before it; the covariance must know.
#[test]
fn a_sample_lost_in_a_burn_leaves_the_filter_consistent() {
    for period in [1, 2, 5] {
        // Of a burn that is lost whole nobody knows.
        let ends = |second: u32| {
            let long = BURNS.iter().filter(|burn| burn.1 > 5 * period);
            long.map(|burn| burn.0 + burn.1)
                .any(|end| (end - 3 * period..end + period).contains(&second))
        };
        let (all, near) = nees_without(period, period, 20, ends);
        assert!((0.5..1.5).contains(&all), "{period} s: NEES {all}");
        assert!((0.3..1.7).contains(&near), "{period} s: NEES about the burns {near}");
    }
}

/// Nothing is measured but the chaser's thrust, every `period` seconds of `SECONDS`: how far the noise of the readings moves the
/// estimate, as the mean's propagation has it, against what the covariance says.
#[test]
fn noise_of_a_reading_that_drives_is_in_the_covariance() {
    const RUNS: u64 = 300;
    let mut told = leo();
    (told.p0.position, told.p0.velocity, told.p0.bias) = (1e-6, 1e-9, 1e-15);
    told.chaser_q_c_m2_s3 = 0.0;
    told.accelerometer.as_mut().unwrap().bias_sigma_m_s2 = 0.0;
    let mut start = Truth::new(0).1;
    start.fixed_rows_mut::<3>(15).fill(BIAS);
    let dcm_bc_n = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner();
    // A reading drives from its epoch on: the last one, at the end, drives no more.
    let fly = |mode: i32, period: i32, noise: &mut dyn FnMut() -> f64| {
        let mut settings = Settings {
            filter: FILTERS.iter().position(|f| f.name == "snc").unwrap(),
            ..Settings::default()
        };
        *settings.tunable_mut("snc", "q").unwrap() = Value::Real(1e-12);
        settings.beliefs.accelerometer_noise_enters = mode;
        let mut nav = Navigator::new(&told, &settings, 0.0).unwrap();
        for k in 1..=60 {
            let mut sample = Sample {
                dcm_bc_n,
                ..Sample::blank(k, f64::from(k))
            };
            if k % period == 0 {
                let alpha = Vector3::new(4e-3, -7e-3, 2e-3).map(|a| a + BIAS + noise());
                sample.accelerometer = Some(SpecificForce::Instant(alpha));
            }
            nav.process(&sample, &start).unwrap();
        }
        nav.estimate().clone()
    };
    for period in [1, 4] {
        let still = fly(-1, period, &mut || 0.0);
        let p = still.p_target.fixed_view::<6, 6>(0, 0).cholesky().unwrap();
        let (mut nees, mut v_c) = (0.0, 0.0);
        for run in 0..RUNS {
            let mut g = stream(9, run, Source::Accelerometer);
            let x = fly(-1, period, &mut || SIGMA_ACCELEROMETER * normal(&mut g)).x - still.x;
            let relative = x.fixed_rows::<6>(0).into_owned();
            nees += relative.dot(&p.solve(&relative)) / 6.0 / RUNS as f64;
            v_c += x.fixed_rows::<3>(12).norm_squared() / 3.0 / RUNS as f64;
            // The target does not move.
            assert!((x.fixed_rows::<3>(3) + x.fixed_rows::<3>(12)).norm() < 1e-6 * x.fixed_rows::<3>(12).norm());
        }
        // Three sigma over the root of N, of chi-square of six and of three.
        let runs = RUNS as f64;
        assert!(
            (nees - 1.0).abs() < 3.0 * (2.0 / (6.0 * runs)).sqrt(),
            "every {period} s: {nees}"
        );
        assert!((v_c / still.sigma[12].powi(2) - 1.0).abs() < 3.0 * (2.0 / (3.0 * runs)).sqrt());
        // Readings of variance sigma^2, held for the period: sigma^2 period T.
        let held = f64::from(60 - period);
        let by_hand = SIGMA_ACCELEROMETER.powi(2) * f64::from(period) * held;
        assert!((still.sigma[12].powi(2) / by_hand - 1.0).abs() < 0.01);
        assert!(fly(0, period, &mut || 0.0).sigma[12].powi(2) < 0.01 * by_hand);
    }
}
