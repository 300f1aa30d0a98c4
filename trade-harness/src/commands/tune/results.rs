//! What `tune` leaves behind: the tuned sets, the judged study, and every filter at its own best.

use std::io::Write;

use super::super::compare::Report;
use super::super::{Cast, Verdict, closing, say};
use super::plan::{Plan, tuned_label};
use crate::HarnessError;
use crate::cli::TuneArgs;
use crate::models::Assignment;
use crate::output::OutputFolder;
use crate::report::best::{self, Entry, Ranking};
use crate::report::searched::{self, settings};
use crate::scenarios::Scenario;
use crate::study::{Study, StudyResult};
use crate::tuning::notes::notes;
use crate::tuning::sets::TunedFile;
use crate::tuning::study::{Options, Searched};

/// What is through so far.
pub(super) struct Done {
    pub(super) file: TunedFile,
    pub(super) plans: Vec<Plan>,
    pub(super) studies: Vec<Study>,
    pub(super) results: Vec<StudyResult>,
}

impl Done {
    pub(super) fn new(args: &TuneArgs) -> Self {
        let set = |a: &Assignment| format!("{}.{}={}", a.model, a.variable, a.value);
        Self {
            file: TunedFile {
                harness_version: env!("CARGO_PKG_VERSION").to_owned(),
                objective: args.objective.name().to_owned(),
                nees_limits: [args.nees_min, args.nees_max],
                search_seed: args.study.seed,
                search_runs: args.work.runs,
                evaluations: args.evaluations,
                judge_seed: args.judge_seed,
                judge_runs: args.judge_runs,
                set: args.study.assignments.iter().map(set).collect(),
                sets: Vec::new(),
            },
            plans: Vec::new(),
            studies: Vec::new(),
            results: Vec::new(),
        }
    }

    /// Contents of `search.csv`, with what another plan has so far.
    pub(super) fn search_csv(&self, under_way: Option<&Plan>, options: &Options) -> Result<Vec<u8>, HarnessError> {
        let plans = self.plans.iter().chain(under_way);
        let searches = plans.map(|plan| (plan.scenario.name, plan.tuning.filters.as_slice()));
        searched::render(searches, options.objective)
    }

    fn rankings<'a>(&'a self, report: &'a Report<'_>, options: &Options) -> Vec<Ranking<'a>> {
        let ranking = |plan: &'a Plan| {
            let filters = plan.tuning.filters.iter();
            let entries = filters.filter_map(|searched| entry(searched, plan.scenario, report, options));
            Ranking::new(entries.collect(), options.objective)
        };
        self.plans.iter().map(ranking).collect()
    }

    /// Writes every file; what shows the epochs of the scenario that has just been judged, and no earlier one.
    pub(super) fn write(
        &self,
        folder: &OutputFolder,
        cast: &Cast,
        args: &TuneArgs,
        options: &Options,
    ) -> Result<Vec<String>, HarnessError> {
        let report = Report::new(&self.studies, &self.results);
        let rankings = self.rankings(&report, options);
        let more = vec![
            ("best.csv".to_owned(), best::render(&rankings)?),
            ("best.md".to_owned(), self.markdown(&rankings, args).into_bytes()),
            ("search.csv".to_owned(), self.search_csv(None, options)?),
            ("tuned.json".to_owned(), self.file.render()?),
        ];
        let written = self.studies.len().saturating_sub(1);
        report.write(folder, cast, options.jobs, written, more)
    }

    fn markdown(&self, rankings: &[Ranking<'_>], args: &TuneArgs) -> String {
        let mut text = "# Every filter at its own best\n".to_owned();
        for (plan, ranking) in self.plans.iter().zip(rankings) {
            let heading = heading(plan.scenario, args);
            let legend = best::LEGEND.replace('\n', "\n\n");
            text.push_str(&format!(
                "\n## {}\n\n{heading}\n\n{}\n{legend}\n",
                plan.scenario.name,
                ranking.markdown()
            ));
        }
        text
    }

    pub(super) fn print(
        &self,
        args: &TuneArgs,
        options: &Options,
        folder: &OutputFolder,
        files: &[String],
        out: &mut dyn Write,
    ) -> Result<Verdict, HarnessError> {
        let report = Report::new(&self.studies, &self.results);
        for (plan, ranking) in self.plans.iter().zip(self.rankings(&report, options)) {
            let heading = heading(plan.scenario, args);
            say(
                out,
                &format!(
                    "{}: {heading}\n{}\n{}\n",
                    plan.scenario.name,
                    ranking.render(),
                    best::LEGEND
                ),
            )?;
        }
        closing(folder, files, out)?;
        Ok(Verdict::Done)
    }
}

fn heading(scenario: &Scenario, args: &TuneArgs) -> String {
    format!(
        "least RMSE of {} with NEES from {} to {}, {} evaluations of {} runs from seed {}; judged by {} runs from seed {}, {} to {} s",
        args.objective.name(),
        args.nees_min,
        args.nees_max,
        args.evaluations,
        args.work.runs,
        args.study.seed,
        args.judge_runs,
        args.judge_seed,
        scenario.scored_from,
        scenario.duration,
    )
}

/// A filter's line in the table; `None` while it is not judged.
fn entry<'a>(
    searched: &'a Searched,
    scenario: &Scenario,
    report: &'a Report<'_>,
    options: &Options,
) -> Option<Entry<'a>> {
    let row = |label: &str| {
        report
            .rows
            .iter()
            .find(|r| r.scenario == scenario.name && r.filter == label)
    };
    let timing = |label: &str| {
        report
            .timings
            .iter()
            .find(|t| t.scenario == scenario.name && t.filter == label)
    };
    let given = &searched.base.label;
    let winner = searched.best();
    let label = winner.map_or_else(|| given.clone(), |_| tuned_label(given));
    let best = row(&label)?;
    let mut notes = notes(searched, options);
    if !options.limits.hold(best.nees) {
        notes.push("judged, its NEES is outside the limits".to_owned());
    }
    let found = winner.map(|w| settings(searched.settings(w)));
    Some(Entry {
        best,
        given: row(given).filter(|_| winner.is_some()),
        timing: timing(&label),
        tuned: found.map_or_else(String::new, |f| if f.is_empty() { "as given".to_owned() } else { f }),
        notes,
    })
}
