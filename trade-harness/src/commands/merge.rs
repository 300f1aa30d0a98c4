//! `merge`: the parts of a study put together, as if one process had done them all.

use std::fs;
use std::path::{Path, PathBuf};

use study::{Engine, Journal, Models, Plan, Study};

use super::finished::{Finished, finish};
use super::kept::{KEPT, Kept, SHARDS};
use super::out::Out;
use super::progress::run_watched;
use super::shared::{Verdict, cast, held, scratch};
use crate::HarnessError;
use crate::cli::MergeArgs;
use crate::store::{Claim, StudyFolder, identity};

pub(super) fn merge(args: &MergeArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let wrong = |problem: String| HarnessError::Shards {
        path: args.dir.clone(),
        problem,
    };
    let parts = folders(&args.dir.join(SHARDS));
    let Some(first) = parts.first() else {
        return Err(wrong(
            "there are no parts of a study; 'compare --shard I/N --out DIR' makes them".into(),
        ));
    };
    let kept = first.join(".unfinished").join(KEPT);
    let text = fs::read(&kept).map_err(|source| HarnessError::Read {
        path: kept.clone(),
        source,
    })?;
    let kept: Kept = serde_json::from_slice(&text)?;
    let (plan, own) = kept.parts();
    let plan = Plan {
        jobs: args.jobs,
        ..plan
    };
    let models = Models::of(&plan, &own)?;
    let scratch = scratch()?;
    let identity = identity(&cast(&plan, &models, scratch.path())?, &models)?;
    if StudyFolder::is_complete(&args.dir, &identity)
        && parts.iter().all(|part| StudyFolder::has_begun(part, &identity))
    {
        StudyFolder::remove_within(&args.dir, SHARDS)?;
        return held(&args.dir, "; its parts are removed", out);
    }
    let folder = StudyFolder::claim(&args.dir, &identity, Claim::Resume)?;
    let studies = cast(&plan, &models, folder.output().path())?;
    for study in &studies {
        let whole = folder.journal(study)?;
        for part in &parts {
            gather(study, part, &identity, &whole)?;
        }
        let missing = u64::from(study.runs) - whole.runs().len() as u64;
        if missing > 0 {
            return Err(wrong(format!(
                "{missing} of {} runs of {} are in no part; finish 'compare --shard' with --resume first",
                study.runs, study.spec.world.name
            )));
        }
    }
    // Nothing is run: the journals hold every run.
    let results = studies.iter().map(|study| {
        let journal = folder.journal(study)?;
        let engine = Engine {
            journal: Some(&journal),
            ..Engine::default()
        };
        run_watched(study, engine, args.quiet)
    });
    let results: Result<Vec<_>, HarnessError> = results.collect();
    let finished = Finished {
        studies: &studies,
        results: &results?,
        workers: &[],
        said: &[],
        page: plan.output.report,
        wide: args.wide,
    };
    let judged = finish(folder, finished, &models, &plan, out)?;
    StudyFolder::remove_within(&args.dir, SHARDS)?;
    Ok(if judged.failed {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}

fn folders(path: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries.map(|e| e.path()).filter(|p| p.is_dir()).collect();
    found.sort();
    found
}

/// Copies the runs of a part that the whole does not hold yet.
fn gather(study: &Study, part: &Path, identity: &str, whole: &Journal) -> Result<(), HarnessError> {
    let part = StudyFolder::claim(part, identity, Claim::Resume)?;
    let journal = part.journal(study)?;
    let present = whole.runs();
    for run in journal.runs() {
        if present.binary_search(&run).is_err()
            && let Some(outcome) = journal.read(run)?
        {
            whole.append(&outcome)?;
        }
    }
    Ok(())
}
