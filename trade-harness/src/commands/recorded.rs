//! What a manifest says of how its study is made, for commands that make it again or look at it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use study::{Models, NAV, OwnFmus, Plan, TRUTH};

use super::shared::note;
use crate::HarnessError;
use crate::digest::of_file;

/// What a manifest says of how its study is made.
#[derive(Debug, Deserialize)]
pub(super) struct Recorded {
    /// The study.
    pub(super) study: Option<Plan>,
    #[serde(default)]
    inputs: BTreeMap<PathBuf, String>,
    models: BTreeMap<String, RecordedModel>,
    environment: RecordedEnvironment,
}

#[derive(Debug, Deserialize)]
struct RecordedModel {
    sha256: String,
}

#[derive(Debug, Deserialize)]
struct RecordedEnvironment {
    fmu_paths: BTreeMap<String, PathBuf>,
    build: RecordedBuild,
}

#[derive(Debug, Deserialize)]
struct RecordedBuild {
    commit: Option<String>,
}

impl Recorded {
    /// Reads the manifest of a folder.
    pub(super) fn read(folder: &Path) -> Result<Self, HarnessError> {
        let path = folder.join("manifest.json");
        let text = fs::read(&path).map_err(|source| HarnessError::Read {
            path: path.clone(),
            source,
        })?;
        serde_json::from_slice(&text).map_err(|source| HarnessError::NoStudy {
            path,
            problem: source.to_string(),
        })
    }

    /// The study, which a folder of `tune` or `reproduce` has none of.
    pub(super) fn plan(&self, folder: &Path) -> Result<&Plan, HarnessError> {
        self.study.as_ref().ok_or_else(|| HarnessError::NoStudy {
            path: folder.join("manifest.json"),
            problem: "it is not of one study that 'compare' or 'merge' has made".to_owned(),
        })
    }

    /// What is not as it was: FMUs and files that are gone or others.
    fn changes(&self) -> Vec<String> {
        let fmus = self.models.iter().filter_map(|(name, model)| {
            let path = self.environment.fmu_paths.get(name)?;
            Some((name.as_str(), path, &model.sha256))
        });
        let inputs = self.inputs.iter().map(|(path, digest)| ("input", path, digest));
        let changed = fmus
            .chain(inputs)
            .filter_map(|(what, path, digest)| match of_file(path) {
                Ok(found) if found == *digest => None,
                Ok(found) => Some(format!(
                    "{what} {} is another file: SHA-256 {found}, not {digest}",
                    path.display()
                )),
                Err(_) => Some(format!("{what} {} cannot be read", path.display())),
            });
        changed.collect()
    }

    /// Refuses to go on where something is not as it was, unless that is wanted.
    pub(super) fn check(&self, folder: &Path, others: bool) -> Result<(), HarnessError> {
        let changes = self.changes();
        if changes.is_empty() {
            return Ok(());
        }
        if others {
            changes.iter().for_each(|text| note(&format!("note: {text}")));
            return Ok(());
        }
        let commit = self.environment.build.commit.as_ref();
        Err(HarnessError::NotAsItWas {
            path: folder.to_owned(),
            changes: changes.join("; "),
            commit: commit.map_or_else(String::new, |commit| format!(" build commit {commit},")),
        })
    }

    /// The FMUs where they were.
    pub(super) fn models(&self, plan: &Plan) -> Result<Models, HarnessError> {
        let path = |name: &str| self.environment.fmu_paths.get(name).cloned();
        let own = OwnFmus {
            truth: path(TRUTH).filter(|_| plan.truth.is_none()),
            nav: path(NAV),
        };
        Ok(Models::of(plan, &own)?)
    }
}
