//! One instance behind the C functions: call order and panics around what [`fmi_model::Instance`] does.

use std::ffi::CString;
use std::path::PathBuf;

use fmi_model::{Category, Checked, Experiment, InstanceError, Log, Model, Phase, Scalar, Snapshot, guarded};
use uuid::Uuid;

use crate::error::CallError;
use crate::log::Logger;
use crate::order::Function;
use crate::status::Status;
use crate::version::Version;

/// What most calls answer.
pub type Answer = Result<Status, CallError>;

/// One instance, as the functions of the boundary see it. Variables go by the numbers of their entries.
pub struct Instance<V: Version, M> {
    /// What the description is tied by: the identifier of the library, or what the FMU was packed with made another of it.
    identity: Uuid,
    logger: Logger<V::Sink>,
    model: fmi_model::Instance<M>,
    /// The texts that were handed out last; they hold until others are.
    texts: Vec<CString>,
}

impl<V: Version, M: Model> Instance<V, M> {
    pub(crate) fn new(identity: Uuid, logger: Logger<V::Sink>, resources: Option<PathBuf>) -> Self {
        Self {
            identity,
            logger,
            model: resources.map_or_else(fmi_model::Instance::new, fmi_model::Instance::with_resources),
            texts: Vec::new(),
        }
    }

    /// Runs one call: call order first, then `body`, and the reason of any failure to the log. After a panic the instance
    /// answers nothing but fatal.
    pub(crate) fn run(&mut self, function: &Function, body: impl FnOnce(&mut Self) -> Answer) -> Status {
        if self.model.phase() == Phase::Fatal {
            return Status::Fatal;
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
            self.explain(Status::Fatal, function, &panic);
            Status::Fatal
        })
    }

    fn explain(&self, status: Status, function: &Function, reason: &str) {
        let message = format!("{}: {reason}", function.name);
        self.logger.explain(status, &message);
    }

    /// Hands the instance to `body` with the log of the call, whose warnings become the status.
    fn logged(
        &mut self,
        body: impl FnOnce(&mut fmi_model::Instance<M>, &mut Log<'_>) -> Result<(), InstanceError>,
    ) -> Answer {
        let mut log = Log::new(&self.logger);
        body(&mut self.model, &mut log)?;
        Ok(if log.warned() { Status::Warning } else { Status::Ok })
    }

    // Life cycle.

    pub(crate) fn set_debug_logging(&mut self, function: &Function, logging_on: bool, categories: &[&str]) -> Answer {
        let known: Vec<Category> = categories.iter().filter_map(|name| Category::from_name(name)).collect();
        // Those of the standard that this FMU has no use for are no reason to give the simulation up.
        let all_known = known.len() == categories.len();
        if all_known || !known.is_empty() {
            self.logger.want(logging_on, &known);
        }
        Ok(if all_known {
            Status::Ok
        } else {
            self.not_known(function, categories)
        })
    }

    /// Tells which categories are unknown.
    fn not_known(&self, function: &Function, categories: &[&str]) -> Status {
        let unknown = categories.iter().filter(|name| Category::from_name(name).is_none());
        let error = CallError::UnknownCategory {
            given: unknown.copied().collect::<Vec<_>>().join("', '"),
            known: Category::ALL.map(Category::name).join(", "),
        };
        self.explain(Status::Warning, function, &error.to_string());
        Status::Warning
    }

    /// Takes the times of the simulation.
    ///
    /// # Errors
    /// Times that cannot be.
    pub fn setup_experiment(&mut self, experiment: Experiment) -> Answer {
        self.model.setup_experiment(experiment)?;
        Ok(Status::Ok)
    }

    /// Initialization begins.
    ///
    /// # Errors
    /// Why the model could not initialise.
    pub fn enter_initialization_mode(&mut self) -> Answer {
        self.logged(fmi_model::Instance::enter_initialization)
    }

    /// Initialization ends.
    ///
    /// # Errors
    /// Why the model could not initialise.
    pub fn exit_initialization_mode(&mut self) -> Answer {
        self.logged(fmi_model::Instance::exit_initialization)
    }

    /// The simulation is over.
    ///
    /// # Errors
    /// None.
    pub fn terminate(&mut self) -> Answer {
        self.logged(|model, log| {
            model.terminate(log);
            Ok(())
        })
    }

    /// As it was created.
    ///
    /// # Errors
    /// None.
    pub fn reset(&mut self) -> Answer {
        self.model.reset();
        Ok(Status::Ok)
    }

    // Variables.

    /// Hands the value of each entry to `put`, with its place among `entries`.
    ///
    /// # Errors
    /// Why the instance refused, or why the model could not initialise.
    pub fn get<T: Scalar>(&mut self, entries: impl Iterator<Item = u32> + Clone, put: impl FnMut(usize, T)) -> Answer {
        self.logged(|model, log| model.get_entries(entries, log, put))
    }

    /// Like [`get`](Self::get), for texts that live until the next call of this function.
    ///
    /// # Errors
    /// As for [`get`](Self::get), and a text that C has no way to write.
    pub fn get_texts(
        &mut self,
        entries: impl Iterator<Item = u32> + Clone,
        mut put: impl FnMut(usize, &CString),
    ) -> Answer {
        let mut values = Vec::new();
        let status = self.get(entries.clone(), |_, value: String| values.push(value))?;
        let mut texts = Vec::with_capacity(values.len());
        for (value, entry) in values.into_iter().zip(entries) {
            let unfit = |_| {
                let name = M::table().entry(entry).map(|entry| entry.name().into_owned());
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

    /// Sets entries; `value` gives the value at a place among `entries`.
    ///
    /// # Errors
    /// Why the instance refused.
    pub fn set<T: Checked>(
        &mut self,
        entries: impl Iterator<Item = u32> + Clone,
        value: impl Fn(usize) -> T,
    ) -> Answer {
        self.model.set_entries(entries, value)?;
        Ok(Status::Ok)
    }

    // Steps.

    /// Advances from `t` to `t + h`, s.
    ///
    /// # Errors
    /// Why the instance refused, or why the model failed.
    pub fn do_step(&mut self, t: f64, h: f64) -> Answer {
        self.logged(|model, log| model.do_step(t, h, log))
    }

    /// End of the last successful step, s; before the first one the start time.
    pub fn time(&self) -> f64 {
        self.model.time()
    }

    // Saved states.

    /// Whose states it takes.
    pub(crate) fn identity(&self) -> Uuid {
        self.identity
    }

    pub(crate) fn state(&self) -> &Snapshot<M> {
        self.model.state()
    }

    pub(crate) fn set_state(&mut self, state: &Snapshot<M>) -> Answer {
        self.model.set_state(state.clone());
        Ok(Status::Ok)
    }
}
