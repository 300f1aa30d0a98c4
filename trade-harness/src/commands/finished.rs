//! What becomes of finished studies: files and tables.

use std::io::Write;

use study::{Models, Output, Plan, Study, StudyResult, Summary, Workers, chain};

use super::files::Report;
use super::report::write_page;
use super::shared::{closing, note, say};
use crate::HarnessError;
use crate::claims;
use crate::output::OutputFolder;
use crate::report::table;
use crate::store::StudyFolder;

/// Name of the file that makes the study again.
const STUDY_FILE: &str = "study.toml";

/// The study file of what was run: all of the plan but threads and folder, which change no number.
fn study_file(plan: &Plan, studies: &[Study]) -> Result<String, HarnessError> {
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
        jobs: None,
        output: Output {
            folder: None,
            ..plan.output.clone()
        },
        ..plan.clone()
    };
    Ok(plan.with_whole_paths()?.to_toml()?)
}

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

/// Writes and prints what finished studies found; returns whether a bound was missed.
pub(super) fn finish(
    folder: StudyFolder,
    finished: Finished<'_>,
    models: &Models,
    plan: &Plan,
    out: &mut dyn Write,
) -> Result<bool, HarnessError> {
    let report = Report::new(finished.studies, finished.results, finished.workers);
    let output = folder.output().clone();
    let own = vec![(STUDY_FILE.to_owned(), study_file(plan, finished.studies)?.into_bytes())];
    let mut files = report.write(&output, models, plan, 0, own, Some(folder.identity()))?;
    if finished.page {
        match write_page(&output) {
            Ok(name) => files.push(name),
            // The results are worth more than their page.
            Err(error) => note(&format!("note: there is no report.html: {}", chain(&error))),
        }
    }
    folder.complete()?;
    print(&report, plan, &output, &files, out)
}

fn print(
    report: &Report<'_>,
    plan: &Plan,
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
            .filter(|r| r.scenario == world.name && r.case == study.case)
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
        // What a source claims is claimed of its own world, not of a changed one.
        for note in &world.notes {
            say(out, &format!("note: {note}"))?;
        }
        let verdicts = if plan.of_case(&study.case).as_published() {
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
    closing(folder, files, out)?;
    Ok(missed)
}
