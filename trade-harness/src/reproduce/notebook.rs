//! Where the runs come from, and what they have shown.

use std::time::Duration;

use study::{Plan, Study, StudyResult, Summary, TruthSample};

use super::line::Line;
use super::request::Request;
use crate::HarnessError;
use crate::bound::Bound;
use crate::format::csv_bytes;
use crate::report::manifest::StudyFacts;
use crate::report::measured::measured;
use crate::report::summary::value;
use crate::report::timing::TimingRow;

/// Where studies are run.
pub trait Laboratory {
    /// Runs a study.
    ///
    /// * returns: the plan that was run, and what it has found.
    ///
    /// # Errors
    /// What a filter or the truth refuses; a run that fails is counted in the result.
    fn study(&mut self, request: &Request) -> Result<(Plan, Study, StudyResult), HarnessError>;

    /// Runs the worlds and filters of run 0 of a study once, for its true states.
    ///
    /// # Errors
    /// As [`Laboratory::study`]; a run that fails says so in its result.
    fn first_run(&mut self, request: &Request) -> Result<FirstRun, HarnessError>;
}

/// The truth of one run.
#[derive(Debug, Clone, Default)]
pub struct FirstRun {
    /// True states, sample by sample.
    pub samples: Vec<TruthSample>,
    /// Filters beside it that ended with an error, and so perhaps before the last sample.
    pub failed: usize,
}

/// What the chapters have found so far.
#[derive(Debug, Default)]
pub struct Notebook {
    /// Each number beside the paper's, with the title of its chapter.
    pub lines: Vec<(&'static str, Line)>,
    /// A row for each filter of each study.
    pub rows: Vec<Summary>,
    /// What each filter cost.
    pub timings: Vec<TimingRow>,
    /// What was run.
    pub studies: Vec<StudyFacts>,
    /// Further tables, by file name.
    pub files: Vec<(String, Vec<u8>)>,
    /// Time on the clock for all runs.
    pub wall: Duration,
    /// Filters that ended such a run with an error.
    failed_first_runs: usize,
    /// Title of the chapter that is being written.
    chapter: &'static str,
}

impl Notebook {
    /// Begins a chapter: what is written from now on stands under its title.
    pub(crate) fn begin(&mut self, chapter: &'static str) {
        self.chapter = chapter;
    }

    /// Lines that miss a bound they are required to hold.
    pub fn missed(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().map(|(_, line)| line).filter(|line| line.is_missed())
    }

    /// Runs a study and keeps its summary and cost.
    pub(crate) fn run(
        &mut self,
        laboratory: &mut dyn Laboratory,
        request: &Request,
    ) -> Result<StudyResult, HarnessError> {
        let (plan, study, result) = laboratory.study(request)?;
        let (rows, timings) = measured(&study, &result, None)?;
        self.rows.extend(rows);
        self.timings.extend(timings);
        self.studies.push(StudyFacts::new(&plan, &study, &result.filters));
        self.wall += result.wall;
        Ok(result)
    }

    /// The true states of run 0 of a study; a failure is counted.
    pub(crate) fn first_run(
        &mut self,
        laboratory: &mut dyn Laboratory,
        request: &Request,
    ) -> Result<Vec<TruthSample>, HarnessError> {
        let first = laboratory.first_run(request)?;
        self.failed_first_runs += first.failed;
        Ok(first.samples)
    }

    /// A column of the summary; `None` where there is no such row, or the cell is empty.
    pub(crate) fn number(&self, request: &Request, filter: &str, column: &str) -> Option<f64> {
        let row = |r: &&Summary| r.scenario == request.world() && r.case == request.case() && r.filter == filter;
        value(self.rows.iter().find(row)?, column)
    }

    pub(crate) fn push(&mut self, line: Line) {
        self.lines.push((self.chapter, line));
    }

    pub(crate) fn push_file(
        &mut self,
        name: &str,
        columns: &[&str],
        rows: &[Vec<Option<f64>>],
    ) -> Result<(), HarnessError> {
        self.files.push((name.to_owned(), csv_bytes(columns, rows)?));
        Ok(())
    }

    /// Statistics over the runs that are left would hide those that are not.
    pub(crate) fn count_failures(&mut self) {
        let failed = self.failed_first_runs + self.rows.iter().map(|row| row.failed).sum::<usize>();
        let line = Line::new(
            "",
            "all studies",
            "runs that ended with an error, over all filters",
            "1",
        )
        .value(Some(failed as f64))
        .bound(Bound::exactly(0.0))
        .required(true);
        self.push(line);
        let mut diverged: Vec<Line> = Vec::new();
        for row in self.rows.iter().filter(|row| row.diverged > 0) {
            let quantity = format!(
                "{} in case {}: runs that diverged, of {}",
                row.filter, row.case, row.runs
            );
            let line = Line::new("", &row.scenario, &quantity, "1").value(Some(row.diverged as f64));
            diverged
                .push(line.note("by the filter's own word (NIS beyond its limit) or by its distance from the truth"));
        }
        if diverged.is_empty() {
            let line = Line::new("", "all studies", "runs that diverged, over all filters", "1");
            diverged.push(line.value(Some(0.0)));
        }
        diverged.into_iter().for_each(|line| self.push(line));
    }
}
