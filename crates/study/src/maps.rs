//! Files of names: what the variables of foreign FMUs are called here.

use std::collections::BTreeMap;
use std::path::Path;

use interface::mission::Problem;

use crate::arguments::Mapping;
use crate::error::StudyError;

/// Reads a file of mappings: a TOML table for each FMU, by its label, of `THEIR_NAME = "OUR_NAME"`.
///
/// # Errors
/// [`StudyError::File`], [`StudyError::FileProblem`] with line and column, [`StudyError::Mappings`].
pub fn read_mappings(path: &Path) -> Result<Vec<Mapping>, StudyError> {
    let text = interface::text::read(path).map_err(|source| StudyError::File {
        path: path.to_owned(),
        source,
    })?;
    let origin = path.display().to_string();
    let tables: BTreeMap<String, BTreeMap<String, String>> =
        toml::from_str(&text).map_err(|error| StudyError::FileProblem(Problem::of_toml(&origin, &text, &error)))?;
    let names = tables
        .iter()
        .flat_map(|(label, names)| names.iter().map(move |(own, contract)| (label, own, contract)));
    names
        .map(|(label, own, contract)| {
            let mapping = format!("{label}.{own}={contract}").parse();
            mapping.map_err(|problem| StudyError::Mappings {
                path: path.to_owned(),
                problem,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Mapping>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("names.toml");
        std::fs::write(&path, text).unwrap();
        read_mappings(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn a_file_says_what_the_option_says() {
        let option = |text: &str| text.parse::<Mapping>().unwrap();
        let file = "# theirs\n[a]\nx_hat = \"est.r_tc_n\"\n\"P[1,2]\" = \"cov.p[1,2]\"\n[fmu-truth]\n\"s.n\" = \"sample_count\"\n";
        let expected = [
            "a.P[1,2]=cov.p[1,2]",
            "a.x_hat=est.r_tc_n",
            "fmu-truth.s.n=sample_count",
        ];
        assert_eq!(read(file).unwrap(), expected.map(option));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (text, says) in [
            ("[a]\nx = 3\n", "names.toml:2:5: "),
            ("x = \"est.r_tc_n\"\n", "names.toml:1:5: "),
            ("[a]\nx = \"\"\n", "'a.x=' is not LABEL.THEIR_NAME=OUR_NAME"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
