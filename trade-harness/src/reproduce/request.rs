//! What a chapter asks for.

use study::Plan;

/// A study of one world that a chapter needs, or run 0 of one alone.
#[derive(Debug, Clone)]
pub struct Request {
    /// What is studied; seed, runs and threads are up to the laboratory.
    pub plan: Plan,
    /// This study makes do with one run where the others have so many.
    pub one_run_in: u32,
}

/// Runs of the studies that the bounds are meant for.
pub(crate) const MEANT_RUNS: u32 = 100;

/// The study files that chapters run, embedded.
macro_rules! studies {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../studies/", $name, ".toml")))),*]
    };
}

const STUDIES: &[(&str, &str)] = studies![
    "milton_figures_1_to_6",
    "milton_figures_7_to_13",
    "network_table_2",
    "network_figures_4_and_5",
    "network_figure_4_relaxation",
    "network_drift",
    "network_figures_6_and_7_and_table_3",
    "network_table_4",
    "network_neurons",
    "beyond_less_noise",
    "beyond_ten_kilograms",
];

impl Request {
    /// The cases of a study file; none of one that does not exist or is wrong, which a test rules out.
    ///
    /// * `name`: of the file in `studies/`, without `.toml`.
    pub(crate) fn all(name: &str) -> Vec<Self> {
        let text = STUDIES
            .iter()
            .find(|(own, _)| *own == name)
            .map_or("", |(_, text)| text);
        let cases = Plan::parse(name, text)
            .and_then(|plan| plan.cases())
            .unwrap_or_default();
        let one_run_in = |plan: &Plan| (MEANT_RUNS / plan.runs).max(1);
        cases
            .into_iter()
            .map(|plan| Self {
                one_run_in: one_run_in(&plan),
                plan,
            })
            .collect()
    }

    /// The study of a file that holds one.
    pub(crate) fn of(name: &str) -> Self {
        let one = Self::all(name).into_iter().next();
        one.unwrap_or_else(|| Self {
            plan: Plan::default(),
            one_run_in: 1,
        })
    }

    /// What a parameter is set to.
    pub(crate) fn value(&self, variable: &str) -> Option<f64> {
        let set = self.plan.assignments.iter().find(|a| a.variable == variable)?;
        set.value.parse().ok()
    }

    /// Name of the world.
    pub fn world(&self) -> &str {
        self.plan.scenarios.first().map_or("", String::as_str)
    }

    /// Text of the `case` column; with the world it names the study.
    pub fn case(&self) -> &str {
        self.plan.case.as_deref().unwrap_or_default()
    }

    /// Labels of the filters.
    pub fn filters(&self) -> impl Iterator<Item = &str> {
        self.plan.filters.iter().flatten().map(|choice| choice.label.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_study_file_of_a_chapter_is_read_and_names_its_case() {
        for (name, text) in STUDIES {
            let cases = Plan::parse(name, text).unwrap().cases().unwrap();
            assert!(
                !Request::all(name).is_empty() && Request::all(name).len() == cases.len(),
                "{name}"
            );
            for request in Request::all(name) {
                request.plan.check().unwrap();
                assert!(request.plan.case.is_some() && request.filters().count() > 0, "{name}");
                assert!(MEANT_RUNS.is_multiple_of(request.plan.runs), "{name}");
            }
        }
    }
}
