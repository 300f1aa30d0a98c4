//! Our own past: what every filter estimated over a few hundred samples of each mission of the papers.
//!
//! The figures are no evidence that a filter is right; they say that a change which should move no number moved none.
//! `UPDATE_GOLDEN=1 cargo test -p filters --test regress` rewrites them, with every digit.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod approach;
mod cast;
#[path = "../common/mod.rs"]
mod common;
#[path = "../formation/mod.rs"]
mod formation;

use std::fmt::Write;
use std::path::Path;

const SAMPLES: u32 = 240;

/// One line for each filter in each mission: its name, then final states, deviations, innovation and density, and the sum of
/// the normalised innovations on the way.
fn estimates() -> String {
    let mut text = String::new();
    for (label, mut nav, mut world, start) in cast::everywhere() {
        let mut sum = 0.0;
        for k in 1..=SAMPLES {
            let mut sample = world.step();
            if k % 41 == 0 {
                cast::lose(&mut sample);
            }
            nav.process(&sample, &start).unwrap_or_else(|e| panic!("{label}: {e}"));
            sum += nav.innovation().nis;
        }
        let estimate = nav.estimate();
        write!(text, "{label}:").unwrap();
        let states = estimate.x.iter().take(9).chain(estimate.sigma.iter().take(9));
        for value in states.chain(nav.s().iter()).chain([&nav.innovation().nis, &sum]) {
            write!(text, " {value:e}").unwrap();
        }
        text.push('\n');
    }
    text
}

#[test]
fn regress_estimates_of_every_filter_in_the_missions_of_the_papers() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regress/estimates.txt");
    let now = estimates();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, &now).unwrap();
    }
    let past = std::fs::read_to_string(&file).unwrap();
    assert_eq!(now.lines().count(), past.lines().count());
    for (now, past) in now.lines().zip(past.lines()) {
        let (label, now) = now.split_once(": ").unwrap();
        let (was, past) = past.split_once(": ").unwrap();
        assert_eq!(label, was);
        for (place, (now, past)) in now.split(' ').zip(past.split(' ')).enumerate() {
            let (now, past): (f64, f64) = (now.parse().unwrap(), past.parse().unwrap());
            // Another mathematics library may round otherwise; adaptation carries that on.
            let fits = (now - past).abs() <= 1e-7 * past.abs().max(1e-12);
            assert!(fits, "{label}, value {place}: {now:e}, was {past:e}");
        }
    }
}
