//! Holds the committed `modelDescription.xml` and the code together.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use fmi_model::{DefinitionError, Model};

use crate::description::render;

/// Set to `1`, this environment variable makes [`golden_check`] rewrite the file.
const UPDATE: &str = "UPDATE_GOLDEN";

/// Why the committed description is not that of the code.
#[derive(Debug, thiserror::Error)]
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
    #[error(
        "{path}, line {line}: committed '{committed}', rendered '{rendered}'; if the change is meant, \
         UPDATE_GOLDEN=1 rewrites the file"
    )]
    Differs {
        /// The file.
        path: PathBuf,
        /// First line that differs, from 1.
        line: usize,
        /// That line of the file.
        committed: String,
        /// That line of the code.
        rendered: String,
    },
}

/// Compares the description of `M` with a committed file, byte for byte, or rewrites the file if the environment has
/// `UPDATE_GOLDEN=1`. Checks also that the model reads back every start value. For a unit test in each FMU crate.
///
/// # Errors
/// A mistake in the definition, a file that cannot be read or written, or the first line that differs. The GUID stands near the
/// top and changes with any other line, so a difference below it is reported before it.
pub fn golden_check<M: Model>(path: &Path) -> Result<(), GoldenError> {
    let rendered = render::<M>()?;
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
    let (line, committed, rendered) = first_difference(&committed, rendered);
    Err(GoldenError::Differs {
        path: path.to_owned(),
        line,
        committed,
        rendered,
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

/// Line number and the two lines. The line of the GUID comes last, since it only says that another one differs.
fn first_difference(committed: &str, rendered: &str) -> (usize, String, String) {
    let count = committed.split('\n').count().max(rendered.split('\n').count());
    let lines = |text: &str| -> Vec<String> {
        let lines = text.split('\n').map(str::to_owned);
        lines
            .chain(std::iter::repeat("(end of file)".to_owned()))
            .take(count)
            .collect()
    };
    let (committed, rendered) = (lines(committed), lines(rendered));
    let differing = || (0..count).filter(|i| committed[*i] != rendered[*i]);
    let index = differing()
        .find(|i| !rendered[*i].trim_start().starts_with("guid="))
        .or_else(|| differing().next())
        .unwrap_or(0);
    (index + 1, committed[index].clone(), rendered[index].clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "<a\n  guid=\"1\"\n  b=\"2\"/>\n";

    fn differing(committed: &str) -> (usize, String, String) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/x.xml");
        write(&path, committed).unwrap();
        match compare(&path, TEXT) {
            Err(GoldenError::Differs {
                line,
                committed,
                rendered,
                ..
            }) => (line, committed, rendered),
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
    fn the_first_meaningful_difference_is_named() {
        let line = |number, committed: &str, rendered: &str| (number, committed.to_owned(), rendered.to_owned());
        assert_eq!(
            differing(&TEXT.replace("1", "0").replace("2", "3")),
            line(3, "  b=\"3\"/>", "  b=\"2\"/>")
        );
        assert_eq!(
            differing(&TEXT.replace("1", "0")),
            line(2, "  guid=\"0\"", "  guid=\"1\"")
        );
        assert_eq!(differing(TEXT.trim_end()), line(4, "(end of file)", ""));
        assert_eq!(differing(&TEXT.replace('\n', "\r\n")).0, 1);
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
