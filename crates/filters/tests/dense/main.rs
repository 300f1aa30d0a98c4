//! The filter's time and measurement updates against the same in whole matrices.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "says how far apart they are")]

mod flight;
mod reference;

use filters::update::kalman::Gaussian;
use flight::{apart, flights};
use reference::{Dense, Exponential};

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
