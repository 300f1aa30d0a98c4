//! The folder of a study: it belongs to one study, one process works in it, and what is finished in it stays finished.
//!
//! While a study is under way its folder holds `.unfinished/`: a lock, the identity of the study and the journals of its runs.
//! A study that is complete has `manifest.json`, which holds the identity, and no `.unfinished/`.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use same_file::Handle;
use serde::Serialize;
use study::{Journal, Models, Study, scheme_name};

use crate::HarnessError;
use crate::digest::{of_bytes, of_file};
use crate::output::{OutputFolder, write_whole};

/// Where an unfinished study keeps what it needs to go on.
const UNFINISHED: &str = ".unfinished";

/// What becomes of a study that is in the folder already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Claim {
    /// A complete one of the same identity is made again; any other is refused.
    Fresh,
    /// An unfinished one of the same identity goes on.
    Resume,
    /// It is set aside under another name.
    Force,
}

/// A folder that this process alone works in.
#[derive(Debug)]
pub struct StudyFolder {
    folder: OutputFolder,
    unfinished: PathBuf,
    identity: String,
    // Held until the process ends, however it ends.
    _lock: File,
}

impl StudyFolder {
    /// Takes a folder for a study.
    ///
    /// # Errors
    /// [`HarnessError::InUse`], [`HarnessError::OtherStudy`], [`HarnessError::Unfinished`], [`HarnessError::Write`].
    pub fn claim(path: &Path, identity: &str, claim: Claim) -> Result<Self, HarnessError> {
        let unfinished = path.join(UNFINISHED);
        let begun = unfinished.join("identity").exists();
        let mut folder = OutputFolder::prepare(path)?;
        let mut held = lock(path)?;
        if claim == Claim::Force && (begun || folder.path().join("manifest.json").exists()) {
            let aside = free_name(path);
            fs::rename(path, &aside).map_err(failed(path))?;
            folder = OutputFolder::prepare(path)?;
            held = lock(path)?;
        }
        let this = Self {
            folder,
            unfinished,
            identity: identity.to_owned(),
            _lock: held,
        };
        this.check(claim)?;
        this.folder.remove_torn();
        write_whole(&this.unfinished.join("identity"), identity.as_bytes())?;
        Ok(this)
    }

    /// Whether the folder holds this study, complete.
    pub fn is_complete(path: &Path, identity: &str) -> bool {
        let text = fs::read(path.join("manifest.json")).unwrap_or_default();
        let manifest: Option<serde_json::Value> = serde_json::from_slice(&text).ok();
        !path.join(UNFINISHED).join("identity").exists()
            && manifest.is_some_and(|manifest| manifest["identity"].as_str() == Some(identity))
    }

    /// Clears what a process left that was killed while it cleared the folder of a complete study.
    ///
    /// # Errors
    /// [`HarnessError::InUse`], [`HarnessError::Write`].
    pub fn clear_leftovers(path: &Path) -> Result<(), HarnessError> {
        if path.join(UNFINISHED).exists() {
            Self::clear_beside(path, None)?;
        }
        Ok(())
    }

    /// Removes a folder within that of a complete study: killed meanwhile, the folder is there whole, or nothing of it but what
    /// [`StudyFolder::clear_leftovers`] clears.
    ///
    /// # Errors
    /// [`HarnessError::InUse`], [`HarnessError::Write`].
    pub fn remove_within(path: &Path, within: &str) -> Result<(), HarnessError> {
        Self::clear_beside(path, Some(within))
    }

    fn clear_beside(path: &Path, within: Option<&str>) -> Result<(), HarnessError> {
        let unfinished = path.join(UNFINISHED);
        let _lock = lock(path)?;
        if unfinished.join("identity").exists() {
            // Somebody has begun it anew meanwhile.
            return Ok(());
        }
        if let Some(within) = within {
            let place = path.join(within);
            fs::rename(&place, unfinished.join(within)).map_err(failed(&place))?;
        }
        clear(&unfinished)
    }

    /// Whether the study that a folder has begun is this one.
    pub fn has_begun(path: &Path, identity: &str) -> bool {
        fs::read_to_string(path.join(UNFINISHED).join("identity")).is_ok_and(|begun| begun == identity)
    }

    /// Whether the study may use what the folder holds.
    fn check(&self, claim: Claim) -> Result<(), HarnessError> {
        let path = self.folder.path().to_owned();
        if let Ok(identity) = fs::read_to_string(self.unfinished.join("identity")) {
            if identity != self.identity {
                return Err(HarnessError::OtherStudy { path });
            }
            let journals = fs::read_dir(&self.unfinished).into_iter().flatten().flatten();
            let begun = journals
                .into_iter()
                .any(|e| e.path().extension().is_some_and(|e| e == "journal"));
            return if claim == Claim::Fresh && begun {
                Err(HarnessError::Unfinished { path })
            } else {
                Ok(())
            };
        }
        let manifest = path.join("manifest.json");
        let Ok(text) = fs::read(&manifest) else { return Ok(()) };
        let found: Option<serde_json::Value> = serde_json::from_slice(&text).ok();
        let same = found.is_some_and(|m| m["identity"].as_str() == Some(&self.identity));
        if same {
            Ok(())
        } else {
            Err(HarnessError::OtherStudy { path })
        }
    }

    /// Where results go.
    pub fn output(&self) -> &OutputFolder {
        &self.folder
    }

    /// What tells this study from any other.
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// The journal of one world and case.
    ///
    /// # Errors
    /// [`study::StudyError::Journal`].
    pub fn journal(&self, study: &Study) -> Result<Journal, HarnessError> {
        let name = format!("{}_{}.journal", study.spec.world.name, study.case);
        Ok(Journal::open(&self.unfinished.join(name), &self.identity)?)
    }

    /// Keeps a file beside the journals, whole; returns its path.
    ///
    /// # Errors
    /// [`HarnessError::Write`].
    pub fn keep(&self, name: &str, contents: &[u8]) -> Result<PathBuf, HarnessError> {
        let path = self.unfinished.join(name);
        write_whole(&path, contents)?;
        Ok(path)
    }

    /// The study is complete: nothing is left but its results.
    ///
    /// # Errors
    /// [`HarnessError::Write`].
    pub fn complete(self) -> Result<(), HarnessError> {
        // First what calls the study unfinished: killed from here on, it is complete, and what is left is cleared by whoever comes.
        let identity = self.unfinished.join("identity");
        fs::remove_file(&identity).map_err(failed(&identity))?;
        clear(&self.unfinished)
    }
}

/// Makes an error of the system one that names the file.
fn failed(path: &Path) -> impl FnOnce(io::Error) -> HarnessError {
    let path = path.to_owned();
    move |source| HarnessError::Write { path, source }
}

/// The right to work in a folder, until it is dropped.
fn lock(folder: &Path) -> Result<File, HarnessError> {
    let unfinished = folder.join(UNFINISHED);
    let name = unfinished.join("lock");
    loop {
        fs::create_dir_all(&unfinished).map_err(failed(&unfinished))?;
        let lock = match File::create(&name) {
            Ok(lock) => lock,
            // Whoever worked here has removed the folder just now.
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(source) => return Err(HarnessError::Write { path: name, source }),
        };
        match lock.try_lock() {
            // Whoever worked here may have removed the file before it was locked: then it locks out nobody.
            Ok(()) if is_at(&lock, &name) => return Ok(lock),
            Ok(()) => (),
            Err(TryLockError::WouldBlock) => {
                return Err(HarnessError::InUse {
                    path: folder.to_owned(),
                });
            }
            Err(TryLockError::Error(source)) => return Err(HarnessError::Write { path: name, source }),
        }
    }
}

/// Whether an open file is the one at this path.
fn is_at(file: &File, path: &Path) -> bool {
    let open = file.try_clone().and_then(Handle::from_file);
    open.is_ok_and(|open| Handle::from_path(path).is_ok_and(|there| there == open))
}

/// Removes the folder of what is under way, the lock last; held by the caller. Who waits for the lock makes a new one.
fn clear(unfinished: &Path) -> Result<(), HarnessError> {
    let lock = unfinished.join("lock");
    for entry in fs::read_dir(unfinished).map_err(failed(unfinished))? {
        let path = entry.map_err(failed(unfinished))?.path();
        let removed = match &path {
            path if *path == lock => Ok(()),
            path if path.is_dir() && !path.is_symlink() => fs::remove_dir_all(path),
            path => fs::remove_file(path),
        };
        removed.map_err(failed(&path))?;
    }
    fs::remove_file(&lock).map_err(failed(&lock))?;
    match fs::remove_dir(unfinished) {
        // Somebody has come already, and looks for themselves.
        Err(error) if matches!(error.kind(), io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::NotFound) => Ok(()),
        removed => removed.map_err(failed(unfinished)),
    }
}

/// `PATH.old-1`, or the first of these names that is free.
fn free_name(path: &Path) -> PathBuf {
    let name = |n: u32| {
        let mut text = path.as_os_str().to_owned();
        text.push(format!(".old-{n}"));
        PathBuf::from(text)
    };
    let mut n = 1;
    while name(n).exists() {
        n += 1;
    }
    name(n)
}

/// Everything that decides what the results of studies are, and nothing that does not: not the threads, not the names of files.
#[derive(Serialize)]
struct Facts<'a> {
    version: &'a str,
    fmus: Vec<(String, String)>,
    studies: Vec<StudyIdentity<'a>>,
}

#[derive(Serialize)]
struct StudyIdentity<'a> {
    mission: &'a interface::Mission,
    /// SHA-256 of each file that the mission reads, by its key.
    mission_files: BTreeMap<&'a str, String>,
    case: &'a str,
    runs: u32,
    seed: i32,
    duration_s: f64,
    scored_from_s: f64,
    step_s: f64,
    sample_period_s: f64,
    scheme: &'a str,
    phases: &'a [study::Phase],
    parts: Vec<PartIdentity<'a>>,
}

#[derive(Serialize)]
struct PartIdentity<'a> {
    label: &'a str,
    model: &'a str,
    parameters: Vec<&'a (String, String)>,
}

/// SHA-256 of what tells the studies of one command from any others: missions, parameters, FMUs, seeds, lengths.
///
/// # Errors
/// An FMU or a file of a mission that cannot be read any more.
pub fn identity(studies: &[Study], models: &Models) -> Result<String, HarnessError> {
    let fmus = models
        .all()
        .map(|model| Ok((model.name.clone(), of_file(model.fmu.path())?)));
    let studies = studies.iter().map(|study| {
        let spec = &study.spec;
        let parts = std::iter::once(&spec.truth).chain(&spec.filters).chain(&spec.drivers);
        let parts = parts.map(|part| {
            // Where the mission's file stands is no matter; what stands in it is told.
            PartIdentity {
                label: &part.label,
                model: &part.model,
                parameters: part.record.iter().filter(|(name, _)| name != "mission_file").collect(),
            }
        });
        let files = spec.world.mission.files().into_iter();
        let files = files.map(|(key, path)| Ok((key, of_file(&path)?)));
        Ok(StudyIdentity {
            mission: &spec.world.mission,
            mission_files: files.collect::<Result<_, HarnessError>>()?,
            case: &study.case,
            runs: study.runs,
            seed: spec.seed,
            duration_s: spec.world.duration_s,
            scored_from_s: spec.world.scored_from_s,
            step_s: spec.step,
            sample_period_s: spec.sample_period,
            scheme: scheme_name(spec.scheme),
            phases: spec.phases.rules(),
            parts: parts.collect(),
        })
    });
    let facts = Facts {
        version: env!("CARGO_PKG_VERSION"),
        fmus: fmus.collect::<Result<_, HarnessError>>()?,
        studies: studies.collect::<Result<_, HarnessError>>()?,
    };
    Ok(of_bytes(&serde_json::to_vec(&facts)?))
}
