//! What a plan requires, held to what its studies found.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use study::{FilterResult, PhaseRun, PhaseSummary, Requirement, Study, StudyResult, Summary};

use crate::HarnessError;
use crate::format::{number as short, wrapped};
use crate::report::column::{self, Column, count, find, number, text};
use crate::report::{phases, summary};

/// The file of a study that holds them.
pub const FILE: &str = "requirements.csv";

/// Verdict on one that is not met.
const MISSED: &str = "MISSED";

/// A requirement, and what a filter did in one world and case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// What is asked.
    pub requirement: Requirement,
    /// World.
    pub scenario: String,
    /// Case.
    pub case: String,
    /// Filter with its preset.
    pub filter: String,
    /// Unit of value and margin.
    pub unit: &'static str,
    /// What is held to the bound: of the column, or the share of runs that satisfy it.
    pub value: Option<f64>,
    /// How far inside the bound it is, with the confidence asked for; negative outside.
    pub margin: Option<f64>,
    /// The bound that is nearest.
    pub bound: Option<f64>,
    /// Runs asked for, failed, diverged.
    pub runs: [u32; 3],
    /// Runs that satisfy the bound by themselves, where a share is asked for.
    pub satisfied: Option<u32>,
    /// Whether it is met.
    pub met: bool,
}

/// Where the value of a metric stands.
enum Metric {
    Summary(&'static Column<Summary>),
    Phases(&'static Column<PhaseSummary>),
}

/// Columns of `summary.csv` with the column of their standard error.
const ERRORS: [(&str, &str); 6] = [
    ("pos_rmse_m", "pos_rmse_se_m"),
    ("vel_rmse_m_s", "vel_rmse_se_m_s"),
    ("acc_rmse_m_s2", "acc_rmse_se_m_s2"),
    ("nees", "nees_se"),
    ("nees6", "nees6_se"),
    ("nis", "nis_se"),
];

/// Columns of `phases.csv` with those of the ends of their 95 % interval.
const INTERVALS: [(&str, &str, &str); 3] = [
    ("pos_rmse_m", "pos_rmse_low_m", "pos_rmse_high_m"),
    ("vel_rmse_m_s", "vel_rmse_low_m_s", "vel_rmse_high_m_s"),
    ("acc_rmse_m_s2", "acc_rmse_low_m_s2", "acc_rmse_high_m_s2"),
];

/// Half the 95 % interval of a Gaussian, in its sigma.
const HALF_95: f64 = 1.959_963_985;

fn wrong(requirement: &Requirement, problem: &str) -> HarnessError {
    HarnessError::Requirement {
        requirement: requirement.to_string(),
        problem: problem.to_owned(),
    }
}

impl Metric {
    fn of(requirement: &Requirement) -> Result<Self, HarnessError> {
        let name = requirement.metric.as_str();
        if requirement.phase.is_none()
            && requirement.share.is_none()
            && let Some(column) = find(summary::COLUMNS, name).filter(|c| !c.is_text())
        {
            return Ok(Self::Summary(column));
        }
        if let Some(column) = find(phases::COLUMNS, name).filter(|c| !c.is_text()) {
            return Ok(Self::Phases(column));
        }
        let of_phases = phases::COLUMNS.iter().filter(|c| !c.is_text()).map(|c| c.name);
        let of_summary = summary::COLUMNS.iter().filter(|c| !c.is_text()).map(|c| c.name);
        let mut known: Vec<&str> = of_phases.collect();
        if requirement.phase.is_none() {
            known.extend(of_summary);
        }
        known.sort_unstable();
        known.dedup();
        Err(wrong(
            requirement,
            &format!("there is no metric '{name}', only {}", known.join(", ")),
        ))
    }

    fn unit(&self) -> &'static str {
        match self {
            Self::Summary(column) => column.unit,
            Self::Phases(column) => column.unit,
        }
    }
}

/// Checks that metrics, phases and filters that are named exist.
///
/// # Errors
/// [`HarnessError::Requirement`], with those there are.
pub fn check(requirements: &[Requirement], studies: &[Study]) -> Result<(), HarnessError> {
    for requirement in requirements {
        let metric = Metric::of(requirement)?;
        let name = requirement.metric.as_str();
        if requirement.share.is_some() {
            if !PhaseRun::COLUMNS.contains(&name) {
                let known = PhaseRun::COLUMNS.join(", ");
                return Err(wrong(
                    requirement,
                    &format!("a share of runs is known of {known} alone"),
                ));
            }
        } else if requirement.confidence.is_some() {
            let known: Vec<&str> = match metric {
                Metric::Summary(_) => ERRORS.iter().map(|(name, _)| *name).collect(),
                Metric::Phases(_) => INTERVALS.iter().map(|(name, ..)| *name).collect(),
            };
            if !known.contains(&name) {
                let text = format!("a confidence needs a share, or one of {}", known.join(", "));
                return Err(wrong(requirement, &text));
            }
        }
        for study in studies {
            let names: Vec<&str> = study.spec.phases.rules().iter().map(|r| r.name.as_str()).collect();
            if let Some(phase) = &requirement.phase
                && !names.contains(&phase.as_str())
            {
                let text = format!(
                    "{} has no phase '{phase}', only {}",
                    study.spec.world.name,
                    names.join(", ")
                );
                return Err(wrong(requirement, &text));
            }
        }
        let labels: Vec<&str> = studies
            .iter()
            .flat_map(|s| s.spec.filters.iter().map(|f| f.label.as_str()))
            .collect();
        if let Some(filter) = &requirement.filter
            && !labels.contains(&filter.as_str())
        {
            let text = format!("filter '{filter}' takes no part, only {}", labels.join(", "));
            return Err(wrong(requirement, &text));
        }
    }
    Ok(())
}

/// Holds every requirement to every case and filter that it is asked of.
///
/// * `rows`, `of_phases`: the summaries of these studies.
///
/// # Errors
/// As for [`check`].
pub fn evaluate(
    requirements: &[Requirement],
    studies: &[Study],
    results: &[StudyResult],
    rows: &[Summary],
    of_phases: &[PhaseSummary],
) -> Result<Vec<Verdict>, HarnessError> {
    check(requirements, studies)?;
    let key = |scenario: &str, case: &str, filter: &str| [scenario, case, filter].map(str::to_owned);
    let rows: BTreeMap<_, _> = rows.iter().map(|r| (key(&r.scenario, &r.case, &r.filter), r)).collect();
    let mut verdicts = Vec::new();
    for requirement in requirements {
        let metric = Metric::of(requirement)?;
        let phase = requirement.phase.as_deref().unwrap_or("scored");
        for (study, result) in studies.iter().zip(results) {
            let asked = |f: &&FilterResult| requirement.filter.as_ref().is_none_or(|label| *label == f.label);
            for filter in result.filters.iter().filter(asked) {
                let own = key(&study.spec.world.name, &study.case, &filter.label);
                let row = rows.get(&own).copied();
                let in_phase = of_phases
                    .iter()
                    .find(|p| p.phase == phase && key(&p.scenario, &p.case, &p.filter) == own);
                let found = match metric {
                    Metric::Summary(column) => row.and_then(|r| column.cell(r).as_f64()),
                    Metric::Phases(column) => in_phase.and_then(|p| column.cell(p).as_f64()),
                };
                let error = match metric {
                    Metric::Summary(_) => row.and_then(|r| error_of(requirement, r)),
                    Metric::Phases(_) => in_phase.and_then(|p| error_in_phase(requirement, p)),
                };
                let judged = judge(requirement, filter, phase, study.runs, metric.unit(), found, error);
                let [scenario, case, filter] = own;
                verdicts.push(Verdict {
                    scenario,
                    case,
                    filter,
                    ..judged
                });
            }
        }
    }
    Ok(verdicts)
}

fn error_of(requirement: &Requirement, row: &Summary) -> Option<f64> {
    let (_, name) = ERRORS.iter().find(|(name, _)| *name == requirement.metric)?;
    summary::value(row, name)
}

/// The standard error that the interval would have of a Gaussian.
fn error_in_phase(requirement: &Requirement, row: &PhaseSummary) -> Option<f64> {
    let (_, low, high) = INTERVALS.iter().find(|(name, ..)| *name == requirement.metric)?;
    let of = |name| find(phases::COLUMNS, name)?.cell(row).as_f64();
    Some((of(high)? - of(low)?) / (2.0 * HALF_95))
}

/// * `value`, `error`: of the metric over all runs.
fn judge(
    requirement: &Requirement,
    filter: &FilterResult,
    phase: &str,
    runs: u32,
    unit: &'static str,
    value: Option<f64>,
    error: Option<f64>,
) -> Verdict {
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let [failed, diverged] = [filter.failed(), filter.diverged()].map(count);
    let verdict = Verdict {
        requirement: requirement.clone(),
        scenario: String::new(),
        case: String::new(),
        filter: String::new(),
        unit,
        value,
        margin: None,
        bound: None,
        runs: [runs, failed, diverged],
        satisfied: None,
        met: false,
    };
    if let Some(share) = requirement.share {
        let of_phase = filter.phases.iter().find(|p| p.name == phase);
        let of_runs = of_phase.into_iter().flat_map(|p| p.runs.iter().zip(&filter.runs));
        let satisfied = of_runs.filter(|(run, row)| {
            row.failure.is_none() && !row.diverged && requirement.holds(run.value(&requirement.metric))
        });
        let satisfied = count(satisfied.count());
        let value = requirement.share_of(satisfied, runs);
        let margin = value.map(|v| v - share);
        return Verdict {
            unit: "1",
            value,
            margin,
            bound: Some(share),
            satisfied: Some(satisfied),
            met: margin.is_some_and(|m| m >= 0.0),
            ..verdict
        };
    }
    let margin = requirement.margin(value, error);
    let ends = requirement.at_least.into_iter().chain(requirement.at_most);
    let bound = ends.min_by(|a, b| {
        let away = |end: f64| (value.unwrap_or_default() - end).abs();
        away(*a).total_cmp(&away(*b))
    });
    // A count of them may allow some; whatever else is pooled leaves them out, and so cannot speak for them.
    let counts_them = ["failed", "diverged"].contains(&requirement.metric.as_str());
    let all_there = counts_them || (failed == 0 && diverged == 0);
    Verdict {
        margin,
        bound,
        met: all_there && margin.is_some_and(|m| m >= 0.0),
        ..verdict
    }
}

impl Verdict {
    /// The margin in percent of the bound that is nearest; `None` of a bound of 0.
    pub fn margin_percent(&self) -> Option<f64> {
        let bound = self.bound.filter(|b| b.abs() > 0.0)?;
        Some(100.0 * self.margin? / bound.abs())
    }

    /// What stands behind a verdict beside its numbers; empty where nothing does.
    pub fn reason(&self) -> String {
        let [runs, failed, diverged] = self.runs;
        let mut parts = Vec::new();
        if self.value.is_none() {
            parts.push("no value".to_owned());
        } else if self.margin.is_none() {
            parts.push("too few runs for the confidence".to_owned());
        }
        if let Some(satisfied) = self.satisfied {
            parts.push(format!("{satisfied} of {runs} runs satisfy it"));
        }
        if failed + diverged > 0 {
            parts.push(format!("of {runs} runs {failed} failed and {diverged} diverged"));
        }
        parts.join("; ")
    }

    fn word(&self) -> &'static str {
        if self.met { "met" } else { MISSED }
    }
}

pub(crate) const COLUMNS: &[Column<Verdict>] = &[
    text("scenario", "world", |v| v.scenario.as_str().into()),
    text("filter", "filter with its preset", |v| v.filter.as_str().into()),
    text("case", "case", |v| v.case.as_str().into()),
    text("metric", "column of summary.csv or phases.csv", |v| {
        v.requirement.metric.as_str().into()
    }),
    text("phase", "phase that counts; empty: the scored time", |v| {
        v.requirement.phase.as_deref().unwrap_or_default().into()
    }),
    number("at_least", "of metric", "smallest value", |v| v.requirement.at_least),
    number("at_most", "of metric", "largest value", |v| v.requirement.at_most),
    number("share", "1", "least share of runs that each satisfy the bound", |v| {
        v.requirement.share
    }),
    number("confidence", "1", "one-sided confidence asked for", |v| {
        v.requirement.confidence
    }),
    number(
        "value",
        "of unit",
        "of the metric over all runs; with a share, that of the runs that satisfy the bound, with a confidence its lower bound",
        |v| v.value,
    ),
    text("unit", "of value and margin", |v| v.unit.into()),
    number(
        "margin",
        "of unit",
        "how far inside the bound, with the confidence asked for; negative outside",
        |v| v.margin,
    ),
    number(
        "margin_percent",
        "%",
        "the same of the nearest bound",
        Verdict::margin_percent,
    ),
    count("runs", "runs asked for", |v| Some(v.runs[0].into())),
    count("failed", "runs that ended with an error", |v| Some(v.runs[1].into())),
    count("diverged", "runs that lost the target", |v| Some(v.runs[2].into())),
    count("satisfied", "runs that satisfy the bound, with a share", |v| {
        v.satisfied.map(u64::from)
    }),
    text(
        "verdict",
        "met or MISSED; without a share, failed or diverged runs miss it whatever the value",
        |v| v.word().into(),
    ),
    text("reason", "what stands behind it beside the numbers", |v| {
        v.reason().into()
    }),
];

/// Contents of `requirements.csv`.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_csv(verdicts: &[Verdict]) -> Result<Vec<u8>, HarnessError> {
    column::render(COLUMNS, verdicts)
}

/// How many requirements the study of a folder has missed, by its `requirements.csv`; none without one.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn missed_in(folder: &Path) -> Result<usize, HarnessError> {
    let path = folder.join(FILE);
    if !path.exists() {
        return Ok(0);
    }
    let mut reader = csv::Reader::from_path(&path)?;
    let place = reader.headers()?.iter().position(|name| name == "verdict");
    let verdicts = reader
        .records()
        .map(|row| Ok(row?.get(place.unwrap_or(usize::MAX)) == Some(MISSED)));
    let missed = verdicts.collect::<Result<Vec<_>, HarnessError>>()?;
    Ok(missed.into_iter().filter(|missed| *missed).count())
}

/// What a terminal of 80 columns shows, by world and case, without a final newline.
pub fn render(verdicts: &[Verdict]) -> String {
    let line = |v: &Verdict| {
        let percent = v.margin_percent().map_or_else(String::new, |p| format!(" ({p:+.1} %)"));
        let unit = if v.unit == "1" {
            String::new()
        } else {
            format!(" {}", v.unit)
        };
        let mut text = format!(
            "{:6}  {}: {}: {}{unit}, margin {}{percent}",
            v.word(),
            v.filter,
            v.requirement,
            short(v.value),
            short(v.margin)
        );
        if !v.reason().is_empty() {
            text.push_str(&format!("; {}", v.reason()));
        }
        wrapped(&text)
    };
    let place = |v: &Verdict| (v.scenario.clone(), v.case.clone());
    let mut places: Vec<(String, String)> = Vec::new();
    for own in verdicts.iter().map(place) {
        if !places.contains(&own) {
            places.push(own);
        }
    }
    let mut lines = Vec::new();
    for own in places {
        lines.push(format!("{}, case {}", own.0, own.1));
        lines.extend(verdicts.iter().filter(|v| place(v) == own).map(line));
    }
    lines.join("\n")
}
