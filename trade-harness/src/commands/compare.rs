//! `compare`: the Monte Carlo study.

use std::path::{Path, PathBuf};

use study::{Engine, Flown, Journal, Models, Output, Plan, Shard, read_mappings, rehearse};

use super::finished::{Finished, finish};
use super::kept::{KEPT, Kept, shard_folder};
use super::out::Out;
use super::progress::{run_watched, shard_watched};
use super::recorded::Recorded;
use super::shared::{Verdict, cast, end_when_asked, held, models, note, plan_of, scratch};
use super::worker;
use crate::HarnessError;
use crate::cli::CompareArgs;
use crate::format::json_bytes;
use crate::output::OutputFolder;
use crate::store::{Claim, StudyFolder, identity};
use crate::structure::{Told, read};

pub(super) fn compare(args: &CompareArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    end_when_asked()?;
    let told = match &args.ssp {
        Some(path) => Some(structure(args, path)?),
        None => None,
    };
    let (told, own) = told.map_or((None, None), |told| (Some(told.plan), Some(told.own)));
    let plan = asked(args, told)?;
    // Before anything is built.
    OutputFolder::check(&results(args, &plan))?;
    let models = match &own {
        Some(own) => {
            plan.check()?;
            Models::of(&plan, own)?
        }
        None => models(&plan, &args.study.build)?,
    };
    let claim = match (args.folder.resume, args.folder.force) {
        (true, _) => Claim::Resume,
        (_, true) => Claim::Force,
        _ => Claim::Fresh,
    };
    let way = Way {
        out_dir: results(args, &plan),
        claim,
        shard: args.folder.shard,
        quiet: args.study.build.quiet,
        wide: args.wide,
        check: args.check,
    };
    carry_out(&plan, &models, &way, out)
}

/// How a study is carried out, beside what it is.
pub(super) struct Way {
    /// Folder of the results.
    pub(super) out_dir: PathBuf,
    /// What becomes of a study that is there already.
    pub(super) claim: Claim,
    /// Part of the runs.
    pub(super) shard: Option<Shard>,
    /// Whether there is no progress.
    pub(super) quiet: bool,
    /// Whether every column is printed.
    pub(super) wide: bool,
    /// Whether a claim that is missed is an exit code.
    pub(super) check: bool,
}

/// Runs a plan and writes and prints what it finds.
pub(super) fn carry_out(plan: &Plan, models: &Models, way: &Way, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let foreign = plan.truth.is_some() || !plan.foreign.is_empty() || !plan.drive.is_empty();
    let isolate = plan
        .isolation
        .isolate
        .unwrap_or(foreign || !plan.isolation.preload.is_empty());
    let scratch = scratch()?;
    let trial = cast(plan, models, scratch.path())?;
    let (mut workers, mut said) = (Vec::new(), Vec::new());
    for study in &trial {
        let world = &study.spec.world;
        for text in &world.notes {
            note(&format!("note: {}: {text}", world.name));
        }
        // A bad setting shows before the folder is touched; somebody's FMU is called by a worker alone.
        let told = if isolate {
            let own = worker::workers(study, plan, models, scratch.path(), plan.isolation.limits())?;
            let told = own.rehearse(&study.spec)?;
            workers.push(own);
            told
        } else {
            rehearse(&study.spec)?
        };
        told.iter().for_each(|text| note(&format!("note: {text}")));
        said.extend(told);
    }
    let identity = identity(&trial, models)?;
    drop(trial);
    let place = way
        .shard
        .map_or_else(|| way.out_dir.clone(), |shard| shard_folder(&way.out_dir, shard));
    if way.claim == Claim::Resume && StudyFolder::is_complete(&place, &identity) {
        StudyFolder::clear_leftovers(&place)?;
        let judged = Recorded::read(&place)?.study;
        if judged.is_some_and(|judged| judged.requirements != plan.requirements) {
            return Err(HarnessError::OtherRequirements { path: place });
        }
        return held(&place, "", out);
    }
    let folder = StudyFolder::claim(&place, &identity, way.claim)?;
    let studies = cast(plan, models, folder.output().path())?;
    let quiet = way.quiet;
    let journals = studies.iter().map(|study| {
        let journal = folder.journal(study)?;
        journal.rest();
        Ok(journal)
    });
    let journals: Vec<Journal> = journals.collect::<Result<_, HarnessError>>()?;
    // A filter that cases have in common is run once.
    let flown = studies.iter().enumerate().map(|(index, study)| {
        let earlier = studies[..index].iter().map(|other| &other.spec);
        Flown::of(&study.spec, earlier.zip(&journals))
    });
    let flown: Vec<Flown<'_>> = flown.collect();
    let engine = |index: usize| Engine {
        journal: journals.get(index),
        workers: workers.get(index),
        flown: flown.get(index),
    };
    if let Some(shard) = way.shard {
        let kept = Kept::new(plan, models)?;
        folder.keep(KEPT, &json_bytes(&kept)?)?;
        for (index, study) in studies.iter().enumerate() {
            shard_watched(study, shard, engine(index), quiet)?;
            journals[index].rest();
        }
        let text = format!(
            "part {shard} is done: {}; 'trade-harness merge {}' when all are",
            place.display(),
            way.out_dir.display()
        );
        out.say(&text)?;
        return Ok(Verdict::Done);
    }

    let mut results = Vec::new();
    for (index, study) in studies.iter().enumerate() {
        results.push(run_watched(study, engine(index), quiet)?);
        journals[index].rest();
    }
    drop(flown);
    drop(journals);
    let finished = Finished {
        studies: &studies,
        results: &results,
        workers: &workers,
        said: &said,
        page: plan.output.report,
        wide: way.wide,
    };
    let judged = finish(folder, finished, models, plan, out)?;
    Ok(if judged.failed || (judged.claims_missed && way.check) {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}

/// What a system structure says; its FMUs are put beside the folder of the results, where a repeat finds them.
fn structure(args: &CompareArgs, path: &Path) -> Result<Told, HarnessError> {
    let mut folder = results(args, &Plan::default()).into_os_string();
    folder.push(".fmus");
    let named = !args.worlds.scenarios.is_empty() || !args.worlds.missions.is_empty();
    let mut mappings = args.study.mappings.clone();
    for file in &args.study.map_files {
        mappings.extend(read_mappings(file)?);
    }
    let told = read(path, folder.as_ref(), &mappings, named)?;
    told.notes.iter().for_each(|text| note(&format!("note: {text}")));
    Ok(told)
}

/// The plan of the study file or system structure, if there is one, with what the options say.
fn asked(args: &CompareArgs, told: Option<Plan>) -> Result<Plan, HarnessError> {
    let file = args.file.as_deref().map(Plan::read).transpose()?;
    let told = file.or(told);
    let plan = plan_of(told.unwrap_or_default(), &args.study, &args.worlds, &args.work)?;
    let plan = Plan {
        isolation: args.isolation.changed(&plan.isolation),
        case: args.case.clone().or(plan.case.clone()),
        duration_s: args.duration.or(plan.duration_s),
        phases: plan.phases.iter().chain(&args.phases).cloned().collect(),
        requirements: plan.requirements.iter().chain(&args.requirements).cloned().collect(),
        grids: plan.grids.iter().chain(&args.grids).cloned().collect(),
        ..plan
    };
    if plan.case.as_deref() == Some("nominal") && !plan.deviations().is_empty() {
        return Err(HarnessError::NotNominal {
            differs: plan.deviations().join(", "),
        });
    }
    let output = Output {
        report: plan.output.report && !args.no_report,
        ..plan.output
    };
    Ok(Plan { output, ..plan })
}

/// Folder of the results.
fn results(args: &CompareArgs, plan: &Plan) -> PathBuf {
    let own = || {
        let stem = args.file.as_deref().or(args.ssp.as_deref()).and_then(Path::file_stem);
        Path::new("results").join(stem.unwrap_or("compare".as_ref()))
    };
    args.out.clone().or(plan.output.folder.clone()).unwrap_or_else(own)
}
