//! Many runs of one world, reduced to statistics as they come.

use std::time::{Duration, Instant};

use crate::error::StudyError;
use crate::flown::Flown;
use crate::fold::{FilterResult, RunRow};
use crate::journal::Journal;
use crate::kept::PathPoint;
use crate::ordered::in_order;
use crate::outcome::{Outcome, Part};
use crate::shard::Shard;
use crate::spec::Spec;
use crate::stop::stop_asked;
use crate::workers::Workers;

/// Runs whose records may wait for an earlier run, beside those that the threads are at: they are what a study needs its
/// memory for, and runs of one study take about the same time.
const WAITING: u32 = 1;

/// A Monte Carlo study of one world.
#[derive(Debug)]
pub struct Study {
    /// What every run shares.
    pub spec: Spec,
    /// Number of runs; run j has the parameter `run` = j.
    pub runs: u32,
    /// Threads.
    pub jobs: usize,
    /// Text of the `case` column.
    pub case: String,
}

/// Who makes the runs of a study, and what keeps them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Engine<'a> {
    /// Takes each run as it ends; those that it holds already are not made again, and have the same results.
    pub journal: Option<&'a Journal>,
    /// Processes that make the runs; `None`: this one.
    pub workers: Option<&'a Workers>,
    /// What need not be run, since an earlier case has.
    pub flown: Option<&'a Flown<'a>>,
}

/// Everything a study found.
#[derive(Debug)]
pub struct StudyResult {
    /// By filter, in the order of the study.
    pub filters: Vec<FilterResult>,
    /// Where the vehicles truly were in run 0, thinned.
    pub path: Vec<PathPoint>,
    /// What the FMUs have logged in run 0, by name.
    pub messages: Vec<String>,
    /// Time on the clock.
    pub wall: Duration,
}

impl Study {
    /// Runs the study. Results are folded in the order of the runs, so they do not depend on the number of threads.
    ///
    /// * `engine`: who makes the runs, and what keeps them.
    /// * `finished`: called after each run with its number and how it ended for each filter.
    ///
    /// # Errors
    /// [`StudyError::Stats`], [`StudyError::Journal`], [`StudyError::Stopped`]; what goes wrong in a run is counted in its
    /// results.
    pub fn run(&self, engine: Engine<'_>, mut finished: impl FnMut(u32, &[RunRow])) -> Result<StudyResult, StudyError> {
        let begin = Instant::now();
        let layout = self.spec.layout();
        let empty = |filter| FilterResult::of(filter, &layout);
        let mut filters: Vec<_> = self.spec.filters.iter().map(empty).collect();
        let (mut path, mut messages) = (Vec::new(), Vec::new());
        self.each(&Shard::WHOLE.runs(self.runs), engine, |outcome| {
            if outcome.run == 0 {
                (path, messages) = (outcome.path, outcome.messages);
            }
            for (filter, part) in filters.iter_mut().zip(outcome.parts) {
                filter.fold(part.row, &part.records)?;
                filter.timing.add(outcome.steps, part.time, outcome.truth_time);
            }
            let rows: Vec<RunRow> = filters.iter().filter_map(|f| f.runs.last().cloned()).collect();
            finished(outcome.run, &rows);
            Ok(())
        })?;
        Ok(StudyResult {
            filters,
            path,
            messages,
            wall: begin.elapsed(),
        })
    }

    /// Makes a part of the runs and leaves them in the journal, for whoever puts the parts together.
    ///
    /// * `finished`: as for [`Study::run`].
    ///
    /// # Errors
    /// [`StudyError::Journal`], [`StudyError::Stopped`].
    pub fn run_shard(
        &self,
        shard: Shard,
        engine: Engine<'_>,
        mut finished: impl FnMut(u32, &[RunRow]),
    ) -> Result<(), StudyError> {
        self.each(&shard.runs(self.runs), engine, |outcome| {
            let rows: Vec<RunRow> = outcome.parts.into_iter().map(|part| part.row).collect();
            finished(outcome.run, &rows);
            Ok(())
        })
    }

    /// Hands over these runs in their order, from the journal or newly made.
    fn each(
        &self,
        runs: &[u32],
        engine: Engine<'_>,
        mut take: impl FnMut(Outcome) -> Result<(), StudyError>,
    ) -> Result<(), StudyError> {
        let count = u32::try_from(runs.len()).unwrap_or(u32::MAX);
        let work = |index: u32| self.one(runs[index as usize], engine);
        in_order(count, self.jobs, WAITING, work, |_, outcome| take(outcome?))
    }

    fn one(&self, run: u32, engine: Engine<'_>) -> Result<Outcome, StudyError> {
        if let Some(journal) = engine.journal
            && let Some(kept) = journal.read(run)?
        {
            let fits = kept.fits(run, self.spec.filters.len(), self.spec.epochs());
            fits.map_err(|problem| journal.damaged(problem))?;
            return Ok(kept);
        }
        let mut whole = Outcome::begun(run);
        let mut parts: Vec<Option<Part>> = self.spec.filters.iter().map(|_| None).collect();
        if let Some(flown) = engine.flown {
            flown.fill(&mut whole, &mut parts)?;
        }
        let open: Vec<usize> = (0..parts.len()).filter(|place| parts[*place].is_none()).collect();
        if !open.is_empty() {
            let mut made = match engine.workers {
                _ if stop_asked() => return Err(StudyError::Stopped),
                Some(workers) => workers.run(&self.spec, &open, run)?,
                None if open.len() == parts.len() => Outcome::of(&self.spec, run),
                None => Outcome::of(&self.spec.subset(&open), run),
            };
            for (place, part) in open.into_iter().zip(std::mem::take(&mut made.parts)) {
                parts[place] = Some(part);
            }
            whole.join(made);
        }
        // A run that was broken off is none.
        if stop_asked() {
            return Err(StudyError::Stopped);
        }
        whole.parts = parts.into_iter().flatten().collect();
        let outcome = whole;
        if let Some(journal) = engine.journal {
            journal.append(&outcome)?;
        }
        Ok(outcome)
    }
}
