//! Time of one navigation step: every filter at its defaults in a world of each kind, MILTON over the length of its buffer, the
//! network over its neurons, the shapes of constrained_q; and the share of a law alone, with three measured rows and with six.
//!
//! `cargo bench -p filters` prints the time of one step, averaged over the same ten minutes of samples for each filter,
//! so that the cost of MILTON's rare updates is spread over the steps between them, as in use.

#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/formation/mod.rs"]
mod formation;

use common::{OwnWorld, navigation};
use criterion::{Bencher, Criterion, criterion_group, criterion_main};
use filters::laws::{Adaptation, FILTERS, Law, Setup, Step};
use filters::state::{RowVector, Rows, State, TargetMatrix};
use filters::tunable::{Tunable, Tunables, Value};
use filters::{Layout, Navigation, Navigator, Sample, Settings, Units};
use formation::{Formation, World};
use interface::Sensor;
use nalgebra::Matrix3;
use numerics::{Source, stream};
use rand_distr::{Distribution, StandardNormal};
use std::hint::black_box;
use std::time::Instant;

const STEPS: u32 = 620;

fn samples() -> (Vec<Sample>, State) {
    let (mut world, start) = OwnWorld::new(1, 1e-6);
    ((0..STEPS).map(|_| world.step()).collect(), start)
}

fn samples_in_formation() -> (Vec<Sample>, State) {
    let (mut world, start) = Formation::new(1);
    ((0..STEPS).map(|_| world.step()).collect(), start)
}

/// Reports the mean time of a step rather than that of a run.
fn per_step(b: &mut Bencher<'_>, told: &Navigation, settings: &Settings, samples: &[Sample], start: &State) {
    b.iter_custom(|iterations| {
        let clock = Instant::now();
        for _ in 0..iterations {
            black_box(run(told, black_box(settings), samples, start));
        }
        clock.elapsed() / STEPS
    });
}

fn run(told: &Navigation, settings: &Settings, samples: &[Sample], start: &State) -> f64 {
    let mut nav = Navigator::new(told, settings, 0.0).expect("default settings are valid");
    for sample in samples {
        nav.process(sample, start).expect("the filter survives its own world");
    }
    nav.estimate().x[0]
}

fn benches(c: &mut Criterion) {
    let (samples, start) = samples();
    let mut group = c.benchmark_group("nav_step");
    group.sample_size(20);
    let in_formation = samples_in_formation();
    for (scenario, samples, start) in [
        ("leo_venting", &samples, &start),
        ("formation", &in_formation.0, &in_formation.1),
    ] {
        let told = navigation(scenario);
        for (filter, entry) in FILTERS.iter().enumerate() {
            if entry.no_meaning_in(&told).is_some() {
                continue;
            }
            let settings = Settings {
                filter,
                ..Settings::default()
            };
            let name = format!("{} in {}", entry.name, scenario);
            group.bench_function(name, |b| per_step(b, &told, &settings, samples, start));
        }
    }
    let told = navigation("leo_venting");
    for neurons in [1, 60, 240] {
        let mut settings = Settings {
            filter: position("rbfnn_ekf"),
            ..Settings::default()
        };
        if let Some(value) = settings.tunable_mut("rbfnn_ekf", "neurons") {
            *value = Value::Integer(neurons);
        }
        group.bench_function(format!("rbfnn_ekf neurons={neurons}"), |b| {
            per_step(b, &told, &settings, &samples, &start)
        });
    }
    for m_b in [3, 10, 30, 60] {
        let filter = position("milton");
        let mut settings = Settings {
            filter,
            ..Settings::default()
        };
        if let Some(value) = settings.tunable_mut("milton", "m_b") {
            *value = Value::Integer(m_b);
        }
        group.bench_function(format!("milton m_b={m_b}"), |b| {
            per_step(b, &told, &settings, &samples, &start)
        });
    }
    for shape in [0, 1] {
        let filter = position("constrained_q");
        let mut settings = Settings {
            filter,
            ..Settings::default()
        };
        for (tunable, chosen) in [
            ("law", Value::Choice(1)),
            ("residuals", Value::Choice(1)),
            ("whiten", Value::Boolean(true)),
            ("shape", Value::Choice(shape)),
        ] {
            if let Some(value) = settings.tunable_mut("constrained_q", tunable) {
                *value = chosen;
            }
        }
        let name = ["diagonal", "full"][shape];
        group.bench_function(format!("constrained_q {name}"), |b| {
            per_step(b, &told, &settings, &samples, &start)
        });
    }
    group.finish();

    let mut group = c.benchmark_group("law_step");
    group.sample_size(20);
    for rows in [3, 6] {
        let steps = steps(rows);
        for (name, shape) in [("milton", 0), ("constrained_q", 0), ("constrained_q full", 1)] {
            let fresh = law(position(name.trim_end_matches(" full")), rows, shape);
            group.bench_function(format!("{name} {rows} rows"), |b| law_per_step(b, &fresh, &steps));
        }
    }
    group.finish();
}

fn position(name: &str) -> usize {
    FILTERS
        .iter()
        .position(|f| f.name == name)
        .expect("the filter is registered")
}

/// Steps of three integrators seen through rows of noise.
fn steps(rows: usize) -> Vec<Step> {
    let mut g = stream(3, 0, Source::Lidar);
    let mut normal = || -> f64 { StandardNormal.sample(&mut g) };
    let (i, half) = (Matrix3::identity(), Matrix3::identity() * 0.5);
    let mut f = TargetMatrix::identity();
    f.fixed_view_mut::<3, 3>(0, 3).copy_from(&i);
    f.fixed_view_mut::<3, 3>(3, 6).copy_from(&i);
    f.fixed_view_mut::<3, 3>(0, 6).copy_from(&half);
    (0..STEPS)
        .map(|_| {
            let mut step = Step::blank(1.0, f);
            step.measured.mark(0..rows);
            step.h = Rows::from_fn(|row, state| f64::from(row < rows && row == state));
            step.innovation = RowVector::from_fn(|row, _| if row < rows { normal() } else { 0.0 });
            step
        })
        .collect()
}

/// A law for rows of unit noise; `shape` is that of constrained_q.
fn law(filter: usize, rows: usize, shape: usize) -> Law {
    let (entry, told) = (&FILTERS[filter], navigation("leo_venting"));
    let value = |t: &Tunable| match t.name {
        "r_w" => Value::Real(1.0),
        "q_w" => Value::Real(1e-5),
        "psi0" => Value::Real(1e-3),
        "s0" => Value::Real(1e-6),
        "law" | "residuals" => Value::Choice(1),
        "shape" => Value::Choice(shape),
        _ => t.kind.start(),
    };
    let values: Vec<Value> = entry.tunables.iter().map(value).collect();
    let setup = Setup {
        tunables: Tunables {
            law: entry.name,
            declared: entry.tunables,
            values: &values,
            told: &told,
        },
        layout: Layout::new(&[if rows == 3 { Sensor::Lidar } else { Sensor::Metrology }]),
        r: RowVector::from_fn(|row, _| f64::from(row < rows)),
        state_measured: rows == 6,
        units: Units::SI,
        off_nominal: 1.0,
        study_seed: 1,
        run: 0,
    };
    Law::new(filter, &setup).expect("the tuning is legal")
}

fn law_per_step(b: &mut Bencher<'_>, fresh: &Law, steps: &[Step]) {
    b.iter_custom(|iterations| {
        let clock = Instant::now();
        for _ in 0..iterations {
            let mut law = fresh.clone();
            for step in steps {
                law.observe(step).expect("the law learns from noise");
            }
            black_box(law.s());
        }
        clock.elapsed() / STEPS
    });
}

criterion_group!(nav_step, benches);
criterion_main!(nav_step);
