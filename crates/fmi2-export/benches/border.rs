//! What it costs to get and set n values through the C functions, and through the model's own accessors.
//!
//! `cargo bench -p fmi2-export` prints both, and between them the instance that checks variables and values but knows no C. The
//! aim: at most 20 ns + 3 n ns above the accessors.

#![allow(unsafe_code, reason = "calls the C functions")]
#![allow(missing_docs, clippy::expect_used, reason = "a bench that cannot run should stop")]

use std::ffi::CString;
use std::hint::black_box;
use std::ptr;
use std::sync::OnceLock;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use fmi_model::{Instance, Scalar};
use fmi2_export::abi::{Fmi2CallbackFunctions, Fmi2Component};
use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table, TableBuilder, export_fmu};

/// A gate, a position, the states of a filter, a covariance.
const COUNTS: [usize; 4] = [1, 3, 18, 81];

/// Holds as many inputs and outputs as a covariance of nine states has elements, and does nothing.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
struct Still {
    u: Vec<f64>,
    p: Vec<f64>,
}

impl Model for Still {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "still",
            model_identifier: "still",
            version: "1",
            default_stop: 1.0,
            default_step: 1.0,
            ..ModelInfo::default()
        })
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Still>> = OnceLock::new();
        TABLE.get_or_init(|| {
            let mut t = TableBuilder::new();
            let u = t.real("u").input().unit("m");
            u.vector_rw(81, |m: &Still, i| m.u[i], |m, i, v| m.u[i] = v);
            t.real("p").output().unit("m2").matrix(9, 9, |m, i, j| m.p[9 * i + j]);
            t.build()
        })
    }

    fn blank() -> Self {
        Self {
            u: vec![0.0; 81],
            p: vec![0.5; 81],
        }
    }

    fn initialise(&mut self, _experiment: &Experiment, _log: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }

    fn do_step(&mut self, _t: f64, _h: f64, _log: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }
}

export_fmu!(Still);

/// An FMU that is ready to step.
fn component() -> Fmi2Component {
    let guid = format!("{{{}}}", fmi2_export::guid::<Still>().expect("a sound definition"));
    let guid = CString::new(guid).expect("no NUL");
    let callbacks = Fmi2CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::null_mut(),
    };
    // SAFETY: the arguments are live for the call, and the component is handed on as it came.
    unsafe {
        let name = c"still".as_ptr();
        let component = fmi2::fmi2Instantiate(name, 1, guid.as_ptr(), ptr::null(), &callbacks, 0, 0);
        assert!(!component.is_null());
        assert_eq!(fmi2::fmi2EnterInitializationMode(component), 0);
        assert_eq!(fmi2::fmi2ExitInitializationMode(component), 0);
        component
    }
}

fn instance() -> Instance<Still> {
    let (mut instance, mut log) = (Instance::new(), Log::silent());
    instance.enter_initialization(&mut log).expect("the model cannot fail");
    instance.exit_initialization(&mut log).expect("the model cannot fail");
    instance
}

/// Value references of the first `count` elements of a row.
fn references(first: &str, count: usize) -> Vec<u32> {
    let first = Still::table().find(first).expect("a variable of the model");
    (first..).take(count).collect()
}

/// Value references of which no two neighbours are of one row.
fn apart(count: usize) -> Vec<u32> {
    let rows = [references("p[1,1]", count), references("u[1]", count)];
    (0..count).map(|at| rows[at % 2][at]).collect()
}

fn get(c: &mut Criterion) {
    get_these(c, "get", |n| references("p[1,1]", n));
    get_these(c, "get_apart", apart);
}

fn get_these(c: &mut Criterion, name: &str, references: fn(usize) -> Vec<u32>) {
    let mut group = c.benchmark_group(name);
    let (component, mut instance, model) = (component(), instance(), Still::blank());
    for n in COUNTS {
        let references = references(n);
        let mut values = vec![0.0; n];
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::new("model", n), |b| {
            let entries: Vec<_> = references.iter().filter_map(|r| Still::table().entry(*r)).collect();
            let accessors: Vec<_> = (entries.iter())
                .filter_map(|entry| Some((f64::access(&entry.row.typed)?, entry.element)))
                .collect();
            b.iter(|| {
                for ((access, element), value) in black_box(&accessors).iter().zip(&mut values) {
                    *value = access.read(black_box(&model), *element);
                }
                black_box(&mut values);
            });
        });
        group.bench_function(BenchmarkId::new("instance", n), |b| {
            let mut log = Log::silent();
            b.iter(|| {
                let read = instance.get(black_box(&references), &mut log, |place, value| values[place] = value);
                black_box(&mut values);
                read
            });
        });
        group.bench_function(BenchmarkId::new("c", n), |b| {
            b.iter(|| {
                let (vr, value) = (black_box(references.as_ptr()), black_box(values.as_mut_ptr()));
                // SAFETY: the component is alive, and both arrays have n elements.
                let status = unsafe { fmi2::fmi2GetReal(component, vr, n, value) };
                assert_eq!(status, 0);
            });
        });
    }
    // SAFETY: not used after this.
    unsafe { fmi2::fmi2FreeInstance(component) };
    group.finish();
}

fn set(c: &mut Criterion) {
    let mut group = c.benchmark_group("set");
    let (component, mut instance, mut model) = (component(), instance(), Still::blank());
    for n in COUNTS {
        let references = references("u[1]", n);
        let values = vec![1.5; n];
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::new("model", n), |b| {
            let entries: Vec<_> = references.iter().filter_map(|r| Still::table().entry(*r)).collect();
            let accessors: Vec<_> = (entries.iter())
                .filter_map(|entry| Some((f64::access(&entry.row.typed)?, entry.element)))
                .collect();
            b.iter(|| {
                for ((access, element), value) in black_box(&accessors).iter().zip(&values) {
                    access.write(black_box(&mut model), *element, *value);
                }
            });
        });
        group.bench_function(BenchmarkId::new("instance", n), |b| {
            b.iter(|| instance.set(black_box(&references), |place| values[place]));
        });
        group.bench_function(BenchmarkId::new("c", n), |b| {
            b.iter(|| {
                let (vr, value) = (black_box(references.as_ptr()), black_box(values.as_ptr()));
                // SAFETY: the component is alive, and both arrays have n elements.
                let status = unsafe { fmi2::fmi2SetReal(component, vr, n, value) };
                assert_eq!(status, 0);
            });
        });
    }
    // SAFETY: not used after this.
    unsafe { fmi2::fmi2FreeInstance(component) };
    group.finish();
}

criterion_group!(benches, get, set);
criterion_main!(benches);
