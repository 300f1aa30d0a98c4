//! What the master itself takes for a coupled step: slaves that do nothing, with their times taken and without.
//!
//! `cargo bench -p cosim` prints the mean over a run of 10 000 steps, for a world and the eight filters of a study.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

use std::ops::ControlFlow;
use std::time::Instant;

use cosim::{BaseType, Causality, Port, RunOptions, Slave, SlaveError, System};
use criterion::{Criterion, criterion_group, criterion_main};

const STEPS: u32 = 10_000;
const FILTERS: usize = 8;
const SIGNALS: u32 = 18;

/// Takes and gives values, and does nothing with them.
struct Idle {
    name: String,
    causality: Causality,
    values: Vec<f64>,
}

impl Slave for Idle {
    fn name(&self) -> &str {
        &self.name
    }

    fn ports(&self) -> Vec<Port> {
        (0..SIGNALS)
            .map(|at| Port::new(format!("z[{at}]"), at, BaseType::Real, self.causality))
            .collect()
    }

    fn do_step(&mut self, _t: f64, _h: f64) -> Result<(), SlaveError> {
        Ok(())
    }

    fn get_real(&mut self, _references: &[u32], values: &mut [f64]) -> Result<(), SlaveError> {
        values.copy_from_slice(&self.values);
        Ok(())
    }

    fn set_real(&mut self, _references: &[u32], values: &[f64]) -> Result<(), SlaveError> {
        self.values.copy_from_slice(values);
        Ok(())
    }
}

fn study() -> System {
    let mut system = System::new();
    let names = std::iter::once("world".to_owned()).chain((0..FILTERS).map(|at| format!("filter {at}")));
    for (at, name) in names.enumerate() {
        let causality = [Causality::Input, Causality::Output][usize::from(at == 0)];
        let values = vec![0.0; SIGNALS as usize];
        system
            .add(Box::new(Idle {
                name,
                causality,
                values,
            }))
            .expect("names differ");
    }
    system.connect_by_name().expect("one source for each input");
    system
}

fn coupled_step(c: &mut Criterion) {
    let mut group = c.benchmark_group("coupled_step");
    for (name, timing) in [("untimed", false), ("timed", true)] {
        let options = RunOptions {
            stop: f64::from(STEPS),
            timing,
            ..RunOptions::default()
        };
        group.bench_function(name, |b| {
            b.iter_custom(|iterations| {
                let mut systems: Vec<_> = (0..iterations).map(|_| study()).collect();
                let begin = Instant::now();
                for system in &mut systems {
                    let report = system.run(&options, |_| ControlFlow::<()>::Continue(()));
                    assert_eq!(report.expect("nothing fails").steps, u64::from(STEPS));
                }
                begin.elapsed() / STEPS
            });
        });
    }
    group.finish();
}

criterion_group!(benches, coupled_step);
criterion_main!(benches);
