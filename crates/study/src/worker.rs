//! The other end of [`crate::Workers`]: a process that makes runs for another, and may die of somebody's FMU.
//!
//! Requests come on standard input, answers go to what was standard output. What an FMU prints goes to standard error, where
//! the parent keeps the end of it.

use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use cosim::{Port, Slave, SlaveError};
use fmi2_import::Experiment;
use serde::{Deserialize, Serialize};

use crate::error::{StudyError, chain};
use crate::outcome::Outcome;
use crate::participant::SlaveSource;
use crate::run::{call_time, rehearse};
use crate::spec::Spec;

/// What a worker is asked for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Request {
    /// A run with some of the filters, by their places in the study.
    Run { run: u32, filters: Vec<usize> },
    /// Whether they start.
    Rehearse { filters: Vec<usize> },
    /// What a call of one costs.
    CallTime { filter: usize },
}

/// What it answers, but for a run.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Answer {
    /// Inputs that nothing feeds, or why one does not start.
    Rehearsed(Result<Vec<String>, String>),
    /// What a call costs.
    CallTime(Duration),
    /// A call has not come back in time: whose, by its place among the participants: truth, filters, drivers.
    Stuck { participant: usize },
}

/// Limits of a worker.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Longest time of one call of an FMU, s.
    pub call_s: f64,
    /// Longest time of a run, s.
    pub run_s: f64,
    /// Most memory that a worker may take, bytes.
    pub memory: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            call_s: 60.0,
            run_s: 3600.0,
            memory: 2 << 30,
        }
    }
}

/// Serves a parent until it closes standard input.
///
/// # Errors
/// When the parent is gone, or the system refuses the limits.
#[cfg(unix)]
pub fn serve(mut spec: Spec, limits: Limits) -> Result<(), StudyError> {
    let failed = |source: io::Error| StudyError::Worker { source };
    rlimit::Resource::AS.set(limits.memory, limits.memory).map_err(failed)?;
    // Nobody needs the memory of a process that died of somebody's FMU.
    rlimit::Resource::CORE.set(0, 0).map_err(failed)?;
    let answers = rustix::io::dup(rustix::stdio::stdout()).map_err(|e| failed(e.into()))?;
    rustix::stdio::dup2_stdout(rustix::stdio::stderr()).map_err(|e| failed(e.into()))?;
    let answers = Arc::new(Mutex::new(std::fs::File::from(answers)));
    let watch = Arc::new(Watch::default());
    let parts = std::iter::once(&mut spec.truth)
        .chain(&mut spec.filters)
        .chain(&mut spec.drivers);
    for (index, part) in parts.enumerate() {
        part.source = Arc::new(Watched {
            inner: Arc::clone(&part.source),
            participant: index,
            watch: Arc::clone(&watch),
        });
    }
    let (for_guard, limit) = (Arc::clone(&answers), Duration::from_secs_f64(limits.call_s));
    thread::spawn(move || watch.guard(limit, &for_guard));

    let mut some = HashMap::new();
    let mut message = Vec::new();
    let mut input = io::stdin().lock();
    while let Some(Message::Other(request)) = receive::<Request>(&mut input).map_err(failed)? {
        let answer = match request {
            Request::Run { run, filters } => {
                let spec = some.entry(filters).or_insert_with_key(|filters| spec.subset(filters));
                message = Outcome::of(spec, run)
                    .to_bytes(begun(message, RUN))
                    .map_err(|e| failed(io::Error::other(e)))?;
                let mut output = answers.lock().unwrap_or_else(PoisonError::into_inner);
                finish(&mut *output, &mut message).map_err(failed)?;
                continue;
            }
            Request::Rehearse { filters } => {
                Answer::Rehearsed(rehearse(&spec.subset(&filters)).map_err(|error| chain(&error)))
            }
            Request::CallTime { filter } => {
                let time = spec
                    .filters
                    .get(filter)
                    .and_then(|filter| call_time(&spec, filter).ok());
                Answer::CallTime(time.unwrap_or_default())
            }
        };
        let mut output = answers.lock().unwrap_or_else(PoisonError::into_inner);
        send(&mut *output, &answer).map_err(failed)?;
    }
    Ok(())
}

/// Kinds of messages: a run, whose bytes are many and stand as they are, and anything else.
const RUN: u8 = 1;
const OTHER: u8 = 0;

/// A message as it arrives.
#[derive(Debug)]
pub(crate) enum Message<T> {
    /// The bytes of an [`Outcome`].
    Run(Vec<u8>),
    /// Anything else.
    Other(T),
}

/// The head of a message in the memory of an earlier one: room for its length, and its kind.
fn begun(mut memory: Vec<u8>, kind: u8) -> Vec<u8> {
    memory.clear();
    memory.extend_from_slice(&[0, 0, 0, 0, kind]);
    memory
}

/// Writes a message that is all there but for its length.
fn finish(output: &mut impl Write, message: &mut [u8]) -> io::Result<()> {
    let length = u32::try_from(message.len() - 4).map_err(io::Error::other)?;
    message[..4].copy_from_slice(&length.to_le_bytes());
    output.write_all(message)?;
    output.flush()
}

/// Writes a message that is no run.
pub(crate) fn send(output: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let mut bytes = postcard::to_extend(message, begun(Vec::new(), OTHER)).map_err(io::Error::other)?;
    finish(output, &mut bytes)
}

/// Reads a message; `None` where the other side has closed.
pub(crate) fn receive<T: for<'de> Deserialize<'de>>(input: &mut impl Read) -> io::Result<Option<Message<T>>> {
    let mut length = [0; 4];
    match input.read_exact(&mut length) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        other => other?,
    }
    let mut kind = [0];
    input.read_exact(&mut kind)?;
    // As much memory as bytes come, whatever length is claimed.
    let length = u64::from(u32::from_le_bytes(length)).saturating_sub(1);
    let mut bytes = Vec::new();
    if input.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    if kind == [RUN] {
        return Ok(Some(Message::Run(bytes)));
    }
    let other = postcard::from_bytes(&bytes).map_err(io::Error::other)?;
    Ok(Some(Message::Other(other)))
}

/// Which call a worker is in.
#[derive(Default)]
struct Watch {
    /// Calls begun and ended: odd within one.
    calls: AtomicU64,
    /// Whose it is.
    participant: AtomicUsize,
}

impl Watch {
    fn during<T>(&self, participant: usize, call: impl FnOnce() -> T) -> T {
        self.participant.store(participant, Ordering::Relaxed);
        self.calls.fetch_add(1, Ordering::Release);
        let result = call();
        self.calls.fetch_add(1, Ordering::Release);
        result
    }

    /// Ends the process when a call does not come back.
    fn guard(&self, limit: Duration, answers: &Mutex<impl Write>) {
        let mut last = 0;
        let mut since = std::time::Instant::now();
        loop {
            thread::sleep(limit.min(Duration::from_secs(1)) / 20);
            let now = self.calls.load(Ordering::Acquire);
            if now != last || now.is_multiple_of(2) {
                (last, since) = (now, std::time::Instant::now());
            } else if since.elapsed() > limit {
                let participant = self.participant.load(Ordering::Relaxed);
                let mut output = answers.lock().unwrap_or_else(PoisonError::into_inner);
                // Whether or not the parent hears of it.
                let _ = send(&mut *output, &Answer::Stuck { participant });
                // At once: what would be tidied up belongs to the FMU that hangs.
                std::process::abort();
            }
        }
    }
}

/// A source whose slaves tell the watch of their calls.
struct Watched {
    inner: Arc<dyn SlaveSource>,
    participant: usize,
    watch: Arc<Watch>,
}

impl SlaveSource for Watched {
    fn create(&self, name: &str) -> Result<Box<dyn Slave>, StudyError> {
        let inner = self.watch.during(self.participant, || self.inner.create(name))?;
        Ok(Box::new(WatchedSlave {
            inner: Some(inner),
            participant: self.participant,
            watch: Arc::clone(&self.watch),
        }))
    }
}

struct WatchedSlave {
    /// Taken when it is dropped, which is a call, too.
    inner: Option<Box<dyn Slave>>,
    participant: usize,
    watch: Arc<Watch>,
}

impl WatchedSlave {
    fn call<T>(&mut self, call: impl FnOnce(&mut dyn Slave) -> Result<T, SlaveError>) -> Result<T, SlaveError> {
        match &mut self.inner {
            Some(inner) => self.watch.during(self.participant, || call(inner.as_mut())),
            None => Err(SlaveError::new("the FMI call", "the slave is gone")),
        }
    }
}

impl Drop for WatchedSlave {
    fn drop(&mut self) {
        let inner = self.inner.take();
        self.watch.during(self.participant, || drop(inner));
    }
}

/// The methods that only pass on what they are given.
macro_rules! passed_on {
    ($($name:ident($($argument:ident: $type:ty),*);)+) => {$(
        fn $name(&mut self, $($argument: $type),*) -> Result<(), SlaveError> {
            self.call(|slave| slave.$name($($argument),*))
        }
    )+};
}

impl Slave for WatchedSlave {
    fn name(&self) -> &str {
        self.inner.as_ref().map_or("", |inner| inner.name())
    }

    fn ports(&self) -> Vec<Port> {
        self.inner.as_ref().map(|inner| inner.ports()).unwrap_or_default()
    }

    fn messages(&mut self) -> Vec<String> {
        self.inner.as_mut().map(|inner| inner.messages()).unwrap_or_default()
    }

    passed_on! {
        setup(experiment: &Experiment);
        enter_initialization();
        exit_initialization();
        do_step(t: f64, h: f64);
        terminate();
        reset();
        get_real(references: &[u32], values: &mut [f64]);
        set_real(references: &[u32], values: &[f64]);
        get_integer(references: &[u32], values: &mut [i32]);
        set_integer(references: &[u32], values: &[i32]);
        get_boolean(references: &[u32], values: &mut [bool]);
        set_boolean(references: &[u32], values: &[bool]);
        get_string(references: &[u32], values: &mut [String]);
        set_string(references: &[u32], values: &[String]);
    }
}
