//! A running instance behind safe methods.
#![allow(unsafe_code, reason = "calls functions of a C library")]

mod states;
mod values;

use std::ffi::CString;
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use fmi2_abi::{
    FMI2_FALSE, FMI2_TRUE, Fmi2Boolean, Fmi2CallbackFunctions, Fmi2Component, Fmi2Status, Fmi2StatusKind, Fmi2String,
    Fmi2Type, RawStatus, boolean, truth,
};

use crate::ImportError;
use crate::description::ModelDescription;
use crate::guard::{self, FirstCalls, Watch};
use crate::handles::{Handle, Handles, Phase};
use crate::library::Binary;
use crate::logger::{Environment, LogMessage, Sink};
use crate::status::Status;

/// Category of what is said about loading a library.
const LOADER: &str = "loader";

/// How a call that succeeded ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Outcome {
    /// All well.
    Ok,
    /// The FMU gave a warning; see [`Instance::messages`].
    Warning,
}

/// Times and tolerance of a simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Experiment {
    /// Start time, s.
    pub start_time: f64,
    /// Stop time, s, if known.
    pub stop_time: Option<f64>,
    /// Relative tolerance for slaves that control their own error.
    pub tolerance: Option<f64>,
}

/// One instance of an FMU.
///
/// Dropping it terminates it if necessary and frees it. After an instance has returned Fatal (or Pending, although no
/// asynchronous steps are asked for), its FMU is never called for it again: further calls answer
/// [`ImportError::Unusable`], and its memory is left to the process.
///
/// Warnings are counted, see [`Instance::warnings`]. Discard, Error and a status unknown to the standard become
/// [`ImportError::Call`] with what the FMU logged during the call.
#[derive(Debug)]
pub struct Instance {
    name: String,
    component: Fmi2Component,
    phase: Phase,
    /// The status after which no call is allowed.
    ended: Option<Status>,
    warnings: u64,
    /// Whether a state was ever saved, so that an earlier point may be returned to.
    saved: bool,
    booleans: Vec<Fmi2Boolean>,
    handles: Arc<Handles>,
    description: Arc<ModelDescription>,
    /// Where it logs to.
    environment: Arc<Environment>,
    first_calls: FirstCalls,
    /// From `Box`; the FMU may keep the pointer until it is freed.
    callbacks: NonNull<Fmi2CallbackFunctions>,
    binary: Arc<Binary>,
}

// SAFETY: the standard ties an instance to no thread; it only forbids overlapping calls, and every call here needs
// `&mut self`. The pointers are not shared with anything else.
unsafe impl Send for Instance {}

impl Instance {
    pub(crate) fn new(
        binary: Arc<Binary>,
        description: Arc<ModelDescription>,
        name: &str,
        logging_on: bool,
    ) -> Result<Self, ImportError> {
        const FUNCTION: &str = "fmi2Instantiate";
        let name_c = c_string(name, FUNCTION, name)?;
        let guid = c_string(name, FUNCTION, &description.guid)?;
        let resources = c_string(name, FUNCTION, &binary.resources)?;
        if description.co_simulation.can_be_instantiated_only_once_per_process {
            if binary
                .alive
                .compare_exchange(0, 1, Ordering::AcqRel, Ordering::Acquire)
                .is_err()
            {
                let model = description.model_name.clone();
                return Err(ImportError::OnlyOnce {
                    instance: name.to_owned(),
                    model,
                });
            }
        } else {
            binary.alive.fetch_add(1, Ordering::AcqRel);
        }

        let sink = Sink::new(Arc::clone(&description));
        for warning in &binary.warnings {
            sink.push(Status::Known(Fmi2Status::Warning), LOADER.to_owned(), warning);
        }
        let environment = Arc::new(Environment::new(sink));
        let callbacks = NonNull::from(Box::leak(Box::new(environment.callbacks())));
        let create = |logging_on: Fmi2Boolean| {
            // SAFETY: all strings are NUL-terminated and live during the call; the callbacks, and the environment they
            // point to, live until the instance is freed.
            guard::around(Watch::Whole, || unsafe {
                (binary.functions.instantiate)(
                    name_c.as_ptr(),
                    Fmi2Type::CoSimulation.raw(),
                    guid.as_ptr(),
                    resources.as_ptr(),
                    callbacks.as_ptr(),
                    FMI2_FALSE,
                    logging_on,
                )
            })
        };
        let mark = environment.sink().mark();
        let mut component = create(boolean(logging_on));
        if component.is_null() && !logging_on && environment.sink().mark() == mark {
            // It keeps silent as it was told to: once more, for the reason.
            component = create(FMI2_TRUE);
        }
        // From here on dropping releases everything; it calls nothing while `component` is null.
        let mut instance = Self {
            name: name.to_owned(),
            component,
            phase: Phase::Starting,
            ended: None,
            warnings: 0,
            saved: false,
            booleans: Vec::new(),
            handles: Arc::default(),
            description,
            environment,
            first_calls: FirstCalls::new(binary.wide),
            callbacks,
            binary,
        };
        if component.is_null() {
            return Err(ImportError::Instantiate {
                instance: instance.name.clone(),
                model: instance.description.model_name.clone(),
                messages: instance.sink().since(mark),
            });
        }
        if !logging_on {
            instance.ask_for_reasons();
        }
        Ok(instance)
    }

    /// Asks an FMU that knows the standard's categories of failed calls to log those, since with logging off it says nothing,
    /// not even why a call failed.
    fn ask_for_reasons(&mut self) {
        const REASONS: [&str; 4] = [
            "logStatusWarning",
            "logStatusDiscard",
            "logStatusError",
            "logStatusFatal",
        ];
        let known = &self.description.log_categories;
        let reasons = REASONS.into_iter().filter(|name| known.iter().any(|c| c.name == *name));
        let reasons: Vec<&str> = reasons.collect();
        if !reasons.is_empty() && self.set_debug_logging(true, &reasons).is_err() && self.ended.is_none() {
            // One that cannot do that is as good as before.
            self.phase = Phase::Starting;
        }
    }

    fn sink(&self) -> &Sink {
        self.environment.sink()
    }

    /// The name it was created with.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The description of its FMU.
    #[must_use]
    pub fn description(&self) -> &ModelDescription {
        &self.description
    }

    /// How many calls ended with a warning so far.
    #[must_use]
    pub fn warnings(&self) -> u64 {
        self.warnings
    }

    /// Takes the messages logged since the last time, in the order in which each came first. Those that differ in their numbers
    /// alone are one, with a count; there are at most 256.
    #[must_use]
    pub fn messages(&self) -> Vec<LogMessage> {
        self.sink().drain()
    }

    /// `fmi2SetDebugLogging` for the given categories; none means all.
    ///
    /// # Errors
    /// [`ImportError::Call`], [`ImportError::Unusable`] or [`ImportError::NulInText`].
    pub fn set_debug_logging(&mut self, on: bool, categories: &[&str]) -> Result<(), ImportError> {
        const FUNCTION: &str = "fmi2SetDebugLogging";
        let owned = self.c_strings(FUNCTION, categories)?;
        let pointers: Vec<Fmi2String> = owned.iter().map(|s| s.as_ptr()).collect();
        let call = self.binary.functions.set_debug_logging;
        self.call(FUNCTION, |component| {
            // SAFETY: the array and its strings live during the call.
            unsafe { call(component, boolean(on), pointers.len(), pointers.as_ptr()) }
        })
    }

    /// `fmi2SetupExperiment`.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn setup_experiment(&mut self, experiment: &Experiment) -> Result<(), ImportError> {
        let call = self.binary.functions.setup_experiment;
        let Experiment {
            start_time,
            stop_time,
            tolerance,
        } = *experiment;
        self.call("fmi2SetupExperiment", |component| {
            // SAFETY: plain numbers.
            unsafe {
                call(
                    component,
                    boolean(tolerance.is_some()),
                    tolerance.unwrap_or(0.0),
                    start_time,
                    boolean(stop_time.is_some()),
                    stop_time.unwrap_or(start_time),
                )
            }
        })
    }

    /// `fmi2EnterInitializationMode`.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn enter_initialization(&mut self) -> Result<(), ImportError> {
        let call = self.binary.functions.enter_initialization_mode;
        // SAFETY: the component is alive.
        self.call("fmi2EnterInitializationMode", |component| unsafe { call(component) })
    }

    /// `fmi2ExitInitializationMode`.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn exit_initialization(&mut self) -> Result<(), ImportError> {
        let call = self.binary.functions.exit_initialization_mode;
        // SAFETY: the component is alive.
        self.call("fmi2ExitInitializationMode", |component| unsafe { call(component) })?;
        self.phase = Phase::Stepping;
        Ok(())
    }

    /// `fmi2DoStep` from time `t` over `h`, both s.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`]. After a Discard the messages end with what the FMU says
    /// about how far it came.
    pub fn do_step(&mut self, t: f64, h: f64) -> Result<Outcome, ImportError> {
        let call = self.binary.functions.do_step;
        let never_back = boolean(!self.saved);
        // SAFETY: plain numbers.
        let mut result = self.outcome("fmi2DoStep", |component| unsafe { call(component, t, h, never_back) });
        if let Err(ImportError::Call {
            status: Status::Known(Fmi2Status::Discard),
            messages,
            ..
        }) = &mut result
        {
            self.explain_discard(messages);
        }
        result
    }

    /// `fmi2Terminate`.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn terminate(&mut self) -> Result<(), ImportError> {
        let call = self.binary.functions.terminate;
        // SAFETY: the component is alive.
        self.call("fmi2Terminate", |component| unsafe { call(component) })?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// `fmi2Reset`: as after instantiation.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn reset(&mut self) -> Result<(), ImportError> {
        let call = self.binary.functions.reset;
        // SAFETY: the component is alive.
        self.call("fmi2Reset", |component| unsafe { call(component) })?;
        self.phase = Phase::Starting;
        Ok(())
    }

    /// Adds what the FMU knows about a discarded step.
    fn explain_discard(&mut self, messages: &mut Vec<String>) {
        if let Some(call) = self.binary.functions.get_real_status {
            let mut time = f64::NAN;
            let kind = Fmi2StatusKind::LastSuccessfulTime.raw();
            // SAFETY: the pointer is to a live double.
            let answer = self.call("fmi2GetRealStatus", |component| unsafe {
                call(component, kind, &raw mut time)
            });
            if answer.is_ok() {
                messages.push(format!("last successful time {time} s"));
            }
        }
        if let Some(call) = self.binary.functions.get_boolean_status {
            let mut terminated = FMI2_FALSE;
            let kind = Fmi2StatusKind::Terminated.raw();
            // SAFETY: the pointer is to a live fmi2Boolean.
            let answer = self.call("fmi2GetBooleanStatus", |component| unsafe {
                call(component, kind, &raw mut terminated)
            });
            if answer.is_ok() && truth(terminated) {
                messages.push("the FMU asks to end the simulation".to_owned());
            }
        }
    }

    fn call(
        &mut self,
        function: &'static str,
        call: impl FnOnce(Fmi2Component) -> RawStatus,
    ) -> Result<(), ImportError> {
        self.outcome(function, call).map(drop)
    }

    /// The one place that calls into the FMU between its creation and its end.
    fn outcome(
        &mut self,
        function: &'static str,
        call: impl FnOnce(Fmi2Component) -> RawStatus,
    ) -> Result<Outcome, ImportError> {
        if let Some(status) = self.ended {
            return Err(ImportError::Unusable {
                instance: self.name.clone(),
                function,
                status,
            });
        }
        let mark = self.sink().mark();
        let watch = self.first_calls.watch(function);
        let status = Status::from_raw(guard::around(watch, || call(self.component)));
        match status {
            Status::Known(Fmi2Status::Ok) => return Ok(Outcome::Ok),
            Status::Known(Fmi2Status::Warning) => {
                self.warnings += 1;
                return Ok(Outcome::Warning);
            }
            Status::Known(Fmi2Status::Discard) => {}
            Status::Known(Fmi2Status::Error) | Status::Unknown(_) => self.phase = Phase::Failed,
            Status::Known(Fmi2Status::Fatal | Fmi2Status::Pending) => self.ended = Some(status),
        }
        Err(ImportError::Call {
            instance: self.name.clone(),
            function,
            status,
            messages: self.sink().since(mark),
        })
    }

    fn free_state(&mut self, handle: Handle) {
        if let Some(functions) = self.binary.functions.states {
            let mut raw = handle.0;
            // SAFETY: the handle was made by this instance, and nobody else holds it any more.
            let _ = self.call("fmi2FreeFMUstate", |component| unsafe {
                (functions.free)(component, &raw mut raw)
            });
        }
    }

    fn c_strings<S: AsRef<str>>(&self, function: &'static str, texts: &[S]) -> Result<Vec<CString>, ImportError> {
        texts
            .iter()
            .map(|s| c_string(&self.name, function, s.as_ref()))
            .collect()
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if !self.component.is_null() {
            if self.phase == Phase::Stepping {
                // Nobody is left to hear of a failure; a Fatal is noted in `ended`.
                let _ = self.terminate();
            }
            for handle in self.handles.take_all() {
                self.free_state(handle);
            }
            if self.ended.is_some() {
                // The FMU may still run code of its own: what it may touch stays where it is.
                self.binary.keep_loaded.store(true, Ordering::Relaxed);
                std::mem::forget(Arc::clone(&self.environment));
                return;
            }
            // SAFETY: the component is alive and not used again.
            guard::around(Watch::Whole, || unsafe {
                (self.binary.functions.free_instance)(self.component)
            });
        }
        // SAFETY: the pointer came from a `Box`, and no instance is left that could use it.
        drop(unsafe { Box::from_raw(self.callbacks.as_ptr()) });
        self.binary.alive.fetch_sub(1, Ordering::AcqRel);
    }
}

fn c_string(instance: &str, function: &'static str, text: &str) -> Result<CString, ImportError> {
    CString::new(text).map_err(|_| ImportError::NulInText {
        instance: instance.to_owned(),
        function,
        text: text.to_owned(),
    })
}
