//! The master: order of calls, values by both schemes, time grid, and slaves that fail.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;

use std::ops::ControlFlow;
use std::time::Duration;

use common::{Journal, Mock, entries};
use cosim::{
    BaseType, Causality, CosimError, Handle, OnSlaveError, RunOptions, RunReport, Sample, Scheme, SlaveId, StepContext,
    System, Value,
};

const GO_ON: ControlFlow<()> = ControlFlow::Continue(());

fn options(stop: f64, scheme: Scheme) -> RunOptions {
    RunOptions {
        stop,
        scheme,
        ..RunOptions::default()
    }
}

fn isolating(stop: f64) -> RunOptions {
    RunOptions {
        on_slave_error: OnSlaveError::Isolate,
        ..options(stop, Scheme::GaussSeidel)
    }
}

/// One Real to read.
type Reading = (Sample, Handle<f64>);

fn reading(system: &System, slave: SlaveId, name: &str) -> Reading {
    let mut probe = system.probe(slave).unwrap();
    let value = probe.real(name).unwrap();
    (probe.sample(), value)
}

/// Runs and takes each reading at every communication point.
fn record(system: &mut System, options: &RunOptions, readings: &mut [Reading]) -> Vec<Vec<f64>> {
    let mut rows = Vec::new();
    let report = system
        .run(options, |ctx| {
            rows.push(
                readings
                    .iter_mut()
                    .map(|(sample, value)| ctx.read(sample).map_or(f64::NAN, |()| sample.get(*value)))
                    .collect(),
            );
            GO_ON
        })
        .unwrap();
    assert_eq!(report.steps as usize + 1, rows.len());
    rows
}

/// a' = a + b and b' = 2 a, each fed by the other; both start at 1.
fn loop_of_two() -> (System, [Reading; 2], Journal) {
    let journal = Journal::default();
    let mut system = System::new();
    let first = Mock::new("first", &journal)
        .output("a", 1.0)
        .input("b")
        .step(|v, _, _| *v.get_mut("a").unwrap() += v["b"])
        .add_to(&mut system);
    let second = Mock::new("second", &journal)
        .output("b", 1.0)
        .input("a")
        .step(|v, _, _| *v.get_mut("b").unwrap() = 2.0 * v["a"])
        .add_to(&mut system);
    assert_eq!(system.connect_by_name().unwrap(), 2);
    let probes = [reading(&system, first, "a"), reading(&system, second, "b")];
    (system, probes, journal)
}

#[test]
#[allow(clippy::float_cmp, reason = "small whole numbers are exact")]
fn each_scheme_gives_the_values_worked_by_hand() {
    let (mut system, mut probes, _) = loop_of_two();
    // The second slave sees what the first has just computed: b = 2 a in every row.
    let rows = record(&mut system, &options(3.0, Scheme::GaussSeidel), &mut probes);
    assert_eq!(rows, [[1.0, 1.0], [2.0, 4.0], [6.0, 12.0], [18.0, 36.0]]);

    // Reset, the same system runs again; now b is twice the a of one row above.
    system.reset().unwrap();
    let rows = record(&mut system, &options(3.0, Scheme::Jacobi), &mut probes);
    assert_eq!(rows, [[1.0, 1.0], [2.0, 2.0], [4.0, 4.0], [8.0, 8.0]]);
}

#[test]
fn calls_come_in_the_order_of_the_standard() {
    let (mut system, _, journal) = loop_of_two();
    let _ = system.run(&options(1.0, Scheme::GaussSeidel), |_| GO_ON).unwrap();
    let initialization = [
        "first.setup 0..Some(1.0)",
        "second.setup 0..Some(1.0)",
        "first.enter",
        "second.enter",
        // Fetched ahead, since it feeds the first.
        "second.get_real",
        "first.set_real",
        "first.get_real",
        "second.set_real",
        "second.get_real",
        "first.exit",
        "second.exit",
        "first.get_real",
        "second.get_real",
    ];
    let end = ["first.terminate", "second.terminate"];
    let one_by_one = [
        "first.set_real",
        "first.step",
        "first.get_real",
        "second.set_real",
        "second.step",
        "second.get_real",
    ];
    assert_eq!(entries(&journal), [&initialization[..], &one_by_one, &end].concat());

    let (mut system, _, journal) = loop_of_two();
    let _ = system.run(&options(1.0, Scheme::Jacobi), |_| GO_ON).unwrap();
    let together = [
        "first.set_real",
        "second.set_real",
        "first.step",
        "second.step",
        "first.get_real",
        "second.get_real",
    ];
    assert_eq!(entries(&journal), [&initialization[..], &together, &end].concat());
}

#[test]
#[allow(clippy::float_cmp, reason = "copied values are exact")]
fn values_travel_in_one_call_per_type_whatever_the_fan_out() {
    let journal = Journal::default();
    let mut system = System::new();
    let kinds = [
        ("x", BaseType::Real, 1.5),
        ("y", BaseType::Real, -2.0),
        ("n", BaseType::Integer, 7.0),
        ("mode", BaseType::Enumeration, 3.0),
        ("valid", BaseType::Boolean, 1.0),
        ("text", BaseType::String, 0.0),
    ];
    let with = |name: &str, causality: Causality, values: bool| {
        kinds.iter().fold(Mock::new(name, &journal), |m, (port, kind, v)| {
            m.port(port, *kind, causality, if values { *v } else { 0.0 })
        })
    };
    let source = with("source", Causality::Output, true)
        .port("title", BaseType::String, Causality::Parameter, 0.0)
        .add_to(&mut system);
    let sinks: Vec<SlaveId> = ["s1", "s2", "s3"]
        .map(|n| with(n, Causality::Input, false).add_to(&mut system))
        .to_vec();
    assert_eq!(system.connect_by_name().unwrap(), 18);
    system
        .set_start(source, "title", Value::String("old".to_owned()))
        .unwrap();
    system
        .set_start(source, "title", Value::String("hello".to_owned()))
        .unwrap();

    let mut probe = system.probe(sinks[2]).unwrap();
    let reals = probe.reals(&["y", "x"]).unwrap();
    let integers = ["mode", "n"].map(|name| probe.integer(name).unwrap());
    let (valid, text) = (probe.boolean("valid").unwrap(), probe.string("text").unwrap());
    let mut sample = probe.sample();
    let _ = system
        .run(&options(1.0, Scheme::GaussSeidel), |ctx| {
            if ctx.step() == 0 {
                entries(&journal);
            } else {
                ctx.read(&mut sample).unwrap();
            }
            GO_ON
        })
        .unwrap();
    assert_eq!(sample.get(reals), [-2.0, 1.5]);
    assert_eq!(integers.map(|handle| sample.get(handle)), [3, 7]);
    assert!(sample.get(valid));
    assert_eq!(sample.get(text), "hello");
    let calls = entries(&journal);
    for kind in ["real", "integer", "boolean", "string"] {
        let count = |call: String| calls.iter().filter(|c| **c == call).count();
        assert_eq!(count(format!("source.get_{kind}")), 1, "{calls:?}");
        assert_eq!(count(format!("s1.set_{kind}")), 1, "{calls:?}");
        assert_eq!(count(format!("s1.get_{kind}")), 0, "{calls:?}");
    }
}

#[test]
#[allow(clippy::float_cmp, reason = "copied values are exact")]
fn initialization_hands_values_down_the_chain() {
    let journal = Journal::default();
    let mut system = System::new();
    let source = Mock::new("source", &journal)
        .port("p", BaseType::Real, Causality::Parameter, 0.0)
        .output("x", 0.0)
        .feedthrough(|v, _, _| *v.get_mut("x").unwrap() = 3.0 * v["p"])
        .add_to(&mut system);
    Mock::new("middle", &journal)
        .input("x")
        .output("y", 0.0)
        .feedthrough(|v, _, _| *v.get_mut("y").unwrap() = 1.0 + v["x"])
        .add_to(&mut system);
    let end = Mock::new("end", &journal).input("y").add_to(&mut system);
    system.connect_by_name().unwrap();
    system.set_start(source, "p", Value::Real(2.0)).unwrap();
    let mut readings = [reading(&system, end, "y")];
    // Before the first step, by either scheme.
    for scheme in [Scheme::GaussSeidel, Scheme::Jacobi] {
        let rows = record(&mut system, &options(0.0, scheme), &mut readings);
        assert_eq!(rows, [[7.0]]);
        system.reset().unwrap();
    }
}

#[test]
#[allow(clippy::float_cmp, reason = "the grid is defined to the last bit")]
fn time_is_a_product_not_a_sum() {
    let journal = Journal::default();
    let mut system = System::new();
    let clock = Mock::new("clock", &journal)
        .output("t", f64::NAN)
        .output("h", f64::NAN)
        .step(|v, t, h| {
            v.insert("t".to_owned(), t);
            v.insert("h".to_owned(), h);
        })
        .add_to(&mut system);
    let mut probe = system.probe(clock).unwrap();
    let times = probe.reals(&["t", "h"]).unwrap();
    let mut sample = probe.sample();
    let options = RunOptions {
        start: 5.0,
        stop: 105.0,
        step: 0.1,
        ..RunOptions::default()
    };
    let report = system
        .run(&options, |ctx| {
            let k = ctx.step() as f64;
            assert_eq!(ctx.time(), 5.0 + k * 0.1);
            if ctx.step() > 0 {
                ctx.read(&mut sample).unwrap();
                assert_eq!(sample.get(times), [5.0 + (k - 1.0) * 0.1, 0.1]);
            }
            GO_ON
        })
        .unwrap();
    assert_eq!(report.steps, 1000);
}

#[test]
fn the_last_point_does_not_pass_the_stop_time() {
    for (stop, step, steps) in [
        (0.3, 0.1, 3),
        (1.0, 0.3, 3),
        (0.0, 1.0, 0),
        (0.9, 1.0, 0),
        (2.5, 0.25, 10),
    ] {
        let mut system = System::new();
        Mock::new("a", &Journal::default()).add_to(&mut system);
        let report = system
            .run(
                &RunOptions {
                    stop,
                    step,
                    ..RunOptions::default()
                },
                |_| GO_ON,
            )
            .unwrap();
        assert_eq!(report.steps, steps, "stop {stop} step {step}");
    }
}

#[test]
fn impossible_times_are_refused_before_anything_is_called() {
    let journal = Journal::default();
    let mut system = System::new();
    Mock::new("a", &journal).add_to(&mut system);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        let error = system
            .run(
                &RunOptions {
                    step,
                    ..RunOptions::default()
                },
                |_| GO_ON,
            )
            .unwrap_err();
        assert!(matches!(error, CosimError::StepSize { .. }), "{error}");
    }
    for (start, stop) in [(1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        let error = system
            .run(
                &RunOptions {
                    start,
                    stop,
                    ..RunOptions::default()
                },
                |_| GO_ON,
            )
            .unwrap_err();
        assert!(matches!(error, CosimError::Interval { .. }), "{error}");
    }
    assert_eq!(entries(&journal), [""; 0]);
}

#[test]
fn the_callback_can_end_the_run() {
    let (mut system, _, journal) = loop_of_two();
    let report = system
        .run(&options(100.0, Scheme::Jacobi), |ctx| {
            if ctx.step() == 2 {
                ControlFlow::Break("enough")
            } else {
                ControlFlow::Continue(())
            }
        })
        .unwrap();
    assert_eq!((report.steps, report.broke), (2, Some("enough")));
    assert_eq!(
        entries(&journal)[23..],
        [
            "first.get_real",
            "second.get_real",
            "first.terminate",
            "second.terminate"
        ]
    );
}

/// truth -> (good, bad); bad -> shadow. The nth call of `function` of `who` fails.
fn family(who: &str, function: &str, nth: u32) -> (System, [SlaveId; 4], Journal) {
    let journal = Journal::default();
    let mut system = System::new();
    let make = |name: &str| {
        let mock = Mock::new(name, &journal);
        if name == who { mock.fail(function, nth) } else { mock }
    };
    let count = |v: &mut std::collections::BTreeMap<String, f64>, _, _| *v.get_mut("n").unwrap() += 1.0;
    let truth = make("truth").output("z", 0.0).add_to(&mut system);
    let bad = make("bad")
        .input("z")
        .output("est", 0.0)
        .port("p", BaseType::Real, Causality::Parameter, 0.0)
        .add_to(&mut system);
    let shadow = make("shadow").input("est").add_to(&mut system);
    let good = make("good")
        .input("z")
        .port("n", BaseType::Real, Causality::Local, 0.0)
        .step(count)
        .add_to(&mut system);
    system.connect_by_name().unwrap();
    (system, [truth, bad, shadow, good], journal)
}

fn names(report: &RunReport<()>) -> Vec<(&str, f64)> {
    report.isolated.iter().map(|i| (i.name.as_str(), i.time)).collect()
}

#[test]
fn a_failure_stops_the_run_and_says_everything() {
    let (mut system, _, _) = family("bad", "step", 3);
    let error = system.run(&options(10.0, Scheme::GaussSeidel), |_| GO_ON).unwrap_err();
    match &error {
        CosimError::Slave { slave, time, error } => {
            assert_eq!((slave.as_str(), *time), ("bad", 2.0));
            assert_eq!((error.function.as_str(), error.status.as_str()), ("step", "fmi2Error"));
            assert_eq!(error.messages, ["told to fail"]);
        }
        other => panic!("{other}"),
    }
    assert_eq!(
        error.to_string(),
        r#"slave "bad" failed at 2 s: step returned fmi2Error: told to fail"#
    );
}

#[test]
#[allow(clippy::float_cmp, reason = "a count is exact")]
fn a_failed_slave_and_its_dependents_leave_and_the_rest_goes_on() {
    for scheme in [Scheme::GaussSeidel, Scheme::Jacobi] {
        let (mut system, [_, bad, shadow, good], journal) = family("bad", "step", 3);
        let (mut of_good, count) = reading(&system, good, "n");
        let (mut of_bad, _) = reading(&system, bad, "est");
        let report = system
            .run(
                &RunOptions {
                    scheme,
                    ..isolating(10.0)
                },
                |ctx: &mut StepContext<'_>| {
                    let alive = ctx.step() < 3;
                    assert_eq!(
                        (ctx.is_active(bad), ctx.is_active(shadow), ctx.is_active(good)),
                        (alive, alive, true)
                    );
                    assert_eq!(ctx.read(&mut of_bad).is_ok(), alive);
                    ctx.read(&mut of_good).unwrap();
                    GO_ON
                },
            )
            .unwrap();
        assert_eq!(
            (report.steps, of_good.get(count)),
            (10, 10.0),
            "the good one has stepped all the way"
        );
        assert_eq!(names(&report), [("bad", 2.0), ("shadow", 2.0)]);
        assert!(matches!(&report.isolated[0].error, CosimError::Slave { .. }));
        let upstream = &report.isolated[1].error;
        assert!(matches!(upstream, CosimError::Upstream { .. }));
        assert!(
            upstream.to_string().contains("told to fail"),
            "the cause is told along: {upstream}"
        );
        let calls = entries(&journal);
        assert_eq!(
            calls.iter().filter(|c| *c == "bad.step").count(),
            3,
            "never called again"
        );
        assert!(!calls.contains(&"bad.terminate".to_owned()));
        assert!(calls.contains(&"good.terminate".to_owned()));
    }
}

#[test]
fn a_run_without_its_source_ends() {
    let (mut system, _, _) = family("truth", "step", 4);
    let mut points = 0;
    let report = system
        .run(&isolating(10.0), |_| {
            points += 1;
            GO_ON
        })
        .unwrap();
    assert_eq!((report.steps, points), (3, 4));
    assert_eq!(
        names(&report),
        [("truth", 3.0), ("bad", 3.0), ("shadow", 3.0), ("good", 3.0)]
    );
}

#[test]
fn any_call_may_be_the_one_that_fails() {
    for (function, nth, at) in [
        ("setup 0..Some(5.0)", 1, 0.0),
        ("set_real", 1, 0.0), // the start value
        ("enter", 1, 0.0),
        ("set_real", 2, 0.0), // the exchange during initialization
        ("exit", 1, 0.0),
        ("get_real", 2, 0.0),
        ("set_real", 4, 1.0),
        ("get_real", 4, 1.0),
    ] {
        let (mut system, [_, bad, _, _], _) = family("bad", function, nth);
        system.set_start(bad, "p", Value::Real(1.0)).unwrap();
        let report = system.run(&isolating(5.0), |_| GO_ON).unwrap();
        assert_eq!(names(&report), [("bad", at), ("shadow", at)], "{function} {nth}");
        assert_eq!(report.steps, 5);
    }
    let (mut system, [_, bad, _, _], _) = family("bad", "set_real", 1);
    system.set_start(bad, "p", Value::Real(0.5)).unwrap();
    let error = system.run(&options(1.0, Scheme::Jacobi), |_| GO_ON).unwrap_err();
    assert!(error.to_string().ends_with(r#"while setting "p" to 0.5"#), "{error}");
}

#[test]
fn a_failed_end_concerns_one_slave_alone() {
    let (mut system, _, journal) = family("bad", "terminate", 1);
    let report = system.run(&isolating(5.0), |_| GO_ON).unwrap();
    assert_eq!(names(&report), [("bad", 5.0)]);
    assert!(entries(&journal).contains(&"shadow.terminate".to_owned()));
}

#[test]
fn a_failed_reading_counts_as_a_failed_slave() {
    // Outputs of `bad` are fetched twice in initialization and once in each step: the third and the fourth call.
    let (mut system, [_, bad, _, _], _) = family("bad", "get_real", 4);
    let (mut sample, _) = reading(&system, bad, "p");
    let mut reads = Vec::new();
    let report = system
        .run(&isolating(5.0), |ctx| {
            if ctx.step() > 0 {
                reads.push(ctx.read(&mut sample).map_err(|e| e.to_string()));
            }
            GO_ON
        })
        .unwrap();
    assert_eq!(names(&report), [("bad", 1.0), ("shadow", 1.0)]);
    assert_eq!(
        reads[0].as_ref().unwrap_err(),
        r#"slave "bad" failed at 1 s: get_real returned fmi2Error: told to fail"#
    );
    assert_eq!(
        reads[1].as_ref().unwrap_err(),
        r#"slave "bad" has left the run and cannot be read"#
    );

    // Without isolation the run ends with the error, even if the callback does not care.
    let (mut system, [_, bad, _, _], _) = family("bad", "get_real", 4);
    let (mut sample, _) = reading(&system, bad, "p");
    let mut last = 0;
    let error = system
        .run(&options(5.0, Scheme::GaussSeidel), |ctx| {
            last = ctx.step();
            if last > 0 {
                let _ = ctx.read(&mut sample);
            }
            GO_ON
        })
        .unwrap_err();
    assert!(matches!(error, CosimError::Slave { .. }), "{error}");
    assert_eq!(last, 1);
}

#[test]
fn a_slave_that_cannot_be_reset_is_named() {
    let (mut system, _, _) = family("good", "reset", 1);
    let error = system.reset().unwrap_err();
    assert!(
        matches!(&error, CosimError::Reset { slave, .. } if slave == "good"),
        "{error}"
    );
}

#[test]
fn timings_are_kept_on_request() {
    let journal = Journal::default();
    let mut system = System::new();
    Mock::new("quick", &journal).output("x", 0.0).add_to(&mut system);
    Mock::new("slow", &journal)
        .input("x")
        .step(|_, _, _| compute(2.0 * MILLISECOND))
        .add_to(&mut system);
    system.connect_by_name().unwrap();
    let timed = |stop| RunOptions {
        timing: true,
        ..options(stop, Scheme::Jacobi)
    };
    let report = system.run(&timed(5.0), |_| GO_ON).unwrap();
    let [quick, slow] = &report.timings[..] else {
        panic!("one entry for each slave")
    };
    assert_eq!((quick.name.as_str(), slow.name.as_str()), ("quick", "slow"));
    let milliseconds = |time: Duration| time.as_secs_f64() / MILLISECOND;
    // What reading the clock takes, less than a microsecond, is subtracted once for each step.
    assert!((9.9..15.0).contains(&milliseconds(slow.step)), "{slow:?}");
    for part in [quick.set, quick.step, quick.get, slow.set, slow.get] {
        assert!(milliseconds(part) < 2.0, "{quick:?} {slow:?}");
    }

    system.reset().unwrap();
    let report = system.run(&options(5.0, Scheme::Jacobi), |_| GO_ON).unwrap();
    assert!(report.timings.is_empty());
}

const MILLISECOND: f64 = 1e-3;

/// Computes for so many seconds of this thread's time.
fn compute(seconds: f64) {
    let begin = clock();
    while clock() - begin < seconds {}
}

/// Seconds that this thread has computed; on the wall where there is no such clock.
fn clock() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    {
        static FIRST: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
        FIRST.elapsed().as_secs_f64()
    }
}

#[cfg(unix)]
#[test]
fn a_slave_that_sleeps_costs_next_to_nothing() {
    let journal = Journal::default();
    let mut system = System::new();
    Mock::new("idle", &journal)
        .step(|_, _, _| std::thread::sleep(Duration::from_millis(5)))
        .add_to(&mut system);
    let timed = RunOptions {
        timing: true,
        ..options(5.0, Scheme::GaussSeidel)
    };
    let begin = std::time::Instant::now();
    let report = system.run(&timed, |_| GO_ON).unwrap();
    assert!(begin.elapsed() >= Duration::from_millis(25));
    assert!(
        report.timings[0].step < Duration::from_millis(2),
        "{:?}",
        report.timings
    );
}

#[test]
#[allow(clippy::float_cmp, reason = "copied values are exact")]
fn handles_know_their_type_and_what_is_not_there_is_told() {
    let journal = Journal::default();
    let mut system = System::new();
    let mut mock = Mock::new("m", &journal).output("r[1]", 1.0).output("r[2]", 2.0);
    mock = mock.port("n", BaseType::Integer, Causality::Output, 5.0);
    for (at, name) in ["p[1,1]", "p[1,2]", "p[2,1]", "p[2,2]", "r[3]"].into_iter().enumerate() {
        mock = mock.output(name, 10.0 + at as f64);
    }
    let m = mock.add_to(&mut system);
    let mut probe = system.probe(m).unwrap();
    let count = probe.integer("n").unwrap();
    let wrong = probe.real("n").unwrap_err();
    assert_eq!(wrong.to_string(), "m.n is of type Integer and cannot be read as Real");
    // Half of a vector is chosen by nobody, and moves no place of the others.
    let half = probe.vec3("p").unwrap_err();
    assert!(matches!(half, CosimError::UnknownVariable { .. }), "{half}");
    assert!(matches!(
        probe.reals(&["r[1]", "r[4]"]),
        Err(CosimError::UnknownVariable { .. })
    ));
    let (matrix, vector) = (probe.matrix::<2, 2>("p").unwrap(), probe.vec3("r").unwrap());
    let mut sample = probe.sample();
    assert_eq!((sample.get(count), sample.get(vector)), (0, [0.0; 3]));
    let _ = system
        .run(&options(0.0, Scheme::GaussSeidel), |ctx| {
            ctx.read(&mut sample).unwrap();
            GO_ON
        })
        .unwrap();
    assert_eq!(sample.get(matrix), [[10.0, 11.0], [12.0, 13.0]]);
    assert_eq!(sample.get(vector), [1.0, 2.0, 14.0]);
    assert_eq!(sample.get(count), 5);
}
