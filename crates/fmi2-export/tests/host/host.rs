//! A C host in miniature: an instance of the probe, its log, and one method for each C function.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr;
use std::sync::Mutex;

use fmi2_export::abi::callbacks::variadic;
use fmi2_export::abi::{Fmi2CallbackFunctions, Fmi2Component, Fmi2FmuState, Fmi2Status, RawStatus};
use fmi2_export::{Model, guid};

use crate::probe::{Probe, fmi2};

/// A message as the logger received it, format and all.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: Fmi2Status,
    pub category: String,
    pub text: String,
}

/// Where messages go; may call back into the instance, as no host should.
#[derive(Default)]
pub struct Journal {
    pub messages: Mutex<Vec<Message>>,
    pub call_back: Mutex<Option<(usize, Vec<Fmi2Status>)>>,
}

unsafe extern "C" fn journal(
    environment: *mut c_void,
    instance: *const c_char,
    status: RawStatus,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is the journal of a host, which outlives its instance.
    let journal = unsafe { &*environment.cast::<Journal>() };
    // SAFETY: the FMU hands over NUL-terminated strings.
    let text = |pointer| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned();
    journal.messages.lock().unwrap().push(Message {
        instance: text(instance),
        status: Fmi2Status::from_raw(status).unwrap(),
        category: text(category),
        text: text(message),
    });
    let call_back = journal.call_back.lock().unwrap().take();
    if let Some((component, mut answers)) = call_back {
        let mut value = 0.0;
        let component = component as Fmi2Component;
        // SAFETY: the component is alive: one of its functions is calling.
        let status = unsafe { fmi2::fmi2GetReal(component, &11, 1, &mut value) };
        // SAFETY: freeing must be refused, for the same reason.
        unsafe { fmi2::fmi2FreeInstance(component) };
        answers.push(Fmi2Status::from_raw(status).unwrap());
        *journal.call_back.lock().unwrap() = Some((0, answers));
    }
}

/// Messages of this crate come finished, so the named arguments are all that there is to read.
pub fn callbacks(journal_of_host: &Journal) -> Fmi2CallbackFunctions {
    Fmi2CallbackFunctions {
        logger: Some(variadic(journal)),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::from_ref(journal_of_host).cast_mut().cast(),
    }
}

pub fn own_guid() -> String {
    format!("{{{}}}", guid::<Probe>().unwrap())
}

/// Value reference of a variable.
pub fn vr(name: &str) -> u32 {
    Probe::table().find(name).unwrap()
}

pub struct Host {
    pub component: Fmi2Component,
    pub journal: Box<Journal>,
}

/// Methods that only hand on the component.
macro_rules! plain {
    ($($method:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {
        $(pub fn $method(&self $(, $argument: $type)*) -> Fmi2Status {
            // SAFETY: the component is null or alive, and pointers come from live Rust values.
            status(unsafe { fmi2::$function(self.component $(, $argument)*) })
        })*
    };
}

fn status(raw: RawStatus) -> Fmi2Status {
    Fmi2Status::from_raw(raw).unwrap()
}

impl Host {
    /// An instance that says why calls end as they do, and nothing else.
    pub fn new() -> Self {
        let host = Self::with_logging(true);
        let reasons = [
            c"logStatusWarning",
            c"logStatusDiscard",
            c"logStatusError",
            c"logStatusFatal",
        ];
        assert_eq!(host.set_debug_logging(1, &reasons), Fmi2Status::Ok);
        host
    }

    pub fn with_logging(on: bool) -> Self {
        let journal = Box::<Journal>::default();
        let guid = CString::new(own_guid()).unwrap();
        let functions = callbacks(&journal);
        // SAFETY: all pointers are to live Rust values.
        let component = unsafe {
            fmi2::fmi2Instantiate(
                c"probe 1".as_ptr(),
                1,
                guid.as_ptr(),
                ptr::null(),
                &functions,
                0,
                on.into(),
            )
        };
        assert!(!component.is_null(), "{:?}", journal.messages);
        Self { component, journal }
    }

    /// An instance whose variables of type Integer are set before initialization, and which is then ready to step.
    pub fn stepping(integers: &[(&str, i32)]) -> Self {
        let host = Self::new();
        for (name, value) in integers {
            assert_eq!(host.set_integer(&[vr(name)], &[*value]), Fmi2Status::Ok);
        }
        assert_eq!(host.enter_initialization_mode(), Fmi2Status::Ok);
        assert_eq!(host.exit_initialization_mode(), Fmi2Status::Ok);
        host
    }

    plain! {
        setup_experiment = fmi2SetupExperiment(
            tolerance_defined: i32, tolerance: f64, start: f64, stop_defined: i32, stop: f64);
        enter_initialization_mode = fmi2EnterInitializationMode();
        exit_initialization_mode = fmi2ExitInitializationMode();
        terminate = fmi2Terminate();
        reset = fmi2Reset();
        do_step_raw = fmi2DoStep(t: f64, h: f64, no_state_set: i32);
        cancel_step = fmi2CancelStep();
        set_fmu_state = fmi2SetFMUstate(state: Fmi2FmuState);
        enter_event_mode = fmi2EnterEventMode();
        set_time = fmi2SetTime(t: f64);
        enter_continuous_time_mode = fmi2EnterContinuousTimeMode();
    }

    pub fn do_step(&self, t: f64, h: f64) -> Fmi2Status {
        self.do_step_raw(t, h, 1)
    }

    pub fn set_real(&self, references: &[u32], values: &[f64]) -> Fmi2Status {
        assert_eq!(references.len(), values.len());
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        status(unsafe { fmi2::fmi2SetReal(c, references.as_ptr(), n, values.as_ptr()) })
    }

    pub fn set_integer(&self, references: &[u32], values: &[i32]) -> Fmi2Status {
        assert_eq!(references.len(), values.len());
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        status(unsafe { fmi2::fmi2SetInteger(c, references.as_ptr(), n, values.as_ptr()) })
    }

    pub fn set_boolean(&self, references: &[u32], values: &[i32]) -> Fmi2Status {
        assert_eq!(references.len(), values.len());
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        status(unsafe { fmi2::fmi2SetBoolean(c, references.as_ptr(), n, values.as_ptr()) })
    }

    pub fn set_string(&self, references: &[u32], values: &[&CStr]) -> Fmi2Status {
        assert_eq!(references.len(), values.len());
        let (c, n) = (self.component, references.len());
        let values: Vec<_> = values.iter().map(|value| value.as_ptr()).collect();
        // SAFETY: both arrays have n elements.
        status(unsafe { fmi2::fmi2SetString(c, references.as_ptr(), n, values.as_ptr()) })
    }

    pub fn get_real(&self, references: &[u32]) -> Result<Vec<f64>, Fmi2Status> {
        let mut values = vec![f64::NAN; references.len()];
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        let raw = unsafe { fmi2::fmi2GetReal(c, references.as_ptr(), n, values.as_mut_ptr()) };
        ok(raw, values)
    }

    pub fn get_integer(&self, references: &[u32]) -> Result<Vec<i32>, Fmi2Status> {
        let mut values = vec![-99; references.len()];
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        let raw = unsafe { fmi2::fmi2GetInteger(c, references.as_ptr(), n, values.as_mut_ptr()) };
        ok(raw, values)
    }

    pub fn get_boolean(&self, references: &[u32]) -> Result<Vec<i32>, Fmi2Status> {
        let mut values = vec![-99; references.len()];
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        let raw = unsafe { fmi2::fmi2GetBoolean(c, references.as_ptr(), n, values.as_mut_ptr()) };
        ok(raw, values)
    }

    pub fn get_string(&self, references: &[u32]) -> Result<Vec<String>, Fmi2Status> {
        let mut values = vec![ptr::null(); references.len()];
        let (c, n) = (self.component, references.len());
        // SAFETY: both arrays have n elements.
        let raw = unsafe { fmi2::fmi2GetString(c, references.as_ptr(), n, values.as_mut_ptr()) };
        let pointers = ok(raw, values)?;
        let copy = |pointer: &*const c_char| {
            // SAFETY: the FMU has just answered with NUL-terminated strings.
            unsafe { CStr::from_ptr(*pointer) }.to_str().unwrap().to_owned()
        };
        Ok(pointers.iter().map(copy).collect())
    }

    pub fn set_debug_logging(&self, on: i32, categories: &[&CStr]) -> Fmi2Status {
        let pointers: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
        let (c, n) = (self.component, pointers.len());
        // SAFETY: the array has n strings.
        status(unsafe { fmi2::fmi2SetDebugLogging(c, on, n, pointers.as_ptr()) })
    }

    pub fn get_fmu_state(&self, state: &mut Fmi2FmuState) -> Fmi2Status {
        // SAFETY: null or a live state.
        status(unsafe { fmi2::fmi2GetFMUstate(self.component, state) })
    }

    pub fn free_fmu_state(&self, state: &mut Fmi2FmuState) -> Fmi2Status {
        // SAFETY: null or a live state.
        status(unsafe { fmi2::fmi2FreeFMUstate(self.component, state) })
    }

    pub fn serialized_size(&self, state: Fmi2FmuState) -> Result<usize, Fmi2Status> {
        let mut size = 0;
        // SAFETY: `size` has room for the answer.
        let raw = unsafe { fmi2::fmi2SerializedFMUstateSize(self.component, state, &mut size) };
        ok(raw, size)
    }

    pub fn serialize_into(&self, state: Fmi2FmuState, bytes: &mut [u8]) -> Fmi2Status {
        let (c, n) = (self.component, bytes.len());
        // SAFETY: the buffer has n bytes.
        status(unsafe { fmi2::fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr().cast(), n) })
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<Fmi2FmuState, Fmi2Status> {
        let mut state = ptr::dangling_mut(); // hosts need not initialise it
        let (c, n) = (self.component, bytes.len());
        let raw =
            // SAFETY: the buffer has n bytes.
            unsafe { fmi2::fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), n, &mut state) };
        ok(raw, state)
    }

    /// The bytes of the present state.
    pub fn bytes(&self) -> Result<Vec<u8>, Fmi2Status> {
        let mut state = ptr::null_mut();
        if self.get_fmu_state(&mut state) != Fmi2Status::Ok {
            return Err(Fmi2Status::Error);
        }
        let mut bytes = vec![0; self.serialized_size(state)?];
        assert_eq!(self.serialize_into(state, &mut bytes), Fmi2Status::Ok);
        assert_eq!(self.free_fmu_state(&mut state), Fmi2Status::Ok);
        assert!(state.is_null());
        Ok(bytes)
    }

    /// Puts the instance into the state that `bytes` hold.
    pub fn restore(&self, bytes: &[u8]) {
        let mut state = self.deserialize(bytes).unwrap();
        assert_eq!(self.set_fmu_state(state), Fmi2Status::Ok);
        assert_eq!(self.free_fmu_state(&mut state), Fmi2Status::Ok);
    }

    /// The messages since the last call of this.
    pub fn messages(&self) -> Vec<Message> {
        std::mem::take(&mut self.journal.messages.lock().unwrap())
    }

    /// The text of the one message since the last call, which must explain `status`.
    #[track_caller]
    pub fn reason(&self, status: Fmi2Status) -> String {
        let messages = self.messages();
        let [message] = messages.as_slice() else {
            panic!("one message expected, not {messages:?}");
        };
        assert_eq!(message.status, status, "{message:?}");
        message.text.clone()
    }

    /// Frees the instance and gives back the rest of the log.
    pub fn free(mut self) -> Vec<Message> {
        let component = std::mem::replace(&mut self.component, ptr::null_mut());
        // SAFETY: the component is alive and not used again.
        unsafe { fmi2::fmi2FreeInstance(component) };
        self.messages()
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: null or alive, and not used again.
        unsafe { fmi2::fmi2FreeInstance(self.component) };
    }
}

pub fn ok<T>(raw: RawStatus, value: T) -> Result<T, Fmi2Status> {
    match status(raw) {
        Fmi2Status::Ok | Fmi2Status::Warning => Ok(value),
        other => Err(other),
    }
}
