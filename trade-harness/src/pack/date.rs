//! When an FMU was generated, by a clock that does not run: the same sources have the same date on every machine.

use std::path::Path;
use std::process::{Command, Stdio};

use jiff::Timestamp;

use crate::HarnessError;

/// The variable by which whoever builds packages sets the clock, as reproducible-builds.org has it.
const VARIABLE: &str = "SOURCE_DATE_EPOCH";

/// `SOURCE_DATE_EPOCH`, or the date of the commit that the workspace stands at, or nothing.
///
/// # Errors
/// [`HarnessError::SourceDate`].
pub(super) fn of(workspace: &Path) -> Result<Option<String>, HarnessError> {
    match std::env::var(VARIABLE) {
        Ok(set) => shown(&set).map(Some).ok_or(HarnessError::SourceDate { value: set }),
        Err(_) => Ok(commit(workspace).and_then(|seconds| shown(&seconds))),
    }
}

/// Seconds since 1970 as the standard writes dates.
fn shown(seconds: &str) -> Option<String> {
    let seconds = seconds.trim().parse().ok()?;
    Timestamp::from_second(seconds).ok().map(|date| date.to_string())
}

/// Date of the commit, s since 1970; nothing where the workspace is no repository of its own, or there is no git.
fn commit(workspace: &Path) -> Option<String> {
    // A folder within somebody else's repository would show the date of theirs.
    if !workspace.join(".git").exists() {
        return None;
    }
    let mut git = Command::new("git");
    git.arg("-C").arg(workspace).args(["log", "-1", "--format=%ct"]);
    let output = git.stdin(Stdio::null()).output().ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A model description with the date; its identifier is made before, from the text without it.
pub(super) fn dated(xml: Vec<u8>, date: Option<&str>) -> Vec<u8> {
    const NEXT: &str = "\n  variableNamingConvention=";
    let Some(date) = date else { return xml };
    let text = String::from_utf8_lossy(&xml);
    let with = format!("\n  generationDateAndTime=\"{date}\"{NEXT}");
    text.replacen(NEXT, &with, 1).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_shown_as_the_standard_writes_dates() {
        // From the calendar: 2000-03-01 is 11017 days after 1970-01-01.
        assert_eq!(shown("951868800\n").as_deref(), Some("2000-03-01T00:00:00Z"));
        assert_eq!(shown("951868861").as_deref(), Some("2000-03-01T00:01:01Z"));
        assert_eq!(shown("yesterday"), None);
    }

    #[test]
    fn a_folder_that_is_no_repository_has_no_date() {
        assert_eq!(commit(tempfile::tempdir().unwrap().path()), None);
    }

    #[test]
    fn only_the_date_is_added() {
        let xml = "<m\n  fmiVersion=\"2.0\"\n  variableNamingConvention=\"structured\">";
        let with = dated(xml.into(), Some("2000-03-01T00:00:00Z"));
        let expected = "<m\n  fmiVersion=\"2.0\"\n  generationDateAndTime=\"2000-03-01T00:00:00Z\"\n  variableNamingConvention=\"structured\">";
        assert_eq!(String::from_utf8(with).unwrap(), expected);
        assert_eq!(dated(xml.into(), None), xml.as_bytes());
    }
}
