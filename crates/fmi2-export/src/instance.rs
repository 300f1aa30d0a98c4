//! One instance behind the C functions: call order and panics around what [`fmi_model::Instance`] does.

use std::ffi::CString;
use std::path::PathBuf;

use fmi_model::{Category, Checked, Experiment, InstanceError, Log, Model, Phase, Scalar, Snapshot, Wanted, guarded};
use fmi2_abi::{Fmi2Status, Fmi2StatusKind};

use crate::error::CallError;
use crate::log::Sink;
use crate::order::Function;

/// What most calls answer.
pub(crate) type Answer = Result<Fmi2Status, CallError>;

pub(crate) struct Instance<M> {
    sink: Sink,
    model: fmi_model::Instance<M>,
    /// What the last `fmi2GetString` handed out; holds until the next call of it.
    texts: Vec<CString>,
}

impl<M: Model> Instance<M> {
    pub(crate) fn new(sink: Sink, resources: Option<PathBuf>) -> Self {
        Self {
            sink,
            model: resources.map_or_else(fmi_model::Instance::new, fmi_model::Instance::with_resources),
            texts: Vec::new(),
        }
    }

    /// Runs one call: call order first, then `body`, and the reason of any failure to the log. After a panic the instance
    /// answers nothing but `fmi2Fatal`.
    pub(crate) fn run(&mut self, function: &Function, body: impl FnOnce(&mut Self) -> Answer) -> Fmi2Status {
        if self.model.phase() == Phase::Fatal {
            return Fmi2Status::Fatal;
        }
        let status = guarded(|| {
            let answer = function.check(self.model.phase()).and_then(|()| body(&mut *self));
            answer.unwrap_or_else(|error| {
                let status = error.status();
                self.explain(status, function, &error.chain());
                status
            })
        });
        status.unwrap_or_else(|panic| {
            self.model.poison();
            self.explain(Fmi2Status::Fatal, function, &panic);
            Fmi2Status::Fatal
        })
    }

    fn explain(&self, status: Fmi2Status, function: &Function, reason: &str) {
        let message = format!("{}: {reason}", function.name);
        self.sink.explain(status, &message);
    }

    /// Hands the instance to `body` with the log of the call, whose warnings become the status.
    fn logged(
        &mut self,
        body: impl FnOnce(&mut fmi_model::Instance<M>, &mut Log<'_>) -> Result<(), InstanceError>,
    ) -> Answer {
        let mut log = Log::new(&self.sink);
        body(&mut self.model, &mut log)?;
        Ok(if log.warned() {
            Fmi2Status::Warning
        } else {
            Fmi2Status::Ok
        })
    }

    // Life cycle.

    pub(crate) fn set_debug_logging(&mut self, logging_on: bool, categories: &[&str]) -> Answer {
        let categories = categories
            .iter()
            .map(|name| Category::from_name(name).ok_or_else(|| unknown_category(name)))
            .collect::<Result<Vec<_>, _>>()?;
        self.sink.set_wanted(Wanted::new(logging_on, &categories));
        Ok(Fmi2Status::Ok)
    }

    pub(crate) fn setup_experiment(&mut self, experiment: Experiment) -> Answer {
        self.model.setup_experiment(experiment)?;
        Ok(Fmi2Status::Ok)
    }

    pub(crate) fn enter_initialization_mode(&mut self) -> Answer {
        self.logged(fmi_model::Instance::enter_initialization)
    }

    pub(crate) fn exit_initialization_mode(&mut self) -> Answer {
        self.logged(fmi_model::Instance::exit_initialization)
    }

    pub(crate) fn terminate(&mut self) -> Answer {
        self.logged(|model, log| {
            model.terminate(log);
            Ok(())
        })
    }

    pub(crate) fn reset(&mut self) -> Answer {
        self.model.reset();
        Ok(Fmi2Status::Ok)
    }

    // Variables.

    /// Hands the value of each variable to `put`, with its place in `references`.
    pub(crate) fn get<T: Scalar>(&mut self, references: &[u32], put: impl FnMut(usize, T)) -> Answer {
        self.logged(|model, log| model.get(references, log, put))
    }

    /// Like [`get`](Self::get), for texts that live until the next call of this function.
    pub(crate) fn get_texts(&mut self, references: &[u32], mut put: impl FnMut(usize, &CString)) -> Answer {
        let mut values = Vec::with_capacity(references.len());
        let status = self.get(references, |_, value: String| values.push(value))?;
        let mut texts = Vec::with_capacity(values.len());
        for (value, reference) in values.into_iter().zip(references) {
            let unfit = |_| {
                let name = M::table().entry(*reference).map(|entry| entry.name().into_owned());
                CallError::NulInText {
                    name: name.unwrap_or_default(),
                }
            };
            texts.push(CString::new(value).map_err(unfit)?);
        }
        self.texts = texts;
        for (place, text) in self.texts.iter().enumerate() {
            put(place, text);
        }
        Ok(status)
    }

    /// Sets variables; `value` gives the value at a place in `references`.
    pub(crate) fn set<T: Checked>(&mut self, references: &[u32], value: impl Fn(usize) -> T) -> Answer {
        self.model.set(references, value)?;
        Ok(Fmi2Status::Ok)
    }

    // Steps.

    pub(crate) fn do_step(&mut self, t: f64, h: f64) -> Answer {
        self.logged(|model, log| model.do_step(t, h, log))
    }

    /// End of the last successful step, s, or why there is no such information.
    pub(crate) fn real_status(&self, kind: Fmi2StatusKind) -> Result<f64, CallError> {
        match kind {
            Fmi2StatusKind::LastSuccessfulTime => Ok(self.model.time()),
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
        self.model.state()
    }

    pub(crate) fn set_state(&mut self, state: &Snapshot<M>) -> Answer {
        self.model.set_state(state.clone());
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
