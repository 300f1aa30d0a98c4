//! The example model of the exporters' tests: every type in every place it may stand, and a switch for each way to go wrong.

use std::sync::OnceLock;

use fmi_model::{Element, Experiment, Log, Model, ModelError, ModelInfo, Table, TableBuilder, VendorAnnotation};
use serde::{Deserialize, Serialize};

pub const GOOD: i32 = 1;
pub const FAILS_TO_INITIALISE: i32 = 2;
pub const FAILS_IN_STEP: i32 = 3;
pub const PANICS_IN_STEP: i32 = 4;
pub const PANICS_IN_GET: i32 = 5;
pub const PANICS_IN_DROP: i32 = 6;
pub const WARNS: i32 = 7;
pub const SAYS_NUL: i32 = 8;
pub const PANICS_IN_CHECK: i32 = 9;

/// s.
pub const LONGEST_STEP: f64 = 1e6;

#[derive(Clone, Serialize, Deserialize)]
pub struct Probe {
    behaviour: i32,
    gain: f64,
    limit: i32,
    label: String,
    invert: bool,
    weights: [f64; 3],
    u: [f64; 3],
    k: i32,
    on: bool,
    note: String,
    kind: i32,
    y: [f64; 3],
    start: f64,
    initialisations: i32,
    steps: i32,
}

#[derive(Debug)]
struct Broken(&'static str, Option<Box<Broken>>);

impl std::fmt::Display for Broken {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

impl std::error::Error for Broken {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.1.as_deref().map(|cause| cause as _)
    }
}

impl Model for Probe {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "probe",
            model_identifier: "probe",
            description: "Integrates its input & misbehaves on demand",
            version: "1.2.3",
            license: "MIT",
            default_stop: 10.0,
            default_step: 0.5,
            vendor_annotations: vec![VendorAnnotation::new(
                "bench",
                Element::new("Preset").attribute("name", "100 % \"wild\""),
            )],
            ..ModelInfo::default()
        })
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Probe>> = OnceLock::new();
        TABLE.get_or_init(table)
    }

    fn blank() -> Self {
        Self {
            behaviour: 0,
            gain: 0.0,
            limit: 0,
            label: String::new(),
            invert: false,
            weights: [0.0; 3],
            u: [0.0; 3],
            k: 0,
            on: false,
            note: String::new(),
            kind: 0,
            y: [0.0; 3],
            start: 0.0,
            initialisations: 0,
            steps: 0,
        }
    }

    fn initialise(&mut self, experiment: &Experiment, log: &mut Log<'_>) -> Result<(), ModelError> {
        if self.behaviour == FAILS_TO_INITIALISE {
            let cause = Broken("no fuel", None);
            return Err(Broken("cannot start", Some(Box::new(cause))).into());
        }
        self.initialisations += 1;
        self.start = experiment.start_time;
        self.y = [self.gain; 3];
        log.event(format_args!("initialised 100 % at {} s", self.start));
        Ok(())
    }

    fn check_step(&self, t: f64, h: f64) -> Result<(), ModelError> {
        if h > LONGEST_STEP {
            let cause = Broken("patience has an end", None);
            return Err(Broken("too far", Some(Box::new(cause))).into());
        }
        assert!(self.behaviour != PANICS_IN_CHECK, "cannot judge {t} s");
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), ModelError> {
        match self.behaviour {
            FAILS_IN_STEP => return Err(Broken("stuck", None).into()),
            PANICS_IN_STEP => panic!("seized at {t} s"),
            WARNS => log.warning("running hot: 90 %s"),
            _ => {}
        }
        for (i, y) in self.y.iter_mut().enumerate() {
            *y += self.weights[i] * self.u[i] * h;
        }
        self.steps += 1;
        log.detail(format_args!("step {}", self.steps));
        Ok(())
    }
}

impl Drop for Probe {
    fn drop(&mut self) {
        if self.behaviour == PANICS_IN_DROP && !std::thread::panicking() {
            panic!("does not want to go");
        }
    }
}

fn table() -> Table<Probe> {
    let mut t = TableBuilder::<Probe>::new();
    t.enumeration_type(
        "Behaviour",
        "how the probe behaves",
        [
            ("good", "as it should"),
            ("fails_to_initialise", ""),
            ("fails_in_step", ""),
            ("panics_in_step", ""),
            ("panics_in_get", ""),
            ("panics_in_drop", ""),
            ("warns", ""),
            ("says_nul", ""),
            ("panics_in_check", ""),
        ],
    );
    t.enumeration_type("Kind", "", [("one", ""), ("two", "")]);
    t.enumeration("behaviour", "Behaviour")
        .parameter()
        .start(GOOD)
        .rw(|m| m.behaviour, |m, v| m.behaviour = v);
    t.real("gain")
        .parameter()
        .unit("m")
        .positive()
        .max(100.0)
        .own_default()
        .about("output at the start")
        .rw(|m| m.gain, |m, v| m.gain = v);
    t.integer("limit")
        .parameter()
        .min(0)
        .max(9)
        .start(3)
        .rw(|m| m.limit, |m, v| m.limit = v);
    t.string("label")
        .parameter()
        .start("a <b> & \"c\"")
        .rw(|m| m.label.clone(), |m, v| m.label = v);
    t.boolean("invert")
        .parameter()
        .start(true)
        .rw(|m| m.invert, |m, v| m.invert = v);
    t.real("weights")
        .parameter()
        .unit_by(|i| ["m/s", "rad/s", "m/s^2.5"][i])
        .start_by(|i| [1.0, 2.0, 0.5][i])
        .min(0.0)
        .vector_rw(3, |m, i| m.weights[i], |m, i, v| m.weights[i] = v);
    t.real("u")
        .input()
        .unit("1")
        .about_by(|i| format!("integrand {}", ["x", "y", "z"][i]))
        .vector_rw(3, |m, i| m.u[i], |m, i, v| m.u[i] = v);
    t.integer("k").input().rw(|m| m.k, |m, v| m.k = v);
    t.boolean("on").input().rw(|m| m.on, |m, v| m.on = v);
    t.string("note")
        .input()
        .start("")
        .rw(|m| m.note.clone(), |m, v| m.note = v);
    t.enumeration("kind", "Kind").input().rw(|m| m.kind, |m, v| m.kind = v);
    t.real("y").output().vector(3, |m, i| m.y[i]);
    t.real("angle")
        .output()
        .discrete()
        .unit("rad")
        .display_unit("deg")
        .get(|m| m.y[0] / 2.0);
    t.integer("steps").output().initially_from("u").get(|m| m.steps);
    t.boolean("started").output().get(|m| m.steps > 0);
    t.string("echo").output().get(|m| match m.behaviour {
        PANICS_IN_GET => panic!("lost my voice"),
        SAYS_NUL => "a\0b".to_owned(),
        _ => format!("{}{}", m.label, m.note),
    });
    t.enumeration("kind_used", "Kind").output().get(|m| m.kind);
    t.real("outer").local().matrix(2, 3, |m, i, j| m.u[i] * m.y[j]);
    t.integer("initialisations").local().get(|m| m.initialisations);
    t.build()
}
