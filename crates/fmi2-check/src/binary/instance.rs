//! One instance: every call is in the journal before it is made, and leaves the surroundings as they were, or is found.

use std::cell::{Cell, RefCell};
use std::ffi::{CString, c_char};
use std::fs;
use std::path::Path;
use std::ptr;

use fmi2_abi::{Fmi2CallbackFunctions, Fmi2Component, Fmi2FmuState, Fmi2Status, Fmi2Type, RawStatus, boolean};

use super::job::{Job, Value, Variable};
use super::journal::Journal;
use super::library::{Functions, Library};
use super::logger::{Offered, Sink, text};
use super::surroundings::Surroundings;
use crate::role::Kind;
use crate::rules::binary as rules;

/// What all instances of a trial share.
#[derive(Debug)]
pub(super) struct Bench<'a> {
    pub(super) job: &'a Job,
    pub(super) loaded: &'a Library,
    pub(super) journal: &'a Journal,
    /// What has to stay, while it does.
    pub(super) surroundings: RefCell<Surroundings>,
    /// File that takes what is printed.
    pub(super) output: &'a Path,
    /// Whether that something is printed is told.
    pub(super) printed: Cell<bool>,
    /// What an instance that was not made has logged, as the tail of a sentence.
    pub(super) last_words: RefCell<String>,
}

impl Bench<'_> {
    /// Finds what a call has changed around it; each change once.
    pub(super) fn look_round(&self, function: &'static str) {
        let now = Surroundings::now();
        let before = self.surroundings.replace(now.clone());
        for (rule, what) in before.changes(&now) {
            self.journal.found(rule, function, format!("after {function} {what}"));
        }
        if !self.printed.get() {
            flush();
            let text = fs::read(self.output).unwrap_or_default();
            if let Some(line) = String::from_utf8_lossy(&text).lines().next() {
                self.printed.set(true);
                self.journal
                    .found(&rules::STDOUT, function, format!("it printed: {}", line.trim()));
            }
        }
    }
}

/// What the C library has not written yet.
fn flush() {
    #[cfg(unix)]
    // SAFETY: NULL means all streams, which takes only what was printed before.
    unsafe {
        libc::fflush(ptr::null_mut());
    }
}

/// How a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// OK or Warning.
    Well,
    /// Discard, Error or Fatal.
    Refused(Fmi2Status),
    /// Pending: the rest comes when it comes.
    Later,
    /// The library has no such function, or the status is none.
    Unclear,
}

/// What an instance is made with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner<'a> {
    pub(super) guid: &'a str,
    pub(super) logging: bool,
    pub(super) offered: Offered,
}

#[derive(Debug)]
pub(super) struct Instance<'a> {
    bench: &'a Bench<'a>,
    component: Fmi2Component,
    pub(super) sink: Box<Sink>,
    // The FMU may keep pointers to both for as long as it lives.
    _callbacks: Box<Fmi2CallbackFunctions>,
    _name: CString,
    /// After Fatal nothing may be called, not even the function that frees.
    fatal: Cell<bool>,
}

impl<'a> Instance<'a> {
    /// As masters make them.
    pub(super) fn usual(bench: &'a Bench<'a>) -> Option<Self> {
        Self::new(bench, "checked", bench.manner())
    }

    /// * returns: nothing where fmi2Instantiate answers NULL.
    pub(super) fn new(bench: &'a Bench<'a>, name: &str, manner: Manner<'_>) -> Option<Self> {
        let sink = Box::new(Sink::default());
        let callbacks = Box::new(sink.callbacks(manner.offered));
        let (name, guid) = (CString::new(name).ok()?, CString::new(manner.guid).ok()?);
        let instantiate = bench.loaded.functions.instantiate?;
        bench.journal.calling("fmi2Instantiate");
        // SAFETY: strings end in NUL, and name and callbacks outlive the instance, which owns them.
        let component = unsafe {
            instantiate(
                name.as_ptr(),
                Fmi2Type::CoSimulation.raw(),
                guid.as_ptr(),
                bench.loaded.resources.as_ptr(),
                &raw const *callbacks,
                boolean(false),
                boolean(manner.logging),
            )
        };
        bench.look_round("fmi2Instantiate");
        bench.last_words.replace(sink.said());
        (!component.is_null()).then_some(Self {
            bench,
            component,
            sink,
            _callbacks: callbacks,
            _name: name,
            fatal: Cell::new(false),
        })
    }

    /// Makes a call of the function that is chosen, where there is one.
    fn call<F>(
        &self,
        name: &'static str,
        choose: impl FnOnce(&Functions) -> Option<F>,
        make: impl FnOnce(F, Fmi2Component) -> RawStatus,
    ) -> Ended {
        let Some(function) = choose(&self.bench.loaded.functions).filter(|_| !self.fatal.get()) else {
            return Ended::Unclear;
        };
        self.bench.journal.calling(name);
        let raw = make(function, self.component);
        self.bench.look_round(name);
        match Fmi2Status::from_raw(raw) {
            Some(Fmi2Status::Ok | Fmi2Status::Warning) => Ended::Well,
            Some(Fmi2Status::Pending) => Ended::Later,
            Some(status) => {
                self.fatal.set(status == Fmi2Status::Fatal);
                Ended::Refused(status)
            }
            None => {
                self.bench
                    .journal
                    .found(&rules::STATUS, name, format!("{name} returned {raw}"));
                Ended::Unclear
            }
        }
    }

    pub(super) fn setup(&self) -> Ended {
        let job = self.bench.job;
        self.call(
            "fmi2SetupExperiment",
            |f| f.setup_experiment,
            |f, c| {
                // SAFETY: the instance lives; the rest are numbers.
                unsafe {
                    f(
                        c,
                        boolean(job.tolerance.is_some()),
                        job.tolerance.unwrap_or(0.0),
                        job.start,
                        boolean(job.stop.is_some()),
                        job.stop.unwrap_or(0.0),
                    )
                }
            },
        )
    }

    pub(super) fn enter_initialization(&self) -> Ended {
        // SAFETY: the instance lives.
        self.call(
            "fmi2EnterInitializationMode",
            |f| f.enter_initialization_mode,
            |f, c| unsafe { f(c) },
        )
    }

    pub(super) fn exit_initialization(&self) -> Ended {
        // SAFETY: the instance lives.
        self.call(
            "fmi2ExitInitializationMode",
            |f| f.exit_initialization_mode,
            |f, c| unsafe { f(c) },
        )
    }

    pub(super) fn terminate(&self) -> Ended {
        // SAFETY: the instance lives.
        self.call("fmi2Terminate", |f| f.terminate, |f, c| unsafe { f(c) })
    }

    pub(super) fn reset(&self) -> Ended {
        // SAFETY: the instance lives.
        self.call("fmi2Reset", |f| f.reset, |f, c| unsafe { f(c) })
    }

    pub(super) fn do_step(&self, time: f64, step: f64) -> Ended {
        // SAFETY: the instance lives; the rest are numbers.
        self.call(
            "fmi2DoStep",
            |f| f.do_step,
            |f, c| unsafe { f(c, time, step, boolean(false)) },
        )
    }

    pub(super) fn set_debug_logging(&self, categories: &[String]) -> Ended {
        let names: Vec<CString> = categories
            .iter()
            .filter_map(|c| CString::new(c.as_str()).ok())
            .collect();
        let pointers: Vec<*const c_char> = names.iter().map(|name| name.as_ptr()).collect();
        self.call(
            "fmi2SetDebugLogging",
            |f| f.set_debug_logging,
            |f, c| {
                // SAFETY: the strings and their list live until the call is over.
                unsafe { f(c, boolean(true), pointers.len(), pointers.as_ptr()) }
            },
        )
    }

    /// Reads variables; a call that is refused leaves its variables out.
    pub(super) fn read(&self, variables: &[&Variable]) -> Result<Vec<Value>, Refusal> {
        let mut values = vec![Value::Nothing; variables.len()];
        for kind in [Kind::Real, Kind::Integer, Kind::Boolean, Kind::String] {
            let function_of = |k| if k == Kind::Enumeration { Kind::Integer } else { k };
            let places: Vec<usize> = (0..variables.len())
                .filter(|place| function_of(variables[*place].kind) == kind)
                .collect();
            let references: Vec<u32> = places.iter().map(|place| variables[*place].reference).collect();
            if references.is_empty() {
                continue;
            }
            let (ended, read) = self.get(kind, &references);
            if ended != Ended::Well {
                let variable = variables[places[0]].name.clone();
                return Err(Refusal {
                    function: get_name(kind),
                    ended,
                    variable,
                });
            }
            for (place, value) in places.into_iter().zip(read) {
                values[place] = value;
            }
        }
        Ok(values)
    }

    /// Reads references of one kind.
    pub(super) fn get(&self, kind: Kind, references: &[u32]) -> (Ended, Vec<Value>) {
        let (count, first) = (references.len(), references.as_ptr());
        // SAFETY, for all four: the instance lives, and both arrays have as many elements as are told.
        match kind {
            Kind::Real => {
                let mut values = vec![0.0; count];
                let into = values.as_mut_ptr();
                // SAFETY: as above.
                let ended = self.call(
                    "fmi2GetReal",
                    |f| f.get_real,
                    |f, c| unsafe { f(c, first, count, into) },
                );
                (ended, values.into_iter().map(Value::real).collect())
            }
            Kind::Integer | Kind::Enumeration => {
                let mut values = vec![0; count];
                let into = values.as_mut_ptr();
                // SAFETY: as above.
                let ended = self.call(
                    "fmi2GetInteger",
                    |f| f.get_integer,
                    |f, c| unsafe { f(c, first, count, into) },
                );
                (ended, values.into_iter().map(Value::Integer).collect())
            }
            Kind::Boolean => {
                let mut values = vec![0; count];
                let into = values.as_mut_ptr();
                // SAFETY: as above.
                let ended = self.call(
                    "fmi2GetBoolean",
                    |f| f.get_boolean,
                    |f, c| unsafe { f(c, first, count, into) },
                );
                (ended, values.into_iter().map(Value::Boolean).collect())
            }
            Kind::String => {
                let mut values = vec![ptr::null(); count];
                let into = values.as_mut_ptr();
                // SAFETY: as above.
                let ended = self.call(
                    "fmi2GetString",
                    |f| f.get_string,
                    |f, c| unsafe { f(c, first, count, into) },
                );
                let copied = values.into_iter().map(|pointer| match (ended, pointer.is_null()) {
                    // SAFETY: strings hold until the next call, and end in NUL.
                    (Ended::Well, false) => Value::Text(unsafe { text(pointer) }),
                    _ => Value::Nothing,
                });
                (ended, copied.collect())
            }
        }
    }

    /// Sets a variable.
    pub(super) fn set(&self, variable: &Variable, value: &Value) -> Ended {
        self.set_reference(variable.reference, value)
    }

    pub(super) fn set_reference(&self, reference: u32, value: &Value) -> Ended {
        let reference = &raw const reference;
        match value {
            Value::Real(bits) => {
                let number = f64::from_bits(*bits);
                // SAFETY: the instance lives, and one reference and one value are told.
                self.call(
                    "fmi2SetReal",
                    |f| f.set_real,
                    |f, c| unsafe { f(c, reference, 1, &raw const number) },
                )
            }
            Value::Integer(number) => {
                // SAFETY: as above.
                self.call(
                    "fmi2SetInteger",
                    |f| f.set_integer,
                    |f, c| unsafe { f(c, reference, 1, &raw const *number) },
                )
            }
            Value::Boolean(number) => {
                // SAFETY: as above.
                self.call(
                    "fmi2SetBoolean",
                    |f| f.set_boolean,
                    |f, c| unsafe { f(c, reference, 1, &raw const *number) },
                )
            }
            Value::Text(text) => {
                let Ok(text) = CString::new(text.as_str()) else {
                    return Ended::Unclear;
                };
                let pointer = text.as_ptr();
                // SAFETY: as above; the text lives until the call is over.
                self.call(
                    "fmi2SetString",
                    |f| f.set_string,
                    |f, c| unsafe { f(c, reference, 1, &raw const pointer) },
                )
            }
            Value::Nothing => Ended::Unclear,
        }
    }

    /// Saves the state, into the handle where it is not NULL.
    pub(super) fn get_state(&self, state: &mut Fmi2FmuState) -> Ended {
        // SAFETY: the instance lives, and the handle is NULL or one of its own.
        self.call(
            "fmi2GetFMUstate",
            |f| f.get_state,
            |f, c| unsafe { f(c, &raw mut *state) },
        )
    }

    pub(super) fn set_state(&self, state: Fmi2FmuState) -> Ended {
        // SAFETY: the instance lives, and the handle is one of its own.
        self.call("fmi2SetFMUstate", |f| f.set_state, |f, c| unsafe { f(c, state) })
    }

    pub(super) fn free_state(&self, state: &mut Fmi2FmuState) -> Ended {
        // SAFETY: the instance lives, and the handle is NULL or one of its own.
        self.call(
            "fmi2FreeFMUstate",
            |f| f.free_state,
            |f, c| unsafe { f(c, &raw mut *state) },
        )
    }

    pub(super) fn serialize(&self, state: Fmi2FmuState) -> (Ended, Vec<u8>) {
        let mut size = 0;
        // SAFETY: the instance lives, and the handle is one of its own.
        let sized = self.call(
            "fmi2SerializedFMUstateSize",
            |f| f.state_size,
            |f, c| unsafe { f(c, state, &raw mut size) },
        );
        if sized != Ended::Well {
            return (sized, Vec::new());
        }
        let mut bytes = vec![0_u8; size];
        let into = bytes.as_mut_ptr().cast::<c_char>();
        // SAFETY: as above, and the buffer has as many bytes as are told.
        let ended = self.call(
            "fmi2SerializeFMUstate",
            |f| f.serialize,
            |f, c| unsafe { f(c, state, into, size) },
        );
        (ended, bytes)
    }

    pub(super) fn deserialize(&self, bytes: &[u8], state: &mut Fmi2FmuState) -> Ended {
        let from = bytes.as_ptr().cast::<c_char>();
        // SAFETY: the instance lives, the buffer has as many bytes as are told, and the handle is NULL.
        self.call(
            "fmi2DeSerializeFMUstate",
            |f| f.deserialize,
            |f, c| unsafe { f(c, from, bytes.len(), &raw mut *state) },
        )
    }
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        if let Some(free) = self.bench.loaded.functions.free_instance.filter(|_| !self.fatal.get()) {
            self.bench.journal.calling("fmi2FreeInstance");
            // SAFETY: the instance lives, and is not used again.
            unsafe { free(self.component) };
            self.bench.look_round("fmi2FreeInstance");
        }
    }
}

/// A call of a reading function that did not end well.
#[derive(Debug)]
pub(super) struct Refusal {
    pub(super) function: &'static str,
    pub(super) ended: Ended,
    /// The first of the variables.
    pub(super) variable: String,
}

fn get_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real => "fmi2GetReal",
        Kind::Integer | Kind::Enumeration => "fmi2GetInteger",
        Kind::Boolean => "fmi2GetBoolean",
        Kind::String => "fmi2GetString",
    }
}

impl Bench<'_> {
    /// How masters make instances: all callbacks that are not optional, nothing logged.
    pub(super) fn manner(&self) -> Manner<'_> {
        Manner {
            guid: &self.job.guid,
            logging: false,
            offered: Offered {
                logger: true,
                memory: true,
            },
        }
    }
}
