//! The output folder: checked before the first run, written file by file, never half.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::HarnessError;

/// A folder that has been seen to take files.
#[derive(Debug, Clone)]
pub struct OutputFolder {
    path: PathBuf,
}

const FOLDER: &str = "a folder";
const FILE: &str = "a file";

/// What is at a path, a link not followed: what is written through one ends where nobody looks for it, and takes the link's place where
/// a file is replaced.
fn what_is_at(path: &Path) -> Option<&'static str> {
    let kind = fs::symlink_metadata(path).ok()?.file_type();
    Some(match () {
        () if kind.is_dir() => FOLDER,
        () if kind.is_file() => FILE,
        () if kind.is_symlink() => "a link",
        () => "a device, pipe or socket",
    })
}

impl OutputFolder {
    /// Refuses a path that can be no folder, and touches nothing.
    ///
    /// # Errors
    /// [`HarnessError::NotAFolder`].
    pub fn check(path: &Path) -> Result<(), HarnessError> {
        match what_is_at(path).filter(|what| *what != FOLDER) {
            None => Ok(()),
            Some(what) => Err(HarnessError::NotAFolder {
                path: path.to_owned(),
                what,
            }),
        }
    }

    /// Creates the folder if need be and writes and removes a file in it.
    ///
    /// # Errors
    /// [`HarnessError::NotAFolder`], [`HarnessError::Write`].
    pub fn prepare(path: &Path) -> Result<Self, HarnessError> {
        Self::check(path)?;
        fs::create_dir_all(path).map_err(|source| HarnessError::Write {
            path: path.to_owned(),
            source,
        })?;
        let probe = temporary(&path.join("probe"));
        fs::write(&probe, b"")
            .and_then(|()| fs::remove_file(&probe))
            .map_err(|source| HarnessError::Write {
                path: path.to_owned(),
                source,
            })?;
        Ok(Self { path: path.to_owned() })
    }

    /// Removes what a process that was killed had begun to write, here and in the folders below.
    pub fn remove_torn(&self) {
        remove_torn(&self.path);
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts a file into the folder, whole or not at all, in place of one of that name.
    ///
    /// * `name`: relative; folders in it are created.
    ///
    /// # Errors
    /// [`HarnessError::Write`]; then a file that was there still is.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<PathBuf, HarnessError> {
        let path = self.path.join(name);
        write_whole(&path, contents)?;
        Ok(path)
    }

    /// The same for several files; returns their names.
    ///
    /// # Errors
    /// [`HarnessError::Write`]; then those before it are written.
    pub fn write_all(&self, files: Vec<(String, Vec<u8>)>) -> Result<Vec<String>, HarnessError> {
        let write = |(name, contents): (String, Vec<u8>)| self.write(&name, &contents).map(|_| name);
        files.into_iter().map(write).collect()
    }
}

/// Checks, before the work, that a file can be written at this path; its folder is created if need be.
///
/// # Errors
/// [`HarnessError::NotAFile`], and those of [`OutputFolder::prepare`].
pub fn prepare_file(path: &Path) -> Result<(), HarnessError> {
    check_file(path)?;
    let folder = path
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    OutputFolder::prepare(folder).map(|_| ())
}

/// Refuses a path that can be no file, or is one of a kind that nothing should be put in the place of.
fn check_file(path: &Path) -> Result<(), HarnessError> {
    let nameless = path.file_name().is_none().then_some(FOLDER);
    match nameless.or_else(|| what_is_at(path)).filter(|what| *what != FILE) {
        None => Ok(()),
        Some(what) => Err(HarnessError::NotAFile {
            path: path.to_owned(),
            what,
        }),
    }
}

/// Writes a file beside its place and moves it there.
///
/// # Errors
/// [`HarnessError::NotAFile`] for a folder, link, device, pipe or socket, which stays; [`HarnessError::Write`]; then a file that was
/// there still is.
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), HarnessError> {
    check_file(path)?;
    let beside = temporary(path);
    let attempt = || -> io::Result<()> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut file = fs::File::create(&beside)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&beside, path)
    };
    attempt().map_err(|source| {
        // Best effort: the first error is the one to tell.
        let _ = fs::remove_file(&beside);
        HarnessError::Write {
            path: path.to_owned(),
            source,
        }
    })
}

/// Removes files that [`write_whole`] has left unmoved; only whoever alone works in a folder may.
fn remove_torn(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        let number = name
            .strip_prefix('.')
            .and_then(|n| n.strip_suffix(".tmp")?.rsplit_once('.'));
        if path.is_dir() {
            remove_torn(&path);
        } else if number.is_some_and(|(_, number)| number.parse::<u32>().is_ok()) {
            // Best effort: it is in nobody's way.
            let _ = fs::remove_file(&path);
        }
    }
}

/// A name beside the file that no other process uses.
fn temporary(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let dir = tempfile::tempdir().unwrap();
        let out = OutputFolder::prepare(&dir.path().join("a/b")).unwrap();
        fs::write(out.path().join("kept.txt"), "mine").unwrap();
        out.write("epochs/x.csv", b"one").unwrap();
        let path = out.write("epochs/x.csv", b"two").unwrap();
        assert_eq!(fs::read(path).unwrap(), b"two");
        let names = |p: &Path| {
            fs::read_dir(p)
                .unwrap()
                .map(|e| e.unwrap().file_name())
                .collect::<Vec<_>>()
        };
        assert_eq!(names(&out.path().join("epochs")), ["x.csv"]);
        assert_eq!(names(out.path()).len(), 2);
    }

    #[test]
    fn a_file_in_the_way_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("results");
        fs::write(&file, "mine").unwrap();
        assert!(matches!(
            OutputFolder::prepare(&file),
            Err(HarnessError::NotAFolder { .. })
        ));
        assert!(matches!(
            OutputFolder::prepare(&file.join("x")),
            Err(HarnessError::Write { .. })
        ));
        assert_eq!(fs::read(&file).unwrap(), b"mine");
        assert!(matches!(prepare_file(dir.path()), Err(HarnessError::NotAFile { .. })));
        prepare_file(&dir.path().join("new/replay.csv")).unwrap();
        assert!(dir.path().join("new").is_dir());
    }

    /// What is neither a file nor a folder of its own is refused before the work and when it is over, and stays what it is.
    #[cfg(unix)]
    #[test]
    fn links_and_devices_are_refused_and_stay() {
        use std::os::unix::{fs::symlink, net::UnixListener};
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        fs::create_dir(at("folder")).unwrap();
        fs::write(at("file"), "mine").unwrap();
        symlink(at("folder"), at("to a folder")).unwrap();
        symlink(at("file"), at("to a file")).unwrap();
        symlink(at("nowhere"), at("to nothing")).unwrap();
        let _socket = UnixListener::bind(at("socket")).unwrap();
        let null = Path::new("/dev/null").to_owned();
        for path in [at("to a folder"), at("to a file"), at("to nothing"), at("socket"), null] {
            let before = fs::symlink_metadata(&path).unwrap().file_type();
            let refused = OutputFolder::prepare(&path).unwrap_err();
            assert!(matches!(refused, HarnessError::NotAFolder { .. }), "{refused}");
            for refused in [
                prepare_file(&path).unwrap_err(),
                write_whole(&path, b"new").unwrap_err(),
            ] {
                assert!(matches!(refused, HarnessError::NotAFile { .. }), "{refused}");
            }
            assert_eq!(fs::symlink_metadata(&path).unwrap().file_type(), before);
        }
        assert_eq!(fs::read(at("file")).unwrap(), b"mine");
        assert_eq!(fs::read_dir(at("folder")).unwrap().count(), 0);
        // Below a link is as good as anywhere.
        OutputFolder::prepare(&at("to a folder").join("below")).unwrap();
        assert!(at("folder").join("below").is_dir());
    }

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let dir = tempfile::tempdir().unwrap();
        let out = OutputFolder::prepare(dir.path()).unwrap();
        // A folder that holds something cannot be replaced by a file.
        fs::create_dir(dir.path().join("summary.csv")).unwrap();
        fs::write(dir.path().join("summary.csv/inner"), "mine").unwrap();
        let error = out.write("summary.csv", b"new").unwrap_err();
        assert!(error.to_string().contains("summary.csv"), "{error}");
        assert_eq!(fs::read(dir.path().join("summary.csv/inner")).unwrap(), b"mine");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
