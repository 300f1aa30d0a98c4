//! Time of one second of each mission that comes with the project, sample included.
//!
//! `cargo bench -p truth` prints the mean over ten minutes, the back-propagation to the start left out.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

use criterion::{Criterion, criterion_group, criterion_main};
use interface::mission::Embedded;
use std::time::Instant;
use truth::{Inputs, Params, Simulation};

const STEPS: u32 = 600;

fn truth_step(c: &mut Criterion) {
    let mut group = c.benchmark_group("truth_step");
    for (ordinal, mission) in (1..).zip(Embedded::scenarios()) {
        let inputs = Inputs::default();
        let start =
            Simulation::new(&Params::of_scenario(ordinal), 0.0, &inputs).expect("a mission of the project starts");
        group.bench_function(mission.name, |b| {
            b.iter_custom(|iterations| {
                let begin = Instant::now();
                for _ in 0..iterations {
                    let mut run = start.clone();
                    for k in 1..=STEPS {
                        run.advance_to(f64::from(k), &inputs).expect("it goes on");
                    }
                }
                begin.elapsed() / STEPS
            });
        });
    }
    group.finish();
}

criterion_group!(benches, truth_step);
criterion_main!(benches);
