//! The library at work. It may crash, hang, exit and change what belongs to its process, so every trial is made by a process of
//! its own, which keeps a journal of what it calls and finds.
#![allow(unsafe_code, reason = "the library under test is C")]

mod instance;
mod job;
mod journal;
mod library;
mod logger;
mod process;
mod run;
mod surroundings;
mod trials;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use fmi2_import::{LIBRARY_SUFFIX, PLATFORM};

use crate::archive::Archive;
use crate::description::view::View;
use crate::error::CheckError;
use crate::finding::Findings;
use crate::options::Running;
use crate::rules::binary as rules;
use crate::rules::by_id;
use crate::xml::lexical::boolean;
use instance::Bench;
use job::Job;
use journal::Journal;
use process::End;
use surroundings::Surroundings;
use trials::{COMPARING, LIFE, OTHERS, REPEAT, Trial};

/// File that tells a process what it needs to know.
const JOB: &str = "job.json";

/// How long a wrong call may take. Nothing says that it comes back at all, so the whole limit is not spent on each.
const BRIEF: Duration = Duration::from_secs(5);

/// Instances that a trial with wrong calls makes at most; none takes longer than a whole life.
const LIVES: u32 = 4;

/// Runs all trials that have a meaning for the FMU.
///
/// # Errors
/// [`CheckError::Unpack`], [`CheckError::Process`], [`CheckError::Json`].
pub(crate) fn check(
    archive: &mut Archive,
    view: &View<'_>,
    running: &Running,
    findings: &mut Findings,
) -> Result<(), CheckError> {
    let skip = |findings: &mut Findings, what: String| findings.add(&rules::SKIPPED, "binaries", what);
    let Some(interface) = view.interface("CoSimulation") else {
        skip(findings, "not run, since it is not for co-simulation".to_owned());
        return Ok(());
    };
    if interface.get("needsExecutionTool").and_then(boolean) == Some(true) && !running.with_tool {
        skip(findings, "not run, since it needs a tool".to_owned());
        return Ok(());
    }
    let identifier = interface.get("modelIdentifier").unwrap_or_default();
    let entry = format!("binaries/{PLATFORM}/{identifier}.{LIBRARY_SUFFIX}");
    if !archive.contains(&entry) {
        skip(findings, format!("not run, since there is no {entry}"));
        return Ok(());
    }
    let folder = tempfile::Builder::new()
        .prefix("fmu-")
        .tempdir()
        .map_err(|source| CheckError::Process { source })?;
    let unpacked = folder.path().join("fmu");
    if !archive.unpack(&unpacked)? {
        skip(
            findings,
            "not run, since the archive cannot be unpacked safely".to_owned(),
        );
        return Ok(());
    }
    let mut job = Job::new(view, interface);
    job.file = unpacked.join(&entry);
    job.resources = unpacked.join("resources");
    job.folder = folder.path().to_owned();
    job.limit = running.limit.as_secs_f64();
    let file = folder.path().join(JOB);
    let failed = |source| CheckError::Process { source };
    fs::write(&file, serde_json::to_vec(&job)?).map_err(failed)?;

    let mut desk = Desk {
        file: &file,
        job: &job,
        running,
        findings,
        known: BTreeSet::new(),
        patience: running.limit,
    };
    let begun = Instant::now();
    if !desk.tries(&LIFE)? {
        return Ok(());
    }
    desk.patience = running.limit.min(BRIEF + LIVES * begun.elapsed());
    let repeats = desk.tries(&REPEAT)? && !desk.known.contains(rules::REPEAT.id);
    for trial in COMPARING.iter().filter(|_| repeats).chain(OTHERS) {
        desk.tries(trial)?;
    }
    Ok(())
}

/// Where trials are ordered, and what they say is taken down.
struct Desk<'a> {
    file: &'a Path,
    job: &'a Job,
    running: &'a Running,
    findings: &'a mut Findings,
    /// Rules that are broken.
    known: BTreeSet<&'static str>,
    /// The longest that a wrong call may take, with what goes before it.
    patience: Duration,
}

impl Desk<'_> {
    /// Makes one trial; whether it went as far as it should.
    fn tries(&mut self, trial: &Trial) -> Result<bool, CheckError> {
        if !(trial.applies)(self.job) {
            return Ok(true);
        }
        let path = journal::path(&self.job.folder, trial.name);
        let output = journal::output(&self.job.folder, trial.name);
        let limit = if trial.mistake {
            self.patience
        } else {
            self.running.limit
        };
        let ended = process::run(self.running, self.file, trial.name, &output, limit)?;
        let account = journal::read(&path);
        let nothing = account.found.is_empty();
        for (rule, element, what) in account.found {
            // That something is printed is told once.
            if let Some(rule) = by_id(&rule)
                && (self.known.insert(rule.id) || rule.id != rules::STDOUT.id)
            {
                self.findings.add(rule, element, what);
            }
        }
        if let Some(good) = account.over {
            if !good && nothing {
                let what = format!("while {} a call had no answer to go on with", trial.about);
                self.findings
                    .add(&rules::SKIPPED, account.last.unwrap_or_default(), what);
            }
            return Ok(good);
        }
        let (rule, what) = match ended {
            End::Hung => (
                trial.hang,
                format!("it did not come back within {:.1} s", limit.as_secs_f64()),
            ),
            End::Ended(how) => (trial.crash, format!("the process ended: {how}")),
        };
        let element = account.last.unwrap_or_else(|| "loading".to_owned());
        self.findings
            .add(rule, element, format!("while {} {what}", trial.about));
        Ok(false)
    }
}

/// What the process does that [`crate::options::Running`] starts: one trial.
///
/// * `job`, `trial`: the last two words of its command line.
///
/// # Errors
/// [`CheckError::Read`], [`CheckError::Json`], [`CheckError::Process`].
pub fn serve(job: &Path, trial: &str) -> Result<(), CheckError> {
    let text = fs::read(job).map_err(|source| CheckError::Read {
        path: job.to_owned(),
        source,
    })?;
    let told: Job = serde_json::from_slice(&text)?;
    let unknown = || CheckError::Process {
        source: std::io::Error::other(format!("there is no trial {trial}")),
    };
    let trial = trials::by_name(trial).ok_or_else(unknown)?;
    let journal =
        Journal::begin(&journal::path(&told.folder, trial.name)).map_err(|source| CheckError::Process { source })?;
    let output = journal::output(&told.folder, trial.name);
    let patience = Duration::from_secs_f64(2.0 * told.limit + 1.0);
    // A library that hangs does not outlive a parent that was killed.
    thread::spawn(move || {
        thread::sleep(patience);
        std::process::abort();
    });
    let surroundings = Surroundings::now();
    let loaded = match library::Library::load(&told.file, &told.resources) {
        Ok(loaded) => loaded,
        Err(reason) => {
            let element = told.file.file_name().unwrap_or_default().to_string_lossy();
            // Folders of the trial say nothing.
            let reason = reason.replace(&format!("{}: ", told.file.display()), "");
            journal.found(&rules::LOAD, &element, reason);
            journal.over(false);
            return Ok(());
        }
    };
    let bench = Bench {
        job: &told,
        loaded: &loaded,
        journal: &journal,
        surroundings: RefCell::new(surroundings),
        output: &output,
        printed: Cell::new(false),
        last_words: RefCell::default(),
    };
    if trial.name == LIFE.name {
        bench.look_round("loading");
    } else {
        bench.surroundings.replace(Surroundings::now());
    }
    let good = (trial.run)(&bench).is_ok();
    journal.over(good);
    Ok(())
}
