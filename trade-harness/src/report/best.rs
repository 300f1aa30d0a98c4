//! `best.csv` and `best.md`: every filter at its own best, the table to decide from.

use study::Summary;

use super::column::{self, Column, count, fields, find, number, text};
use super::table::shortened;
use super::timing::TimingRow;
use crate::HarnessError;
use crate::format::{self, Align, markdown_table, plain_table, wrapped};
use crate::tuning::standing::Objective;

/// What the search says of a filter, beside its judged study.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry<'a> {
    /// Judged at its best.
    pub best: &'a Summary,
    /// Judged as given, if that differs.
    pub given: Option<&'a Summary>,
    /// Cost, if steps were timed.
    pub timing: Option<&'a TimingRow>,
    /// Values found, as `NAME=VALUE NAME=VALUE`.
    pub tuned: String,
    /// What to know of them.
    pub notes: Vec<String>,
}

/// Note of a bound.
const BOUND: &str = "bound, told by the truth: no rank";

/// A filter's row, with its place.
pub(crate) struct Row {
    best: Summary,
    objective: Objective,
    rank: Option<usize>,
    /// Objective of the filter as given, on the same worlds.
    given: Option<f64>,
    tuned: String,
    notes: String,
}

pub(crate) const COLUMNS: &[Column<Row>] = &[
    text("scenario", "world", |r| r.best.scenario.as_str().into()),
    text("filter", "filter with the preset that was best", |r| {
        r.best.filter.as_str().into()
    }),
    text("case", "case", |r| r.best.case.as_str().into()),
    count("runs", "runs it is judged by", |r| Some(r.best.runs.into())),
    count("failed", "runs that ended with an error", |r| {
        Some(r.best.failed as u64)
    }),
    count("diverged", "runs that lost the target", |r| {
        Some(r.best.diverged as u64)
    }),
    number(
        "pos_rmse_m",
        "m",
        "root mean square of the norm of the position error",
        |r| r.best.position.rmse,
    ),
    number("vel_rmse_m_s", "m/s", "the same of velocity", |r| r.best.velocity.rmse),
    number("acc_rmse_m_s2", "m/s2", "the same of acceleration", |r| {
        r.best.acceleration.rmse
    }),
    number("nees", "1", "mean NEES over its dimension", |r| r.best.nees.mean),
    number("nees6", "1", "mean NEES of position and velocity alone, over 6", |r| {
        r.best.nees6.mean
    }),
    number("nis", "1", "mean NIS over its rows", |r| r.best.nis.mean),
    text("objective", "the error that the search made small", |r| {
        r.objective.name().into()
    }),
    count("rank", "place by the objective", |r| r.rank.map(|n| n as u64)),
    number(
        "given",
        "m, m/s or m/s2",
        "objective of the filter as given, in the same worlds",
        |r| r.given,
    ),
    text("tuned", "NAME=VALUE of what was found", |r| r.tuned.as_str().into()),
    text("notes", "what to know of them", |r| r.notes.as_str().into()),
];

/// Every filter of one scenario, best objective first.
#[derive(Debug, Clone)]
pub struct Ranking<'a> {
    /// By objective; filters that have none come last, and bounds after them.
    pub entries: Vec<Entry<'a>>,
    /// What they are sorted by.
    pub objective: Objective,
}

impl<'a> Ranking<'a> {
    /// Sorts.
    pub fn new(mut entries: Vec<Entry<'a>>, objective: Objective) -> Self {
        let key = |e: &Entry<'_>| objective.of(e.best).unwrap_or(f64::INFINITY);
        entries.sort_by(|a, b| (a.best.bound.cmp(&b.best.bound)).then(key(a).total_cmp(&key(b))));
        Self { entries, objective }
    }

    /// Place of a filter by the objective, from 1; equals share a place. What it was not tuned for is no contest, and a bound
    /// takes no part.
    fn rank(&self, entry: &Entry<'_>) -> Option<usize> {
        let of = |e: &Entry<'_>| self.objective.of(e.best).filter(|_| !e.best.bound);
        let own = of(entry)?;
        let better = |e: &&Entry<'_>| of(e).is_some_and(|other| other < own);
        Some(1 + self.entries.iter().filter(better).count())
    }

    fn rows(&self) -> impl Iterator<Item = Row> {
        self.entries.iter().map(|e| Row {
            best: e.best.clone(),
            objective: self.objective,
            rank: self.rank(e),
            given: e.given.and_then(|g| self.objective.of(g)),
            tuned: e.tuned.clone(),
            notes: (e.best.bound.then_some(BOUND).into_iter())
                .chain(e.notes.iter().map(String::as_str))
                .collect::<Vec<_>>()
                .join("; "),
        })
    }

    /// Cells of the table, by filter; the headings are [`HEADERS`].
    fn cells(&self) -> impl Iterator<Item = [String; HEADERS.len()]> {
        self.rows().zip(&self.entries).map(|(row, entry)| {
            let error = |of: Objective| match row.rank {
                Some(rank) if of == self.objective => format!("{} ({rank})", format::number(of.of(&row.best))),
                _ => format::number(of.of(&row.best)),
            };
            [
                row.best.filter.clone(),
                error(Objective::Position),
                error(Objective::Velocity),
                error(Objective::Acceleration),
                format::number(row.best.nees.mean),
                format::number(row.best.nees6.mean),
                format::number(row.best.nis.mean),
                row.best.failed.to_string(),
                row.best.diverged.to_string(),
                format::number(entry.timing.map(|t| t.nav_us_per_step)),
                format::number(row.given),
                row.tuned,
                row.notes,
            ]
        })
    }

    /// The table for the terminal, without a final newline; values and notes stand below it. It fits 80 columns.
    pub fn render(&self) -> String {
        let rows: Vec<Row> = self.rows().collect();
        let cells = rows.iter().map(|row| {
            let shown = SHOWN.iter().filter_map(|(_, name)| find(COLUMNS, name));
            let cells = shown.map(|c| c.cell(row).short()).enumerate();
            cells
                .map(|(i, cell)| if i == 0 { shortened(&cell, LONGEST) } else { cell })
                .collect()
        });
        plain_table(SHOWN.iter().map(|(heading, _)| *heading), 1, cells) + &about(&rows, true)
    }

    /// The table with all columns; values and notes stand below it, a line each.
    pub fn render_wide(&self) -> String {
        let narrow = HEADERS.len() - 2;
        let cells = self.cells().map(|row| row[..narrow].to_vec());
        let rows: Vec<Row> = self.rows().collect();
        plain_table(&HEADERS[..narrow], 1, cells) + &about(&rows, false)
    }

    /// Its rows of `best.csv` by the names of their columns, best first.
    pub fn told(&self) -> Vec<serde_json::Map<String, serde_json::Value>> {
        self.rows().map(|row| fields(COLUMNS, &row)).collect()
    }

    /// The table in Markdown, with a final newline.
    pub fn markdown(&self) -> String {
        let align = |column| if is_text(column) { Align::Left } else { Align::Right };
        let headers: Vec<_> = HEADERS.iter().enumerate().map(|(i, h)| (*h, align(i))).collect();
        markdown_table(&headers, self.cells())
    }
}

/// Values and notes of each filter that has any, each after a newline.
///
/// * `narrow`: below the table that fits 80 columns, which has no room for the filter as given.
fn about(rows: &[Row], narrow: bool) -> String {
    let mut text = String::new();
    for row in rows {
        let given = row.given.filter(|_| narrow);
        let given = given.map(|given| format!("untuned {}", format::number(Some(given))));
        let told = [row.tuned.clone(), given.unwrap_or_default(), row.notes.clone()];
        let parts: Vec<String> = told.into_iter().filter(|t| !t.is_empty()).collect();
        if !parts.is_empty() {
            let line = format!("{}: {}", row.best.filter, parts.join("; "));
            text.push('\n');
            text.push_str(&if narrow { wrapped(&line) } else { line });
        }
    }
    text
}

/// Headings of the table that fits 80 columns, and the columns of `best.csv` below them.
const SHOWN: [(&str, &str); 8] = [
    ("filter", "filter"),
    ("rank", "rank"),
    ("pos RMSE\n[m]", "pos_rmse_m"),
    ("vel RMSE\n[m/s]", "vel_rmse_m_s"),
    ("acc RMSE\n[m/s2]", "acc_rmse_m_s2"),
    ("NEES6", "nees6"),
    ("failed", "failed"),
    ("diver-\nged", "diverged"),
];

/// Longest name of a filter in it.
const LONGEST: usize = 17;

/// Headings of the table with all columns; the objective's column of the given filter tells by how much the search helped.
const HEADERS: [&str; 13] = [
    "filter",
    "pos RMSE\n[m]",
    "vel RMSE\n[m/s]",
    "acc RMSE\n[m/s2]",
    "NEES",
    "NEES6",
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

/// How to read the table that fits 80 columns.
pub const LEGEND: &str = "\
rank: place by what the filters were tuned for; the other errors come with it;
NEES6: of position and velocity, 1 on average when consistent; untuned: RMSE of
the filter as named to --filters, in the same worlds. More columns: --wide,
best.md and best.csv";

/// How to read the table with all columns.
pub const WIDE_LEGEND: &str = "\
in brackets: place by what the filters were tuned for, the other errors being what comes with it; NEES, NIS: 1 on average when consistent; NEES6: of position and velocity alone
objective as given: RMSE of the filter as named to --filters, in the same worlds
nav: time in the filter's fmi2DoStep";

/// Contents of `best.csv`: all but the time per step, which is in `timing.csv`, since it is never the same twice.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(rankings: &[Ranking<'_>]) -> Result<Vec<u8>, HarnessError> {
    let rows: Vec<Row> = rankings.iter().flat_map(Ranking::rows).collect();
    column::render(COLUMNS, &rows)
}
