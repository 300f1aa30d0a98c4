//! `worker`: this program once more, as a process that makes runs for a study and may die of an FMU.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};
use study::{Limits, Models, Plan, Study, StudyError, Workers, serve};

use super::kept::Kept;
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

/// Variable of the environment in which the system's loader looks for libraries to load first.
const PRELOAD: &str = if cfg!(target_os = "macos") {
    "DYLD_INSERT_LIBRARIES"
} else {
    "LD_PRELOAD"
};

/// The value of [`PRELOAD`] for these libraries and those that are there already.
///
/// # Errors
/// [`HarnessError::Preload`] for a library that is no file, or a Python that has none.
fn preloaded(libraries: &[PathBuf]) -> Result<OsString, HarnessError> {
    let mut all = Vec::new();
    for library in libraries {
        let path = if library == Path::new("python") {
            library_of_python()?
        } else {
            library.clone()
        };
        let whole = fs::canonicalize(&path).map_err(|source| HarnessError::Preload {
            library: path.clone(),
            why: source.to_string(),
        })?;
        all.push(whole.into_os_string());
    }
    all.extend(std::env::var_os(PRELOAD).filter(|_| !libraries.is_empty()));
    Ok(all.join(OsStr::new(":")))
}

/// Path of the library of the `python3` on the path.
fn library_of_python() -> Result<PathBuf, HarnessError> {
    let ask = "import os, sysconfig as s; print(os.path.join(*s.get_config_vars('LIBDIR', 'INSTSONAME')))";
    let failed = |why: String| HarnessError::Preload {
        library: "python".into(),
        why,
    };
    let output = Command::new("python3").args(["-c", ask]).output();
    let output = output.map_err(|source| failed(format!("python3 does not run: {source}")))?;
    let path = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    if path.is_file() && path.extension().is_none_or(|extension| extension != "a") {
        Ok(path)
    } else {
        Err(failed(format!(
            "the python3 on the path has no shared library (it says '{}'); install libpython3-dev, or give the path of one",
            path.display()
        )))
    }
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
