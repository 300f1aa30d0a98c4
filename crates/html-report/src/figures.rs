//! What the figures draw, of every study of a folder.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};
use stats::{Bounds, mean_chi_square_bounds};

use crate::ReportError;
use crate::events::{Event, events};
use crate::folder::{Folder, Row, StudyFacts};
use crate::kept::{KeptRuns, Path, kept_runs, path};
use crate::matrix::Matrix;
use crate::search::{Search, searches};
use crate::series::{Column, Series, series};
use crate::window::{Window, window};

/// Most points of a curve.
const POINTS: usize = 1000;

/// Most numbers in all curves of a page: some 1.6 MB.
const NUMBERS: usize = 400_000;

/// Most numbers of single runs: some 1.8 MB.
const RUN_NUMBERS: usize = 450_000;

/// Curves of a filter: three quantities, three axes, three kinds; three of q.
const CURVES: usize = 30;

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
    pub path: Option<Path>,
    /// Position RMSE by phase.
    pub phases: Option<Matrix>,
    /// Position RMSE by case, with the first case of a world that has several.
    pub cases: Option<Matrix>,
    /// What `tune` tried, with the first case of a world.
    pub search: Vec<Search>,
    pub forest: Vec<Forest>,
    /// Quantity and unit.
    pub errors: Vec<[&'static str; 2]>,
    /// For each of `errors`, where the differences span orders of magnitude: within so much of zero their axis is linear.
    pub linear_within: Vec<Option<f64>>,
}

#[derive(Serialize)]
pub(crate) struct FilterFigures {
    pub name: String,
    pub series: Option<Series>,
    pub kept: Option<KeptRuns>,
    pub window: Option<Window>,
    /// Of the mean over the runs at one epoch.
    pub nees_bounds: Option<[f64; 2]>,
    /// Of the means over time that the series has.
    pub nis_bounds: Option<[f64; 2]>,
    pub runs: u32,
    /// RMSE of each run with a result, ascending, for each of `errors`.
    pub sorted: Vec<Vec<f64>>,
}

impl FilterFigures {
    /// Mean over the runs of the root of the jerk density, by axis.
    pub fn jerk_root(&self) -> Option<&[Column; 3]> {
        self.series.as_ref()?.jerk_root.as_ref()
    }
}

/// A mean difference with its interval.
#[derive(Serialize)]
pub(crate) struct Forest {
    pub filter: String,
    pub reference: String,
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
    let of_runs = RUN_NUMBERS / filters.max(1);
    let figures = studies.iter().enumerate();
    figures
        .map(|(index, study)| figures_of(folder, study, index, [points, of_runs]))
        .collect()
}

fn figures_of(folder: &Folder, study: &StudyFacts, index: usize, room: [usize; 2]) -> Result<Figures, ReportError> {
    let (summary, bounds) = (folder.summary(study), folder.bounds(study));
    let mut filters = Vec::new();
    for row in &summary {
        filters.push(filter_figures(folder, study, row, room)?);
    }
    let paired = folder.paired(study);
    let forest: Vec<Forest> = paired.iter().filter_map(|row| forest(row)).collect();
    let file = folder.path(study)?;
    let first = !folder
        .manifest
        .studies
        .iter()
        .take(index)
        .any(|s| s.scenario == study.scenario);
    Ok(Figures {
        id: format!("s{index}"),
        scenario: study.scenario.clone(),
        scored_from_s: study.scored_from_s,
        duration_s: study.duration_s,
        events: events(&study.mission),
        filters,
        path: file.and_then(|file| path(&file, &study.mission["environment"]["gravity"])),
        phases: Matrix::new(&folder.phases(study), "phase", &bounds),
        cases: Matrix::new(&folder.cases(&study.scenario), "case", &bounds).filter(|_| first),
        search: if first {
            searches(&folder.search(&study.scenario))
        } else {
            Vec::new()
        },
        linear_within: ERRORS.iter().map(|(_, name, _)| linear_within(&forest, name)).collect(),
        forest,
        errors: ERRORS.iter().map(|(_, name, unit)| [*name, *unit]).collect(),
    })
}

fn filter_figures(
    folder: &Folder,
    study: &StudyFacts,
    row: &Row,
    [points, of_runs]: [usize; 2],
) -> Result<FilterFigures, ReportError> {
    let name = row.text("filter");
    let epochs = folder.epochs(study, name)?;
    let series = epochs.as_ref().and_then(|epochs| series(epochs, points));
    let runs = folder.runs(study, name);
    let finished = runs.iter().filter(|r| r.count("failed") == 0).count();
    let means = series.as_ref().and_then(|s| Some((s.residual_rows?, s.nis.epochs)));
    let nis_bounds = match means {
        Some((rows, epochs)) if finished > 0 => Some(mean_chi_square_bounds(finished * epochs, rows, CONFIDENCE)?),
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
        kept: folder
            .run_errors(study, name)?
            .and_then(|file| kept_runs(&file, of_runs)),
        window: epochs.as_ref().and_then(|epochs| window(epochs, study.scored_from_s)),
        series,
        runs: study.runs,
        sorted: ERRORS.iter().map(sorted).collect(),
    })
}

/// Half of the least difference, where the largest is more than fifty times that.
fn linear_within(forest: &[Forest], quantity: &str) -> Option<f64> {
    let rows = || forest.iter().filter(|f| f.quantity == quantity);
    let means = rows().map(|f| f.mean.abs()).filter(|m| *m > 0.0);
    let ends = rows()
        .flat_map(|f| [Some(f.mean), f.low, f.high])
        .flatten()
        .map(f64::abs);
    let (least, largest) = (means.min_by(f64::total_cmp)?, ends.max_by(f64::total_cmp)?);
    (largest > 50.0 * least).then_some(0.5 * least)
}

/// A row of `paired.csv` with its interval, or where it tells none that of Student's t about the mean over the runs.
fn forest(row: &Row) -> Option<Forest> {
    let (_, quantity, unit) = *ERRORS.iter().find(|(column, ..)| *column == row.text("quantity"))?;
    let runs = row.count("runs");
    let told = Option::zip(row.number("low"), row.number("high"));
    let mean = told
        .and_then(|_| row.number("difference"))
        .or(row.number("mean_difference"))?;
    let half = row.number("standard_error").and_then(|error| {
        let t = StudentsT::new(0.0, 1.0, runs.checked_sub(1)? as f64).ok()?;
        Some(error * t.inverse_cdf(0.5 * (1.0 + CONFIDENCE)))
    });
    Some(Forest {
        filter: row.text("filter").to_owned(),
        reference: row.text("reference").to_owned(),
        quantity,
        unit,
        runs,
        mean,
        low: told.map(|t| t.0).or(half.map(|h| mean - h)),
        high: told.map(|t| t.1).or(half.map(|h| mean + h)),
    })
}
