//! The fixed-step master.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use fmi2_import::{Experiment, Value};

use crate::exchange::{Bundle, Routes};
use crate::system::{Member, PortAt};
use crate::timing::{Meter, Part};
use crate::units::{Relation, relation};
use crate::{CosimError, Port, Sample, Slave, SlaveError, SlaveId, System};

/// Order of exchange and stepping within one communication step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// One slave after the other: each is given the newest values of those before it, then steps.
    GaussSeidel,
    /// All are given the values at the beginning of the step, then all step: values arrive one step later.
    Jacobi,
}

/// What a failing slave means for the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OnSlaveError {
    /// The run ends with the error.
    Stop,
    /// The slave and those that depend on it, directly or through others, leave the run; the rest goes on.
    Isolate,
}

/// How to run a system. The default runs from 0 s to 1 s in one Gauss-Seidel step and stops at the first error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunOptions {
    /// Start time t0, s.
    pub start: f64,
    /// Stop time, s. The last communication point is the last `start + k * step` that does not exceed it.
    pub stop: f64,
    /// Communication step h, s.
    pub step: f64,
    /// Relative tolerance, for slaves that control their own error.
    pub tolerance: Option<f64>,
    /// Order of exchange and stepping.
    pub scheme: Scheme,
    /// What a failing slave means for the others.
    pub on_slave_error: OnSlaveError,
    /// Whether to measure where the time goes, see [`crate::SlaveTiming`].
    pub timing: bool,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            start: 0.0,
            stop: 1.0,
            step: 1.0,
            tolerance: None,
            scheme: Scheme::GaussSeidel,
            on_slave_error: OnSlaveError::Stop,
            timing: false,
        }
    }
}

impl RunOptions {
    /// Number of whole steps between start and stop.
    fn steps(&self) -> Result<u64, CosimError> {
        let &Self { start, stop, step, .. } = self;
        if !(step.is_finite() && step > 0.0) {
            return Err(CosimError::StepSize { step });
        }
        if !(start.is_finite() && stop.is_finite() && stop >= start) {
            return Err(CosimError::Interval { start, stop });
        }
        let exact = (stop - start) / step;
        if exact >= 2_f64.powi(53) {
            return Err(CosimError::StepSize { step });
        }
        // 0.3 / 0.1 is just below 3: a quotient within rounding of a whole number is meant to be it.
        let nearest = exact.round();
        let whole = if (exact - nearest).abs() <= 1e-9 * nearest.max(1.0) {
            nearest
        } else {
            exact.floor()
        };
        Ok(whole as u64)
    }
}

/// A slave that left the run before its end.
#[derive(Debug, Clone)]
pub struct Isolated {
    /// The slave.
    pub slave: SlaveId,
    /// Its name.
    pub name: String,
    /// Communication point at which it left, s; for a failed step, the point at which the step began.
    pub time: f64,
    /// [`CosimError::Slave`] for the slave that failed, [`CosimError::Upstream`] for those that depend on it.
    pub error: CosimError,
}

/// How a run went.
#[derive(Debug, Clone)]
#[must_use]
pub struct RunReport<B> {
    /// Steps completed.
    pub steps: u64,
    /// What the callback ended the run with, if it did.
    pub broke: Option<B>,
    /// Slaves that left the run, in the order in which they did.
    pub isolated: Vec<Isolated>,
    /// One entry per slave, in their order; empty unless [`RunOptions::timing`] asks for it.
    pub timings: Vec<crate::SlaveTiming>,
}

/// The system at a communication point, as the callback of [`System::run`] sees it.
pub struct StepContext<'a> {
    run: &'a mut Run,
    members: &'a mut [Member],
    step: u64,
}

impl StepContext<'_> {
    /// Steps completed, k; 0 after initialization.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Time of the communication point, `start + k * step`, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.run.time
    }

    /// Whether a slave still takes part.
    #[must_use]
    pub fn is_active(&self, slave: SlaveId) -> bool {
        self.run.active.get(slave.0).copied().unwrap_or(false)
    }

    /// Reads all variables of the sample, one call per type.
    ///
    /// # Errors
    /// [`CosimError::Inactive`], [`CosimError::UnknownSlave`], or [`CosimError::Slave`] if the slave fails. Such a failure
    /// has the same consequence as in a step: the slave leaves the run, or the run ends after this callback.
    pub fn read(&mut self, sample: &mut Sample) -> Result<(), CosimError> {
        let i = sample.slave.0;
        let Some(member) = self.members.get_mut(i) else {
            return Err(CosimError::UnknownSlave {
                index: i,
                count: self.members.len(),
            });
        };
        if !self.run.active[i] {
            return Err(CosimError::Inactive {
                slave: member.name.clone(),
            });
        }
        let result = (self.run.meter).take_apart(i, Part::Get, || sample.bundle.get(member.slave.as_mut()));
        let Err(error) = result else {
            sample.convert();
            return Ok(());
        };
        let error = CosimError::Slave {
            slave: member.name.clone(),
            time: self.run.time,
            error,
        };
        if let Err(stop) = self.run.leave(self.members, i, error.clone()) {
            self.run.stopped.get_or_insert(stop);
        }
        Err(error)
    }
}

/// State of one run. Vectors run over the slaves in their order.
struct Run {
    options: RunOptions,
    /// Current communication point, s.
    time: f64,
    active: Vec<bool>,
    /// Newest connected outputs.
    outputs: Vec<Bundle>,
    /// Connected inputs.
    inputs: Vec<Bundle>,
    routes: Vec<Routes>,
    /// Slaves fed by each slave, directly or through others.
    dependents: Vec<Vec<usize>>,
    meter: Meter,
    isolated: Vec<Isolated>,
    /// Error of a reading in the callback that ends the run.
    stopped: Option<CosimError>,
}

impl System {
    /// Runs the whole life cycle: setup, start values, initialization with an exchange of values in the order of the
    /// slaves, steps, termination.
    ///
    /// `each` is called after initialization, when [`StepContext::step`] is 0, and after every step. It may end the run
    /// with [`ControlFlow::Break`].
    ///
    /// A system runs once; call [`System::reset`] before another run.
    ///
    /// # Errors
    /// [`CosimError::StepSize`] or [`CosimError::Interval`]; with [`crate::OnSlaveError::Stop`] also the
    /// [`CosimError::Slave`] that ended the run.
    pub fn run<B>(
        &mut self,
        options: &RunOptions,
        each: impl FnMut(&mut StepContext<'_>) -> ControlFlow<B>,
    ) -> Result<RunReport<B>, CosimError> {
        run(self, options, each)
    }
}

fn run<B>(
    system: &mut System,
    options: &RunOptions,
    mut each: impl FnMut(&mut StepContext<'_>) -> ControlFlow<B>,
) -> Result<RunReport<B>, CosimError> {
    let steps = options.steps()?;
    let feedback = feeds_earlier(&system.connections, system.members.len());
    let mut run = Run::new(&system.members, &system.connections, *options);
    let members = system.members.as_mut_slice();
    run.initialize(members, &feedback)?;

    let mut done = 0;
    let mut broke = None;
    // A slave that is left alone may go on; a run without any may not.
    while run.active.contains(&true) {
        if let ControlFlow::Break(reason) = each(&mut StepContext {
            run: &mut run,
            members,
            step: done,
        }) {
            broke = Some(reason);
        }
        if let Some(error) = run.stopped.take() {
            return Err(error);
        }
        if broke.is_some() || done == steps {
            break;
        }
        run.meter.next_step();
        match options.scheme {
            Scheme::GaussSeidel => run.step_gauss_seidel(members)?,
            Scheme::Jacobi => run.step_jacobi(members)?,
        }
        if run.active.contains(&true) {
            done += 1;
            // A product rather than a sum of steps, so that rounding does not pile up.
            run.time = options.start + done as f64 * options.step;
        }
    }
    run.terminate(members)?;
    Ok(RunReport {
        steps: done,
        broke,
        isolated: run.isolated,
        timings: run.meter.finish(members.iter().map(|m| m.name.as_str())),
    })
}

impl Run {
    fn new(members: &[Member], connections: &[(PortAt, PortAt)], options: RunOptions) -> Self {
        let count = members.len();
        let mut outputs = vec![Bundle::default(); count];
        let mut inputs = vec![Bundle::default(); count];
        let mut routes = vec![Routes::default(); count];
        // An output that feeds several inputs is fetched once.
        let mut places: HashMap<PortAt, usize> = HashMap::new();
        for &(from, to) in connections {
            let (output, input) = (&members[from.0].ports[from.1], &members[to.0].ports[to.1]);
            let start = *places
                .entry(from)
                .or_insert_with(|| outputs[from.0].push(output.kind, output.reference));
            let end = inputs[to.0].push(input.kind, input.reference);
            routes[to.0].push(output.kind, from.0, start, end);
            if let Relation::Same(Some(conversion)) = relation(output, input) {
                routes[to.0].convert(end, conversion);
            }
        }
        Self {
            options,
            time: options.start,
            active: vec![true; count],
            outputs,
            inputs,
            routes,
            dependents: (0..count).map(|i| dependents(connections, i)).collect(),
            meter: Meter::new(options.timing, count),
            isolated: Vec::new(),
            stopped: None,
        }
    }

    fn initialize(&mut self, members: &mut [Member], feedback: &[bool]) -> Result<(), CosimError> {
        let experiment = Experiment {
            start_time: self.options.start,
            stop_time: Some(self.options.stop),
            tolerance: self.options.tolerance,
        };
        self.for_each(members, |_, _, slave| slave.setup(&experiment))?;
        for i in 0..members.len() {
            if self.active[i] {
                let Member {
                    slave, ports, starts, ..
                } = &mut members[i];
                let result = starts
                    .iter()
                    .try_for_each(|(at, value)| set_one(slave.as_mut(), &ports[*at], value));
                self.note(members, i, result)?;
            }
        }
        self.for_each(members, |_, _, slave| slave.enter_initialization())?;
        // A slave that feeds an earlier one has its first values fetched before that one is served.
        self.for_each(
            members,
            |run, i, slave| if feedback[i] { run.fetch(i, slave) } else { Ok(()) },
        )?;
        self.for_each(members, |run, i, slave| {
            run.serve(i, slave)?;
            run.fetch(i, slave)
        })?;
        self.for_each(members, |_, _, slave| slave.exit_initialization())?;
        // Leaving initialization may have settled the outputs.
        self.for_each(members, Self::fetch)?;
        Ok(())
    }

    fn step_gauss_seidel(&mut self, members: &mut [Member]) -> Result<(), CosimError> {
        self.for_each(members, |run, i, slave| {
            run.serve(i, slave)?;
            run.advance(i, slave)?;
            run.fetch(i, slave)
        })
    }

    fn step_jacobi(&mut self, members: &mut [Member]) -> Result<(), CosimError> {
        self.for_each(members, Self::serve)?;
        self.for_each(members, Self::advance)?;
        self.for_each(members, Self::fetch)
    }

    /// Terminates every slave that still takes part. A failure concerns no other slave: all of them have their results.
    fn terminate(&mut self, members: &mut [Member]) -> Result<(), CosimError> {
        self.dependents.iter_mut().for_each(Vec::clear);
        self.for_each(members, |_, _, slave| slave.terminate())
    }

    /// Hands the newest outputs of its sources to slave `i`.
    fn serve(&mut self, i: usize, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        let (routes, outputs, inputs) = (&self.routes[i], &self.outputs, &mut self.inputs[i]);
        self.meter.take(i, Part::Set, || {
            routes.gather(outputs, inputs);
            inputs.set(slave)
        })
    }

    fn advance(&mut self, i: usize, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        let (time, step) = (self.time, self.options.step);
        self.meter.take(i, Part::Step, || slave.do_step(time, step))
    }

    /// Fetches the connected outputs of slave `i`.
    fn fetch(&mut self, i: usize, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        let outputs = &mut self.outputs[i];
        self.meter.take(i, Part::Get, || outputs.get(slave))
    }

    /// Calls `action` for each slave that still takes part, in order.
    fn for_each(
        &mut self,
        members: &mut [Member],
        mut action: impl FnMut(&mut Self, usize, &mut dyn Slave) -> Result<(), SlaveError>,
    ) -> Result<(), CosimError> {
        for i in 0..members.len() {
            if self.active[i] {
                let result = action(self, i, members[i].slave.as_mut());
                self.note(members, i, result)?;
            }
        }
        Ok(())
    }

    /// Draws the consequence of a failed call, if it failed.
    fn note(&mut self, members: &[Member], i: usize, result: Result<(), SlaveError>) -> Result<(), CosimError> {
        match result {
            Ok(()) => Ok(()),
            Err(error) => {
                let error = CosimError::Slave {
                    slave: members[i].name.clone(),
                    time: self.time,
                    error,
                };
                self.leave(members, i, error)
            }
        }
    }

    /// Takes slave `i` and its dependents out of the run, or ends the run, as the options say.
    fn leave(&mut self, members: &[Member], i: usize, error: CosimError) -> Result<(), CosimError> {
        if self.options.on_slave_error == OnSlaveError::Stop {
            return Err(error);
        }
        let time = self.time;
        self.active[i] = false;
        let cause = Arc::new(error.clone());
        self.isolated.push(Isolated {
            slave: SlaveId(i),
            name: members[i].name.clone(),
            time,
            error,
        });
        for (d, member) in members.iter().enumerate() {
            if self.active[d] && self.dependents[i].contains(&d) {
                self.active[d] = false;
                let name = member.name.clone();
                let error = CosimError::Upstream {
                    slave: name.clone(),
                    time,
                    cause: Arc::clone(&cause),
                };
                self.isolated.push(Isolated {
                    slave: SlaveId(d),
                    name,
                    time,
                    error,
                });
            }
        }
        Ok(())
    }
}

/// Sets one start value; an error says which.
fn set_one(slave: &mut dyn Slave, port: &Port, value: &Value) -> Result<(), SlaveError> {
    let reference = &[port.reference];
    match value {
        Value::Real(v) => slave.set_real(reference, &[*v]),
        Value::Integer(v) => slave.set_integer(reference, &[*v]),
        Value::Boolean(v) => slave.set_boolean(reference, &[*v]),
        Value::String(v) => slave.set_string(reference, std::slice::from_ref(v)),
    }
    .map_err(|mut error| {
        error.messages.push(format!("while setting {:?} to {value}", port.name));
        error
    })
}

/// For each slave, whether it feeds itself or one before it.
fn feeds_earlier(connections: &[(PortAt, PortAt)], count: usize) -> Vec<bool> {
    let mut feeds = vec![false; count];
    for (from, to) in connections {
        feeds[from.0] |= to.0 <= from.0;
    }
    feeds
}

/// Slaves fed by slave `i`, directly or through others; without `i` itself.
fn dependents(connections: &[(PortAt, PortAt)], i: usize) -> Vec<usize> {
    let mut reached = vec![i];
    let mut next = 0;
    while next < reached.len() {
        for (from, to) in connections {
            if from.0 == reached[next] && !reached.contains(&to.0) {
                reached.push(to.0);
            }
        }
        next += 1;
    }
    reached.swap_remove(0);
    reached
}
