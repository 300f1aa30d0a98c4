//! One instance of a model: what each call does.
//!
//! A call that is refused (unknown or unfit variable, value out of bounds, times that do not fit) changes nothing and leaves the
//! instance usable: arrays are checked whole before the first value is applied.

use std::path::PathBuf;

use crate::check::{Checked, check_settable, finite};
use crate::error::InstanceError;
use crate::log::Log;
use crate::lookup::Lookup;
use crate::model::{Experiment, Model, ModelError};
use crate::phase::Phase;
use crate::snapshot::Snapshot;
use crate::variable::Scalar;

/// One instance of a model.
///
/// The methods follow the calls of the standard. Which of them a [`Phase`] allows is for the exporter to check, since the
/// versions of the standard differ in it; here only setting variables depends on the phase. Variables go by the numbers of
/// their entries, see [`Table::entry`](crate::Table::entry).
#[derive(Debug)]
pub struct Instance<M> {
    state: Snapshot<M>,
    /// Where the FMU's resources are; not part of a state, which may be restored elsewhere.
    resources: Option<PathBuf>,
}

impl<M: Model> Default for Instance<M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M: Model> Instance<M> {
    /// A new instance with the start column applied.
    pub fn new() -> Self {
        Self {
            state: Snapshot::start(),
            resources: None,
        }
    }

    /// A new instance of an FMU whose resources are in `folder`.
    pub fn with_resources(folder: PathBuf) -> Self {
        let mut new = Self {
            resources: Some(folder),
            ..Self::new()
        };
        new.locate();
        new
    }

    /// Tells the model where its resources are: here, wherever they were for the instance that a state comes from.
    fn locate(&mut self) {
        self.state.model.set_resources(self.resources.as_deref());
    }

    /// Where it is in its life.
    pub fn phase(&self) -> Phase {
        self.state.phase
    }

    /// End of the last successful step, s; before the first one the start time.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Gives the instance up after a panic.
    pub fn poison(&mut self) {
        self.state.phase = Phase::Fatal;
    }

    // Life cycle.

    /// Takes the times of the simulation.
    ///
    /// # Errors
    /// [`InstanceError::NotFinite`], [`InstanceError::StopBeforeStart`] or [`InstanceError::BadTolerance`].
    pub fn setup_experiment(&mut self, experiment: Experiment) -> Result<(), InstanceError> {
        let start = experiment.start_time;
        finite("start time", start)?;
        if let Some(stop) = experiment.stop_time {
            finite("stop time", stop)?;
            if stop < start {
                return Err(InstanceError::StopBeforeStart { start, stop });
            }
        }
        if let Some(tolerance) = experiment.tolerance {
            finite("tolerance", tolerance)?;
            if tolerance <= 0.0 {
                return Err(InstanceError::BadTolerance { tolerance });
            }
        }
        self.state.experiment = experiment;
        self.state.time = start;
        Ok(())
    }

    /// Initialization begins: the model initialises.
    ///
    /// # Errors
    /// [`InstanceError::Model`].
    pub fn enter_initialization(&mut self, log: &mut Log<'_>) -> Result<(), InstanceError> {
        self.state.phase = Phase::Initialization;
        self.state.stale = true;
        self.refresh(log).map_err(|error| self.fail(error))
    }

    /// Initialization ends; if a variable was set since the model initialised, it does so once more.
    ///
    /// # Errors
    /// [`InstanceError::Model`].
    pub fn exit_initialization(&mut self, log: &mut Log<'_>) -> Result<(), InstanceError> {
        self.refresh(log).map_err(|error| self.fail(error))?;
        self.state.model.initialised(&self.state.experiment, log);
        self.state.phase = Phase::StepComplete;
        Ok(())
    }

    fn fail(&mut self, error: ModelError) -> InstanceError {
        self.state.phase = Phase::Failed;
        InstanceError::Model(error)
    }

    /// The simulation is over.
    pub fn terminate(&mut self, log: &mut Log<'_>) {
        self.state.model.terminate(log);
        self.state.phase = Phase::Terminated;
    }

    /// As after [`Instance::new`].
    pub fn reset(&mut self) {
        self.state = Snapshot::start();
        self.locate();
    }

    /// Lets the model initialise if a variable was set since it last did.
    fn refresh(&mut self, log: &mut Log<'_>) -> Result<(), ModelError> {
        let state = &mut self.state;
        if state.phase == Phase::Initialization && state.stale {
            state.model.initialise(&state.experiment, log)?;
            state.stale = false;
        }
        Ok(())
    }

    // Variables.

    /// Hands the value of each entry to `put`, with its place in `references`.
    ///
    /// # Errors
    /// [`InstanceError::UnknownReference`], [`InstanceError::WrongType`] or, in initialization, [`InstanceError::NotYet`].
    pub fn get<T: Scalar>(
        &mut self,
        references: &[u32],
        log: &mut Log<'_>,
        put: impl FnMut(usize, T),
    ) -> Result<(), InstanceError> {
        self.get_entries(references.iter().copied(), log, put)
    }

    /// [`get`](Self::get) for entries that do not stand in a list, such as those of whole rows.
    ///
    /// # Errors
    /// As for [`get`](Self::get).
    pub fn get_entries<T: Scalar>(
        &mut self,
        entries: impl Iterator<Item = u32> + Clone,
        log: &mut Log<'_>,
        mut put: impl FnMut(usize, T),
    ) -> Result<(), InstanceError> {
        let mut lookup = Lookup::<M, T>::new();
        for number in entries.clone() {
            lookup.entry(number)?;
        }
        self.refresh(log).map_err(InstanceError::NotYet)?;
        for (place, number) in entries.enumerate() {
            let (entry, access) = lookup.entry(number)?;
            put(place, access.read(&self.state.model, entry.element));
        }
        Ok(())
    }

    /// Sets entries; `value` gives the value at a place in `references`.
    ///
    /// # Errors
    /// [`InstanceError::UnknownReference`], [`InstanceError::WrongType`], [`InstanceError::NotSettable`], or why the entry
    /// does not take the value.
    pub fn set<T: Checked>(&mut self, references: &[u32], value: impl Fn(usize) -> T) -> Result<(), InstanceError> {
        self.set_entries(references.iter().copied(), value)
    }

    /// [`set`](Self::set) for entries that do not stand in a list, such as those of whole rows.
    ///
    /// # Errors
    /// As for [`set`](Self::set).
    pub fn set_entries<T: Checked>(
        &mut self,
        entries: impl Iterator<Item = u32> + Clone,
        value: impl Fn(usize) -> T,
    ) -> Result<(), InstanceError> {
        let mut lookup = Lookup::<M, T>::new();
        let mut any = false;
        for (place, number) in entries.clone().enumerate() {
            let (entry, _) = lookup.entry(number)?;
            check_settable(entry, self.state.phase)?;
            T::check(&value(place), entry)?;
            any = true;
        }
        for (place, number) in entries.enumerate() {
            let (entry, access) = lookup.entry(number)?;
            access.write(&mut self.state.model, entry.element, value(place));
        }
        self.state.stale |= self.state.phase == Phase::Initialization && any;
        Ok(())
    }

    // Steps.

    /// Advances from `t` to `t + h`, s.
    ///
    /// # Errors
    /// [`InstanceError::NotFinite`], [`InstanceError::BadStep`], [`InstanceError::TimeMismatch`],
    /// [`InstanceError::StepRefused`] or [`InstanceError::Model`].
    pub fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), InstanceError> {
        finite("communication point", t)?;
        finite("communication step size", h)?;
        if h <= 0.0 {
            return Err(InstanceError::BadStep { h });
        }
        finite("end of the step", t + h)?;
        let expected = self.state.time;
        if (t - expected).abs() > slack(t, expected, h) {
            return Err(InstanceError::TimeMismatch { t, expected });
        }
        let model = &mut self.state.model;
        model.check_step(t, h).map_err(InstanceError::StepRefused)?;
        model.do_step(t, h, log).map_err(|error| self.fail(error))?;
        self.state.time = t + h;
        Ok(())
    }

    // Saved states.

    /// All that later calls depend on.
    pub fn state(&self) -> &Snapshot<M> {
        &self.state
    }

    /// Back, or on, to a state of this or another instance of the model.
    pub fn set_state(&mut self, state: Snapshot<M>) {
        self.state = state;
        self.locate();
    }
}

/// How far, s, the beginning of a step of `h` may lie from the end of the last one: the rounding of masters that count their steps or
/// add them up. It is that of one step each, as every end is `t + h` of the master's own `t`, however late the start time.
fn slack(t: f64, expected: f64, h: f64) -> f64 {
    (8.0 * f64::EPSILON * t.abs().max(expected.abs())).max(1e-9) + 1e-6 * h
}
