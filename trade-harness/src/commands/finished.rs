//! What becomes of finished studies: files and tables.

use serde_json::json;
use study::{Calibration, Models, Output, Plan, Study, StudyResult, Summary, Workers, chain};

use super::files::{Report, Told};
use super::out::Out;
use super::report::write_page;
use super::shared::{closing, note};
use crate::HarnessError;
use crate::claims;
use crate::format::wrapped;
use crate::output::OutputFolder;
use crate::report::column::fields;
use crate::report::summary::COLUMNS;
use crate::report::table;
use crate::requirements;
use crate::store::StudyFolder;

/// Name of the file that makes the study again.
const STUDY_FILE: &str = "study.toml";

/// What was run: all of the plan but threads, workers and folder, which change no number.
fn whole(plan: &Plan, studies: &[Study]) -> Result<Plan, HarnessError> {
    let mut labels = studies.iter().map(|study| {
        let filters = study.spec.filters.iter().map(|filter| &filter.label);
        let ours = filters.filter(|label| plan.foreign.iter().all(|foreign| foreign.label != **label));
        ours.filter_map(|label| label.parse().ok()).collect::<Vec<_>>()
    });
    // Worlds with filters of their own keep them.
    let first = labels.next();
    let same = first.filter(|first| labels.all(|other| other == *first));
    let plan = Plan {
        filters: same.or(plan.filters.clone()),
        output: Output {
            folder: None,
            ..plan.output.clone()
        },
        ..plan.without_means()
    };
    Ok(plan.with_whole_paths()?)
}

/// Studies that are over.
#[derive(Clone, Copy)]
pub(super) struct Finished<'a> {
    pub(super) studies: &'a [Study],
    pub(super) results: &'a [StudyResult],
    /// Those that have made the runs, where this process has not.
    pub(super) workers: &'a [Workers],
    /// Notes that have been said.
    pub(super) said: &'a [String],
    /// Whether the folder gets its HTML page.
    pub(super) page: bool,
    /// Whether every column is printed.
    pub(super) wide: bool,
}

/// What finished studies are found to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Judgement {
    /// Whether a claim of a source was missed.
    pub(super) claims_missed: bool,
    /// Whether a requirement was missed, or a filter failed every run, or the statistics are not to be trusted.
    pub(super) failed: bool,
}

/// Writes and prints what finished studies found; says what was missed.
pub(super) fn finish(
    folder: StudyFolder,
    finished: Finished<'_>,
    models: &Models,
    plan: &Plan,
    out: &mut Out<'_>,
) -> Result<Judgement, HarnessError> {
    let report = Report::new(&plan.requirements, finished.studies, finished.results, finished.workers)?;
    let output = folder.output().clone();
    let whole = whole(plan, finished.studies)?;
    let own = vec![(STUDY_FILE.to_owned(), whole.to_toml()?.into_bytes())];
    let told = Told {
        identity: folder.identity(),
        plan: &whole,
    };
    let mut files = report.write(&output, models, plan, 0, own, Some(told))?;
    if finished.page {
        match write_page(&output) {
            Ok(name) => files.push(name),
            // The results are worth more than their page.
            Err(error) => note(&format!("note: there is no report.html: {}", chain(&error))),
        }
    }
    folder.complete()?;
    let mut said = finished.said.to_vec();
    for text in finished.results.iter().flat_map(|result| &result.messages) {
        if !said.contains(text) {
            note(&format!("note: in run 0, {text}"));
            said.push(text.clone());
        }
    }
    let claims_missed = print(&report, plan, finished.wide, &output, &files, out)?;
    let hopeless = hopeless(&report);
    hopeless.iter().for_each(|text| note(text));
    Ok(Judgement {
        claims_missed,
        failed: !hopeless.is_empty() || !report.calibration.holds || report.verdicts.iter().any(|v| !v.met),
    })
}

/// What the statistics made of a case whose answers are known.
fn calibration(tried: &Calibration) -> String {
    let outside: Vec<&str> = tried
        .checks
        .iter()
        .filter(|c| !c.holds())
        .map(|c| c.statistic)
        .collect();
    let inside = format!(
        "Calibration: {} of {} statistics of a matched linear filter inside their bounds, {} runs",
        tried.checks.len() - outside.len(),
        tried.checks.len(),
        tried.runs
    );
    if outside.is_empty() {
        inside
    } else {
        format!("{inside}; outside: {}", outside.join(", "))
    }
}

/// A line for each filter that has no result in any run.
fn hopeless(report: &Report<'_>) -> Vec<String> {
    let without = |row: &&Summary| row.runs > 0 && row.failed as u64 == u64::from(row.runs);
    let told = report.rows.iter().filter(without).map(|row| {
        format!(
            "failed: {} in {}, case {}: none of its {} runs has a result; failures.csv says why",
            row.filter, row.scenario, row.case, row.runs
        )
    });
    told.collect()
}

fn print(
    report: &Report<'_>,
    plan: &Plan,
    wide: bool,
    folder: &OutputFolder,
    files: &[String],
    out: &mut Out<'_>,
) -> Result<bool, HarnessError> {
    let mut missed = false;
    let mut told = Vec::new();
    for (study, result) in report.studies.iter().zip(report.results) {
        let world = &study.spec.world;
        let rows: Vec<Summary> = report
            .rows
            .iter()
            .filter(|r| r.scenario == world.name && r.case == study.case)
            .cloned()
            .collect();
        let heading = format!(
            "{}, case {}\n{} runs from seed {}, scored {} to {} s; {:.1} s on {} threads",
            world.name,
            study.case,
            study.runs,
            study.spec.seed,
            world.scored_from_s,
            world.duration_s,
            result.wall.as_secs_f64(),
            study.jobs
        );
        out.say(&heading)?;
        if wide {
            out.say(&format!(
                "{}\n{}",
                table::render_wide(&rows, &report.timings),
                table::WIDE_LEGEND
            ))?;
        } else {
            out.say(&format!("{}\n{}", table::render(&rows), table::LEGEND))?;
        }
        for line in table::missing(&rows) {
            out.say(&wrapped(&line))?;
        }
        // What a source claims is claimed of its own world, not of a changed one.
        for note in &world.notes {
            out.say(&wrapped(&format!("note: {note}")))?;
        }
        let verdicts = if plan.of_case(&study.case).as_published() {
            claims::verdicts(&world.name, &rows)
        } else {
            Vec::new()
        };
        if wide {
            out.say(&format!("\n{}", table::render_axes(&rows, world.axes.names())))?;
        }
        if !verdicts.is_empty() {
            let claims: Vec<String> = claims::render(&verdicts).lines().map(wrapped).collect();
            out.say(&format!("\n{}\n{}", world.reference, claims.join("\n")))?;
        }
        told.push(json!({
            "scenario": world.name, "case": study.case, "runs": study.runs, "seed": study.spec.seed,
            "notes": world.notes, "filters": rows.iter().map(|row| fields(COLUMNS, row)).collect::<Vec<_>>(),
            "claims": verdicts.iter().map(|v| json!({
                "filter": v.claim.filter, "column": v.claim.column, "value": v.value, "holds": v.holds(), "text": v.claim.text,
            })).collect::<Vec<_>>(),
        }));
        missed |= verdicts.iter().any(|v| v.holds() == Some(false));
        out.say("")?;
    }
    if !report.verdicts.is_empty() {
        out.say(&format!("Requirements\n{}\n", requirements::render(&report.verdicts)))?;
    }
    out.say(&calibration(&report.calibration))?;
    out.tell("studies", told)?;
    out.tell("requirements", &report.verdicts)?;
    out.tell("calibration", &report.calibration)?;
    closing(folder, files, out)?;
    Ok(missed)
}
