//! `worker`: this program once more, as a process that makes runs for a study and may die of an FMU.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};
use study::{Limits, Models, Plan, Study, StudyError, Workers, serve};

use super::kept::Kept;
use super::preload::{PRELOAD, preloaded};
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::WorkerArgs;
use crate::format::json_bytes;
use crate::output::write_whole;

/// What a worker is told before its first run.
#[derive(Serialize, Deserialize)]
struct Job {
    study: Kept,
    limits: Limits,
}

/// Workers for one study.
///
/// * `folder`: takes a file that every worker reads, as long as there are any.
///
/// # Errors
/// When the folder takes no file, or this program cannot find itself.
pub(super) fn workers(
    study: &Study,
    plan: &Plan,
    models: &Models,
    folder: &Path,
    limits: Limits,
) -> Result<Workers, HarnessError> {
    let job = Job {
        // Nothing is left to a folder or to a default, so that no worker writes a mission.
        study: Kept::new(&plan.of_case(&study.case).resolved(&study.spec), models)?,
        limits,
    };
    let name = format!("{}_{}.job", study.spec.world.name, study.case);
    let path = folder.join(name);
    write_whole(&path, &json_bytes(&job)?)?;
    let own = std::env::current_exe().map_err(|source| HarnessError::Read {
        path: "the path of this program".into(),
        source,
    })?;
    let scratch = tempfile::env::temp_dir();
    let preload = preloaded(&plan.isolation.preload)?;
    let command = move || {
        let mut command = Command::new(&own);
        command.arg("worker").arg(&path).env("TMPDIR", &scratch);
        if !preload.is_empty() {
            command.env(PRELOAD, &preload);
        }
        command
    };
    Ok(Workers::new(command, limits))
}

pub(super) fn worker(args: &WorkerArgs) -> Result<Verdict, HarnessError> {
    let job = read(&args.job)?;
    let (plan, own) = job.study.parts();
    let models = Models::of(&plan, &own)?;
    let world = plan
        .worlds(Path::new("."))?
        .into_iter()
        .next()
        .ok_or(StudyError::NoWorld)?;
    serve(models.spec(&plan, &world)?, job.limits)?;
    Ok(Verdict::Done)
}

fn read(path: &Path) -> Result<Job, HarnessError> {
    let text = fs::read(path).map_err(|source| HarnessError::Read {
        path: path.to_owned(),
        source,
    })?;
    Ok(serde_json::from_slice(&text)?)
}
