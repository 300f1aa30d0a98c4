//! One instance of a model: what each call does, in safe Rust.
//!
//! A call that is refused (wrong phase, unknown or unfit variable, value out of bounds, times that do not fit) changes nothing
//! and leaves the instance usable: arrays are checked whole before the first value is applied.

use std::ffi::CString;

use fmi2_abi::{Fmi2Status, Fmi2StatusKind};

use crate::check::{Checked, check_settable, finite};
use crate::error::CallError;
use crate::guard::guarded;
use crate::log::{Category, Log, Logger};
use crate::model::{Experiment, Model};
use crate::order::{Function, Phase};
use crate::snapshot::Snapshot;
use crate::table::{Scalar, Variable};

/// What most calls answer.
pub(crate) type Answer = Result<Fmi2Status, CallError>;

pub(crate) struct Instance<M> {
    logger: Logger,
    state: Snapshot<M>,
    /// What the last `fmi2GetString` handed out; holds until the next call of it.
    texts: Vec<CString>,
}

impl<M: Model> Instance<M> {
    pub(crate) fn new(logger: Logger) -> Self {
        Self {
            logger,
            state: Snapshot::start(),
            texts: Vec::new(),
        }
    }

    /// Runs one call: call order first, then `body`, and the reason of any failure to the log. After a panic the instance
    /// answers nothing but `fmi2Fatal`.
    pub(crate) fn run(&mut self, function: &Function, body: impl FnOnce(&mut Self) -> Answer) -> Fmi2Status {
        if self.state.phase == Phase::Fatal {
            return Fmi2Status::Fatal;
        }
        let status = guarded(|| {
            let answer = function.check(self.state.phase).and_then(|()| body(&mut *self));
            answer.unwrap_or_else(|error| {
                let status = error.status();
                self.explain(status, function, &error.chain());
                status
            })
        });
        status.unwrap_or_else(|panic| {
            self.state.phase = Phase::Fatal;
            self.explain(Fmi2Status::Fatal, function, &panic);
            Fmi2Status::Fatal
        })
    }

    fn explain(&self, status: Fmi2Status, function: &Function, reason: &str) {
        let message = format!("{}: {reason}", function.name);
        self.logger.sink.explain(status, &message);
    }

    // Life cycle.

    pub(crate) fn set_debug_logging(&mut self, logging_on: bool, categories: &[&str]) -> Answer {
        let categories = categories
            .iter()
            .map(|name| Category::from_name(name).ok_or_else(|| unknown_category(name)))
            .collect::<Result<Vec<_>, _>>()?;
        self.logger.configure(logging_on, &categories);
        Ok(Fmi2Status::Ok)
    }

    pub(crate) fn setup_experiment(&mut self, experiment: Experiment) -> Answer {
        let start = experiment.start_time;
        finite("start time", start)?;
        if let Some(stop) = experiment.stop_time {
            finite("stop time", stop)?;
            if stop < start {
                return Err(CallError::StopBeforeStart { start, stop });
            }
        }
        if let Some(tolerance) = experiment.tolerance {
            finite("tolerance", tolerance)?;
            if tolerance <= 0.0 {
                return Err(CallError::BadTolerance { tolerance });
            }
        }
        self.state.experiment = experiment;
        self.state.time = start;
        Ok(Fmi2Status::Ok)
    }

    pub(crate) fn enter_initialization_mode(&mut self) -> Answer {
        self.state.phase = Phase::Initialization;
        self.state.stale = true;
        self.refresh()
    }

    pub(crate) fn exit_initialization_mode(&mut self) -> Answer {
        let status = self.refresh()?;
        self.state.phase = Phase::StepComplete;
        Ok(status)
    }

    pub(crate) fn terminate(&mut self) -> Answer {
        let mut log = Log::new(&self.logger);
        self.state.model.terminate(&mut log);
        self.state.phase = Phase::Terminated;
        Ok(log.status())
    }

    pub(crate) fn reset(&mut self) -> Answer {
        self.state = Snapshot::start();
        Ok(Fmi2Status::Ok)
    }

    /// Lets the model initialise if a variable was set since it last did.
    fn refresh(&mut self) -> Answer {
        if self.state.phase != Phase::Initialization || !self.state.stale {
            return Ok(Fmi2Status::Ok);
        }
        let mut log = Log::new(&self.logger);
        let state = &mut self.state;
        match state.model.initialise(&state.experiment, &mut log) {
            Ok(()) => {
                state.stale = false;
                Ok(log.status())
            }
            Err(error) => {
                state.phase = Phase::Failed;
                Err(CallError::Model(error))
            }
        }
    }

    // Variables.

    /// Hands the value of each variable to `put`, with its place in `references`.
    pub(crate) fn get<T: Scalar>(&mut self, references: &[u32], mut put: impl FnMut(usize, T)) -> Answer {
        for reference in references {
            variable::<M, T>(*reference)?;
        }
        let status = self.refresh()?;
        for (place, reference) in references.iter().enumerate() {
            if let Some(access) = T::access(&variable::<M, T>(*reference)?.typed) {
                put(place, access.read(&self.state.model));
            }
        }
        Ok(status)
    }

    /// Like [`get`](Self::get), for texts that live until the next call of this function.
    pub(crate) fn get_texts(&mut self, references: &[u32], mut put: impl FnMut(usize, &CString)) -> Answer {
        let mut values = Vec::with_capacity(references.len());
        let status = self.get(references, |_, value: String| values.push(value))?;
        let mut texts = Vec::with_capacity(values.len());
        for (value, reference) in values.into_iter().zip(references) {
            texts.push(CString::new(value).or_else(|_| {
                let name = variable::<M, String>(*reference)?.name.clone();
                Err(CallError::NulInText { name })
            })?);
        }
        self.texts = texts;
        for (place, text) in self.texts.iter().enumerate() {
            put(place, text);
        }
        Ok(status)
    }

    /// Sets variables; `value` gives the value at a place in `references`.
    pub(crate) fn set<T: Checked>(&mut self, references: &[u32], value: impl Fn(usize) -> T) -> Answer {
        for (place, reference) in references.iter().enumerate() {
            let variable = variable::<M, T>(*reference)?;
            check_settable(variable, self.state.phase)?;
            T::check(&value(place), variable)?;
        }
        for (place, reference) in references.iter().enumerate() {
            if let Some(access) = T::access(&variable::<M, T>(*reference)?.typed) {
                access.write(&mut self.state.model, value(place));
            }
        }
        self.state.stale |= self.state.phase == Phase::Initialization && !references.is_empty();
        Ok(Fmi2Status::Ok)
    }

    // Steps.

    pub(crate) fn do_step(&mut self, t: f64, h: f64) -> Answer {
        finite("communication point", t)?;
        finite("communication step size", h)?;
        if h <= 0.0 {
            return Err(CallError::BadStep { h });
        }
        finite("end of the step", t + h)?;
        let expected = self.state.time;
        if (t - expected).abs() > 1e-9 * t.abs().max(1.0) + 1e-6 * h {
            return Err(CallError::TimeMismatch { t, expected });
        }
        let mut log = Log::new(&self.logger);
        let state = &mut self.state;
        match state.model.do_step(t, h, &mut log) {
            Ok(()) => {
                state.time = t + h;
                Ok(log.status())
            }
            Err(error) => {
                state.phase = Phase::Failed;
                Err(CallError::Model(error))
            }
        }
    }

    /// End of the last successful step, s, or why there is no such information.
    pub(crate) fn real_status(&self, kind: Fmi2StatusKind) -> Result<f64, CallError> {
        match kind {
            Fmi2StatusKind::LastSuccessfulTime => Ok(self.state.time),
            other => Err(not_available(other)),
        }
    }

    /// Whether the slave wants to stop (never), or why there is no such information.
    pub(crate) fn boolean_status(&self, kind: Fmi2StatusKind) -> Result<bool, CallError> {
        match kind {
            Fmi2StatusKind::Terminated => Ok(false),
            other => Err(not_available(other)),
        }
    }

    // Saved states.

    pub(crate) fn state(&self) -> &Snapshot<M> {
        &self.state
    }

    pub(crate) fn set_state(&mut self, state: &Snapshot<M>) -> Answer {
        self.state = state.clone();
        Ok(Fmi2Status::Ok)
    }
}

/// Why a status cannot be asked for.
pub(crate) fn not_available(kind: Fmi2StatusKind) -> CallError {
    CallError::StatusNotAvailable {
        why: match kind {
            Fmi2StatusKind::DoStepStatus | Fmi2StatusKind::PendingStatus => "no step is ever pending",
            Fmi2StatusKind::LastSuccessfulTime => "fmi2LastSuccessfulTime is a Real, use fmi2GetRealStatus",
            Fmi2StatusKind::Terminated => "fmi2Terminated is a Boolean, use fmi2GetBooleanStatus",
        },
    }
}

fn unknown_category(given: &str) -> CallError {
    CallError::UnknownCategory {
        given: given.to_owned(),
        known: Category::ALL.map(Category::name).join(", "),
    }
}

/// The row behind a value reference, if its type is `T`.
fn variable<M: Model, T: Scalar>(reference: u32) -> Result<&'static Variable<M>, CallError> {
    let table = M::table();
    let variable = table.variable(reference).ok_or_else(|| CallError::UnknownReference {
        reference,
        count: table.variables().len(),
    })?;
    if T::access(&variable.typed).is_none() {
        return Err(CallError::WrongType {
            name: variable.name.clone(),
            reference,
            declared: variable.typed.name(),
        });
    }
    Ok(variable)
}
