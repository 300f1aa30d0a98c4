//! What becomes of finished studies: files and tables.

use std::io::Write;

use study::{Calibration, Models, Plan, Study, StudyResult, Summary, Workers, chain};

use super::files::Report;
use super::report::write_page;
use super::shared::{closing, note, say};
use crate::HarnessError;
use crate::claims;
use crate::output::OutputFolder;
use crate::report::table;
use crate::requirements;
use crate::store::StudyFolder;

/// Studies that are over.
#[derive(Clone, Copy)]
pub(super) struct Finished<'a> {
    pub(super) studies: &'a [Study],
    pub(super) results: &'a [StudyResult],
    /// Those that have made the runs, where this process has not.
    pub(super) workers: &'a [Workers],
    /// Whether the folder gets its HTML page.
    pub(super) page: bool,
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
    out: &mut dyn Write,
) -> Result<Judgement, HarnessError> {
    let report = Report::new(&plan.requirements, finished.studies, finished.results, finished.workers)?;
    let output = folder.output().clone();
    let mut files = report.write(&output, models, plan, 0, Vec::new(), Some(folder.identity()))?;
    if finished.page {
        match write_page(&output) {
            Ok(name) => files.push(name),
            // The results are worth more than their page.
            Err(error) => note(&format!("note: there is no report.html: {}", chain(&error))),
        }
    }
    folder.complete()?;
    // What a source claims is claimed of its own world, not of a changed one.
    let as_published = plan.assignments.is_empty() && plan.variations.is_empty() && plan.truth.is_none();
    let claims_missed = print(&report, as_published, &output, &files, out)?;
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
    as_published: bool,
    folder: &OutputFolder,
    files: &[String],
    out: &mut dyn Write,
) -> Result<bool, HarnessError> {
    let mut missed = false;
    for (study, result) in report.studies.iter().zip(report.results) {
        let world = &study.spec.world;
        let rows: Vec<Summary> = report
            .rows
            .iter()
            .filter(|r| r.scenario == world.name)
            .cloned()
            .collect();
        let heading = format!(
            "{}, case {}: {} runs from seed {}, {} to {} s, {:.1} s on {} threads",
            world.name,
            study.case,
            study.runs,
            study.spec.seed,
            world.scored_from_s,
            world.duration_s,
            result.wall.as_secs_f64(),
            study.jobs
        );
        say(
            out,
            &format!(
                "{heading}\n{}\n{}",
                table::render(&rows, &report.timings),
                table::LEGEND
            ),
        )?;
        let verdicts = if as_published {
            claims::verdicts(&world.name, &rows)
        } else {
            Vec::new()
        };
        say(out, &format!("\n{}", table::render_axes(&rows, world.axes.names())))?;
        if !verdicts.is_empty() {
            say(out, &format!("\n{}\n{}", world.reference, claims::render(&verdicts)))?;
        }
        missed |= verdicts.iter().any(|v| !v.holds());
        say(out, "")?;
    }
    if !report.verdicts.is_empty() {
        say(
            out,
            &format!("Requirements\n{}\n", requirements::render(&report.verdicts)),
        )?;
    }
    say(out, &calibration(&report.calibration))?;
    closing(folder, files, out)?;
    Ok(missed)
}
