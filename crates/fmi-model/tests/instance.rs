//! An instance without any standard around it: what it refuses, when the model initialises, and how it is saved.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panic, too")]

use std::fmt::Display;
use std::sync::{Mutex, OnceLock};

use fmi_model::{
    Category, Experiment, Instance, InstanceError, Listener, Log, Model, ModelError, ModelInfo, Phase, Seal, Snapshot,
    Table, TableBuilder,
};
use serde::{Deserialize, Serialize};
use uuid::Uuid;

/// Counts down from a start value, and refuses to go below zero.
#[derive(Clone, Default, Debug, PartialEq, Serialize, Deserialize)]
struct Counter {
    from: [i32; 2],
    rate: f64,
    left: [i32; 2],
    initialised: i32,
    heard: f64,
}

impl Model for Counter {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(ModelInfo::default)
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Counter>> = OnceLock::new();
        TABLE.get_or_init(|| {
            let mut t = TableBuilder::<Counter>::new();
            t.integer("from")
                .parameter()
                .min(0)
                .start(3)
                .vector_rw(2, |m, i| m.from[i], |m, i, v| m.from[i] = v);
            t.real("rate").input().unit("1/s").rw(|m| m.rate, |m, v| m.rate = v);
            t.integer("left").output().vector(2, |m, i| m.left[i]);
            t.integer("initialised").local().get(|m| m.initialised);
            t.real("heard").input().any_number().rw(|m| m.heard, |m, v| m.heard = v);
            t.build()
        })
    }

    fn blank() -> Self {
        Self::default()
    }

    fn initialise(&mut self, _: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        self.left = self.from;
        self.initialised += 1;
        log.event("ready");
        Ok(())
    }

    fn do_step(&mut self, t: f64, _h: f64, log: &mut Log<'_>) -> Result<(), ModelError> {
        if self.left.contains(&0) {
            return Err("nothing left".into());
        }
        self.left = self.left.map(|left| left - 1);
        log.detail(format_args!("{} left after {t} s", self.left[0]));
        Ok(())
    }
}

const FROM: [u32; 2] = [0, 1];
const RATE: [u32; 1] = [2];
const LEFT: [u32; 2] = [3, 4];
const INITIALISED: [u32; 1] = [5];
const HEARD: [u32; 1] = [6];

fn integers(counter: &mut Instance<Counter>, references: &[u32]) -> Vec<i32> {
    let mut values = Vec::new();
    counter
        .get(references, &mut Log::silent(), |_, value| values.push(value))
        .unwrap();
    values
}

fn started() -> Instance<Counter> {
    let mut counter = Instance::new();
    counter.setup_experiment(Experiment::default()).unwrap();
    counter.enter_initialization(&mut Log::silent()).unwrap();
    counter.exit_initialization(&mut Log::silent()).unwrap();
    counter
}

#[test]
fn a_refused_set_changes_nothing() {
    let mut counter = Instance::<Counter>::new();
    assert_eq!(integers(&mut counter, &FROM), [3, 3], "the start column");
    let error = counter.set(&FROM, |place| [5, -1][place]).unwrap_err();
    assert_eq!(error.to_string(), "'from[2]' = -1 must be at least 0");
    assert_eq!(integers(&mut counter, &FROM), [3, 3]);
    let wrong: [(Result<(), InstanceError>, &str); 4] = [
        (
            counter.set(&FROM, |_| 1.0),
            "'from[1]' (value reference 0) is of type Integer",
        ),
        (
            counter.set(&[7], |_| 1),
            "no variable has value reference 7; there are 7, counted from 0",
        ),
        (
            counter.set(&LEFT, |_| 1),
            "'left[1]' cannot be set in phase 'instantiated': it has causality output",
        ),
        (counter.set(&RATE, |_| f64::NAN), "'rate' = NaN is not finite"),
    ];
    for (answer, said) in wrong {
        assert_eq!(answer.unwrap_err().to_string(), said);
    }
    // But where a number may be none.
    counter.set(&HEARD, |_| f64::NAN).unwrap();
}

#[test]
fn the_model_initialises_again_only_after_a_set() {
    let (mut counter, mut log) = (Instance::<Counter>::new(), Log::silent());
    counter.enter_initialization(&mut log).unwrap();
    assert_eq!(integers(&mut counter, &INITIALISED), [1]);
    counter.set(&FROM, |_| 7).unwrap();
    counter.set(&RATE, |_| 1.0).unwrap();
    assert_eq!(integers(&mut counter, &LEFT), [7, 7]);
    counter.exit_initialization(&mut log).unwrap();
    assert_eq!(integers(&mut counter, &INITIALISED), [2]);
    assert!(counter.set(&FROM, |_| 8).is_err(), "a parameter is fixed by now");
    counter.set(&RATE, |_| 2.0).unwrap();
    assert_eq!(integers(&mut counter, &INITIALISED), [2]);
}

#[test]
fn steps_follow_one_another_until_the_model_fails() {
    let (mut counter, mut log) = (started(), Log::silent());
    for (t, h) in [(0.5, 1.0), (0.0, 0.0), (0.0, f64::INFINITY)] {
        assert!(counter.do_step(t, h, &mut log).is_err());
    }
    for t in [0.0, 1.0, 2.0] {
        counter.do_step(t, 1.0, &mut log).unwrap();
    }
    let error = counter.do_step(3.0, 1.0, &mut log).unwrap_err();
    assert!(matches!(&error, InstanceError::Model(why) if why.to_string() == "nothing left"));
    assert_eq!(counter.phase(), Phase::Failed);
    assert!(
        (counter.time() - 3.0).abs() < f64::EPSILON,
        "end of the last step that went well"
    );
    counter.reset();
    assert_eq!(
        (counter.phase(), integers(&mut counter, &FROM)),
        (Phase::Instantiated, vec![3, 3])
    );
}

#[test]
fn a_state_goes_through_bytes_under_its_own_seal_only() {
    let seal = Seal {
        magic: *b"testtest",
        tool: "a test",
        guid: Uuid::from_u128(1),
    };
    let (mut counter, mut log) = (started(), Log::silent());
    counter.do_step(0.0, 1.0, &mut log).unwrap();
    let bytes = counter.state().to_bytes(&seal).unwrap();
    let mut other = Instance::<Counter>::new();
    other.set_state(Snapshot::from_bytes(&bytes, &seal).unwrap());
    assert_eq!(integers(&mut other, &LEFT), [2, 2]);
    other.do_step(1.0, 1.0, &mut log).unwrap();

    let refused = |seal: Seal| Snapshot::<Counter>::from_bytes(&bytes, &seal).unwrap_err();
    let guid = Uuid::from_u128(2);
    assert!(matches!(
        refused(Seal { guid, ..seal }),
        InstanceError::StateOfOtherFmu { .. }
    ));
    let magic = *b"elsewise";
    assert!(matches!(
        refused(Seal { magic, ..seal }),
        InstanceError::NotAState { tool: "a test" }
    ));
    for i in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[i] ^= 0x10;
        assert!(Snapshot::<Counter>::from_bytes(&damaged, &seal).is_err(), "byte {i}");
        assert!(
            Snapshot::<Counter>::from_bytes(&bytes[..i], &seal).is_err(),
            "the first {i} bytes"
        );
    }
}

/// Wants events, and keeps what it hears.
#[derive(Debug, Default)]
struct Ear(Mutex<Vec<(Category, String)>>);

impl Listener for Ear {
    fn wants(&self, category: Category) -> bool {
        category == Category::Events
    }

    fn hear(&self, category: Category, message: &dyn Display) {
        self.0.lock().unwrap().push((category, message.to_string()));
    }
}

#[test]
fn a_listener_hears_what_it_wants() {
    let (mut counter, ear) = (started(), Ear::default());
    counter.reset();
    counter.enter_initialization(&mut Log::new(&ear)).unwrap();
    counter.exit_initialization(&mut Log::new(&ear)).unwrap();
    counter.do_step(0.0, 1.0, &mut Log::new(&ear)).unwrap();
    assert_eq!(*ear.0.lock().unwrap(), [(Category::Events, "ready".to_owned())]);
}
