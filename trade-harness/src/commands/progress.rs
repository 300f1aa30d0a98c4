//! The live line on stderr; hidden where nobody watches.

use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use study::{Engine, RunRow, Shard, Study, StudyError, StudyResult};

use super::shared::note;
use crate::HarnessError;
use crate::format::number;

/// How far a command has come, and how long it still takes.
pub(super) struct Progress {
    bar: ProgressBar,
    /// Ends the plain lines when dropped; `None` where a live line is seen, or nothing shall be.
    _plain: Option<Sender<()>>,
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
        let style = ProgressStyle::with_template(&format!(
            "{{msg}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{rate}}, {{eta}} left"
        ));
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let named = unit.to_owned();
        bar.set_style(
            style.with_key("rate", move |state: &ProgressState, out: &mut dyn fmt::Write| {
                let _ = write!(out, "{} {named}/s", number(Some(state.per_sec())));
            }),
        );
        bar.enable_steady_tick(Duration::from_millis(500));
        let plain = !quiet && !io::stderr().is_terminal();
        Self {
            _plain: plain.then(|| plain_lines(bar.clone(), unit.to_owned())),
            bar,
        }
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

/// Writes a line every [`PLAIN`], however long one piece of work takes, until the returned end is dropped.
fn plain_lines(bar: ProgressBar, unit: String) -> Sender<()> {
    let (end, ended) = channel();
    // Without a thread to spare there are no lines; the work goes on.
    let _ = thread::Builder::new().spawn(move || {
        while ended.recv_timeout(PLAIN) == Err(RecvTimeoutError::Timeout) {
            let all = bar.length().unwrap_or_default();
            note(&plain_line(&bar.message(), bar.position(), all, &unit, bar.elapsed()));
        }
    });
    end
}

/// How far the work has come, its mean rate so far, and how long the rest takes at that rate.
fn plain_line(what: &str, done: u64, all: u64, unit: &str, elapsed: Duration) -> String {
    let begin = format!("{what}: {done} of {all} {unit}");
    if done == 0 {
        return format!("{begin} after {:.0} s", elapsed.as_secs_f64());
    }
    let rate = done as f64 / elapsed.as_secs_f64();
    let left = Duration::try_from_secs_f64(all.saturating_sub(done) as f64 / rate).unwrap_or_default();
    let left = humantime::format_duration(Duration::from_secs(left.as_secs()));
    format!("{begin}, {} {unit}/s, {left} left", number(Some(rate)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_line_tells_rate_and_remaining_time() {
        let line =
            |done, all, seconds| plain_line("leo_venting, nominal", done, all, "runs", Duration::from_secs(seconds));
        // 30 runs in 60 s are one in 2 s; the other 70 take 140 s.
        let expected = "leo_venting, nominal: 30 of 100 runs, 0.5000 runs/s, 2m 20s left";
        assert_eq!(line(30, 100, 60), expected);
        assert_eq!(line(0, 100, 30), "leo_venting, nominal: 0 of 100 runs after 30 s");
        assert!(line(100, 100, 50).ends_with("2.000 runs/s, 0s left"));
    }
}
