//! `rerun`: a study once more, from its manifest alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use study::Plan;

use super::compare::{Way, carry_out};
use super::out::Out;
use super::recorded::Recorded;
use super::shared::{Verdict, end_when_asked};
use crate::HarnessError;
use crate::cli::RerunArgs;
use crate::store::Claim;

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
