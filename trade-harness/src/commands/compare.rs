//! `compare`: the Monte Carlo study.

use std::io::Write;
use std::path::Path;

use study::{Models, Plan, Study, StudyResult, Summary, chain, rehearse};

use super::files::Report;
use super::merge::{KEPT, Kept, shard_folder};
use super::progress::{run_watched, shard_watched};
use super::report::write_page;
use super::shared::{Verdict, closing, end_when_asked, models, note, plan_of, say, scratch};
use crate::HarnessError;
use crate::claims;
use crate::cli::CompareArgs;
use crate::format::json_bytes;
use crate::output::OutputFolder;
use crate::report::table;
use crate::store::{Claim, StudyFolder, identity};

pub(super) fn compare(args: &CompareArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    end_when_asked()?;
    let plan = Plan {
        case: args.case.clone(),
        ..plan_of(&args.study, &args.worlds, &args.work)?
    };
    let models = models(&plan, &args.study.build)?;
    let scratch = scratch()?;
    let identity = identity(&cast(&plan, &models, scratch.path())?, &models)?;
    let claim = match (args.folder.resume, args.folder.force) {
        (true, _) => Claim::Resume,
        (_, true) => Claim::Force,
        _ => Claim::Fresh,
    };
    let place = args
        .folder
        .shard
        .map_or_else(|| args.out.clone(), |shard| shard_folder(&args.out, shard));
    if claim == Claim::Resume && StudyFolder::is_complete(&place, &identity) {
        say(out, &format!("{} holds this study, complete", place.display()))?;
        return Ok(Verdict::Done);
    }
    let folder = StudyFolder::claim(&place, &identity, claim)?;
    let studies = cast(&plan, &models, folder.output().path())?;
    for study in &studies {
        let world = &study.spec.world;
        for text in &world.notes {
            note(&format!("note: {}: {text}", world.name));
        }
        for open in rehearse(&study.spec)? {
            note(&format!("note: nothing feeds {open}; it keeps its start value"));
        }
    }
    if let Some(shard) = args.folder.shard {
        let kept = Kept::new(&plan, &models)?;
        folder.keep(KEPT, &json_bytes(&kept)?)?;
        for study in &studies {
            shard_watched(study, shard, &folder.journal(study)?, args.study.build.quiet)?;
        }
        let text = format!(
            "part {shard} is done: {}; 'trade-harness merge {}' when all are",
            place.display(),
            args.out.display()
        );
        say(out, &text)?;
        return Ok(Verdict::Done);
    }

    let mut results = Vec::new();
    for study in &studies {
        results.push(run_watched(
            study,
            Some(&folder.journal(study)?),
            args.study.build.quiet,
        )?);
    }
    // What a source claims is claimed of its own world, not of a changed one.
    let as_published =
        args.study.assignments.is_empty() && args.study.variations.is_empty() && args.study.truth.is_none();
    let told = Told {
        as_published,
        page: !args.no_report,
    };
    let missed = finish(folder, &studies, &results, &models, &plan, told, out)?;
    Ok(if missed && args.check {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}

/// The studies of a plan.
///
/// * `folder`: where the files of missions go that the plan changes.
pub(super) fn cast(plan: &Plan, models: &Models, folder: &Path) -> Result<Vec<Study>, HarnessError> {
    let worlds = plan.worlds(folder)?;
    let studies = worlds.iter().map(|world| Ok(models.study(plan, world)?));
    studies.collect()
}

/// What is told of finished studies beside their tables.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    /// Whether the worlds are those that the papers make claims of.
    pub(super) as_published: bool,
    /// Whether the folder gets its HTML page.
    pub(super) page: bool,
}

/// Writes and prints what finished studies found; returns whether a bound was missed.
pub(super) fn finish(
    folder: StudyFolder,
    studies: &[Study],
    results: &[StudyResult],
    models: &Models,
    plan: &Plan,
    told: Told,
    out: &mut dyn Write,
) -> Result<bool, HarnessError> {
    let report = Report::new(studies, results);
    let output = folder.output().clone();
    let mut files = report.write(&output, models, plan, 0, Vec::new(), Some(folder.identity()))?;
    if told.page {
        match write_page(&output) {
            Ok(name) => files.push(name),
            // The results are worth more than their page.
            Err(error) => note(&format!("note: there is no report.html: {}", chain(&error))),
        }
    }
    folder.complete()?;
    print(&report, told.as_published, &output, &files, out)
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
    closing(folder, files, out)?;
    Ok(missed)
}
