//! `best.csv` and `best.md`: every filter at its own best, the table to decide from.

use std::fmt::Write;

use serde::Serialize;

use super::csv_bytes;
use super::summary::SummaryRow;
use super::table::{number, plain_table};
use super::timing::TimingRow;
use crate::HarnessError;
use crate::tuning::standing::Objective;

/// What the search says of a filter, beside its judged study.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry<'a> {
    /// Judged at its best.
    pub best: &'a SummaryRow,
    /// Judged as given, if that differs.
    pub given: Option<&'a SummaryRow>,
    /// Cost, if steps were timed.
    pub timing: Option<&'a TimingRow>,
    /// Values found, as `NAME=VALUE NAME=VALUE`.
    pub tuned: String,
    /// What to know of them.
    pub notes: Vec<String>,
}

row! {
    struct Row {
        scenario: String,
        filter: String,
        case: String,
        runs: u32,
        failed: usize,
        diverged: usize,
        pos_rmse_m: Option<f64>,
        vel_rmse_m_s: Option<f64>,
        acc_rmse_m_s2: Option<f64>,
        nees: Option<f64>,
        nis: Option<f64>,
        objective: &'static str,
        /// Place by the objective.
        rank: Option<usize>,
        /// Objective of the filter as given, on the same worlds.
        given: Option<f64>,
        tuned: String,
        notes: String,
    }
}

/// Every filter of one scenario, best objective first.
#[derive(Debug, Clone)]
pub struct Ranking<'a> {
    /// By objective; filters that have none come last.
    pub entries: Vec<Entry<'a>>,
    /// What they are sorted by.
    pub objective: Objective,
}

impl<'a> Ranking<'a> {
    /// Sorts.
    pub fn new(mut entries: Vec<Entry<'a>>, objective: Objective) -> Self {
        let key = |e: &Entry<'_>| objective.of(e.best).unwrap_or(f64::INFINITY);
        entries.sort_by(|a, b| key(a).total_cmp(&key(b)));
        Self { entries, objective }
    }

    /// Place of a filter by the objective, from 1; equals share a place. What it was not tuned for is no contest.
    fn rank(&self, entry: &Entry<'_>) -> Option<usize> {
        let of = |e: &Entry<'_>| self.objective.of(e.best);
        let own = of(entry)?;
        let better = |e: &&Entry<'_>| of(e).is_some_and(|other| other < own);
        Some(1 + self.entries.iter().filter(better).count())
    }

    fn rows(&self) -> impl Iterator<Item = Row> {
        self.entries.iter().map(|e| Row {
            scenario: e.best.scenario.clone(),
            filter: e.best.filter.clone(),
            case: e.best.case.clone(),
            runs: e.best.runs,
            failed: e.best.failed,
            diverged: e.best.diverged,
            pos_rmse_m: e.best.pos_rmse_m,
            vel_rmse_m_s: e.best.vel_rmse_m_s,
            acc_rmse_m_s2: e.best.acc_rmse_m_s2,
            nees: e.best.nees,
            nis: e.best.nis,
            objective: self.objective.name(),
            rank: self.rank(e),
            given: e.given.and_then(|g| self.objective.of(g)),
            tuned: e.tuned.clone(),
            notes: e.notes.join("; "),
        })
    }

    /// Cells of the table, by filter; the headings are [`HEADERS`].
    fn cells(&self) -> impl Iterator<Item = [String; HEADERS.len()]> {
        self.rows().zip(&self.entries).map(|(row, entry)| {
            let error = |of: Objective, value: Option<f64>| match row.rank {
                Some(rank) if of == self.objective => format!("{} ({rank})", number(value)),
                _ => number(value),
            };
            let errors = [
                error(Objective::Position, row.pos_rmse_m),
                error(Objective::Velocity, row.vel_rmse_m_s),
                error(Objective::Acceleration, row.acc_rmse_m_s2),
            ];
            let [position, velocity, acceleration] = errors;
            [
                row.filter,
                position,
                velocity,
                acceleration,
                number(row.nees),
                number(row.nis),
                row.failed.to_string(),
                row.diverged.to_string(),
                number(entry.timing.map(|t| t.nav_us_per_step)),
                number(row.given),
                row.tuned,
                row.notes,
            ]
        })
    }

    /// The table for the terminal, without a final newline; values and notes stand below it, a line each.
    pub fn render(&self) -> String {
        let cells: Vec<_> = self.cells().collect();
        let narrow = HEADERS.len() - 2;
        let rows = cells.iter().map(|row| row[..narrow].to_vec());
        let mut text = plain_table(&HEADERS[..narrow], 1, rows);
        for row in &cells {
            let about: Vec<&str> = row[narrow..]
                .iter()
                .map(String::as_str)
                .filter(|t| !t.is_empty())
                .collect();
            if !about.is_empty() {
                // Writing to a String cannot fail.
                let _ = write!(text, "\n{}: {}", row[0], about.join("; "));
            }
        }
        text
    }

    /// The table in Markdown, with a final newline.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|").replace('\n', " ")).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rules: Vec<String> = (0..HEADERS.len())
            .map(|i| (if is_text(i) { "---" } else { "---:" }).to_owned())
            .collect();
        let mut text = line(&HEADERS.map(str::to_owned));
        text.push_str(&line(&rules));
        for cells in self.cells() {
            text.push_str(&line(&cells));
        }
        text
    }
}

/// Headings of the table; the objective's column of the given filter tells by how much the search helped.
const HEADERS: [&str; 12] = [
    "filter",
    "pos RMSE\n[m]",
    "vel RMSE\n[m/s]",
    "acc RMSE\n[m/s2]",
    "NEES",
    "NIS",
    "failed",
    "diverged",
    "nav\n[us/step]",
    "objective\nas given",
    "tuned",
    "notes",
];

fn is_text(column: usize) -> bool {
    column == 0 || column >= HEADERS.len() - 2
}

/// How to read the table.
pub const LEGEND: &str = "\
in brackets: place by what the filters were tuned for, the other errors being what comes with it; NEES, NIS: 1 on average when consistent
objective as given: RMSE of the filter as named to --filters, in the same worlds
nav: time in the filter's fmi2DoStep";

/// Contents of `best.csv`: all but the time per step, which is in `timing.csv`, since it is never the same twice.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rankings: &[Ranking<'_>]) -> Result<Vec<u8>, HarnessError> {
    csv_bytes(COLUMNS, rankings.iter().flat_map(Ranking::rows))
}
