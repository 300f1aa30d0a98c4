//! Time of one navigation step: every filter at its defaults, and MILTON over the length of its buffer.
//!
//! `cargo bench -p filters` prints the time of one step, averaged over the same ten minutes of samples for each filter,
//! so that the cost of MILTON's rare updates is spread over the steps between them, as in use.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

#[path = "../tests/common/mod.rs"]
mod common;

use common::OwnWorld;
use criterion::{Bencher, Criterion, criterion_group, criterion_main};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Navigator, Sample, Settings};
use std::hint::black_box;
use std::time::Instant;

const STEPS: u32 = 620;

fn samples() -> (Vec<Sample>, State) {
    let (mut world, start) = OwnWorld::new(1, 1e-6);
    ((0..STEPS).map(|_| world.step()).collect(), start)
}

/// Reports the mean time of a step rather than that of a run.
fn per_step(b: &mut Bencher<'_>, settings: &Settings, samples: &[Sample], start: &State) {
    b.iter_custom(|iterations| {
        let clock = Instant::now();
        for _ in 0..iterations {
            black_box(run(black_box(settings), samples, start));
        }
        clock.elapsed() / STEPS
    });
}

fn run(settings: &Settings, samples: &[Sample], start: &State) -> f64 {
    let mut nav = Navigator::new(settings, 0.0).expect("default settings are valid");
    for sample in samples {
        nav.process(sample, start).expect("the filter survives its own world");
    }
    nav.estimate().x[0]
}

fn benches(c: &mut Criterion) {
    let (samples, start) = samples();
    let mut group = c.benchmark_group("nav_step");
    group.sample_size(20);
    for (filter, entry) in FILTERS.iter().enumerate() {
        let settings = Settings {
            filter,
            ..Settings::default()
        };
        group.bench_function(entry.name, |b| per_step(b, &settings, &samples, &start));
    }
    for m_b in [3, 10, 30, 60] {
        let filter = FILTERS
            .iter()
            .position(|f| f.name == "milton")
            .expect("milton is registered");
        let mut settings = Settings {
            filter,
            ..Settings::default()
        };
        if let Some(value) = settings.tunable_mut("milton", "m_b") {
            *value = Value::Integer(m_b);
        }
        group.bench_function(format!("milton m_b={m_b}"), |b| {
            per_step(b, &settings, &samples, &start)
        });
    }
    group.finish();
}

criterion_group!(nav_step, benches);
criterion_main!(nav_step);
