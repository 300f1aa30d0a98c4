//! The live line on stderr; hidden where nobody watches.

use std::cell::Cell;
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use study::{Engine, RunRow, Shard, Study, StudyError, StudyResult};

use super::shared::note;
use crate::HarnessError;

/// How far a command has come, and how long it still takes.
pub(super) struct Progress {
    bar: ProgressBar,
    /// When the next plain line is due; `None` where a live line is seen, or nothing shall be.
    plain: Option<Cell<Instant>>,
}

/// Time between the lines that stand for a live one where there is no terminal.
const PLAIN: Duration = Duration::from_secs(30);

impl Progress {
    /// * `work`: all there is to do, counted in `unit`.
    pub(super) fn new(work: u64, unit: &str, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(work), target);
        let style = ProgressStyle::with_template(&format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"));
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(500));
        let plain = !quiet && !io::stderr().is_terminal();
        Self {
            bar,
            plain: plain.then(|| Cell::new(Instant::now() + PLAIN)),
        }
    }

    /// Says what is going on.
    pub(super) fn doing(&self, what: String) {
        self.bar.set_message(what);
    }

    /// So much of the work is done.
    pub(super) fn advance(&self, done: u64) {
        self.bar.inc(done);
        let Some(due) = self.plain.as_ref().filter(|due| Instant::now() >= due.get()) else {
            return;
        };
        due.set(Instant::now() + PLAIN);
        let (done, all) = (self.bar.position(), self.bar.length().unwrap_or_default());
        let left = humantime::format_duration(Duration::from_secs(self.bar.eta().as_secs()));
        note(&format!("{}: {done} of {all}, {left} left", self.bar.message()));
    }

    /// A line for each filter that failed in a run.
    pub(super) fn failures(&self, study: &Study, run: u32, rows: &[RunRow]) {
        let seed = study.spec.seed;
        for (filter, row) in study.spec.filters.iter().zip(rows) {
            let Some(failure) = &row.failure else { continue };
            let when = failure.time.map(|t| format!(" at {t} s")).unwrap_or_default();
            let (label, message) = (&filter.label, &failure.message);
            let text = format!("failed: {label} seed {seed} run {run}{when}: {message}");
            self.bar.suspend(|| note(&text));
        }
    }

    /// Takes the line away.
    pub(super) fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// Runs a study under a line of its own.
pub(super) fn run_watched(study: &Study, engine: Engine<'_>, quiet: bool) -> Result<StudyResult, HarnessError> {
    watched(study, study.runs, quiet, |finished| study.run(engine, finished))
}

/// Makes a part of a study's runs, likewise.
pub(super) fn shard_watched(study: &Study, shard: Shard, engine: Engine<'_>, quiet: bool) -> Result<(), HarnessError> {
    let runs = u32::try_from(shard.runs(study.runs).len()).unwrap_or(u32::MAX);
    watched(study, runs, quiet, |finished| study.run_shard(shard, engine, finished))
}

fn watched<T>(
    study: &Study,
    runs: u32,
    quiet: bool,
    work: impl FnOnce(&mut dyn FnMut(u32, &[RunRow])) -> Result<T, StudyError>,
) -> Result<T, HarnessError> {
    let progress = Progress::new(runs.into(), "runs", quiet);
    progress.doing(format!("{}, {}", study.spec.world.name, study.case));
    let result = work(&mut |run, rows| {
        progress.failures(study, run, rows);
        progress.advance(1);
    });
    progress.end();
    Ok(result?)
}
