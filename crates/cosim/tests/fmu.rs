//! A compiled FMU in a system with a slave in plain Rust.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;
#[path = "../../fmi2-import/tests/common/mod.rs"]
mod workshop;

use std::ops::ControlFlow;

use common::{Journal, Mock};
use cosim::{CosimError, FmuSlave, OnSlaveError, RunOptions, System, Value};
use fmi2_import::Fmu;
use workshop::{Workshop, tank_description};

const GO_ON: ControlFlow<()> = ControlFlow::Continue(());

#[test]
#[allow(clippy::float_cmp, reason = "sums of powers of two are exact")]
fn an_fmu_and_a_mock_share_a_system() {
    let shop = Workshop::new();
    let Some(library) = shop.compile(&[]) else { return };
    let fmu = Fmu::open(shop.fmu("tank.fmu", &tank_description(""), &library)).unwrap();
    let mut system = System::new();
    // The inflow is k + 1 in step k.
    let pump = Mock::new("pump", &Journal::default())
        .output("inflow", 0.0)
        .step(|v, t, _| *v.get_mut("inflow").unwrap() = t / 0.5 + 1.0)
        .add_to(&mut system);
    let tank = system
        .add(Box::new(FmuSlave::new(fmu.instantiate("tank", false).unwrap())))
        .unwrap();
    let broken = system
        .add(Box::new(FmuSlave::from(fmu.instantiate("broken", false).unwrap())))
        .unwrap();
    assert_eq!(system.connect_by_name().unwrap(), 2);
    system.set_start(broken, "answer", Value::Integer(4)).unwrap();
    system.set_start(tank, "answer", Value::Integer(1)).unwrap();

    let mut probe = system.probe(tank).unwrap();
    let level = probe.real("level").unwrap();
    let (steps, open) = (probe.integer("steps").unwrap(), probe.boolean("open").unwrap());
    let trace = probe.string("trace").unwrap();
    let mut sample = probe.sample();
    let mut levels = Vec::new();
    let options = RunOptions {
        stop: 2.0,
        step: 0.5,
        on_slave_error: OnSlaveError::Isolate,
        ..RunOptions::default()
    };
    let report = system
        .run(&options, |ctx| {
            ctx.read(&mut sample).unwrap();
            levels.push(sample.get(level));
            GO_ON
        })
        .unwrap();
    // From 0.5 by 0.5 (1, 2, 3, 4).
    assert_eq!(levels, [0.5, 1.0, 2.0, 3.5, 5.5]);
    assert_eq!(
        (sample.get(steps), sample.get(open), sample.get(trace)),
        (4, true, String::new())
    );

    let [failed] = &report.isolated[..] else {
        panic!("one slave has failed")
    };
    assert_eq!((failed.slave, failed.time), (broken, 0.0));
    let CosimError::Slave { error, .. } = &failed.error else {
        panic!("{}", failed.error)
    };
    assert_eq!(
        (error.function.as_str(), error.status.as_str()),
        ("fmi2DoStep", "fmi2Fatal")
    );
    assert_eq!(error.messages, ["answer 4 at 100% load"]);

    // Warnings let the run go on and can be read.
    assert_eq!(system.messages(tank), ["fmi2Warning [tank] nearly full (x 4)"]);
    assert!(system.messages(pump).is_empty());
    // Fatal is for good.
    assert!(matches!(system.reset().unwrap_err(), CosimError::Reset { slave, .. } if slave == "broken"));
}
