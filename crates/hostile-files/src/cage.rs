//! A folder in which readers work, looked at after each of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use tempfile::TempDir;

/// The folder of this process. Files are put deep inside, so that what climbs out of its own folder is still in this one.
pub(crate) struct Cage {
    folder: TempDir,
    /// Where readers unpack to.
    temporary: PathBuf,
    /// Where files are put.
    given: PathBuf,
}

/// Taken for one file at a time: two would find each other's traces.
pub(crate) fn cage() -> MutexGuard<'static, Cage> {
    static CAGE: OnceLock<Mutex<Cage>> = OnceLock::new();
    let cage = CAGE.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let [temporary, given] = ["a/b/c/d/temporary", "a/b/c/d/given"].map(|name| folder.path().join(name));
        std::fs::create_dir_all(&temporary).unwrap();
        std::fs::create_dir_all(&given).unwrap();
        // Whoever was first keeps it: then nothing is left behind there is not seen, and all else is.
        let _ = tempfile::env::override_temp_dir(&temporary);
        Mutex::new(Cage {
            folder,
            temporary,
            given,
        })
    });
    cage.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Cage {
    /// Puts a file there.
    pub(crate) fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.given.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Whether nothing is there but files that were put, which are removed, too.
    pub(crate) fn check(&self, put: &[&Path]) {
        let mut found = BTreeSet::new();
        collect(self.folder.path(), &mut found);
        for path in put {
            assert!(found.remove(*path), "{} is gone", path.display());
            std::fs::remove_file(path).unwrap();
        }
        assert!(found.is_empty(), "left behind or written outside: {found:?}");
    }

    /// Whether a folder that a reader has made is inside this one, and all in it are files and folders.
    pub(crate) fn holds(&self, folder: &Path) {
        assert!(folder.starts_with(&self.temporary), "{} is elsewhere", folder.display());
        let mut found = BTreeSet::new();
        collect(self.folder.path(), &mut found);
        for path in found {
            assert!(
                path.starts_with(folder) || path.starts_with(&self.given),
                "{} is outside",
                path.display()
            );
            assert!(
                path.symlink_metadata().unwrap().is_file(),
                "{} is no file",
                path.display()
            );
        }
    }
}

fn collect(folder: &Path, found: &mut BTreeSet<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_dir() {
            collect(&entry.path(), found);
        } else {
            found.insert(entry.path());
        }
    }
}
