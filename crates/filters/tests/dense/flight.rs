//! Ten minutes of a flight as both filters see it: what drives the vehicles, rows of H, what is measured.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(missing_docs, reason = "part of test binaries")]
#![allow(dead_code, reason = "each binary uses its own part")]

use filters::Gravity;
use filters::dynamics::{Drive, Thrust, TwoVehicles, initial_covariance};
use filters::state::{N, State, StateMatrix, TargetMatrix, idx};
use filters::update::kalman::{self, Gaussian, Measurement};
use interface::mission::InitialSigma;
use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector3};
use numerics::{Source, stream};
use rand_distr::{Distribution, StandardNormal};

use crate::reference::{Dense, Exponential};

/// Rows of an update: range and angles, and the accelerometer's bias.
pub const ROWS: usize = 6;

/// One sample.
#[derive(Clone, Debug)]
pub struct Epoch {
    pub drive: Drive,
    pub h: SMatrix<f64, ROWS, N>,
    /// Measured, linear in the state.
    pub z: SVector<f64, ROWS>,
    pub r: SVector<f64, ROWS>,
}

/// A flight in internal units.
pub struct Flight {
    pub name: &'static str,
    pub dynamics: TwoVehicles,
    pub dt: f64,
    pub q_target: TargetMatrix,
    pub start: Gaussian,
    pub epochs: Vec<Epoch>,
}

/// Low orbit in SI, and about the Moon in units of the three-body problem.
pub fn flights() -> [Flight; 2] {
    let (r_tc, v_tc) = ([300.0, -900.0, 250.0], [0.1, 0.5, -0.2]);
    let system = astro::Cr3bpSystem::EARTH_MOON;
    let moon = |v: [f64; 3], unit: f64| v.map(|v| v / unit);
    let speed = system.length / system.time;
    [
        flight(
            "leo_venting",
            Gravity::Zonal(astro::earth::FILTER),
            [1.0, 1.0],
            [r_tc, v_tc, [6.878e6, 0.0, 0.0], [0.0, 7350.0, 1970.0]],
        ),
        flight(
            "nrho_venting",
            Gravity::Cr3bp(astro::Cr3bp {
                mass_ratio: system.problem.mass_ratio,
            }),
            [system.length, system.time],
            [
                moon(r_tc, system.length),
                moon(v_tc, speed),
                [0.9879, 1.432e-2, 2.009e-3],
                [7.173e-2, 0.9238, -0.8528],
            ],
        ),
    ]
}

/// * `units`: of length and time, m and s.
/// * `state`: r_tc, v_tc, r_c, v_c.
fn flight(name: &'static str, gravity: Gravity, units: [f64; 2], state: [[f64; 3]; 4]) -> Flight {
    let [length, time] = units;
    let (speed, acceleration) = (length / time, length / (time * time));
    let dynamics = TwoVehicles {
        gravity,
        acceleration_decay: 0.0,
        beta: time / 3600.0,
        q_c: 1e-12 * time / (speed * speed),
        q_coupled: true,
        q_bias: (3.433e-8 / acceleration).powi(2) * time,
    };
    let sigma = InitialSigma {
        position: 25.0 / 3.0 / length,
        velocity: 0.1 / speed,
        acceleration: 1e-6 / acceleration,
        bias: 1e-6 / acceleration,
    };
    let dt = 1.0 / time;
    let g = &mut stream(5, 0, Source::Lidar);
    let mut normal = || -> f64 { StandardNormal.sample(g) };
    let p = initial_covariance(&sigma);
    let mut truth = State::zeros();
    for (slot, part) in [0, 3, 9, 12].into_iter().zip(state) {
        truth.fixed_rows_mut::<3>(slot).copy_from_slice(&part);
    }
    truth.fixed_rows_mut::<3>(15).fill(2.943e-6 / acceleration);
    let start = Gaussian {
        x: truth + p.cholesky().unwrap().l() * State::from_fn(|_, _| normal()),
        p,
    };
    let mut epochs = Vec::new();
    for k in 0..600 {
        let axes = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 1e-3 * f64::from(k));
        let force = if (k / 60) % 10 == 5 {
            Vector3::new(2e-3, -1e-3, 5e-4) / acceleration
        } else {
            Vector3::zeros()
        };
        let thrust = (force != Vector3::zeros()).then(|| Thrust {
            alpha_c_bc: force + truth.fixed_rows::<3>(15),
            dcm_n_bc: axes.into_inner(),
        });
        let drive = thrust.map(Drive::from).unwrap_or_default();
        truth = dynamics.propagate_mean(&truth, dt, &drive);
        // Range and two angles: a direction and two across it by the distance.
        let r = truth.fixed_rows::<3>(0).into_owned();
        let along = r.normalize();
        let across = along.cross(&Vector3::z()).normalize();
        let third = along.cross(&across);
        let mut h = SMatrix::<f64, ROWS, N>::zeros();
        h.fixed_view_mut::<1, 3>(0, 0).copy_from(&along.transpose());
        h.fixed_view_mut::<1, 3>(1, 0)
            .copy_from(&(across.transpose() / r.norm()));
        h.fixed_view_mut::<1, 3>(2, 0)
            .copy_from(&(third.transpose() / r.norm()));
        h.fixed_view_mut::<3, 3>(3, idx::B_C.start).fill_with_identity();
        let sigmas = [
            0.08 / length,
            7e-4,
            7e-4,
            3.4e-6 / acceleration,
            3.4e-6 / acceleration,
            3.4e-6 / acceleration,
        ];
        let sigmas = SVector::<f64, ROWS>::from(sigmas);
        let noise = SVector::<f64, ROWS>::from_fn(|i, _| sigmas[i] * normal());
        epochs.push(Epoch {
            drive,
            h,
            z: h * truth + noise,
            r: sigmas.component_mul(&sigmas),
        });
    }
    let density = Vector3::repeat((1e-6 / acceleration).powi(2) / time);
    Flight {
        name,
        dynamics,
        dt,
        q_target: filters::jerk::process_noise(&density, dt),
        start,
        epochs,
    }
}

impl Flight {
    /// Time and measurement update of the fast filter.
    pub fn fast(&self, est: &mut Gaussian, epoch: &Epoch) {
        self.fast_predict(est, epoch);
        self.fast_update(est, epoch);
    }

    pub fn fast_predict(&self, est: &mut Gaussian, epoch: &Epoch) {
        self.dynamics.predict(est, self.dt, &epoch.drive, None, &self.q_target);
    }

    pub fn fast_update(&self, est: &mut Gaussian, epoch: &Epoch) {
        let m = Measurement {
            h: epoch.h,
            innovation: epoch.z - epoch.h * est.x,
            r: epoch.r,
        };
        kalman::update(est, &m, idx::CONSIDER).unwrap();
    }

    /// The same of the other.
    pub fn dense(&self, est: &mut Dense, epoch: &Epoch) {
        self.dense_predict(est, epoch);
        self.dense_update(est, epoch);
    }

    pub fn dense_predict(&self, est: &mut Dense, epoch: &Epoch) {
        est.predict(&self.dynamics, self.dt, &epoch.drive, &self.q_target);
    }

    pub fn dense_update(&self, est: &mut Dense, epoch: &Epoch) {
        let innovation = epoch.z - epoch.h * est.x;
        est.update(
            &DMatrix::from_iterator(ROWS, N, epoch.h.iter().copied()),
            &DVector::from_iterator(ROWS, innovation.iter().copied()),
            &DVector::from_iterator(ROWS, epoch.r.iter().copied()),
        );
    }

    pub fn start_dense(&self, exponential: Exponential) -> Dense {
        Dense {
            x: self.start.x,
            p: self.start.p,
            exponential,
        }
    }
}

/// The largest difference of two covariances, in standard deviations of `scale`.
pub fn apart(p: &StateMatrix, expected: &StateMatrix, scale: &StateMatrix) -> f64 {
    let mut worst = 0.0_f64;
    for i in 0..N {
        for j in 0..N {
            let scale = (scale[(i, i)] * scale[(j, j)]).sqrt();
            worst = worst.max((p[(i, j)] - expected[(i, j)]).abs() / scale);
        }
    }
    worst
}
