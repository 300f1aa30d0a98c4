//! `compare`: the Monte Carlo study.

use std::io::Write;

use study::{Plan, Study, Summary, rehearse};

use super::files::Report;
use super::progress::run_watched;
use super::shared::{Verdict, closing, models, note, plan_of, say};
use crate::HarnessError;
use crate::claims;
use crate::cli::CompareArgs;
use crate::output::OutputFolder;
use crate::report::table;

pub(super) fn compare(args: &CompareArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let plan = Plan {
        case: args.case.clone(),
        ..plan_of(&args.study, &args.worlds, &args.work)?
    };
    let folder = OutputFolder::prepare(&args.out)?;
    let worlds = plan.worlds(folder.path())?;
    let models = models(&plan, &args.study.build)?;
    let mut studies: Vec<Study> = Vec::new();
    for world in &worlds {
        for text in &world.notes {
            note(&format!("note: {}: {text}", world.name));
        }
        let study = models.study(&plan, world)?;
        for open in rehearse(&study.spec)? {
            note(&format!("note: nothing feeds {open}; it keeps its start value"));
        }
        studies.push(study);
    }

    let mut results = Vec::new();
    for study in &studies {
        results.push(run_watched(study, args.study.build.quiet)?);
    }
    let report = Report::new(&studies, &results);
    let files = report.write(&folder, &models, &plan, 0, Vec::new())?;
    print(&report, args, &folder, &files, out)
}

fn print(
    report: &Report<'_>,
    args: &CompareArgs,
    folder: &OutputFolder,
    files: &[String],
    out: &mut dyn Write,
) -> Result<Verdict, HarnessError> {
    // What a source claims is claimed of its own world, not of a changed one.
    let as_published =
        args.study.assignments.is_empty() && args.study.variations.is_empty() && args.study.truth.is_none();
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
    closing(folder, files, out)?;
    Ok(if missed && args.check {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}
