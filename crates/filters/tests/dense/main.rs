//! The filter's time and measurement updates against the same in whole matrices.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "says how far apart they are")]

mod flight;
mod reference;

use filters::Gravity;
use filters::dynamics::{Thrust, TwoVehicles};
use filters::state::{State, StateMatrix};
use filters::update::kalman::Gaussian;
use flight::{apart, flights};
use nalgebra::Vector3;
use numerics::expm;
use reference::{Dense, Exponential, generator};

/// One step from the same estimate.
#[test]
fn a_step_is_that_of_whole_matrices() {
    for flight in flights() {
        let mut est = flight.start.clone();
        let mut worst = [0.0_f64; 2];
        for epoch in &flight.epochs {
            let as_dense = |est: &Gaussian| Dense {
                x: est.x,
                p: est.p,
                exponential: Exponential::Nalgebra,
            };
            let mut dense = as_dense(&est);
            flight.fast_predict(&mut est, epoch);
            flight.dense_predict(&mut dense, epoch);
            assert_eq!(est.p, est.p.transpose());
            worst[0] = worst[0].max(apart(&est.p, &dense.p, &dense.p));
            // An update takes from the prior, whose rounding stays.
            let prior = est.p;
            let mut dense = as_dense(&est);
            flight.fast_update(&mut est, epoch);
            flight.dense_update(&mut dense, epoch);
            assert_eq!(est.p, est.p.transpose());
            worst[1] = worst[1].max(apart(&est.p, &dense.p, &prior));
        }
        let [carried, updated] = worst;
        println!(
            "{}: covariances of a step differ by {carried:.1e} and {updated:.1e} of their scale",
            flight.name
        );
        assert!(worst.iter().all(|w| *w < 1e-14), "{}: {worst:?}", flight.name);
    }
}

/// A whole run by itself: what rounding does to it is nothing beside what the filter does not know.
#[test]
fn a_run_is_that_of_whole_matrices() {
    for flight in flights() {
        let mut est = flight.start.clone();
        let mut dense = flight.start_dense(Exponential::Nalgebra);
        let mut worst = [0.0_f64; 2];
        for epoch in &flight.epochs {
            flight.fast(&mut est, epoch);
            flight.dense(&mut dense, epoch);
            let sigma = dense.p.diagonal().map(f64::sqrt);
            worst[0] = worst[0].max((est.x - dense.x).component_div(&sigma).amax());
            worst[1] = worst[1].max(apart(&est.p, &dense.p, &dense.p));
        }
        println!(
            "{}: a run differs by {:.1e} sigma, its covariance by {:.1e}",
            flight.name, worst[0], worst[1]
        );
        assert!(worst[0] < 1e-8, "{}: {worst:?}", flight.name);
    }
}

/// Two vehicles a kilometre apart, in a low orbit and near the Moon; SI.
fn apart_by_a_kilometre() -> [(Gravity, Vector3<f64>); 2] {
    let near_moon = Vector3::new(3.79e8, 2.1e6, -3.0e6);
    [
        (Gravity::Zonal(astro::earth::FILTER), Vector3::new(5.0e6, 4.2e6, 2.0e6)),
        (Gravity::Cr3bpSi(astro::Cr3bpSystem::EARTH_MOON), near_moon),
    ]
}

/// exp(A t) by parts against that of the whole, A of Eq. (5).
#[test]
fn parts_are_the_exponential_of_the_whole() {
    let thrust = Thrust {
        alpha_c_bc: Vector3::zeros(),
        dcm_n_bc: nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner(),
    };
    for (gravity, r_c) in apart_by_a_kilometre() {
        let mut x = State::zeros();
        x.fixed_rows_mut::<3>(0).copy_from_slice(&[600.0, -700.0, 400.0]);
        x.fixed_rows_mut::<3>(9).copy_from(&r_c);
        for t in [0.02, 1.0, 30.0, 170.0, 900.0] {
            for k in [[0.0, 0.0], [1e-5, 1.0 / 3600.0], [0.02, 0.14], [0.9, 1.1], [7.0, 60.0]] {
                let dynamics = TwoVehicles {
                    gravity: gravity.clone(),
                    acceleration_decay: k[0],
                    beta: k[1],
                    q_c: 0.0,
                    q_coupled: true,
                    q_bias: 0.0,
                };
                let ours = dynamics.transition(&x, t, Some(&thrust)).dense();
                // In units of t, in which nothing is large but the decay.
                let unit = |i: usize| t.powi([0, -1, -2][(i / 3) % 3]);
                let of_units = |m: StateMatrix, to: bool| {
                    StateMatrix::from_fn(|i, j| m[(i, j)] * if to { unit(j) / unit(i) } else { unit(i) / unit(j) })
                };
                let expected = expm(&of_units(generator(&dynamics, &x, Some(&thrust)) * t, true));
                let expected = of_units(expected, false);
                // Squaring a matrix of a large exponent costs the reference digits: eps times the exponent.
                let size = 1.0 + k[0].max(k[1]) * t;
                for (part, rows) in [("position", 0..3), ("velocity", 3..6), ("third", 6..9)] {
                    let of = |m: &StateMatrix| {
                        let rows = rows.clone().chain(rows.clone().map(|i| i + 9));
                        rows.flat_map(|i| m.row(i).iter().copied().collect::<Vec<_>>())
                            .collect::<Vec<_>>()
                    };
                    let (ours, expected) = (of(&ours), of(&expected));
                    let scale = expected.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
                    let worst = ours
                        .iter()
                        .zip(&expected)
                        .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                    assert!(
                        worst <= 1e-14 * size * scale,
                        "{part}, t = {t}, k = {k:?}: {worst} of {scale}"
                    );
                }
            }
        }
    }
}
