//! What a chapter asks for.

use study::{Assignment, Plan, TRUTH};

/// Names of the papers' worlds.
pub(crate) const LEO_VENTING: &str = "leo_venting";
/// The second.
pub(crate) const NRHO_VENTING: &str = "nrho_venting";
/// The third.
pub(crate) const FORMATION: &str = "formation";

/// A study of one world that a chapter needs, or run 0 of one alone.
#[derive(Debug, Clone)]
pub struct Request {
    /// What is studied; seed, runs and threads are up to the laboratory.
    pub plan: Plan,
    /// This study makes do with one run where the others have so many.
    pub one_run_in: u32,
}

impl Request {
    /// * `filters`: as `--filters` takes them.
    pub(crate) fn new(world: &str, case: &str, filters: &[&str]) -> Self {
        Self {
            plan: Plan {
                scenarios: vec![world.to_owned()],
                case: Some(case.to_owned()),
                filters: Some(filters.iter().filter_map(|label| label.parse().ok()).collect()),
                ..Plan::default()
            },
            one_run_in: 1,
        }
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

    /// With a parameter set for every run.
    pub(crate) fn set(mut self, model: &str, variable: &str, value: &str) -> Self {
        self.plan.assignments.push(Assignment {
            model: model.to_owned(),
            variable: variable.to_owned(),
            value: value.to_owned(),
        });
        self
    }

    /// With the J2 relative model as the truth, as in Sec. IV.B of the network's paper.
    pub(crate) fn with_j2_alone(self) -> Self {
        self.set(TRUTH, "formation.forces", "j2")
    }

    /// With runs of this length, s.
    pub(crate) fn lasting(mut self, duration_s: f64) -> Self {
        self.plan.duration_s = Some(duration_s);
        self
    }

    /// With one run where the others have so many.
    pub(crate) fn one_run_in(self, one_run_in: u32) -> Self {
        Self { one_run_in, ..self }
    }
}
