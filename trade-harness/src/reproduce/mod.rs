//! Everything the two papers print or claim, rerun and held beside it.
//!
//! A chapter is one file here and one line in [`CHAPTERS`]: the studies it needs, the paper's numbers, and the bounds
//! that ours are held to. Those stand nowhere else, except for the claims of the venting scenarios, which `compare` holds
//! as well. Where the runs come from is a [`Laboratory`]: FMUs, or mocks in tests.
//!
//! Start reading at [`Line`], then `disturbance.rs`, the shortest chapter.

mod beyond;
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
use crate::report::manifest::StudyFacts;
use crate::report::summary::SummaryRow;
use crate::report::timing::TimingRow;
use crate::report::{csv_bytes, measured};
use crate::scenarios::Scenario;
use crate::signals::TruthSample;
use crate::study::{Study, StudyResult};

pub use crate::bound::Bound;
pub use line::{Line, Verdict};
pub use render::{csv, line_text, markdown};

/// The paper of the venting scenarios.
const MILTON_PAPER: &str = "Mamich and Zanetti";
/// The paper of the formation.
const NETWORK_PAPER: &str = "Pesce, Silvestrini and Lavagna";

/// Largest difference from a table of that paper, as a share of it.
const SHARE: f64 = 0.15;

/// A part of the reproduction.
pub struct Chapter {
    /// Its heading.
    pub title: &'static str,
    /// The studies it runs, and what it only flies for the truth of run 0.
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
    beyond::CHAPTER,
    off_nominal::CHAPTER,
    neurons::CHAPTER,
];

/// A study that a chapter needs, or a flight: run 0 of one.
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

    /// Runs the worlds and filters of run 0 of a study once, for its true states.
    ///
    /// # Errors
    /// As [`Laboratory::study`]; a flight that fails says so in its result.
    fn fly(&mut self, request: &Request) -> Result<Flight, HarnessError>;
}

/// The truth of one run.
#[derive(Debug, Clone, Default)]
pub struct Flight {
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
    pub rows: Vec<SummaryRow>,
    /// What each filter cost.
    pub timings: Vec<TimingRow>,
    /// What was run.
    pub studies: Vec<StudyFacts>,
    /// Further tables, by file name.
    pub files: Vec<(String, Vec<u8>)>,
    /// Time on the clock for all runs.
    pub wall: Duration,
    /// Filters that ended a flight with an error.
    failed_flights: usize,
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
        let (rows, timings) = measured(&study, &result);
        self.rows.extend(rows);
        self.timings.extend(timings);
        self.studies.push(StudyFacts::new(&study));
        self.wall += result.wall;
        Ok(result)
    }

    /// The true states of run 0 of a study; a failure is counted.
    fn fly(&mut self, laboratory: &mut dyn Laboratory, request: &Request) -> Result<Vec<TruthSample>, HarnessError> {
        let flight = laboratory.fly(request)?;
        self.failed_flights += flight.failed;
        Ok(flight.samples)
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
        let failed = self.failed_flights + self.rows.iter().map(|row| row.failed).sum::<usize>();
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
