//! A process that makes a trial, and how it ends.

use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::CheckError;
use crate::options::Running;

/// How often it is looked at.
const LOOK: Duration = Duration::from_millis(2);

/// How it ended.
#[derive(Debug)]
pub(super) enum End {
    /// It took too long.
    Hung,
    /// By itself; in words.
    Ended(String),
}

/// Starts it and waits for its end.
///
/// * `output`: file that takes what it prints.
/// * `limit`: the longest that it may take.
///
/// # Errors
/// [`CheckError::Process`].
pub(super) fn run(
    running: &Running,
    job: &Path,
    trial: &str,
    output: &Path,
    limit: Duration,
) -> Result<End, CheckError> {
    let failed = |source: io::Error| CheckError::Process { source };
    let mut command = (running.program)();
    command
        .arg(job)
        .arg(trial)
        .stdin(Stdio::null())
        .stdout(File::create(output).map_err(failed)?)
        .stderr(Stdio::null());
    let mut child = command.spawn().map_err(failed)?;
    wait(&mut child, limit).map_err(failed)
}

fn wait(child: &mut Child, limit: Duration) -> io::Result<End> {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(End::Ended(describe(status)));
        }
        if begun.elapsed() > limit {
            let _ = child.kill();
            child.wait()?;
            return Ok(End::Hung);
        }
        thread::sleep(LOOK);
    }
}

/// With the name of a signal that everybody knows.
fn describe(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = match signal {
            libc::SIGILL => " (illegal instruction)",
            libc::SIGABRT => " (abort)",
            libc::SIGBUS => " (bus error)",
            libc::SIGFPE => " (arithmetic exception)",
            libc::SIGKILL => " (killed)",
            libc::SIGSEGV => " (segmentation fault)",
            _ => "",
        };
        return format!("signal {signal}{name}");
    }
    status
        .code()
        .map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}
