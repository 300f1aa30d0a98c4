//! `--preload`: libraries that the system's loader takes in before any FMU.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::HarnessError;

/// Variable of the environment in which the system's loader looks for libraries to load first.
pub(super) const PRELOAD: &str = if cfg!(target_os = "macos") {
    "DYLD_INSERT_LIBRARIES"
} else {
    "LD_PRELOAD"
};

/// The value of [`PRELOAD`] for these libraries and those that are there already.
///
/// # Errors
/// [`HarnessError::Preload`] for a library that is no file, or a Python that has none.
pub(super) fn preloaded(libraries: &[PathBuf]) -> Result<OsString, HarnessError> {
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

/// Set in a process that has been started again.
const STARTED_AGAIN: &str = "TRADE_HARNESS_PRELOADED";

/// Starts this program again with the same arguments and these libraries loaded, for a command that calls FMUs itself; goes on
/// where there are none, or where that has been done.
///
/// # Errors
/// As for [`preloaded`], and when the program cannot be started again.
#[cfg(unix)]
pub(super) fn start_again_with(libraries: &[PathBuf]) -> Result<(), HarnessError> {
    use std::os::unix::process::CommandExt;
    if libraries.is_empty() || std::env::var_os(STARTED_AGAIN).is_some() {
        return Ok(());
    }
    let value = preloaded(libraries)?;
    let own = std::env::current_exe().map_err(|source| no_program(&source))?;
    let mut command = Command::new(own);
    command.args(std::env::args_os().skip(1));
    // Comes back only with an error.
    Err(no_program(&command.env(PRELOAD, value).env(STARTED_AGAIN, "1").exec()))
}

/// There is no such loader.
///
/// # Errors
/// [`HarnessError::Preload`] where a library is asked for.
#[cfg(not(unix))]
pub(super) fn start_again_with(libraries: &[PathBuf]) -> Result<(), HarnessError> {
    match libraries.first() {
        None => Ok(()),
        Some(_) => Err(no_program(&std::io::ErrorKind::Unsupported.into())),
    }
}

fn no_program(source: &std::io::Error) -> HarnessError {
    HarnessError::Preload {
        library: "this program, started again".into(),
        why: source.to_string(),
    }
}
