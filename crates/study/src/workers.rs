//! Runs made by other processes, so that an FMU that crashes, loops or eats memory costs its own runs and nothing else.

use std::collections::BTreeSet;
use std::io::{self, Read};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::StudyError;
use crate::fold::RunRow;
use crate::outcome::{Outcome, Part};
use crate::participant::Participant;
use crate::run::{Ending, Failure, SlaveTime};
use crate::spec::Spec;
use crate::stop::stop_asked;
use crate::worker::{Answer, Limits, Message, Request, receive, send};

/// How often a waiting parent looks whether it shall stop.
const LOOK: Duration = Duration::from_millis(50);
/// Bytes that are kept of what a worker's FMUs print.
const TAIL: usize = 2048;

/// Processes that make the runs of one study.
pub struct Workers {
    /// Makes the command line of a worker that calls [`crate::serve`].
    command: Box<dyn Fn() -> Command + Send + Sync>,
    limits: Limits,
    idle: Mutex<Vec<Worker>>,
    /// Filters that a worker has died of: each runs alone from then on.
    suspects: Mutex<BTreeSet<usize>>,
}

struct Worker {
    child: Child,
    requests: Option<ChildStdin>,
    answers: Receiver<io::Result<Option<Message<Answer>>>>,
    printed: Arc<Mutex<Vec<u8>>>,
    /// Closed when all that was printed is there.
    printing: Receiver<()>,
}

/// Why a worker has no answer.
enum Lost {
    /// Somebody asked to stop.
    Stopped,
    /// It could not be started.
    Start(io::Error),
    /// An FMU is to blame; whose, if it is known, by its place, truth first.
    Died {
        participant: Option<usize>,
        message: String,
    },
}

impl Workers {
    /// Workers of one study.
    ///
    /// * `command`: of a process that calls [`crate::serve`] with the same study and limits.
    pub fn new(command: impl Fn() -> Command + Send + Sync + 'static, limits: Limits) -> Self {
        Self {
            command: Box::new(command),
            limits,
            idle: Mutex::default(),
            suspects: Mutex::default(),
        }
    }

    /// As [`crate::rehearse`]; a filter that kills its worker is told, too, and no error: it may start another time.
    ///
    /// # Errors
    /// [`StudyError::Rehearsal`], [`StudyError::Worker`], [`StudyError::Stopped`].
    pub fn rehearse(&self, spec: &Spec) -> Result<Vec<String>, StudyError> {
        let mut told = Vec::new();
        for filter in 0..spec.filters.len() {
            match self.ask(&Request::Rehearse { filters: vec![filter] }) {
                Ok(Message::Other(Answer::Rehearsed(Ok(open)))) => {
                    // A driver takes part in the rehearsal of each filter.
                    let new: Vec<String> = open.into_iter().filter(|text| !told.contains(text)).collect();
                    told.extend(new);
                }
                Ok(Message::Other(Answer::Rehearsed(Err(why)))) => return Err(StudyError::Rehearsal { why }),
                Ok(_) => return Err(out_of_turn()),
                Err(Lost::Died { message, .. }) => told.push(format!("{}: {message}", spec.filters[filter].label)),
                Err(lost) => return Err(lost.into()),
            }
        }
        Ok(told)
    }

    /// As [`crate::call_time`]; nothing for a filter that kills its worker.
    pub fn call_time(&self, filter: usize) -> Duration {
        match self.ask(&Request::CallTime { filter }) {
            Ok(Message::Other(Answer::CallTime(time))) => time,
            _ => Duration::ZERO,
        }
    }

    /// Makes a run with some of the filters. One that kills its worker has failed this run; the others are run again
    /// without it.
    ///
    /// * `filters`: their places in the study.
    /// * returns: the run, with a part for each of them in the same order.
    ///
    /// # Errors
    /// [`StudyError::Worker`], [`StudyError::Stopped`].
    pub(crate) fn run(&self, spec: &Spec, filters: &[usize], run: u32) -> Result<Outcome, StudyError> {
        let suspects = self.suspects().clone();
        let (alone, together): (Vec<usize>, Vec<usize>) = filters.iter().partition(|f| suspects.contains(f));
        let mut groups: Vec<Vec<usize>> = alone.into_iter().map(|filter| vec![filter]).collect();
        groups.extend(Some(together).filter(|group| !group.is_empty()));
        let mut whole = Outcome::begun(run);
        let mut parts: Vec<Option<Part>> = spec.filters.iter().map(|_| None).collect();
        while let Some(filters) = groups.pop() {
            let request = Request::Run {
                run,
                filters: filters.clone(),
            };
            match self.ask(&request) {
                Ok(Message::Run(bytes)) => {
                    let mut outcome = Outcome::from_bytes(&bytes).map_err(|e| worker_error(io::Error::other(e)))?;
                    for (place, part) in filters.into_iter().zip(std::mem::take(&mut outcome.parts)) {
                        parts[place] = Some(part);
                    }
                    whole.join(outcome);
                }
                Ok(_) => return Err(out_of_turn()),
                Err(Lost::Died { participant, message }) => {
                    if let Some(driver) = participant.and_then(|p| driver(spec, p)) {
                        let message = format!("driver '{}': {message}", driver.label);
                        for place in filters {
                            parts[place] = Some(failed(spec, run, message.clone()));
                        }
                        continue;
                    }
                    let message = format!("{message}{}", with_drivers(spec));
                    let blamed = participant
                        .and_then(|p| p.checked_sub(1))
                        .filter(|place| filters.contains(place));
                    if let ([filter], _) | (_, Some(filter)) = (filters.as_slice(), blamed.as_ref()) {
                        self.suspects().insert(*filter);
                        parts[*filter] = Some(failed(spec, run, message));
                        let others: Vec<usize> = filters.iter().copied().filter(|other| other != filter).collect();
                        groups.extend(Some(others).filter(|group| !group.is_empty()));
                    } else {
                        groups.extend(filters.into_iter().map(|filter| vec![filter]));
                    }
                }
                Err(lost) => return Err(lost.into()),
            }
        }
        whole.parts = filters.iter().filter_map(|place| parts[*place].take()).collect();
        Ok(whole)
    }

    /// Asks a worker; one that has died is no longer there.
    fn ask(&self, request: &Request) -> Result<Message<Answer>, Lost> {
        let idle = self.idle().pop();
        let mut worker = match idle {
            Some(worker) => worker,
            None => Worker::start((self.command)()).map_err(Lost::Start)?,
        };
        let answer = worker.ask(request, self.limits)?;
        self.idle().push(worker);
        Ok(answer)
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Worker>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn suspects(&self) -> MutexGuard<'_, BTreeSet<usize>> {
        self.suspects.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The driver among the participants, which are truth, filters and drivers.
fn driver(spec: &Spec, participant: usize) -> Option<&Participant> {
    let place = participant.checked_sub(1 + spec.filters.len())?;
    spec.drivers.get(place)
}

/// What a message adds where a driver may be to blame.
fn with_drivers(spec: &Spec) -> String {
    let labels: Vec<&str> = spec.drivers.iter().map(|driver| driver.label.as_str()).collect();
    if labels.is_empty() {
        String::new()
    } else {
        format!("; it held the driver {}, too", labels.join(", "))
    }
}

/// The part of a filter that has no result.
fn failed(spec: &Spec, run: u32, message: String) -> Part {
    let ending = Ending {
        failure: Some(Failure { time: None, message }),
        ..Ending::default()
    };
    Part {
        row: RunRow::new(run, &[], spec.first_scored(), &ending),
        records: Vec::new(),
        time: SlaveTime::default(),
    }
}

impl Worker {
    fn start(mut command: Command) -> io::Result<Self> {
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        // Ctrl-C at the terminal is for the parent, which ends its workers itself.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let (sender, answers) = mpsc::channel();
        if let Some(mut output) = child.stdout.take() {
            thread::spawn(move || {
                loop {
                    let answer = receive::<Answer>(&mut output);
                    let last = !matches!(answer, Ok(Some(_)));
                    if sender.send(answer).is_err() || last {
                        return;
                    }
                }
            });
        }
        let printed = Arc::new(Mutex::new(Vec::new()));
        let (printing, all_printed) = mpsc::channel();
        if let Some(output) = child.stderr.take() {
            let kept = Arc::clone(&printed);
            thread::spawn(move || {
                keep_the_end(output, &kept);
                drop(printing);
            });
        }
        Ok(Self {
            requests: child.stdin.take(),
            child,
            answers,
            printed,
            printing: all_printed,
        })
    }

    fn ask(&mut self, request: &Request, limits: Limits) -> Result<Message<Answer>, Lost> {
        // A worker that is gone already shows when it is listened to.
        let _ = self.requests.as_mut().map(|requests| send(requests, request));
        let begun = Instant::now();
        loop {
            match self.answers.recv_timeout(LOOK) {
                Ok(Ok(Some(Message::Other(Answer::Stuck { participant })))) => {
                    return Err(Lost::Died {
                        participant: Some(participant),
                        message: format!("a call did not come back within {} s{}", limits.call_s, self.said()),
                    });
                }
                Ok(Ok(Some(answer))) => return Ok(answer),
                Err(RecvTimeoutError::Timeout) if stop_asked() => return Err(Lost::Stopped),
                Err(RecvTimeoutError::Timeout) if begun.elapsed().as_secs_f64() > limits.run_s => {
                    return Err(Lost::Died {
                        participant: None,
                        message: format!("the run did not end within {} s", limits.run_s),
                    });
                }
                Err(RecvTimeoutError::Timeout) => (),
                Ok(Ok(None) | Err(_)) | Err(RecvTimeoutError::Disconnected) => return Err(self.death(limits)),
            }
        }
    }

    /// How a worker ended that no longer answers.
    fn death(&mut self, limits: Limits) -> Lost {
        // One that has closed its output and lives on is ended.
        let patience = Instant::now() + Duration::from_secs(1);
        let status = loop {
            match self.child.try_wait() {
                Ok(Some(status)) => break Ok(status),
                Ok(None) if Instant::now() < patience => thread::sleep(Duration::from_millis(5)),
                Ok(None) => {
                    let _ = self.child.kill();
                    break self.child.wait();
                }
                Err(error) => break Err(error),
            }
        };
        let _ = self.printing.recv_timeout(Duration::from_secs(2));
        let how = status.map_or_else(|error| error.to_string(), describe);
        Lost::Died {
            participant: None,
            message: format!(
                "its process ended: {how} (memory limit {} MiB){}",
                limits.memory >> 20,
                self.said()
            ),
        }
    }

    /// The last line that its FMUs have printed, for a message.
    fn said(&self) -> String {
        let printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&printed).into_owned();
        let last = text.lines().rev().map(str::trim).find(|line| !line.is_empty());
        last.map(|line| format!("; it last printed: {line}"))
            .unwrap_or_default()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // An idle worker ends when its input does; a busy one has to be told.
        drop(self.requests.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl std::fmt::Debug for Workers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workers")
            .field("limits", &self.limits)
            .finish_non_exhaustive()
    }
}

impl From<Lost> for StudyError {
    fn from(lost: Lost) -> Self {
        match lost {
            Lost::Stopped => Self::Stopped,
            Lost::Start(source) => Self::Worker { source },
            Lost::Died { message, .. } => worker_error(io::Error::other(message)),
        }
    }
}

fn worker_error(source: io::Error) -> StudyError {
    StudyError::Worker { source }
}

fn out_of_turn() -> StudyError {
    worker_error(io::Error::other("a worker answered something else than it was asked"))
}

/// How a process ended, with the name of a signal that everybody knows.
fn describe(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = match signal {
            4 => " (illegal instruction)",
            6 => " (abort)",
            7 => " (bus error)",
            8 => " (arithmetic exception)",
            9 => " (killed)",
            11 => " (segmentation fault)",
            _ => "",
        };
        return format!("signal {signal}{name}");
    }
    status.code().map_or_else(
        || status.to_string(),
        |code| format!("exit code {code} in the middle of its work"),
    )
}

/// Reads to the end and keeps the last of it.
fn keep_the_end(mut output: impl Read, kept: &Mutex<Vec<u8>>) {
    let mut buffer = [0; 4096];
    while let Ok(count @ 1..) = output.read(&mut buffer) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(&buffer[..count]);
        let excess = kept.len().saturating_sub(TAIL);
        kept.drain(..excess);
    }
}
