//! A world made of the filter's own assumptions, seen by range and angles, for tests and benches.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(missing_docs, reason = "part of test binaries")]
#![allow(dead_code, reason = "each binary uses its own part")]

use filters::dynamics::{Drive, Thrust, TwoVehicles, initial_covariance};
use filters::state::{State, StateMatrix};
use filters::{Gravity, Reading, Sample, SpecificForce, Untold, jerk};
use interface::Sensor;
use interface::mission::InitialSigma;
use nalgebra::{Matrix3, Vector3};
use numerics::{Generator, Source, stream};
use rand_distr::{Distribution, StandardNormal};

/// What a filter is told of a mission that comes with the project.
pub fn navigation(mission: &str) -> filters::Navigation {
    interface::mission::embedded(mission)
        .unwrap()
        .mission()
        .unwrap()
        .navigation()
}

const SIGMA_RANGE: f64 = 0.08;
const SIGMA_ANGLE: f64 = 0.04 * std::f64::consts::PI / 180.0;
const SIGMA_ACCELEROMETER: f64 = 3.433e-6;

fn normal(g: &mut Generator) -> f64 {
    StandardNormal.sample(g)
}

fn normal3(g: &mut Generator) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(g))
}

/// The world that the filter believes in; `s` is the square root of the jerk density.
pub struct OwnWorld {
    dynamics: TwoVehicles,
    /// True state, SI.
    pub x: State,
    s: f64,
    g: Generator,
    k: i32,
    /// What a bound is told: the target's acceleration acts at all times.
    untold: Untold,
}

impl OwnWorld {
    /// A world and an initial estimate drawn around its truth.
    pub fn new(run: u64, s: f64) -> (Self, State) {
        let dynamics = TwoVehicles {
            gravity: Gravity::Zonal(astro::earth::FILTER),
            acceleration_decay: 0.0,
            beta: 1.0 / 3600.0,
            q_c: 1e-12,
            q_coupled: true,
            q_bias: 3.433e-8_f64.powi(2),
        };
        let mut x = State::zeros();
        x.fixed_rows_mut::<3>(0).copy_from_slice(&[300.0, -900.0, 250.0]);
        x.fixed_rows_mut::<3>(3).copy_from_slice(&[0.1, 0.5, -0.2]);
        x.fixed_rows_mut::<3>(9).copy_from_slice(&[6.878e6, 0.0, 0.0]);
        x.fixed_rows_mut::<3>(12).copy_from_slice(&[0.0, 7350.0, 1970.0]);
        x.fixed_rows_mut::<3>(15).fill(2.943e-6);
        let mut g = stream(11, run, Source::InitialError);
        let p0 = initial_covariance(&InitialSigma {
            position: 25.0 / 3.0,
            velocity: 0.1,
            acceleration: 1e-9,
            bias: 1e-9,
        });
        let error = p0.cholesky().unwrap().l() * State::from_fn(|_, _| normal(&mut g));
        (
            Self {
                dynamics,
                x,
                s,
                g,
                k: 0,
                untold: Untold::default(),
            },
            x + error,
        )
    }

    fn attitude(&self) -> Matrix3<f64> {
        let part = |slot: usize| self.x.fixed_rows::<3>(slot).into_owned();
        let normal = part(9).cross(&part(12)).normalize();
        astro::frames::los_body_axes(&part(0), &part(3), &normal)
    }

    /// One second of truth and the sample at its end; the chaser thrusts during every tenth minute.
    pub fn step(&mut self) -> Sample {
        let before = self.attitude();
        let force = |k: i32| {
            if (k / 60) % 10 == 5 {
                Vector3::new(2e-3, -1e-3, 5e-4)
            } else {
                Vector3::zeros()
            }
        };
        let bias = self.x.fixed_rows::<3>(15).into_owned();
        let thrust = Thrust {
            alpha_c_bc: before * force(self.k) + bias,
            dcm_n_bc: before.transpose(),
        };
        self.x = self.dynamics.propagate_mean(&self.x, 1.0, &Drive::from(thrust));
        let mut q = StateMatrix::zeros();
        let of_target = jerk::process_noise(&Vector3::repeat(self.s * self.s), 1.0);
        self.dynamics.add_process_noise(&mut q, &of_target, 1.0);
        let l = q.cholesky().unwrap().l();
        self.untold.dv_t_n += self.x.fixed_rows::<3>(6);
        self.untold.event_time += 1.0;
        self.x += l * State::from_fn(|_, _| normal(&mut self.g));
        self.k += 1;
        let dcm_bc_n = self.attitude();
        let rho = astro::frames::lidar_from_body() * dcm_bc_n * self.x.fixed_rows::<3>(0);
        let sigma = Vector3::new(SIGMA_RANGE, SIGMA_ANGLE, SIGMA_ANGLE);
        let noise = normal3(&mut self.g).component_mul(&sigma);
        let alpha = dcm_bc_n * force(self.k) + self.x.fixed_rows::<3>(15) + normal3(&mut self.g) * SIGMA_ACCELEROMETER;
        let mut sample = Sample {
            accelerometer: Some(SpecificForce::Instant(alpha)),
            dcm_bc_n,
            untold: Some(self.untold),
            ..Sample::blank(self.k, f64::from(self.k))
        };
        sample[Sensor::Lidar] = Reading::of((sensors::lidar::measure(&rho) + noise).as_slice());
        sample
    }
}
