//! What the figures draw, of every study of a folder.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};
use stats::{Bounds, mean_chi_square_bounds};

use crate::ReportError;
use crate::events::{Event, events};
use crate::folder::{Folder, Row, StudyFacts};
use crate::series::{Series, series};

/// Most points of a curve.
const POINTS: usize = 1000;

/// Most numbers in all curves of a page: some 3 MB.
const NUMBERS: usize = 400_000;

/// Curves of a filter: three quantities, three axes, three kinds; NEES and NIS.
const CURVES: usize = 29;

/// Two-sided probability of bounds and intervals.
const CONFIDENCE: f64 = 0.95;

/// Column of `runs.csv` and `paired.csv`, what it is, its unit.
const ERRORS: [(&str, &str, &str); 3] = [
    ("pos_rmse_m", "position", "m"),
    ("vel_rmse_m_s", "velocity", "m/s"),
    ("acc_rmse_m_s2", "acceleration", "m/s²"),
];

/// What the figures of a study draw.
#[derive(Serialize)]
pub(crate) struct Figures {
    pub id: String,
    pub scenario: String,
    pub scored_from_s: f64,
    pub duration_s: f64,
    pub events: Vec<Event>,
    pub filters: Vec<FilterFigures>,
    pub reference: String,
    pub forest: Vec<Forest>,
    pub errors: Vec<[&'static str; 2]>,
}

#[derive(Serialize)]
pub(crate) struct FilterFigures {
    pub name: String,
    pub series: Option<Series>,
    pub nees_bounds: Option<[f64; 2]>,
    pub nis_bounds: Option<[f64; 2]>,
    pub runs: u32,
    /// RMSE of each run with a result, ascending, for each of `errors`.
    pub sorted: Vec<Vec<f64>>,
}

/// A mean difference with its interval.
#[derive(Serialize)]
pub(crate) struct Forest {
    pub filter: String,
    pub quantity: &'static str,
    pub unit: &'static str,
    pub runs: u64,
    pub mean: f64,
    pub low: Option<f64>,
    pub high: Option<f64>,
}

/// The figures of every study, in the order of the manifest.
pub(crate) fn all(folder: &Folder) -> Result<Vec<Figures>, ReportError> {
    let studies = &folder.manifest.studies;
    let filters: usize = studies.iter().map(|s| s.filters.len()).sum();
    let points = (NUMBERS / (CURVES * filters.max(1))).clamp(50, POINTS);
    let figures = studies.iter().enumerate();
    figures
        .map(|(index, study)| figures_of(folder, study, index, points))
        .collect()
}

fn figures_of(folder: &Folder, study: &StudyFacts, index: usize, points: usize) -> Result<Figures, ReportError> {
    let summary = folder.summary(study);
    let mut filters = Vec::new();
    for row in &summary {
        filters.push(filter_figures(folder, study, row, points)?);
    }
    let paired = folder.paired(study);
    let reference = paired.first().map_or("", |r| r.text("reference")).to_owned();
    Ok(Figures {
        id: format!("s{index}"),
        scenario: study.scenario.clone(),
        scored_from_s: study.scored_from_s,
        duration_s: study.duration_s,
        events: events(&study.mission),
        filters,
        forest: (paired.iter())
            .filter(|row| row.text("reference") == reference)
            .filter_map(|row| forest(row))
            .collect(),
        reference,
        errors: ERRORS.iter().map(|(_, name, unit)| [*name, *unit]).collect(),
    })
}

fn filter_figures(folder: &Folder, study: &StudyFacts, row: &Row, points: usize) -> Result<FilterFigures, ReportError> {
    let name = row.text("filter");
    let epochs = folder.epochs(study, name)?;
    let series = epochs.as_ref().and_then(|epochs| series(epochs, points));
    let runs = folder.runs(study, name);
    let finished = runs.iter().filter(|r| r.count("failed") == 0).count();
    let nis_bounds = match series.as_ref().and_then(|s| s.residual_rows) {
        Some(rows) if finished > 0 => Some(mean_chi_square_bounds(finished, rows, CONFIDENCE)?),
        _ => None,
    };
    let sorted = |(column, ..): &(&str, &str, &str)| {
        let mut values: Vec<f64> = runs.iter().filter_map(|r| r.number(column)).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    Ok(FilterFigures {
        name: name.to_owned(),
        nees_bounds: Option::zip(row.number("nees_low"), row.number("nees_high")).map(|(low, high)| [low, high]),
        nis_bounds: nis_bounds.map(|Bounds { low, high }| [low, high]),
        series,
        runs: study.runs,
        sorted: ERRORS.iter().map(sorted).collect(),
    })
}

/// A row of `paired.csv` with the interval of Student's t.
fn forest(row: &Row) -> Option<Forest> {
    let (_, quantity, unit) = *ERRORS.iter().find(|(column, ..)| *column == row.text("quantity"))?;
    let mean = row.number("mean_difference")?;
    let runs = row.count("runs");
    let half = row.number("standard_error").and_then(|error| {
        let t = StudentsT::new(0.0, 1.0, runs.checked_sub(1)? as f64).ok()?;
        Some(error * t.inverse_cdf(0.5 * (1.0 + CONFIDENCE)))
    });
    Some(Forest {
        filter: row.text("filter").to_owned(),
        quantity,
        unit,
        runs,
        mean,
        low: half.map(|h| mean - h),
        high: half.map(|h| mean + h),
    })
}
