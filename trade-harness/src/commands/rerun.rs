//! `rerun`: a study once more, from its manifest alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use study::{Models, NAV, OwnFmus, Plan, TRUTH};

use super::compare::{Way, carry_out};
use super::out::Out;
use super::shared::{Verdict, end_when_asked, note};
use crate::HarnessError;
use crate::cli::RerunArgs;
use crate::digest::of_file;
use crate::store::Claim;

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

pub(super) fn rerun(args: &RerunArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    end_when_asked()?;
    let recorded = Recorded::read(&args.dir)?;
    let plan = Plan {
        jobs: args.jobs,
        ..recorded.plan(&args.dir)?.clone()
    };
    recorded.check(&args.dir, args.other_files)?;
    let models = recorded.models(&plan)?;
    let out_dir = args.out.clone().unwrap_or_else(|| {
        let mut name = args.dir.as_os_str().to_owned();
        name.push(".rerun");
        name.into()
    });
    let way = Way {
        out_dir: out_dir.clone(),
        claim: if args.force { Claim::Force } else { Claim::Fresh },
        shard: None,
        quiet: args.quiet,
        wide: false,
        check: false,
    };
    carry_out(&plan, &models, &way, out)?;
    let (equal, different) = compared(&args.dir, &out_dir)?;
    out.tell("equal", equal)?;
    out.tell("different", &different)?;
    if different.is_empty() {
        out.say(&format!(
            "{equal} files as in {}, not a byte different",
            args.dir.display()
        ))?;
        return Ok(Verdict::Done);
    }
    out.say(&format!("Not as in {}: {}", args.dir.display(), different.join(", ")))?;
    Ok(Verdict::BoundsMissed)
}

/// How many files of two studies are equal, and which are not; times and places aside.
fn compared(one: &Path, other: &Path) -> Result<(usize, Vec<String>), HarnessError> {
    let (one, other) = (contents(one)?, contents(other)?);
    let mut names: Vec<&String> = one.keys().chain(other.keys()).collect();
    names.sort_unstable();
    names.dedup();
    let (equal, different): (Vec<_>, Vec<_>) = names.into_iter().partition(|name| one.get(*name) == other.get(*name));
    Ok((equal.len(), different.into_iter().cloned().collect()))
}

/// Files that a study writes, by their names, as far as bytes are promised.
fn contents(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, HarnessError> {
    let read = |path: &Path| {
        fs::read(path).map_err(|source| HarnessError::Read {
            path: path.to_owned(),
            source,
        })
    };
    let mut manifest: serde_json::Value = serde_json::from_slice(&read(&folder.join("manifest.json"))?)?;
    let files = manifest["files"].as_array().cloned().unwrap_or_default();
    let names = files
        .iter()
        .filter_map(|name| name.as_str())
        .filter(|name| *name != "timing.csv");
    let mut found = BTreeMap::new();
    for name in names {
        found.insert(name.to_owned(), read(&folder.join(name))?);
    }
    if let Some(manifest) = manifest.as_object_mut() {
        manifest.remove("environment");
    }
    found.insert("manifest.json".to_owned(), serde_json::to_vec(&manifest)?);
    Ok(found)
}
