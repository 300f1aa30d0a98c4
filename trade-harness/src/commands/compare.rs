//! `compare`: the Monte Carlo study.

use std::io::Write;

use study::{Engine, Journal, Plan, Workers, rehearse};

use super::finished::{Finished, finish};
use super::kept::{KEPT, Kept, shard_folder};
use super::progress::{run_watched, shard_watched};
use super::shared::{Verdict, cast, end_when_asked, models, note, plan_of, say, scratch};
use super::worker;
use crate::HarnessError;
use crate::cli::CompareArgs;
use crate::format::json_bytes;
use crate::store::{Claim, StudyFolder, identity};

pub(super) fn compare(args: &CompareArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    end_when_asked()?;
    let plan = plan_of(&args.study, &args.worlds, &args.work)?;
    let case = args.case.clone().unwrap_or_else(|| plan.case_text());
    let differs = plan.deviations();
    if case == "nominal" && !differs.is_empty() {
        return Err(HarnessError::NotNominal {
            differs: differs.join(", "),
        });
    }
    let plan = Plan {
        case: Some(case),
        ..plan
    };
    let models = models(&plan, &args.study.build)?;
    let foreign = plan.truth.is_some() || !plan.foreign.is_empty();
    let isolate = args.isolation.isolate || (foreign && !args.isolation.no_isolate);
    let scratch = scratch()?;
    let trial = cast(&plan, &models, scratch.path())?;
    let mut workers = Vec::new();
    for study in &trial {
        let world = &study.spec.world;
        for text in &world.notes {
            note(&format!("note: {}: {text}", world.name));
        }
        // A bad setting shows before the folder is touched; somebody's FMU is called by a worker alone.
        let told = if isolate {
            let own = worker::workers(study, &plan, &models, scratch.path(), args.isolation.limits())?;
            let told = own.rehearse(&study.spec)?;
            workers.push(own);
            told
        } else {
            rehearse(&study.spec)?
        };
        told.iter().for_each(|text| note(&format!("note: {text}")));
    }
    let identity = identity(&trial, &models)?;
    drop(trial);
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
    let quiet = args.study.build.quiet;
    if let Some(shard) = args.folder.shard {
        let kept = Kept::new(&plan, &models)?;
        folder.keep(KEPT, &json_bytes(&kept)?)?;
        for (index, study) in studies.iter().enumerate() {
            shard_watched(study, shard, engine(&folder.journal(study)?, workers.get(index)), quiet)?;
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
    for (index, study) in studies.iter().enumerate() {
        results.push(run_watched(
            study,
            engine(&folder.journal(study)?, workers.get(index)),
            quiet,
        )?);
    }
    let finished = Finished {
        studies: &studies,
        results: &results,
        workers: &workers,
        page: !args.no_report,
    };
    let judged = finish(folder, finished, &models, &plan, out)?;
    Ok(if judged.failed || (judged.claims_missed && args.check) {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}

fn engine<'a>(journal: &'a Journal, workers: Option<&'a Workers>) -> Engine<'a> {
    Engine {
        journal: Some(journal),
        workers,
    }
}
