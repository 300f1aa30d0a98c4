//! `merge`: the parts of a study put together, as if one process had done them all.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use study::{Journal, Models, NAV, OwnFmus, Plan, Shard, Study, TRUTH};

use super::compare::{Told, cast, finish};
use super::progress::run_watched;
use super::shared::{Verdict, scratch};
use crate::HarnessError;
use crate::cli::MergeArgs;
use crate::store::{Claim, StudyFolder, identity};

/// What a part keeps beside its journals: how to make the study again.
pub(super) const KEPT: &str = "plan.json";

/// Where the parts are, below the folder of the study.
const SHARDS: &str = "shards";

/// A plan with the FMUs that it was made with.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Kept {
    plan: Plan,
    truth: Option<PathBuf>,
    nav: Option<PathBuf>,
}

impl Kept {
    /// With whole paths, so that it may be read from anywhere.
    pub(super) fn new(plan: &Plan, models: &Models) -> Result<Self, HarnessError> {
        let whole = |path: &Path| {
            std::path::absolute(path).map_err(|source| HarnessError::Read {
                path: path.to_owned(),
                source,
            })
        };
        let own = |name: &str| {
            let model = models.all().find(|model| model.name == name);
            model.map(|model| whole(model.fmu.path())).transpose()
        };
        let mut plan = plan.clone();
        for path in plan.missions.iter_mut().chain(&mut plan.truth) {
            *path = whole(path)?;
        }
        for foreign in &mut plan.foreign {
            foreign.path = whole(&foreign.path)?;
        }
        Ok(Self {
            plan,
            truth: own(TRUTH)?,
            nav: own(NAV)?,
        })
    }
}

/// The folder of one part.
pub(super) fn shard_folder(out: &Path, shard: Shard) -> PathBuf {
    out.join(SHARDS).join(shard.to_string().replace('/', "-of-"))
}

pub(super) fn merge(args: &MergeArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
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
    let plan = Plan {
        jobs: args.jobs,
        ..kept.plan
    };
    let own = OwnFmus {
        truth: kept.truth,
        nav: kept.nav,
    };
    let models = Models::of(&plan, &own)?;
    let scratch = scratch()?;
    let identity = identity(&cast(&plan, &models, scratch.path())?, &models)?;
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
    let results: Result<Vec<_>, _> = studies
        .iter()
        .map(|study| run_watched(study, Some(&folder.journal(study)?), args.quiet))
        .collect();
    let as_published = plan.assignments.is_empty() && plan.variations.is_empty() && plan.truth.is_none();
    let told = Told {
        as_published,
        page: true,
    };
    finish(folder, &studies, &results?, &models, &plan, told, out)?;
    let shards = args.dir.join(SHARDS);
    fs::remove_dir_all(&shards).map_err(|source| HarnessError::Write { path: shards, source })?;
    Ok(Verdict::Done)
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
