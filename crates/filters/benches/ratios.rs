//! What filters cost by each other and by the filter that one would write first, as ratios: `cargo bench -p filters --bench ratios`.
//!
//! All that is compared takes turns, round after round, and of each the fastest round counts: what else a machine does makes rounds
//! longer and none shorter.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]
#![allow(clippy::print_stdout, reason = "that is what it is for")]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/dense/flight.rs"]
mod flight;
#[path = "../tests/formation/mod.rs"]
mod formation;
#[path = "../tests/dense/reference.rs"]
mod reference;

use std::hint::black_box;
use std::time::{Duration, Instant};

use common::{OwnWorld, navigation};
use filters::laws::FILTERS;
use filters::{Navigation, Navigator, Sample, Settings, state::State};
use formation::{Formation, World};
use reference::Exponential;

const ROUNDS: usize = 30;
const STEPS: u32 = 600;

/// Fastest round of each, in microseconds a step.
fn fastest(mut runs: Vec<(String, Box<dyn FnMut()>)>) -> Vec<(String, f64)> {
    let mut best = vec![Duration::MAX; runs.len()];
    for _ in 0..ROUNDS {
        for ((_, run), best) in runs.iter_mut().zip(&mut best) {
            let clock = Instant::now();
            run();
            *best = clock.elapsed().min(*best);
        }
    }
    let per_step = |best: Duration| best.as_secs_f64() * 1e6 / f64::from(STEPS);
    runs.into_iter()
        .zip(best)
        .map(|((name, _), best)| (name, per_step(best)))
        .collect()
}

fn of<'a>(all: &'a [(String, f64)], name: &str) -> &'a f64 {
    &all.iter().find(|(known, _)| known == name).expect("it has been run").1
}

fn core() {
    for flight in flight::flights() {
        let (name, flight) = (flight.name, std::rc::Rc::new(flight));
        let dense = |exponential| {
            let flight = flight.clone();
            let run = move || {
                let mut est = flight.start_dense(exponential);
                flight.epochs.iter().for_each(|epoch| flight.dense(&mut est, epoch));
                black_box(est.x);
            };
            Box::new(run) as Box<dyn FnMut()>
        };
        let fast = {
            let flight = flight.clone();
            move || {
                let mut est = flight.start.clone();
                flight.epochs.iter().for_each(|epoch| flight.fast(&mut est, epoch));
                black_box(est.x);
            }
        };
        let all = fastest(vec![
            ("ours".to_owned(), Box::new(fast)),
            ("exp()".to_owned(), dense(Exponential::Nalgebra)),
            ("three terms".to_owned(), dense(Exponential::ThreeTerms)),
        ]);
        let ours = of(&all, "ours");
        println!("predict and update in {name}: {ours:.2} us a step");
        for (other, time) in &all[1..] {
            println!(
                "  whole matrices with {other}: {time:.2} us, {:.2} of ours",
                time / ours
            );
        }
    }
}

/// Every filter at its defaults, by `fixed_q`.
fn filters(mission: &str, samples: &[Sample], start: &State, dense: Option<f64>) {
    let told = navigation(mission);
    let run = |filter: usize| {
        let (told, samples, start): (Navigation, Vec<Sample>, State) = (told.clone(), samples.to_vec(), *start);
        let settings = Settings {
            filter,
            ..Settings::default()
        };
        let run = move || {
            let mut nav = Navigator::new(&told, &settings, 0.0).expect("default settings are valid");
            for sample in &samples {
                nav.process(sample, &start).expect("the filter survives its own world");
            }
            black_box(nav.estimate().x[0]);
        };
        Box::new(run) as Box<dyn FnMut()>
    };
    let known = FILTERS
        .iter()
        .enumerate()
        .filter(|(_, entry)| entry.no_meaning_in(&told).is_none());
    let all = fastest(known.map(|(i, entry)| (entry.name.to_owned(), run(i))).collect());
    let yardstick = *of(&all, "fixed_q");
    println!("filters in {mission}: fixed_q {yardstick:.2} us a step");
    for (name, time) in all.iter().filter(|(name, _)| name != "fixed_q") {
        println!("  {name}: {time:.2} us, {:.2} of fixed_q", time / yardstick);
    }
    if let Some(dense) = dense {
        let milton = of(&all, "milton") - yardstick;
        println!(
            "  milton beyond fixed_q: {:.2} steps of whole matrices with exp()",
            milton / dense
        );
    }
}

fn dense_step() -> f64 {
    let [flight, _] = flight::flights();
    let run = move || {
        let mut est = flight.start_dense(Exponential::Nalgebra);
        flight.epochs.iter().for_each(|epoch| flight.dense(&mut est, epoch));
        black_box(est.x);
    };
    fastest(vec![("dense".to_owned(), Box::new(run) as Box<dyn FnMut()>)])[0].1
}

fn main() {
    core();
    let dense = dense_step();
    let (mut world, start) = OwnWorld::new(1, 1e-6);
    let samples: Vec<Sample> = (0..STEPS).map(|_| world.step()).collect();
    filters("leo_venting", &samples, &start, Some(dense));
    let (mut world, start) = Formation::new(1);
    let samples: Vec<Sample> = (0..STEPS).map(|_| world.step()).collect();
    filters("formation", &samples, &start, None);
}
