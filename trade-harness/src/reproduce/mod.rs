//! Everything the two papers print or claim, rerun and held beside it.
//!
//! A chapter is one file here and one line in [`CHAPTERS`]: the studies it needs, the paper's numbers, and the bounds
//! that ours are held to. Those stand nowhere else, except for the claims of the venting scenarios, which `compare` holds
//! as well. Where the runs come from is a [`Laboratory`]: FMUs, or mocks in tests.
//!
//! Start reading at [`Line`], then `disturbance.rs`, the shortest chapter.

mod disturbance;
mod learning;
mod line;
mod milton;
mod neurons;
mod nominal;
mod off_nominal;
mod render;

use std::time::Duration;

use crate::HarnessError;
use crate::models::{Assignment, TRUTH, Variation};
use crate::report::csv_bytes;
use crate::report::manifest::StudyFacts;
use crate::report::summary::SummaryRow;
use crate::report::timing::TimingRow;
use crate::run::call_time;
use crate::scenarios::Scenario;
use crate::signals::TruthSample;
use crate::study::{Study, StudyResult};

pub use line::{Bound, Line, Verdict};
pub use render::{csv, line_text, markdown};

/// The paper of the venting scenarios.
const MILTON_PAPER: &str = "Mamich and Zanetti";
/// The paper of the formation.
const NETWORK_PAPER: &str = "Pesce, Silvestrini and Lavagna";

/// A part of the reproduction.
pub struct Chapter {
    /// Its heading.
    pub title: &'static str,
    /// The studies it runs.
    pub requests: fn() -> Vec<Request>,
    /// Runs them and writes down what they show.
    pub write: fn(&mut dyn Laboratory, &mut Notebook) -> Result<(), HarnessError>,
}

/// Every chapter, in order; a later one may look up what an earlier one has found.
pub const CHAPTERS: &[Chapter] = &[
    milton::CHAPTER,
    disturbance::CHAPTER,
    learning::CHAPTER,
    nominal::CHAPTER,
    off_nominal::CHAPTER,
    neurons::CHAPTER,
];

/// A study that a chapter needs.
#[derive(Debug, Clone)]
pub struct Request {
    /// The world.
    pub scenario: &'static Scenario,
    /// Text of the `case` column; with the scenario it names the study.
    pub case: String,
    /// Filters, as `--filters` takes them.
    pub filters: Vec<&'static str>,
    /// Parameters set for every run.
    pub sets: Vec<Assignment>,
    /// Parameters drawn for each run.
    pub variations: Vec<Variation>,
    /// This study makes do with one run where the others have so many.
    pub one_run_in: u32,
}

impl Request {
    fn new(scenario: &'static Scenario, case: &str, filters: &[&'static str]) -> Self {
        Self {
            scenario,
            case: case.to_owned(),
            filters: filters.to_vec(),
            sets: Vec::new(),
            variations: Vec::new(),
            one_run_in: 1,
        }
    }

    /// With a parameter set for every run.
    fn set(mut self, model: &str, variable: &str, value: &str) -> Self {
        self.sets.push(Assignment {
            model: model.to_owned(),
            variable: variable.to_owned(),
            value: value.to_owned(),
        });
        self
    }

    /// With the J2 relative model as the truth, as in Sec. IV.B of the network's paper.
    fn with_j2_alone(self) -> Self {
        self.set(TRUTH, "formation.forces", "j2")
    }
}

/// Where studies are run.
pub trait Laboratory {
    /// Runs a study.
    ///
    /// # Errors
    /// What a filter or the truth refuses; a run that fails is counted in the result.
    fn study(&mut self, request: &Request) -> Result<(Study, StudyResult), HarnessError>;

    /// The true states of run 0 of a study, sample by sample.
    ///
    /// # Errors
    /// As [`Laboratory::study`].
    fn truth(&mut self, request: &Request) -> Result<Vec<TruthSample>, HarnessError>;
}

/// What the chapters have found so far.
#[derive(Debug, Default)]
pub struct Notebook {
    /// Each number beside the paper's, with the title of its chapter.
    pub lines: Vec<(&'static str, Line)>,
    /// A row for each filter of each study.
    pub rows: Vec<SummaryRow>,
    /// What each filter cost.
    pub timings: Vec<TimingRow>,
    /// What was run.
    pub studies: Vec<StudyFacts>,
    /// Further tables, by file name.
    pub files: Vec<(String, Vec<u8>)>,
    /// Time on the clock for all runs.
    pub wall: Duration,
    /// Title of the chapter that is being written.
    chapter: &'static str,
}

impl Notebook {
    /// Runs every chapter in order.
    ///
    /// * `after`: called after each chapter, so that what has been found can be saved.
    ///
    /// # Errors
    /// Those of the laboratory and of `after`.
    pub fn fill(
        laboratory: &mut dyn Laboratory,
        mut after: impl FnMut(&Self) -> Result<(), HarnessError>,
    ) -> Result<Self, HarnessError> {
        let mut notebook = Self::default();
        for chapter in CHAPTERS {
            notebook.chapter = chapter.title;
            (chapter.write)(laboratory, &mut notebook)?;
            after(&notebook)?;
        }
        notebook.chapter = "Runs";
        notebook.count_failures();
        after(&notebook)?;
        Ok(notebook)
    }

    /// Lines that miss a bound they are required to hold.
    pub fn missed(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().map(|(_, line)| line).filter(|line| line.is_missed())
    }

    /// Runs a study and keeps its summary and cost.
    fn run(&mut self, laboratory: &mut dyn Laboratory, request: &Request) -> Result<StudyResult, HarnessError> {
        let (study, result) = laboratory.study(request)?;
        let name = study.spec.scenario.name;
        for (filter, participant) in result.filters.iter().zip(&study.spec.filters) {
            self.rows.push(SummaryRow::new(name, &study.case, filter));
            let call = call_time(&study.spec, participant).unwrap_or_default();
            let timing = TimingRow::new(name, &filter.label, &study.case, &filter.timing, call);
            self.timings.extend(timing);
        }
        self.studies.push(StudyFacts::new(&study));
        self.wall += result.wall;
        Ok(result)
    }

    /// A column of the summary; `None` where there is no such row, or the cell is empty.
    fn number(&self, request: &Request, filter: &str, column: &str) -> Option<f64> {
        let row = |r: &&SummaryRow| r.scenario == request.scenario.name && r.case == request.case && r.filter == filter;
        self.rows.iter().find(row)?.number(column)
    }

    fn push(&mut self, line: Line) {
        self.lines.push((self.chapter, line));
    }

    fn push_file(&mut self, name: &str, columns: &[&str], rows: &[Vec<Option<f64>>]) -> Result<(), HarnessError> {
        self.files.push((name.to_owned(), csv_bytes(columns, rows)?));
        Ok(())
    }

    /// Statistics over the runs that are left would hide those that are not.
    fn count_failures(&mut self) {
        let failed: usize = self.rows.iter().map(|row| row.failed).sum();
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
    }
}
