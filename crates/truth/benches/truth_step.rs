//! Start of a run, and one second of it, for each mission that comes with the project; in CPU time of the thread, on Unix.
//!
//! `cargo bench -p truth` prints for `truth_start` the time of a start, which reads the mission and takes the vehicles back from
//! its end; for `truth_step` the mean over ten minutes, sample included.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

use criterion::{Criterion, criterion_group, criterion_main};
use interface::mission::Embedded;
use std::hint::black_box;
use std::time::Duration;
use truth::{Inputs, Params, Simulation};

const STEPS: u32 = 600;

#[cfg(unix)]
fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    // Both parts are positive, the latter below a second.
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

#[cfg(not(unix))]
fn now() -> Duration {
    static FIRST: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    FIRST.elapsed()
}

fn start(ordinal: i32) -> Simulation {
    Simulation::new(&Params::of_scenario(ordinal), 0.0, &Inputs::default()).expect("a mission of the project starts")
}

fn truth_start(c: &mut Criterion) {
    let mut group = c.benchmark_group("truth_start");
    for (ordinal, mission) in (1..).zip(Embedded::scenarios()) {
        group.bench_function(mission.name, |b| {
            b.iter_custom(|iterations| {
                let begin = now();
                for _ in 0..iterations {
                    black_box(start(ordinal));
                }
                now() - begin
            });
        });
    }
    group.finish();
}

fn truth_step(c: &mut Criterion) {
    let mut group = c.benchmark_group("truth_step");
    let inputs = Inputs::default();
    for (ordinal, mission) in (1..).zip(Embedded::scenarios()) {
        let start = start(ordinal);
        group.bench_function(mission.name, |b| {
            b.iter_custom(|iterations| {
                let begin = now();
                for _ in 0..iterations {
                    let mut run = start.clone();
                    for k in 1..=STEPS {
                        run.advance_to(f64::from(k), &inputs).expect("it goes on");
                    }
                }
                (now() - begin) / STEPS
            });
        });
    }
    group.finish();
}

criterion_group!(benches, truth_start, truth_step);
criterion_main!(benches);
