//! Holds the committed `modelDescription.xml` and the code together.

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use fmi_model::{DefinitionError, Model};
use similar::TextDiff;

use crate::description::render;
use crate::version::Version;

/// Set to `1`, this environment variable makes [`golden_check`] rewrite the file.
const UPDATE: &str = "UPDATE_GOLDEN";

/// Why the committed description is not that of the code.
#[derive(thiserror::Error)]
pub enum GoldenError {
    /// The code cannot be described.
    #[error(transparent)]
    Definition(#[from] DefinitionError),
    /// The file cannot be read.
    #[error("{path} cannot be read; UPDATE_GOLDEN=1 creates it")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("{path} cannot be written")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The texts differ.
    #[error("{path} is not what the code renders; if the change is meant, UPDATE_GOLDEN=1 rewrites the file\n{diff}")]
    Differs {
        /// The file.
        path: PathBuf,
        /// From the file to what the code renders, as a unified diff.
        diff: String,
    },
}

// A test unwraps it, and a derived `Debug` would fold the diff into one line.
impl fmt::Debug for GoldenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")?;
        std::error::Error::source(self).map_or(Ok(()), |source| write!(f, ": {source}"))
    }
}

/// Compares the description of `M` with a committed file, byte for byte, or rewrites the file if the environment has
/// `UPDATE_GOLDEN=1`. Checks also that the model reads back every start value. For a unit test in each FMU crate.
///
/// # Errors
/// A mistake in the definition, a file that cannot be read or written, or what differs.
pub fn golden_check<V: Version, M: Model>(path: &Path) -> Result<(), GoldenError> {
    let rendered = render::<V, M>()?;
    let mut model = M::blank();
    M::table().apply_start(&mut model);
    M::table().check_start(&model)?;
    if std::env::var(UPDATE).is_ok_and(|value| value == "1") {
        return write(path, &rendered);
    }
    compare(path, &rendered)
}

fn compare(path: &Path, rendered: &str) -> Result<(), GoldenError> {
    let committed = fs::read(path).map_err(|source| GoldenError::Read {
        path: path.to_owned(),
        source,
    })?;
    if committed == rendered.as_bytes() {
        return Ok(());
    }
    let committed = String::from_utf8_lossy(&committed);
    let diff = TextDiff::from_lines(committed.as_ref(), rendered);
    let diff = diff
        .unified_diff()
        .context_radius(1)
        .header("committed", "rendered")
        .to_string();
    Err(GoldenError::Differs {
        path: path.to_owned(),
        diff,
    })
}

fn write(path: &Path, text: &str) -> Result<(), GoldenError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|source| GoldenError::Write {
            path: path.to_owned(),
            source,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "<a\n  guid=\"1\"\n  b=\"2\"/>\n";

    fn differing(committed: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/x.xml");
        write(&path, committed).unwrap();
        match compare(&path, TEXT) {
            Err(error @ GoldenError::Differs { .. }) => error.to_string(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_was_written_compares_equal() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.xml");
        write(&path, TEXT).unwrap();
        compare(&path, TEXT).unwrap();
    }

    #[test]
    fn every_difference_is_shown() {
        let said = differing(&TEXT.replace('1', "0").replace('2', "3"));
        for part in [
            "x.xml is not what the code renders",
            "UPDATE_GOLDEN=1",
            "-  guid=\"0\"\n",
            "+  guid=\"1\"\n",
            "-  b=\"3\"/>\n",
            "+  b=\"2\"/>\n",
        ] {
            assert!(said.contains(part), "{part}: {said}");
        }
        let error = compare(Path::new("none.xml"), TEXT).unwrap_err();
        assert!(format!("{error:?}").starts_with("none.xml cannot be read; UPDATE_GOLDEN=1 creates it: "));
        assert!(differing(TEXT.trim_end()).contains("No newline at end of file"));
        assert!(differing(&TEXT.replace('\n', "\r\n")).contains("-<a\r\n"));
    }

    #[test]
    fn files_that_cannot_be_read_or_written_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = compare(&folder.path().join("none.xml"), TEXT).unwrap_err();
        assert!(matches!(&missing, GoldenError::Read { .. }));
        assert!(missing.to_string().contains("none.xml"));
        let written = write(folder.path(), TEXT).unwrap_err();
        assert!(matches!(&written, GoldenError::Write { .. }));
    }
}
