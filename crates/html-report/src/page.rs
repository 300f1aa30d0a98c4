//! The template, filled.

use std::collections::BTreeSet;

use askama::Template;
use serde_json::Value;

use crate::ReportError;
use crate::figures::{self, Figures, FilterFigures};
use crate::folder::{Folder, Manifest, Row, StudyFacts};
use crate::frame::Frame;
use crate::number::short;
use crate::series::{Means, Series};
use crate::verdict::{RunValues, Verdict};

/// Worst runs listed of each filter.
const WORST: usize = 5;

/// Column of `summary.csv`, heading, unit.
const TABLE: [(&str, &str, &str); 14] = [
    ("pos_rmse_m", "position RMSE", "m"),
    ("pos_rmse_se_m", "standard error", "m"),
    ("vel_rmse_m_s", "velocity RMSE", "m/s"),
    ("acc_rmse_m_s2", "acceleration RMSE", "m/s²"),
    ("ratio_pos", "σ ratio position", ""),
    ("ratio_vel", "σ ratio velocity", ""),
    ("ratio_acc", "σ ratio acceleration", ""),
    ("mean_err_sigma", "mean error", "σ"),
    ("nees", "NEES", ""),
    ("nees_inside", "NEES in bounds", ""),
    ("nees6", "NEES position, velocity", ""),
    ("nis", "NIS", ""),
    ("failed", "failed", ""),
    ("diverged", "diverged", ""),
];

#[derive(Template)]
#[template(path = "report.html")]
struct Page {
    frame: Frame,
    studies: Vec<Section>,
    digests: Vec<[String; 2]>,
}

/// What the page says of one world's study.
struct Section {
    id: String,
    scenario: String,
    case: String,
    about: String,
    headline: String,
    sentences: Vec<String>,
    nominal: bool,
    deviations: Vec<String>,
    facts: Vec<[String; 2]>,
    badges: Vec<Badges>,
    /// Who meets every requirement.
    fit: String,
    met: Vec<Requirement>,
    missed: Vec<Requirement>,
    identity: String,
    short_identity: String,
    headings: Vec<[&'static str; 2]>,
    rows: Vec<TableRow>,
    worst: Vec<Worst>,
    notes: Vec<String>,
    every: usize,
    /// Epochs of which each point of the NEES is a mean.
    nees_epochs: usize,
    nis_epochs: usize,
    has_curves: bool,
    has_events: bool,
    drawn_events: bool,
    has_nis_bounds: bool,
    has_runs: bool,
    has_jerk_root: bool,
    has_path: bool,
    has_phases: bool,
    has_cases: bool,
    has_search: bool,
}

/// A line of `requirements.csv`.
#[derive(Clone)]
struct Requirement {
    met: bool,
    filter: String,
    text: String,
    margin: String,
}

struct TableRow {
    filter: String,
    cells: Vec<TableCell>,
}

struct TableCell {
    value: String,
    shown: String,
}

/// How a filter did, in few words.
struct Badges {
    filter: String,
    marks: Vec<Mark>,
}

struct Mark {
    good: bool,
    text: String,
}

struct Worst {
    filter: String,
    runs: Vec<WorstRun>,
}

struct WorstRun {
    run: String,
    what: String,
    nees: String,
    command: String,
}

pub(crate) fn render(folder: &Folder) -> Result<String, ReportError> {
    let manifest = &folder.manifest;
    let mut studies = Vec::new();
    let figures = figures::all(folder)?;
    for (study, drawn) in manifest.studies.iter().zip(&figures) {
        studies.push(section(folder, study, drawn)?);
    }
    let mut worlds: Vec<&str> = manifest.studies.iter().map(|s| s.scenario.as_str()).collect();
    worlds.dedup();
    let page = Page {
        frame: Frame::new(format!("Navigation filters in {}", worlds.join(", ")), &figures)?,
        studies,
        digests: digests(manifest),
    };
    Ok(page.render()?)
}

fn section(folder: &Folder, study: &StudyFacts, figures: &Figures) -> Result<Section, ReportError> {
    let summary = folder.summary(study);
    let filters = summary.iter().filter(|row| !row.is_bound());
    let values: Vec<RunValues> = filters.map(|row| run_values(folder, study, row)).collect();
    let verdict = Verdict::new(&values)?;
    let (headline, mut sentences) = match &verdict {
        Some(verdict) => (format!("{}.", verdict.headline()), verdict.sentences()),
        None => ("No filter has a result.".to_owned(), Vec::new()),
    };
    let bounds = folder.bounds(study);
    if !bounds.is_empty() {
        sentences.push(format!(
            "Bounds, told by the truth and not held beside it: {}.",
            bounds.join(", ")
        ));
    }
    let deviations = deviations(study);
    let requirements: Vec<Requirement> = folder.requirements(study).into_iter().map(requirement).collect();
    let every = figures
        .filters
        .iter()
        .filter_map(|f| Some(f.series.as_ref()?.every))
        .max();
    let epochs = |of: fn(&Series) -> &Means| {
        let drawn = figures.filters.iter().filter_map(|f| f.series.as_ref());
        drawn.map(|series| of(series).epochs).max().unwrap_or(1)
    };
    let any = |has: fn(&FilterFigures) -> bool| figures.filters.iter().any(has);
    Ok(Section {
        has_runs: any(|f| f.kept.is_some()),
        has_jerk_root: any(|f| f.jerk_root().is_some()),
        has_path: figures.path.is_some(),
        has_phases: figures.phases.is_some(),
        has_cases: figures.cases.is_some(),
        has_search: !figures.search.is_empty(),
        fit: fit(&requirements),
        met: requirements.iter().filter(|r| r.met).cloned().collect(),
        missed: requirements.into_iter().filter(|r| !r.met).collect(),
        short_identity: folder
            .manifest
            .identity
            .iter()
            .flat_map(|id| id.chars().take(12))
            .collect(),
        identity: folder.manifest.identity.clone().unwrap_or_default(),
        id: figures.id.clone(),
        scenario: study.scenario.clone(),
        case: study.case.clone(),
        about: study.mission["about"].as_str().unwrap_or_default().to_owned(),
        headline,
        sentences,
        nominal: deviations.is_empty(),
        deviations,
        facts: vec![
            ["runs".to_owned(), study.runs.to_string()],
            ["seed".to_owned(), study.study_seed.to_string()],
            ["duration".to_owned(), format!("{} s", study.duration_s)],
            ["scored from".to_owned(), format!("{} s", study.scored_from_s)],
            ["step".to_owned(), format!("{} s", study.step_s)],
        ],
        badges: summary.iter().map(|row| badges(row)).collect(),
        headings: TABLE.iter().map(|(_, heading, unit)| [*heading, *unit]).collect(),
        rows: summary.iter().map(|row| table_row(row)).collect(),
        worst: summary
            .iter()
            .map(|row| worst(folder, study, row.text("filter")))
            .collect(),
        notes: study.notes.clone(),
        every: every.unwrap_or(1),
        nees_epochs: epochs(|series| &series.nees),
        nis_epochs: epochs(|series| &series.nis),
        has_curves: every.is_some(),
        has_events: !figures.events.is_empty(),
        drawn_events: figures.events.iter().any(|e| e.drawn),
        has_nis_bounds: figures.filters.iter().any(|f| f.nis_bounds.is_some()),
    })
}

fn run_values(folder: &Folder, study: &StudyFacts, row: &Row) -> RunValues {
    let filter = row.text("filter");
    RunValues {
        filter: filter.to_owned(),
        rmse: row.number("pos_rmse_m"),
        standard_error: row.number("pos_rmse_se_m"),
        runs: folder
            .runs(study, filter)
            .iter()
            .map(|r| r.number("pos_rmse_m"))
            .collect(),
        failed: row.count("failed"),
        diverged: row.count("diverged"),
    }
}

/// Everything that differs from the mission as published and from the defaults.
fn deviations(study: &StudyFacts) -> Vec<String> {
    let plan = &study.plan;
    let list = |key: &str| texts(&plan[key]);
    let mut found: Vec<String> = list("set").iter().map(|s| format!("set {s}")).collect();
    found.extend(list("vary").iter().map(|v| format!("varied {v}")));
    found.extend(plan["truth"].as_str().map(|path| format!("foreign world {path}")));
    found.extend(list("nav").iter().map(|nav| format!("foreign filter {nav}")));
    found.extend(list("map").iter().map(|map| format!("mapped {map}")));
    if plan["tuned"].as_array().is_some_and(|sets| !sets.is_empty()) {
        found.push("tuned sets in the place of presets".to_owned());
    }
    if let Some(scheme) = plan["scheme"].as_str().filter(|s| *s != "gauss-seidel") {
        found.push(format!("scheme {scheme}"));
    }
    // Both are numbers that were copied, not computed.
    if study.step_s.total_cmp(&study.sample_period_s).is_ne() {
        found.push(format!(
            "step of {} s instead of {} s",
            study.step_s, study.sample_period_s
        ));
    }
    if let Some(own) = study.mission["time"]["duration_s"].as_f64()
        && own.total_cmp(&study.duration_s).is_ne()
    {
        found.push(format!("{} s long instead of {own} s", study.duration_s));
    }
    found
}

/// The texts of a list; what is no text as JSON.
fn texts(list: &Value) -> Vec<String> {
    let text = |v: &Value| v.as_str().map_or_else(|| v.to_string(), str::to_owned);
    list.as_array().into_iter().flatten().map(text).collect()
}

fn badges(row: &Row) -> Badges {
    let mut marks = Vec::new();
    for kind in ["failed", "diverged"] {
        let n = row.count(kind);
        marks.push(Mark {
            good: n == 0,
            text: format!("{n} {kind}"),
        });
    }
    // Most filters have neither.
    for (column, what) in [
        ("cov_broken", "samples without a covariance"),
        ("missing_epochs", "samples unanswered"),
    ] {
        let n = row.count(column);
        marks.extend((n > 0).then(|| Mark {
            good: false,
            text: format!("{n} {what}"),
        }));
    }
    if let (Some(nees), Some(low), Some(high)) = (row.number("nees"), row.number("nees_low"), row.number("nees_high")) {
        let good = (low..=high).contains(&nees);
        let place = match good {
            true => "in",
            false if nees < low => "below",
            false => "above",
        };
        marks.push(Mark {
            good,
            // Bounds stay on one line.
            text: format!(
                "NEES {} {place} {}\u{2060}–\u{2060}{}",
                short(Some(nees)),
                short(Some(low)),
                short(Some(high))
            ),
        });
    }
    Badges {
        filter: row.text("filter").to_owned(),
        marks,
    }
}

/// A requirement in words: metric, phase, value and bounds.
fn requirement(row: &Row) -> Requirement {
    // A share or a normalised square has none to show.
    let unit = match row.text("unit") {
        "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let mut text = row.text("metric").to_owned();
    if !row.text("phase").is_empty() {
        text.push_str(&format!(" in {}", row.text("phase")));
    }
    let value = |column: &str| row.number(column).map(|v| short(Some(v)).replace('-', "−"));
    if let Some(value) = value("value") {
        text.push_str(&format!(" {value}{unit}"));
    }
    for (column, sign) in [("at_least", "≥"), ("at_most", "≤")] {
        if let Some(bound) = value(column) {
            text.push_str(&format!(", required {sign} {bound}"));
        }
    }
    let met = row.text("verdict") == "met";
    let reason = row.text("reason");
    if !met && !reason.is_empty() {
        text.push_str(&format!("; {reason}"));
    }
    Requirement {
        met,
        filter: row.text("filter").to_owned(),
        text,
        margin: value("margin").map_or_else(String::new, |margin| format!("margin {margin}{unit}")),
    }
}

/// Who meets every requirement that it is held to, and who does not; nothing where nothing is required.
fn fit(requirements: &[Requirement]) -> String {
    let mut filters: Vec<&str> = requirements.iter().map(|r| r.filter.as_str()).collect();
    let mut seen = BTreeSet::new();
    filters.retain(|filter| seen.insert(*filter));
    let meets = |filter: &&str| requirements.iter().filter(|r| r.filter == **filter).all(|r| r.met);
    let (fit, unfit): (Vec<&str>, Vec<&str>) = filters.into_iter().partition(meets);
    match (fit.is_empty(), unfit.is_empty()) {
        (true, true) => String::new(),
        (false, true) => "Every filter meets every requirement.".to_owned(),
        (true, false) => "No filter meets every requirement.".to_owned(),
        (false, false) => format!(
            "Every requirement is met by {}, not by {}.",
            fit.join(", "),
            unfit.join(", ")
        ),
    }
}

fn table_row(row: &Row) -> TableRow {
    let cell = |(column, ..): &(&str, &str, &str)| TableCell {
        value: row.text(column).to_owned(),
        shown: match *column {
            "failed" | "diverged" => row.count(column).to_string(),
            // A mean over what is left says too little of such a filter.
            "nees" | "nees6" | "nees_inside" if row.count("cov_broken") > 0 => {
                format!("{} !", short(row.number(column)))
            }
            _ => short(row.number(column)),
        },
    };
    let bound = if row.is_bound() { " (bound)" } else { "" };
    TableRow {
        filter: format!("{}{bound}", row.text("filter")),
        cells: TABLE.iter().map(cell).collect(),
    }
}

/// The runs of a filter that failed, then those of the largest position error.
fn worst(folder: &Folder, study: &StudyFacts, filter: &str) -> Worst {
    let mut runs = folder.runs(study, filter);
    let key = |r: &Row| r.number("pos_rmse_m").unwrap_or(f64::INFINITY);
    runs.sort_by(|a, b| key(b).total_cmp(&key(a)));
    let failures = folder.failures(study);
    let line = |row: &&Row| {
        let run = row.text("run").to_owned();
        let failure = failures
            .iter()
            .find(|f| f.text("filter") == filter && f.text("run") == run);
        let lost = if row.count("diverged") > 0 { ", diverged" } else { "" };
        WorstRun {
            what: match failure {
                Some(f) => format!("failed: {}", f.text("message")),
                None => format!("{} m{lost}", short(row.number("pos_rmse_m"))),
            },
            nees: short(row.number("nees")),
            command: replay(study, filter, &run),
            run,
        }
    };
    Worst {
        filter: filter.to_owned(),
        runs: runs.iter().take(WORST).map(line).collect(),
    }
}

/// The command line that writes one run of one filter out, from the folder of the page.
fn replay(study: &StudyFacts, filter: &str, run: &str) -> String {
    let mut words = vec!["trade-harness".to_owned(), "replay".to_owned(), "DIR".to_owned()];
    for (name, value) in [
        ("scenario", study.scenario.as_str()),
        ("case", &study.case),
        ("run", run),
        ("filter", filter),
    ] {
        words.extend([format!("--{name}"), quoted(value)]);
    }
    words.join(" ")
}

/// A word that a shell takes as one.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "@%+=:,./_-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Whatever tells this study from any other.
fn digests(manifest: &Manifest) -> Vec<[String; 2]> {
    let mut found = Vec::new();
    found.extend(
        manifest
            .identity
            .iter()
            .map(|id| ["study (SHA-256)".to_owned(), id.clone()]),
    );
    for (name, model) in &manifest.models {
        for (key, value) in model.as_object().into_iter().flatten() {
            if let (true, Some(value)) = (["guid", "sha256"].contains(&key.as_str()), value.as_str()) {
                found.push([format!("{name} ({key})"), value.to_owned()]);
            }
        }
    }
    found.push(["version".to_owned(), manifest.harness_version.clone()]);
    found
}
