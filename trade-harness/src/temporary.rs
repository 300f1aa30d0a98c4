//! Temporary files of this process, in one folder that somebody removes, whatever happens.
//!
//! FMUs are unpacked to be loaded. A process that ends takes its folder along; that of a process that was killed is removed by
//! the next one.

use std::fs;
use std::path::{Path, PathBuf};

/// Begins the names of these folders; the process's number follows.
const PREFIX: &str = "trade-harness-";

/// The folder, removed when this is dropped.
#[derive(Debug)]
pub struct Temporary(PathBuf);

impl Temporary {
    /// Makes the folder, lets everything temporary go there, and removes those of processes that are no more.
    ///
    /// Without such a folder everything goes where it goes otherwise.
    pub fn begin() -> Option<Self> {
        let all = std::env::temp_dir();
        sweep(&all);
        let own = all.join(format!("{PREFIX}{}", std::process::id()));
        fs::create_dir_all(&own).ok()?;
        let own = Self(own);
        tempfile::env::override_temp_dir(&own.0).ok()?;
        Some(own)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // Best effort: the next process tries again.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn sweep(all: &Path) {
    for entry in fs::read_dir(all).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let number = name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.parse().ok());
        if number.is_some_and(|number: i32| !is_alive(number)) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether there is a process of this number; one that was given it anew counts, and keeps what is not its own.
#[cfg(unix)]
fn is_alive(number: i32) -> bool {
    let own = i32::try_from(std::process::id()).is_ok_and(|own| own == number);
    let process = rustix::process::Pid::from_raw(number);
    !own && process.is_some_and(|pid| rustix::process::test_kill_process(pid) != Err(rustix::io::Errno::SRCH))
}

#[cfg(not(unix))]
fn is_alive(_number: i32) -> bool {
    true
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn folders_of_the_dead_are_removed_and_no_others() {
        let all = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        let dead = all.path().join(format!("{PREFIX}{}", child.id()));
        let alive = all.path().join(format!("{PREFIX}1"));
        let other = all.path().join(format!("{PREFIX}notes"));
        for folder in [&dead, &alive, &other] {
            fs::create_dir(folder).unwrap();
        }
        sweep(all.path());
        assert_eq!(
            [&dead, &alive, &other].map(|folder| folder.exists()),
            [false, true, true]
        );
    }
}
