//! One run as a study keeps it: what each filter did in it, with every record that statistics are made of.

use crate::fold::RunRow;
use crate::kept::{Path, PathPoint};
use crate::record::{self, Record};
use crate::run::{SlaveTime, run_once};
use crate::score::score;
use crate::spec::Spec;

/// A run that is over, on its way to the statistics and to the journal.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Number of the run.
    pub run: u32,
    /// Communication steps taken.
    pub steps: u64,
    /// CPU time that the truth took.
    pub truth_time: SlaveTime,
    /// Where the vehicles truly were, thinned; of run 0 alone.
    pub path: Vec<PathPoint>,
    /// What the FMUs have logged, by name; of run 0 alone.
    pub messages: Vec<String>,
    /// By filter, in the order of the study.
    pub parts: Vec<Part>,
}

/// What one filter did in it.
#[derive(Debug, Clone)]
pub struct Part {
    /// The run in one line.
    pub row: RunRow,
    /// Of its estimates, in order; none of a run without a result.
    pub records: Vec<Record>,
    /// CPU time that the filter took.
    pub time: SlaveTime,
}

impl Outcome {
    /// A run of which nothing is known yet.
    pub(crate) fn begun(run: u32) -> Self {
        Self {
            run,
            steps: 0,
            truth_time: SlaveTime::default(),
            path: Vec::new(),
            messages: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// Takes what is known of the same run from a flight with other filters, apart from what these did in it.
    pub(crate) fn join(&mut self, other: Self) {
        if other.steps >= self.steps {
            (self.steps, self.truth_time) = (other.steps, other.truth_time);
        }
        // A point is kept at an epoch that some filter has an estimate of.
        self.path.extend(other.path);
        self.path.sort_by_key(|point| point.epoch);
        self.path.dedup_by_key(|point| point.epoch);
        for text in other.messages {
            if !self.messages.contains(&text) {
                self.messages.push(text);
            }
        }
    }

    /// Makes a run.
    pub fn of(spec: &Spec, run: u32) -> Self {
        let epochs = spec.epochs();
        let mut records: Vec<_> = spec.filters.iter().map(|_| Vec::with_capacity(epochs)).collect();
        let mut path = Path::new(spec);
        let phases = spec.phases.in_run(&spec.truth, spec.seed, run);
        let report = run_once(spec, run, |filter, truth, estimate| {
            let mut record = score(&spec.world, truth, estimate)
                .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
            record.phases = phases.of(truth);
            records[filter].push(record);
            if run == 0 {
                path.push(spec, truth);
            }
            Ok(())
        });
        let first = spec.first_scored();
        let parts = records
            .into_iter()
            .zip(report.endings.iter().zip(report.filter_times))
            .map(|(records, (ending, time))| {
                let row = RunRow::new(run, &records, first, ending);
                // Those of a failed run count for nothing, and need no memory while they wait.
                let records = if ending.failure.is_none() { records } else { Vec::new() };
                Part { row, records, time }
            });
        Self {
            run,
            steps: report.steps,
            truth_time: report.truth_time,
            path: path.into_points(),
            messages: if run == 0 { report.messages } else { Vec::new() },
            parts: parts.collect(),
        }
    }
}

/// All of an outcome but its records.
type Head = (
    u32,
    u64,
    SlaveTime,
    Vec<PathPoint>,
    Vec<String>,
    Vec<(RunRow, SlaveTime)>,
);

impl Outcome {
    /// As bytes, behind those that are there; the number of the run comes first.
    ///
    /// # Errors
    /// None but for lack of memory.
    pub(crate) fn to_bytes(&self, bytes: Vec<u8>) -> Result<Vec<u8>, postcard::Error> {
        let rows = self.parts.iter().map(|part| (&part.row, part.time)).collect::<Vec<_>>();
        let head = (self.run, self.steps, self.truth_time, &self.path, &self.messages, rows);
        let mut bytes = postcard::to_extend(&head, bytes)?;
        for part in &self.parts {
            record::to_bytes(&part.records, &mut bytes);
        }
        Ok(bytes)
    }

    /// From such bytes, all of them.
    ///
    /// # Errors
    /// When they are something else.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, postcard::Error> {
        let (head, mut rest) = postcard::take_from_bytes::<Head>(bytes)?;
        let (run, steps, truth_time, path, messages, rows) = head;
        let parts = rows.into_iter().map(|(row, time)| {
            let records = record::from_bytes(&mut rest).ok_or(postcard::Error::DeserializeUnexpectedEnd)?;
            Ok(Part { row, records, time })
        });
        let parts = parts.collect::<Result<_, postcard::Error>>()?;
        if !rest.is_empty() {
            return Err(postcard::Error::DeserializeBadEncoding);
        }
        Ok(Self {
            run,
            steps,
            truth_time,
            path,
            messages,
            parts,
        })
    }

    /// Whether it is a run of a study of so many filters and epochs: what a journal holds, somebody may have written.
    ///
    /// * `run`: number that it goes by.
    ///
    /// # Errors
    /// What does not belong there.
    pub fn fits(&self, run: u32, filters: usize, epochs: usize) -> Result<(), String> {
        let numbers = std::iter::once(self.run).chain(self.parts.iter().map(|part| part.row.run));
        if let Some(other) = numbers.into_iter().find(|other| *other != run) {
            return Err(format!("run {run} says that it is run {other}"));
        }
        if self.parts.len() != filters {
            return Err(format!(
                "run {run} has {} filters, the study has {filters}",
                self.parts.len()
            ));
        }
        let records = self
            .parts
            .iter()
            .flat_map(|part| &part.records)
            .map(|record| record.epoch);
        let points = self.path.iter().map(|point| point.epoch);
        match records.chain(points).find(|epoch| *epoch as usize >= epochs) {
            Some(epoch) => Err(format!("run {run} has an epoch {epoch}, the study has {epochs}")),
            None => Ok(()),
        }
    }
}
