//! Calls in any order with any arguments that a host can get wrong: null pointers, lengths, references, values, texts, times, handles
//! of others. What no library can survive, memory that is not there or a handle after its end, is not tried.

use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_void};
use std::fmt::Write as _;
use std::ptr;

use fmi2_abi::callbacks::variadic;
use fmi2_abi::{CallbackLogger, Fmi2CallbackFunctions, Fmi2Component, Fmi2FmuState, Fmi2Status, Fmi2String};
use numerics::{Generator, Source, stream};
use rand::RngExt;

use crate::library::Library;

/// Instances and states alive at once, at most.
const ALIVE: usize = 6;

struct Instance {
    maker: usize,
    component: Fmi2Component,
    /// Where its next step should begin, if all has gone well.
    time: f64,
}

pub struct Attack {
    libraries: [&'static Library; 2],
    random: Generator,
    instances: Vec<Instance>,
    /// Each with the library that made it.
    states: Vec<(usize, Fmi2FmuState)>,
    callbacks: [Box<Fmi2CallbackFunctions>; 2],
    /// Answers by function.
    answers: BTreeMap<(&'static str, Fmi2Status), u64>,
}

unsafe extern "C" fn hear(_: *mut c_void, _: *const c_char, _: i32, _: *const c_char, message: *const c_char) {
    assert!(!message.is_null());
}

fn callbacks(logger: Option<CallbackLogger>) -> Box<Fmi2CallbackFunctions> {
    Box::new(Fmi2CallbackFunctions {
        logger,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::null_mut(),
    })
}

/// An argument that is an array of the host's: its pointer, or null, and the length that is claimed for it.
fn lengths<T>(random: &mut Generator, array: &[T]) -> (*const T, usize) {
    match random.random_range(0..12) {
        0 => (ptr::null(), array.len()),
        1 => (ptr::null(), usize::MAX),
        2 => (array.as_ptr(), 0),
        _ => (array.as_ptr(), array.len()),
    }
}

impl Attack {
    pub fn new(libraries: [&'static Library; 2], seed: u64) -> Self {
        Self {
            libraries,
            random: stream(seed, 0, Source::VentTiming),
            instances: Vec::new(),
            states: Vec::new(),
            callbacks: [callbacks(Some(variadic(hear))), callbacks(None)],
            answers: BTreeMap::new(),
        }
    }

    /// One in `n`.
    fn chance(&mut self, n: u32) -> bool {
        self.random.random_range(0..n) == 0
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.random.random_range(0..of.len())]
    }

    fn real(&mut self) -> f64 {
        let magnitude = self.random.random_range(-3.0..3.0);
        let any = f64::from_bits(self.random.random());
        let small: f64 = self.random.random_range(-1.0..1.0);
        self.pick(&[
            0.0,
            1.0,
            -1.0,
            small,
            10_f64.powf(magnitude),
            f64::NAN,
            f64::INFINITY,
            f64::MIN_POSITIVE,
            -0.0,
            f64::MAX,
            any,
        ])
    }

    fn integer(&mut self) -> i32 {
        let any = self.random.random();
        self.pick(&[0, 1, 2, 3, -1, 7, i32::MAX, i32::MIN, any])
    }

    /// Value references: mostly of the type, some of any, some of none.
    fn references(&mut self, of_type: &[u32]) -> Vec<u32> {
        let length = self.random.random_range(0..6);
        let one = |attack: &mut Self| match attack.random.random_range(0..12) {
            0 => attack.random.random(),
            1 => attack.random.random_range(0..1000),
            _ if of_type.is_empty() => 0,
            _ => attack.pick(of_type),
        };
        (0..length).map(|_| one(self)).collect()
    }

    fn text(&mut self) -> CString {
        let texts = [
            "",
            "logEvents",
            "logAll",
            "logStatusError",
            "logWeather",
            "leo_venting",
            "%s%n",
            "a#r1#",
        ];
        let long = "x".repeat(self.random.random_range(0..5000));
        match self.random.random_range(0..12) {
            0 => CString::new(long).unwrap(),
            1 => CString::new(b"\xff\xfe\x80".as_slice()).unwrap(),
            _ => CString::new(self.pick(&texts)).unwrap(),
        }
    }

    fn texts(&mut self, length: usize) -> (Vec<CString>, Vec<Fmi2String>) {
        let owned: Vec<CString> = (0..length).map(|_| self.text()).collect();
        let null = |attack: &mut Self, text: &CString| if attack.chance(10) { ptr::null() } else { text.as_ptr() };
        let pointers = owned.iter().map(|text| null(self, text)).collect();
        (owned, pointers)
    }

    /// An instance and a library to call with it, which is now and then the wrong one, and what is no instance at all.
    fn target(&mut self) -> (&'static Library, Fmi2Component, Option<usize>) {
        let library = self.random.random_range(0..2_usize);
        if self.instances.is_empty() || self.chance(50) {
            let state = self.states.first().map_or(ptr::null_mut(), |(_, state)| *state);
            let stranger = self.pick(&[ptr::null_mut(), state, ptr::without_provenance_mut(1)]);
            return (self.libraries[library], stranger, None);
        }
        let place = self.random.random_range(0..self.instances.len());
        let instance = &self.instances[place];
        let (own, component) = (instance.maker, instance.component);
        if self.chance(50) {
            (self.libraries[1 - own], component, None)
        } else {
            (self.libraries[own], component, Some(place))
        }
    }

    fn state(&mut self) -> Fmi2FmuState {
        let component = self.instances.first().map_or(ptr::null_mut(), |i| i.component);
        match self.states.len() {
            0 => ptr::null_mut(),
            _ if self.chance(10) => self.pick(&[ptr::null_mut(), component, ptr::without_provenance_mut(3)]),
            n => self.states[self.random.random_range(0..n)].1,
        }
    }

    fn note(&mut self, function: &'static str, raw: i32) -> bool {
        let status = Fmi2Status::from_raw(raw).unwrap_or_else(|| panic!("{function} answers {raw}"));
        // A panic inside is fatal, and nothing is ever pending.
        let fits = matches!(status, Fmi2Status::Ok | Fmi2Status::Warning | Fmi2Status::Error)
            || (status == Fmi2Status::Discard && (function.ends_with("Status") || function == "fmi2DoStep"));
        assert!(fits, "{function} answers {status}; so far {}", self.summary());
        *self.answers.entry((function, status)).or_default() += 1;
        matches!(status, Fmi2Status::Ok | Fmi2Status::Warning)
    }

    pub fn summary(&self) -> String {
        let mut by_status: BTreeMap<Fmi2Status, u64> = BTreeMap::new();
        let mut refused: BTreeMap<&str, [u64; 2]> = BTreeMap::new();
        for ((function, status), count) in &self.answers {
            *by_status.entry(*status).or_default() += count;
            refused.entry(function).or_default()[usize::from(*status > Fmi2Status::Warning)] += count;
        }
        let mut text = format!("{by_status:?}");
        for (function, [done, refused]) in refused {
            let _ = write!(text, ", {function} {done} done {refused} refused");
        }
        text
    }

    pub fn calls(&mut self, count: u64) {
        for _ in 0..count {
            self.call();
        }
    }

    /// Frees what is left.
    pub fn end(mut self) {
        while !self.instances.is_empty() {
            self.free_instance(0);
        }
    }

    fn free_instance(&mut self, place: usize) {
        let instance = self.instances.swap_remove(place);
        let library = self.libraries[instance.maker];
        // States outlive their instance, but only an instance can free them: what would be left is freed with the last.
        if !self.instances.iter().any(|i| i.maker == instance.maker) {
            let states = std::mem::take(&mut self.states);
            let (own, others): (Vec<_>, Vec<_>) = states.into_iter().partition(|(owner, _)| *owner == instance.maker);
            self.states = others;
            for (_, mut state) in own {
                // SAFETY: instance and state are alive, and the state is not used again.
                let raw = unsafe { (library.c.free_state)(instance.component, &raw mut state) };
                assert!(self.note("fmi2FreeFMUstate", raw) && state.is_null());
            }
        }
        // SAFETY: the instance is alive and not used again.
        unsafe { (library.c.free_instance)(instance.component) };
    }

    fn instantiate(&mut self) {
        if self.instances.len() == ALIVE {
            let place = self.random.random_range(0..ALIVE);
            self.free_instance(place);
        }
        let own = self.random.random_range(0..2_usize);
        let library = self.libraries[own];
        let (name, location, other) = (self.text(), self.text(), self.text());
        let whole = CString::new(library.resources.as_str()).unwrap();
        let name = self.pick(&[c"i1".as_ptr(), c"i2".as_ptr(), name.as_ptr(), ptr::null()]);
        let guid = self.pick(&[
            library.guid.as_ptr(),
            library.guid.as_ptr(),
            library.guid.as_ptr(),
            other.as_ptr(),
            ptr::null(),
        ]);
        let location = self.pick(&[whole.as_ptr(), whole.as_ptr(), location.as_ptr(), ptr::null()]);
        let kind = self.pick(&[1, 1, 1, 1, 0, 2, -1]);
        let functions = match self.random.random_range(0..4) {
            0 => ptr::null(),
            1 => ptr::without_provenance(1),
            2 => ptr::from_ref(&*self.callbacks[0]),
            _ => ptr::from_ref(&*self.callbacks[1]),
        };
        let logging = self.random.random_range(-1..2);
        // SAFETY: texts are null or NUL-terminated, callbacks null, misaligned or alive as long as any instance.
        let component = unsafe { (library.c.instantiate)(name, kind, guid, location, functions, 0, logging) };
        let status = if component.is_null() {
            Fmi2Status::Error
        } else {
            Fmi2Status::Ok
        };
        self.note("fmi2Instantiate", status.raw());
        if !component.is_null() {
            self.instances.push(Instance {
                maker: own,
                component,
                time: 0.0,
            });
        }
    }

    fn call(&mut self) {
        let (library, c, place) = self.target();
        // SAFETY (of every call below): the component is null, misaligned, an instance or a state that is alive; arrays are as long
        // as said, null, or said to hold nothing.
        match self.random.random_range(0..40) {
            0..2 => self.instantiate(),
            2 => {
                if let Some(place) = place.filter(|_| self.chance(2)) {
                    self.free_instance(place);
                } else if place.is_none() {
                    // SAFETY: no instance of this library: refused without a word.
                    unsafe { (library.c.free_instance)(c) };
                }
            }
            3 => {
                let (_owned, names) = self.texts(2);
                let (names, n) = lengths(&mut self.random, &names);
                let on = self.random.random_range(-1..2);
                // SAFETY: see above.
                let raw = unsafe { (library.c.set_debug_logging)(c, on, n, names) };
                self.note("fmi2SetDebugLogging", raw);
            }
            4 => {
                let (start, stop, tolerance) = (self.real(), self.real(), self.real());
                let start = if self.chance(2) { 0.0 } else { start };
                // SAFETY: plain numbers.
                let raw = unsafe { (library.c.setup_experiment)(c, self.integer() & 1, tolerance, start, 0, stop) };
                if self.note("fmi2SetupExperiment", raw) {
                    self.at(place, start);
                }
            }
            5..7 => {
                // SAFETY: see above.
                let raw = unsafe { (library.c.enter_initialization_mode)(c) };
                self.note("fmi2EnterInitializationMode", raw);
            }
            7..10 => {
                // SAFETY: see above.
                let raw = unsafe { (library.c.exit_initialization_mode)(c) };
                self.note("fmi2ExitInitializationMode", raw);
            }
            10 => {
                if self.chance(4) {
                    // SAFETY: see above.
                    let raw = unsafe { (library.c.terminate)(c) };
                    self.note("fmi2Terminate", raw);
                }
                // SAFETY: see above.
                let raw = unsafe { (library.c.reset)(c) };
                if self.note("fmi2Reset", raw) {
                    self.at(place, 0.0);
                }
            }
            11..17 => self.step(library, c, place),
            17..29 => self.exchange(library, c),
            29..36 => self.save(library, c, place),
            36 => self.ask(library, c),
            _ => self.unsupported(library, c),
        }
    }

    fn at(&mut self, place: Option<usize>, time: f64) {
        if let Some(place) = place {
            self.instances[place].time = time;
        }
    }

    fn step(&mut self, library: &Library, c: Fmi2Component, place: Option<usize>) {
        let any = self.real();
        // What a model takes is taken: steps that it would compute at for hours are not asked for.
        let long = if (20.0..1e8).contains(&any) { 20.0 } else { any };
        let h = self.pick(&[1.0, 1.0, 0.5, 0.25, 3.0, 0.1, long]);
        let expected = place.map_or(0.0, |place| self.instances[place].time);
        let t = if self.chance(10) { self.real() } else { expected };
        // SAFETY: plain numbers.
        let raw = unsafe { (library.c.do_step)(c, t, h, self.integer()) };
        if self.note("fmi2DoStep", raw) {
            assert!(h > 0.0 && (t + h).is_finite(), "took t = {t} s, h = {h} s");
            self.at(place, t + h);
        }
    }

    /// Gets and sets.
    fn exchange(&mut self, library: &Library, c: Fmi2Component) {
        let which = self.random.random_range(0..8);
        let of_type = [&library.reals, &library.integers, &library.booleans, &library.strings][which / 2];
        let references = self.references(of_type);
        let (vr, n) = lengths(&mut self.random, &references);
        // As long as the references are said to be, or null.
        let length = if n == usize::MAX { 0 } else { n };
        let absent = n == usize::MAX || self.chance(15);
        let array = |pointer: *mut c_void| if absent { ptr::null_mut() } else { pointer };
        let (function, raw) = match which {
            0 => {
                let mut values = vec![0.0; length];
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.get_real)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2GetReal", raw)
            }
            1 => {
                let mut values: Vec<f64> = (0..length).map(|_| self.real()).collect();
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.set_real)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2SetReal", raw)
            }
            2 => {
                let mut values = vec![0; length];
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.get_integer)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2GetInteger", raw)
            }
            3 => {
                let mut values: Vec<i32> = (0..length).map(|_| self.integer()).collect();
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.set_integer)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2SetInteger", raw)
            }
            4 => {
                let mut values = vec![0; length];
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.get_boolean)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2GetBoolean", raw)
            }
            5 => {
                let mut values: Vec<i32> = (0..length).map(|_| self.integer()).collect();
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.set_boolean)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2SetBoolean", raw)
            }
            6 => {
                let mut values: Vec<Fmi2String> = vec![ptr::null(); length];
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.get_string)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2GetString", raw)
            }
            _ => {
                let (_owned, mut values) = self.texts(length);
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.set_string)(c, vr, n, array(values.as_mut_ptr().cast()).cast()) };
                ("fmi2SetString", raw)
            }
        };
        self.note(function, raw);
    }

    /// Saved states.
    fn save(&mut self, library: &'static Library, c: Fmi2Component, place: Option<usize>) {
        let own = usize::from(!ptr::eq(library, self.libraries[0]));
        let mut state = self.state();
        match self.random.random_range(0..5) {
            0 => {
                if self.chance(10) {
                    // SAFETY: see `call`.
                    let raw = unsafe { (library.c.get_state)(c, ptr::null_mut()) };
                    assert!(!self.note("fmi2GetFMUstate", raw));
                }
                let fresh = self.states.len() < ALIVE && self.chance(2);
                let mut handle = if fresh { ptr::null_mut() } else { state };
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.get_state)(c, &raw mut handle) };
                if self.note("fmi2GetFMUstate", raw) && !self.states.iter().any(|(_, known)| *known == handle) {
                    self.states.push((own, handle));
                }
            }
            1 => {
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.set_state)(c, state) };
                if self.note("fmi2SetFMUstate", raw)
                    && let Some(place) = place
                {
                    // Where it goes on from is asked for, if there is an answer in its phase.
                    let mut time = 0.0;
                    // SAFETY: the room is a double.
                    let raw = unsafe { (library.c.get_real_status)(c, 2, &raw mut time) };
                    self.note("fmi2GetRealStatus", raw);
                    self.instances[place].time = time;
                }
            }
            2 => {
                let before = state;
                let pointer = if self.chance(10) {
                    ptr::null_mut()
                } else {
                    &raw mut state
                };
                // SAFETY: see `call`.
                let raw = unsafe { (library.c.free_state)(c, pointer) };
                if self.note("fmi2FreeFMUstate", raw) {
                    assert!(state.is_null());
                    self.states.retain(|(_, known)| *known != before);
                }
            }
            _ => self.serialize(library, own, c, state),
        }
    }

    /// States as bytes, whole and damaged.
    fn serialize(&mut self, library: &Library, own: usize, c: Fmi2Component, state: Fmi2FmuState) {
        let mut size = 0;
        // SAFETY: see `call`.
        let raw = unsafe { (library.c.state_size)(c, state, &raw mut size) };
        if !self.note("fmi2SerializedFMUstateSize", raw) {
            return;
        }
        let short = self.chance(5);
        let mut bytes = vec![0_u8; if short { size / 2 } else { size }];
        // SAFETY: see `call`.
        let raw = unsafe { (library.c.serialize_state)(c, state, bytes.as_mut_ptr().cast(), bytes.len()) };
        let done = self.note("fmi2SerializeFMUstate", raw);
        assert_eq!(done, !short);
        let damage = self.random.random_range(0..4);
        let at = self.random.random_range(0..bytes.len());
        match damage {
            0 => bytes[at] ^= 1 << self.random.random_range(0..8),
            1 => bytes.truncate(at),
            _ => {}
        }
        let (bytes, n) = lengths(&mut self.random, &bytes);
        let mut back = ptr::null_mut();
        // SAFETY: see `call`.
        let raw = unsafe { (library.c.deserialize_state)(c, bytes.cast(), n, &raw mut back) };
        if self.note("fmi2DeSerializeFMUstate", raw) {
            assert!(!short && damage > 1, "took damaged bytes");
            if self.states.len() < ALIVE {
                self.states.push((own, back));
            } else {
                // SAFETY: the state is alive and not used again.
                let raw = unsafe { (library.c.free_state)(c, &raw mut back) };
                assert!(self.note("fmi2FreeFMUstate", raw));
            }
        }
    }

    /// What may be asked about steps.
    fn ask(&mut self, library: &Library, c: Fmi2Component) {
        let kind = self.random.random_range(-1..5);
        let absent = self.chance(10);
        let (mut status, mut real, mut integer, mut text) = (0, 0.0, 0, ptr::null());
        let real: *mut f64 = if absent { ptr::null_mut() } else { &raw mut real };
        // SAFETY: see `call`; each answer has room, or a null pointer.
        let raws = unsafe {
            [
                ("fmi2GetStatus", (library.c.get_status)(c, kind, &raw mut status)),
                ("fmi2GetRealStatus", (library.c.get_real_status)(c, kind, real)),
                (
                    "fmi2GetIntegerStatus",
                    (library.c.get_integer_status)(c, kind, &raw mut integer),
                ),
                (
                    "fmi2GetBooleanStatus",
                    (library.c.get_boolean_status)(c, kind, &raw mut integer),
                ),
                (
                    "fmi2GetStringStatus",
                    (library.c.get_string_status)(c, kind, &raw mut text),
                ),
            ]
        };
        let (function, raw) = self.pick(&raws);
        self.note(function, raw);
    }

    /// What these FMUs do not offer is refused, whatever the arguments.
    fn unsupported(&mut self, library: &Library, c: Fmi2Component) {
        let references = self.references(&library.reals);
        let (vr, n) = lengths(&mut self.random, &references);
        let null = ptr::null_mut();
        // SAFETY: see `call`.
        let raws = unsafe {
            [
                ("fmi2CancelStep", (library.c.cancel_step)(c)),
                (
                    "fmi2SetRealInputDerivatives",
                    (library.c.input_derivatives)(c, vr, n, ptr::null(), ptr::null()),
                ),
                (
                    "fmi2GetRealOutputDerivatives",
                    (library.c.output_derivatives)(c, vr, n, ptr::null(), null),
                ),
                (
                    "fmi2GetDirectionalDerivative",
                    (library.c.directional_derivative)(c, vr, n, vr, n, ptr::null(), null),
                ),
                ("fmi2SetTime", (library.c.set_time)(c, f64::NAN)),
                ("fmi2GetDerivatives", (library.c.get_derivatives)(c, null, usize::MAX)),
            ]
        };
        let (function, raw) = self.pick(&raws);
        assert!(!self.note(function, raw), "{function}");
    }
}
