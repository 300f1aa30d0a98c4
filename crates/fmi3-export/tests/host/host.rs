//! A C host in miniature: an instance of the probe, its log, and one method for each C function.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr;
use std::sync::Mutex;

use fmi3_export::abi::{Fmi3FmuState, Fmi3Instance, Fmi3Status, RawStatus};
use fmi3_export::{Model, instantiation_token, value_reference};

use crate::probe::{Probe, fmi3};

/// A message as the logger received it.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    pub status: Fmi3Status,
    pub category: String,
    pub text: String,
}

/// Where messages go; may call back into the instance, as no host should.
#[derive(Default)]
pub struct Journal {
    pub messages: Mutex<Vec<Message>>,
    pub call_back: Mutex<Option<(usize, Vec<Fmi3Status>)>>,
}

pub unsafe extern "C" fn journal(
    environment: *mut c_void,
    status: RawStatus,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is the journal of a host, which outlives its instance.
    let journal = unsafe { &*environment.cast::<Journal>() };
    // SAFETY: the FMU hands over NUL-terminated strings.
    let text = |pointer| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned();
    journal.messages.lock().unwrap().push(Message {
        status: Fmi3Status::from_raw(status).unwrap(),
        category: text(category),
        text: text(message),
    });
    let call_back = journal.call_back.lock().unwrap().take();
    if let Some((instance, mut answers)) = call_back {
        let instance = instance as Fmi3Instance;
        // SAFETY: the instance is alive: one of its functions is calling.
        let status = unsafe { fmi3::fmi3Reset(instance) };
        // SAFETY: freeing must be refused, for the same reason.
        unsafe { fmi3::fmi3FreeInstance(instance) };
        answers.push(Fmi3Status::from_raw(status).unwrap());
        *journal.call_back.lock().unwrap() = Some((0, answers));
    }
}

pub fn own_token() -> String {
    format!("{{{}}}", instantiation_token::<Probe>().unwrap())
}

/// Value reference of a variable.
pub fn vr(name: &str) -> u32 {
    value_reference(Probe::table(), name).unwrap()
}

/// What the four answers of a step were before and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped {
    pub event_handling_needed: u8,
    pub terminate_simulation: u8,
    pub early_return: u8,
    pub last_successful_time: f64,
}

pub const UNTOUCHED: Stepped = Stepped {
    event_handling_needed: 77,
    terminate_simulation: 77,
    early_return: 77,
    last_successful_time: -77.0,
};

pub struct Host {
    pub instance: Fmi3Instance,
    pub journal: Box<Journal>,
}

/// Methods that only hand on the instance.
macro_rules! plain {
    ($($method:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {
        $(pub fn $method(&self $(, $argument: $type)*) -> Fmi3Status {
            // SAFETY: the instance is null or alive, and pointers come from live Rust values.
            status(unsafe { fmi3::$function(self.instance $(, $argument)*) })
        })*
    };
}

/// Methods that set variables, and that read so many values of variables.
macro_rules! typed {
    ($($type:ty: $set:ident = $set_function:ident, $get:ident = $get_function:ident;)*) => {
        $(
            pub fn $set(&self, references: &[u32], values: &[$type]) -> Fmi3Status {
                let (vr, n) = (references.as_ptr(), references.len());
                // SAFETY: both arrays are as long as is said.
                status(unsafe { fmi3::$set_function(self.instance, vr, n, values.as_ptr(), values.len()) })
            }

            pub fn $get(&self, references: &[u32], count: usize) -> Result<Vec<$type>, Fmi3Status> {
                let mut values = vec![<$type>::default(); count];
                let (vr, n) = (references.as_ptr(), references.len());
                // SAFETY: both arrays are as long as is said.
                let raw = unsafe { fmi3::$get_function(self.instance, vr, n, values.as_mut_ptr(), count) };
                ok(raw, values)
            }
        )*
    };
}

pub fn status(raw: RawStatus) -> Fmi3Status {
    Fmi3Status::from_raw(raw).unwrap()
}

pub fn ok<T>(raw: RawStatus, value: T) -> Result<T, Fmi3Status> {
    match status(raw) {
        Fmi3Status::Ok | Fmi3Status::Warning => Ok(value),
        other => Err(other),
    }
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
        assert_eq!(host.set_debug_logging(1, &reasons), Fmi3Status::Ok);
        host
    }

    pub fn with_logging(on: bool) -> Self {
        let journal = Box::<Journal>::default();
        let token = CString::new(own_token()).unwrap();
        let environment = ptr::from_ref::<Journal>(&journal).cast_mut().cast();
        let (name, token, none) = (c"probe 1".as_ptr(), token.as_ptr(), ptr::null());
        let logger = Some(self::journal as _);
        // SAFETY: all pointers are to live Rust values.
        let instance = unsafe {
            fmi3::fmi3InstantiateCoSimulation(
                name,
                token,
                none,
                0,
                on.into(),
                0,
                1,
                ptr::null(),
                0,
                environment,
                logger,
                None,
            )
        };
        assert!(!instance.is_null(), "{:?}", journal.messages);
        Self { instance, journal }
    }

    /// An instance whose behaviour is chosen before initialization, and which is then ready to step.
    pub fn stepping(behaviour: i32) -> Self {
        let host = Self::new();
        assert_eq!(host.set_int64(&[vr("behaviour")], &[behaviour.into()]), Fmi3Status::Ok);
        assert_eq!(host.enter(), Fmi3Status::Ok);
        assert_eq!(host.exit_initialization_mode(), Fmi3Status::Ok);
        host
    }

    plain! {
        enter_initialization_mode = fmi3EnterInitializationMode(
            tolerance_defined: u8, tolerance: f64, start: f64, stop_defined: u8, stop: f64);
        exit_initialization_mode = fmi3ExitInitializationMode();
        terminate = fmi3Terminate();
        reset = fmi3Reset();
        set_fmu_state = fmi3SetFMUState(state: Fmi3FmuState);
        enter_event_mode = fmi3EnterEventMode();
        enter_step_mode = fmi3EnterStepMode();
        enter_configuration_mode = fmi3EnterConfigurationMode();
        set_time = fmi3SetTime(t: f64);
        activate_model_partition = fmi3ActivateModelPartition(clock: u32, t: f64);
    }

    typed! {
        f64: set_float64 = fmi3SetFloat64, get_float64 = fmi3GetFloat64;
        f32: set_float32 = fmi3SetFloat32, get_float32 = fmi3GetFloat32;
        i8: set_int8 = fmi3SetInt8, get_int8 = fmi3GetInt8;
        u8: set_uint8 = fmi3SetUInt8, get_uint8 = fmi3GetUInt8;
        i16: set_int16 = fmi3SetInt16, get_int16 = fmi3GetInt16;
        u16: set_uint16 = fmi3SetUInt16, get_uint16 = fmi3GetUInt16;
        i32: set_int32 = fmi3SetInt32, get_int32 = fmi3GetInt32;
        u32: set_uint32 = fmi3SetUInt32, get_uint32 = fmi3GetUInt32;
        i64: set_int64 = fmi3SetInt64, get_int64 = fmi3GetInt64;
        u64: set_uint64 = fmi3SetUInt64, get_uint64 = fmi3GetUInt64;
        u8: set_boolean = fmi3SetBoolean, get_boolean = fmi3GetBoolean;
    }

    /// From 0 s on, without an end.
    pub fn enter(&self) -> Fmi3Status {
        self.enter_initialization_mode(0, 0.0, 0.0, 0, 0.0)
    }

    pub fn step(&self, t: f64, h: f64) -> (Fmi3Status, Stepped) {
        let mut told = UNTOUCHED;
        // SAFETY: each answer has room.
        let raw = unsafe {
            fmi3::fmi3DoStep(
                self.instance,
                t,
                h,
                1,
                &mut told.event_handling_needed,
                &mut told.terminate_simulation,
                &mut told.early_return,
                &mut told.last_successful_time,
            )
        };
        (status(raw), told)
    }

    pub fn do_step(&self, t: f64, h: f64) -> Fmi3Status {
        self.step(t, h).0
    }

    pub fn set_string(&self, references: &[u32], values: &[&CStr]) -> Fmi3Status {
        let values: Vec<_> = values.iter().map(|value| value.as_ptr()).collect();
        let (vr, n) = (references.as_ptr(), references.len());
        // SAFETY: both arrays are as long as is said.
        status(unsafe { fmi3::fmi3SetString(self.instance, vr, n, values.as_ptr(), values.len()) })
    }

    pub fn get_string(&self, references: &[u32]) -> Result<Vec<String>, Fmi3Status> {
        let mut values = vec![ptr::null(); references.len()];
        let (vr, n) = (references.as_ptr(), references.len());
        // SAFETY: both arrays have n elements.
        let raw = unsafe { fmi3::fmi3GetString(self.instance, vr, n, values.as_mut_ptr(), n) };
        let pointers = ok(raw, values)?;
        let copy = |pointer: &*const c_char| {
            // SAFETY: the FMU has just answered with NUL-terminated strings.
            unsafe { CStr::from_ptr(*pointer) }.to_str().unwrap().to_owned()
        };
        Ok(pointers.iter().map(copy).collect())
    }

    pub fn set_debug_logging(&self, on: u8, categories: &[&CStr]) -> Fmi3Status {
        let pointers: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
        let (c, n) = (self.instance, pointers.len());
        // SAFETY: the array has n strings.
        status(unsafe { fmi3::fmi3SetDebugLogging(c, on, n, pointers.as_ptr()) })
    }

    pub fn get_fmu_state(&self, state: &mut Fmi3FmuState) -> Fmi3Status {
        // SAFETY: null or a live state.
        status(unsafe { fmi3::fmi3GetFMUState(self.instance, state) })
    }

    pub fn free_fmu_state(&self, state: &mut Fmi3FmuState) -> Fmi3Status {
        // SAFETY: null or a live state.
        status(unsafe { fmi3::fmi3FreeFMUState(self.instance, state) })
    }

    pub fn serialized_size(&self, state: Fmi3FmuState) -> Result<usize, Fmi3Status> {
        let mut size = 0;
        // SAFETY: `size` has room for the answer.
        let raw = unsafe { fmi3::fmi3SerializedFMUStateSize(self.instance, state, &mut size) };
        ok(raw, size)
    }

    pub fn serialize_into(&self, state: Fmi3FmuState, bytes: &mut [u8]) -> Fmi3Status {
        let (c, n) = (self.instance, bytes.len());
        // SAFETY: the buffer has n bytes.
        status(unsafe { fmi3::fmi3SerializeFMUState(c, state, bytes.as_mut_ptr(), n) })
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<Fmi3FmuState, Fmi3Status> {
        let mut state = ptr::dangling_mut(); // hosts need not initialise it
        let (c, n) = (self.instance, bytes.len());
        // SAFETY: the buffer has n bytes.
        let raw = unsafe { fmi3::fmi3DeserializeFMUState(c, bytes.as_ptr(), n, &mut state) };
        ok(raw, state)
    }

    /// The bytes of the present state.
    pub fn bytes(&self) -> Result<Vec<u8>, Fmi3Status> {
        let mut state = ptr::null_mut();
        if self.get_fmu_state(&mut state) != Fmi3Status::Ok {
            return Err(Fmi3Status::Error);
        }
        let mut bytes = vec![0; self.serialized_size(state)?];
        assert_eq!(self.serialize_into(state, &mut bytes), Fmi3Status::Ok);
        assert_eq!(self.free_fmu_state(&mut state), Fmi3Status::Ok);
        assert!(state.is_null());
        Ok(bytes)
    }

    /// Puts the instance into the state that `bytes` hold.
    pub fn restore(&self, bytes: &[u8]) {
        let mut state = self.deserialize(bytes).unwrap();
        assert_eq!(self.set_fmu_state(state), Fmi3Status::Ok);
        assert_eq!(self.free_fmu_state(&mut state), Fmi3Status::Ok);
    }

    /// The messages since the last call of this.
    pub fn messages(&self) -> Vec<Message> {
        std::mem::take(&mut self.journal.messages.lock().unwrap())
    }

    /// The text of the one message since the last call, which must explain `status`.
    #[track_caller]
    pub fn reason(&self, status: Fmi3Status) -> String {
        let messages = self.messages();
        let [message] = messages.as_slice() else {
            panic!("one message expected, not {messages:?}");
        };
        assert_eq!(message.status, status, "{message:?}");
        message.text.clone()
    }

    /// Frees the instance and gives back the rest of the log.
    pub fn free(mut self) -> Vec<Message> {
        let instance = std::mem::replace(&mut self.instance, ptr::null_mut());
        // SAFETY: the instance is alive and not used again.
        unsafe { fmi3::fmi3FreeInstance(instance) };
        self.messages()
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: null or alive, and not used again.
        unsafe { fmi3::fmi3FreeInstance(self.instance) };
    }
}
