//! The live line on stderr; hidden where nobody watches.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use study::{RunRow, Study, StudyResult};

use super::shared::note;
use crate::HarnessError;

/// How far a command has come, and how long it still takes.
pub(super) struct Progress {
    bar: ProgressBar,
}

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
        Self { bar }
    }

    /// Says what is going on.
    pub(super) fn doing(&self, what: String) {
        self.bar.set_message(what);
    }

    /// So much of the work is done.
    pub(super) fn advance(&self, done: u64) {
        self.bar.inc(done);
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
pub(super) fn run_watched(study: &Study, quiet: bool) -> Result<StudyResult, HarnessError> {
    let progress = Progress::new(study.runs.into(), "runs", quiet);
    progress.doing(format!("{}, {}", study.spec.world.name, study.case));
    let result = study.run(|run, rows| {
        progress.failures(study, run, rows);
        progress.advance(1);
    })?;
    progress.end();
    Ok(result)
}
