//! Study files: a plan as TOML.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use interface::mission::Problem;
use serde::de::DeserializeOwned;

use crate::error::StudyError;
use crate::plan::Plan;

/// First line of a file that a study writes.
const HEAD: &str = "# A study as it ran; 'trade-harness compare --study FILE' runs it again.\n";

impl Plan {
    /// Reads a study file. Relative paths in it start from its folder.
    ///
    /// # Errors
    /// [`StudyError::File`], [`StudyError::FileProblem`] with line and column.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let failed = |source| StudyError::File {
            path: path.to_owned(),
            source,
        };
        let text = interface::text::read(path).map_err(failed)?;
        let mut plan = Self::parse(&path.display().to_string(), &text)?;
        let whole = std::path::absolute(path).map_err(failed)?;
        let folder = whole.parent().unwrap_or(Path::new(""));
        plan.each_path(|path| *path = folder.join(&path));
        Ok(plan)
    }

    /// Reads the text of a study file; paths stay as they are.
    ///
    /// * `origin`: what messages call it.
    ///
    /// # Errors
    /// [`StudyError::FileProblem`] with line and column.
    pub fn parse(origin: &str, text: &str) -> Result<Self, StudyError> {
        let wrong = |error| StudyError::FileProblem(Problem::of_toml(origin, text, &error));
        let mut plan: Self = toml::from_str(text).map_err(wrong)?;
        // A file that names missions alone wants no other beside them.
        let told: toml::Table = toml::from_str(text).map_err(wrong)?;
        if told.contains_key("mission") && !told.contains_key("scenario") {
            plan.scenarios.clear();
        }
        Ok(plan)
    }

    /// The text of a study file that holds all of the plan.
    ///
    /// # Errors
    /// [`StudyError::Unwritten`]: a number that TOML has no form for.
    pub fn to_toml(&self) -> Result<String, StudyError> {
        Ok(format!(
            "{HEAD}{}",
            toml::to_string_pretty(self).map_err(StudyError::Unwritten)?
        ))
    }

    /// With whole paths, so that it may be read from anywhere.
    ///
    /// # Errors
    /// [`StudyError::File`] when the system knows no current folder.
    pub fn with_whole_paths(mut self) -> Result<Self, StudyError> {
        let mut failed = None;
        self.each_path(|path| match std::path::absolute(&*path) {
            Ok(whole) => *path = whole,
            Err(source) => {
                failed = Some(StudyError::File {
                    path: path.clone(),
                    source,
                });
            }
        });
        failed.map_or(Ok(self), Err)
    }

    fn each_path(&mut self, mut change: impl FnMut(&mut PathBuf)) {
        let files = self
            .missions
            .iter_mut()
            .chain(&mut self.truth)
            .chain(&mut self.map_files)
            .chain(&mut self.tuned_files);
        let foreign = self
            .foreign
            .iter_mut()
            .chain(&mut self.drive)
            .map(|filter| &mut filter.path);
        files
            .chain(foreign)
            .chain(&mut self.output.folder)
            .for_each(&mut change);
    }
}

/// One table of a study file as a command line gives it: `name = "last", from_s = 4480`.
///
/// # Errors
/// What the parser says.
pub fn inline<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    let whole = format!("table = {{ {text} }}");
    let mut table: BTreeMap<String, T> = toml::from_str(&whole).map_err(|error| {
        let problem = Problem::of_toml("", &whole, &error).what;
        format!("'{text}' is no part of a study file: {problem}")
    })?;
    table.remove("table").ok_or_else(|| format!("'{text}' holds nothing"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::Requirement;
    use interface::mission::Phase;

    #[test]
    fn a_table_on_the_command_line_has_the_words_of_the_file() {
        let phase: Phase = inline("name = \"last\", from_s = 4480").unwrap();
        assert_eq!((phase.name.as_str(), phase.from_s), ("last", Some(4480.0)));
        let asked: Requirement = inline("metric = \"nees\", at_most = 2").unwrap();
        assert_eq!((asked.metric.as_str(), asked.at_most), ("nees", Some(2.0)));
        let error = inline::<Requirement>("metric = \"nees\", at_mots = 2").unwrap_err();
        assert!(error.contains("did you mean `at_most`"), "{error}");
        assert!(inline::<Phase>("last").is_err());
    }

    #[test]
    fn mistakes_are_told_with_place_and_what_is_allowed() {
        for (text, says) in [
            (
                "runs = 3\nscenarios = []\n",
                "s.toml:2:1: unknown key `scenarios`, did you mean `scenario`?",
            ),
            ("runs = \"3\"\n", "s.toml:1:8: invalid type"),
            (
                "[[grid]]\nzips = true\n",
                "s.toml:2:1: unknown key `zips`, did you mean `zip`?",
            ),
            (
                "vary = [\n  \"m.k=uniform:2:1\",\n]\n",
                "s.toml:1:8: the range 2 to 1 is empty",
            ),
            ("[[phase]]\nname = \"a\"\nfrom = 1\n", "unknown key `from`"),
            (
                "[[requirement]]\nmetric = \"nees\"\nat_mots = 1\n",
                "s.toml:3:1: unknown key `at_mots`, did you mean `at_most`?",
            ),
            ("scheme = \"newton\"\n", "gauss-seidel or jacobi"),
            ("runs = = 3\n", "s.toml:1:8"),
        ] {
            let error = Plan::parse("s.toml", text).unwrap_err().to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
    }

    #[test]
    fn paths_start_from_the_folder_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.toml");
        let text = "mission = [\"a/m.toml\", \"/b.toml\"]\nnav = [\"x=x.fmu\"]\ntruth = \"../t.fmu\"\n";
        std::fs::write(&path, text).unwrap();
        let plan = Plan::read(&path).unwrap();
        assert!(plan.scenarios.is_empty());
        assert_eq!(plan.missions, [folder.path().join("a/m.toml"), "/b.toml".into()]);
        assert_eq!(plan.foreign[0].path, folder.path().join("x.fmu"));
        assert_eq!(plan.truth, Some(folder.path().join("../t.fmu")));
        assert_eq!(Plan::parse("again", &plan.to_toml().unwrap()).unwrap(), plan);
    }
}
