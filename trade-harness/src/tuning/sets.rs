//! `tuned.json`: what a search found, in a form that `--tuned` reads back.

use std::path::Path;

use serde::{Deserialize, Serialize};
use study::TunedSet;

use crate::HarnessError;
use crate::format::json_bytes;

/// The file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TunedFile {
    /// Version of the harness that searched.
    pub harness_version: String,
    /// What was made small: `position`, `velocity` or `acceleration`.
    pub objective: String,
    /// Range of NEES over its dimension that was asked for.
    pub nees_limits: [f64; 2],
    /// Seed of the worlds that were searched in.
    pub search_seed: i32,
    /// Runs of each candidate.
    pub search_runs: u32,
    /// Candidates of each filter.
    pub evaluations: u32,
    /// Seed of the worlds that the result was judged in.
    pub judge_seed: i32,
    /// Runs it was judged by.
    pub judge_runs: u32,
    /// What else was set, as `MODEL.VARIABLE=VALUE`.
    pub set: Vec<String>,
    /// The winners.
    pub sets: Vec<TunedSet>,
}

impl TunedFile {
    /// Reads the file.
    ///
    /// # Errors
    /// [`HarnessError::Read`], [`HarnessError::NotTuned`].
    pub fn read(path: &Path) -> Result<Self, HarnessError> {
        let text = interface::text::read(path).map_err(|source| HarnessError::Read {
            path: path.to_owned(),
            source,
        })?;
        let mut file: Self = serde_json::from_str(&text).map_err(|source| HarnessError::NotTuned {
            path: path.to_owned(),
            source,
        })?;
        for set in &mut file.sets {
            set.file = Some(path.to_owned());
        }
        Ok(file)
    }

    /// Contents of the file.
    ///
    /// # Errors
    /// [`HarnessError::Json`].
    pub fn render(&self) -> Result<Vec<u8>, HarnessError> {
        json_bytes(self)
    }
}

/// Puts what a search found in place of sets of the same names.
pub fn add(sets: &mut Vec<TunedSet>, found: &[TunedSet]) {
    let same = |a: &TunedSet, b: &TunedSet| (&a.scenario, &a.filter, &a.name) == (&b.scenario, &b.filter, &b.name);
    sets.retain(|old| !found.iter().any(|new| same(old, new)));
    sets.extend_from_slice(found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use study::PAPER;

    #[test]
    fn what_is_written_is_read_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tuned.json");
        let values = [("a", 1.234e-27), ("b", 0.1 + 0.2), ("c", f64::MIN_POSITIVE)];
        let file = TunedFile {
            harness_version: "0".to_owned(),
            objective: "velocity".to_owned(),
            nees_limits: [0.5, 2.0],
            search_seed: 7,
            search_runs: 2,
            evaluations: 3,
            judge_seed: 1,
            judge_runs: 4,
            set: vec!["fmu-truth.vent.scale=2".to_owned()],
            sets: vec![TunedSet {
                file: Some(path.clone()),
                scenario: "s".to_owned(),
                filter: "f".to_owned(),
                preset: "p".to_owned(),
                name: TunedSet::name_for("p"),
                values: values.map(|(k, v)| (k.to_owned(), v)).into(),
                conditions: vec!["vent.scale-2".to_owned()],
                search_objective: Some(0.1),
                search_nees: None,
                feasible: true,
            }],
        };
        std::fs::write(&path, file.render().unwrap()).unwrap();
        assert_eq!(TunedFile::read(&path).unwrap(), file);
        assert_eq!(file.sets[0].name, "p-tuned");
        assert_eq!(TunedSet::name_for(PAPER), "tuned");
    }

    #[test]
    fn another_file_is_told_from_one_that_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tuned.json");
        assert!(matches!(TunedFile::read(&path), Err(HarnessError::Read { .. })));
        std::fs::write(&path, "{\"sets\": 3}").unwrap();
        let error = TunedFile::read(&path).unwrap_err();
        assert!(matches!(error, HarnessError::NotTuned { .. }), "{error}");
        assert!(error.to_string().contains("tuned.json"), "{error}");
    }
}
