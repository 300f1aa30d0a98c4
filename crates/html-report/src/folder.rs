//! The files of a study, read back.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use crate::ReportError;
use crate::number::short;

/// What the page uses of `manifest.json`; whatever else stands there is left alone.
#[derive(Debug, Deserialize)]
pub(crate) struct Manifest {
    pub harness_version: String,
    pub identity: Option<String>,
    #[serde(default)]
    pub models: BTreeMap<String, Value>,
    pub studies: Vec<StudyFacts>,
}

/// One world's study.
#[derive(Debug, Deserialize)]
pub(crate) struct StudyFacts {
    pub scenario: String,
    pub case: String,
    pub runs: u32,
    pub study_seed: i64,
    pub duration_s: f64,
    pub scored_from_s: f64,
    pub step_s: f64,
    pub sample_period_s: f64,
    pub filters: Vec<Value>,
    #[serde(default)]
    pub plan: Value,
    #[serde(default)]
    pub mission: Value,
    #[serde(default)]
    pub notes: Vec<String>,
}

/// A row of a table by the names of its columns.
#[derive(Debug, Clone)]
pub(crate) struct Row(BTreeMap<String, String>);

impl Row {
    pub fn text(&self, column: &str) -> &str {
        self.0.get(column).map_or("", String::as_str)
    }

    /// `None` for an empty cell.
    pub fn number(&self, column: &str) -> Option<f64> {
        self.text(column).parse().ok()
    }

    /// A number as it is sorted and as it is shown.
    pub fn cell(&self, column: &str) -> [String; 2] {
        [self.text(column).to_owned(), short(self.number(column))]
    }

    /// Zero for an empty cell.
    pub fn count(&self, column: &str) -> u64 {
        self.text(column).parse().unwrap_or(0)
    }

    /// Whether it is of a bound, which is told by the truth and has no place among filters; of `summary.csv`.
    pub fn is_bound(&self) -> bool {
        self.text("kind") == "bound"
    }

    fn is_of(&self, study: &StudyFacts) -> bool {
        self.text("scenario") == study.scenario && self.text("case") == study.case
    }
}

/// A study's folder.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    pub manifest: Manifest,
    summary: Vec<Row>,
    runs: Vec<Row>,
    paired: Vec<Row>,
    failures: Vec<Row>,
    phases: Vec<Row>,
    requirements: Vec<Row>,
    search: Vec<Row>,
}

impl Folder {
    pub fn read(path: &Path) -> Result<Self, ReportError> {
        let bytes = contents(path, "manifest.json")?;
        let manifest = serde_json::from_slice(&bytes).map_err(|source| ReportError::Manifest {
            path: path.join("manifest.json"),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            manifest,
            summary: table(
                path,
                "summary.csv",
                &["scenario", "filter", "case", "pos_rmse_m", "failed", "diverged"],
            )?,
            runs: table(
                path,
                "runs.csv",
                &["scenario", "filter", "case", "run", "failed", "pos_rmse_m"],
            )?,
            paired: table(
                path,
                "paired.csv",
                &["scenario", "filter", "quantity", "mean_difference"],
            )?,
            failures: table(path, "failures.csv", &["scenario", "filter", "run", "message"])?,
            phases: table_if_there(
                path,
                "phases.csv",
                &["scenario", "filter", "case", "phase", "pos_rmse_m"],
            )?,
            requirements: table_if_there(path, "requirements.csv", &["scenario", "filter", "metric", "verdict"])?,
            search: table_if_there(
                path,
                "search.csv",
                &["scenario", "filter", "values", "ranges", "value", "feasible"],
            )?,
        })
    }

    pub fn summary(&self, study: &StudyFacts) -> Vec<&Row> {
        self.summary.iter().filter(|r| r.is_of(study)).collect()
    }

    /// Names of the bounds among its filters.
    pub fn bounds(&self, study: &StudyFacts) -> Vec<&str> {
        let rows = self.summary.iter().filter(|r| r.is_of(study) && r.is_bound());
        rows.map(|r| r.text("filter")).collect()
    }

    /// Rows of `runs.csv` of a filter, in the order of the runs.
    pub fn runs(&self, study: &StudyFacts, filter: &str) -> Vec<&Row> {
        let of = |r: &&Row| r.is_of(study) && r.text("filter") == filter;
        self.runs.iter().filter(of).collect()
    }

    pub fn paired(&self, study: &StudyFacts) -> Vec<&Row> {
        self.paired.iter().filter(|r| r.is_of(study)).collect()
    }

    pub fn failures(&self, study: &StudyFacts) -> Vec<&Row> {
        self.failures.iter().filter(|r| r.is_of(study)).collect()
    }

    pub fn phases(&self, study: &StudyFacts) -> Vec<&Row> {
        self.phases.iter().filter(|r| r.is_of(study)).collect()
    }

    pub fn requirements(&self, study: &StudyFacts) -> Vec<&Row> {
        self.requirements.iter().filter(|r| r.is_of(study)).collect()
    }

    /// Candidates of the searches in a world.
    pub fn search(&self, scenario: &str) -> Vec<&Row> {
        self.search.iter().filter(|r| r.text("scenario") == scenario).collect()
    }

    /// Rows of `summary.csv` of a world, in all cases.
    pub fn cases(&self, scenario: &str) -> Vec<&Row> {
        self.summary.iter().filter(|r| r.text("scenario") == scenario).collect()
    }

    /// The file over time of a filter; `None` when the folder came without it.
    pub fn epochs(&self, study: &StudyFacts, filter: &str) -> Result<Option<Epochs>, ReportError> {
        self.over_time(&format!("epochs/{}_{filter}_{}.csv", study.scenario, study.case))
    }

    /// The errors of single runs of a filter.
    pub fn run_errors(&self, study: &StudyFacts, filter: &str) -> Result<Option<Epochs>, ReportError> {
        self.over_time(&format!("run_errors/{}_{filter}_{}.csv", study.scenario, study.case))
    }

    /// The true path of run 0.
    pub fn path(&self, study: &StudyFacts) -> Result<Option<Epochs>, ReportError> {
        self.over_time(&format!("paths/{}_{}.csv", study.scenario, study.case))
    }

    fn over_time(&self, name: &str) -> Result<Option<Epochs>, ReportError> {
        over_time(&self.path, name)
    }
}

/// A file over time; `None` when there is none.
pub(crate) fn over_time(folder: &Path, name: &str) -> Result<Option<Epochs>, ReportError> {
    let path = folder.join(name);
    let wrong = |source| ReportError::Table {
        path: path.clone(),
        source,
    };
    if !path.is_file() {
        return Ok(None);
    }
    let mut reader = csv::Reader::from_path(&path).map_err(wrong)?;
    let header: Vec<String> = reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
    let mut columns = vec![Vec::new(); header.len()];
    for record in reader.records() {
        for (column, cell) in columns.iter_mut().zip(&record.map_err(wrong)?) {
            column.push(cell.parse::<f64>().ok());
        }
    }
    Ok(Some(Epochs { header, columns }))
}

/// A file over time: each column with `None` where its cell is empty.
#[derive(Debug)]
pub(crate) struct Epochs {
    pub header: Vec<String>,
    pub columns: Vec<Vec<Option<f64>>>,
}

impl Epochs {
    pub fn column(&self, name: &str) -> Option<&[Option<f64>]> {
        let index = self.header.iter().position(|h| h == name)?;
        self.columns.get(index).map(Vec::as_slice)
    }
}

fn contents(folder: &Path, name: &'static str) -> Result<Vec<u8>, ReportError> {
    let path = folder.join(name);
    fs::read(&path).map_err(|source| match source.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => ReportError::NoStudy {
            path: folder.to_owned(),
            missing: name,
        },
        _ => ReportError::Read { path, source },
    })
}

/// No rows where there is no file.
fn table_if_there(folder: &Path, name: &'static str, needed: &[&'static str]) -> Result<Vec<Row>, ReportError> {
    if folder.join(name).is_file() {
        table(folder, name, needed)
    } else {
        Ok(Vec::new())
    }
}

pub(crate) fn table(folder: &Path, name: &'static str, needed: &[&'static str]) -> Result<Vec<Row>, ReportError> {
    let bytes = contents(folder, name)?;
    let path = folder.join(name);
    let wrong = |source| ReportError::Table {
        path: path.clone(),
        source,
    };
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    let header = reader.headers().map_err(wrong)?.clone();
    if let Some(column) = needed.iter().find(|c| !header.iter().any(|h| h == **c)) {
        return Err(ReportError::NoColumn { path, column });
    }
    reader
        .records()
        .map(|record| {
            let record = record.map_err(wrong)?;
            let cells = header.iter().zip(&record).map(|(h, c)| (h.to_owned(), c.to_owned()));
            Ok(Row(cells.collect()))
        })
        .collect()
}
