//! What `tune` leaves behind: the tuned sets, the judged study, and every filter at its own best.

use serde_json::json;
use study::{Assignment, Models, Plan, Study, StudyResult, World};

use super::super::files::Report;
use super::super::out::Out;
use super::super::shared::{Verdict, closing};
use super::contest::Contest;
use crate::HarnessError;
use crate::cli::TuneArgs;
use crate::format::wrapped;
use crate::output::OutputFolder;
use crate::report::best::{self, Entry, Ranking};
use crate::report::searched::{self, settings};
use crate::tuning::notes::notes;
use crate::tuning::sets::TunedFile;
use crate::tuning::study::{Options, Searched};

/// What is through so far.
pub(super) struct Done {
    pub(super) file: TunedFile,
    pub(super) contests: Vec<Contest>,
    pub(super) studies: Vec<Study>,
    pub(super) results: Vec<StudyResult>,
}

impl Done {
    pub(super) fn new(args: &TuneArgs) -> Self {
        Self {
            file: TunedFile {
                harness_version: env!("CARGO_PKG_VERSION").to_owned(),
                objective: args.objective.name().to_owned(),
                nees_limits: [args.nees_min, args.nees_max],
                search_seed: args.study.seed(),
                search_runs: args.work.runs(),
                evaluations: args.evaluations,
                judge_seed: args.judge_seed,
                judge_runs: args.judge_runs,
                set: args.study.assignments.iter().map(Assignment::to_string).collect(),
                sets: Vec::new(),
            },
            contests: Vec::new(),
            studies: Vec::new(),
            results: Vec::new(),
        }
    }

    /// Contents of `search.csv`, with what another contest has so far.
    pub(super) fn search_csv(&self, under_way: Option<&Contest>, options: &Options) -> Result<Vec<u8>, HarnessError> {
        let contests = self.contests.iter().chain(under_way);
        let searches = contests.map(|c| (c.world.name.as_str(), c.tuning.filters.as_slice()));
        searched::render(searches, options.objective)
    }

    fn rankings<'a>(&'a self, report: &'a Report<'_>, options: &Options) -> Vec<Ranking<'a>> {
        let ranking = |contest: &'a Contest| {
            let filters = contest.tuning.filters.iter();
            let entries = filters.filter_map(|searched| entry(searched, &contest.world, report, options));
            Ranking::new(entries.collect(), options.objective)
        };
        self.contests.iter().map(ranking).collect()
    }

    /// Writes every file; what shows the epochs of the world that has just been judged, and no earlier one.
    pub(super) fn write(
        &self,
        folder: &OutputFolder,
        models: &Models,
        judge: &Plan,
        args: &TuneArgs,
        options: &Options,
    ) -> Result<Vec<String>, HarnessError> {
        let report = Report::new(&[], &self.studies, &self.results, &[])?;
        let rankings = self.rankings(&report, options);
        let more = vec![
            ("best.csv".to_owned(), best::render(&rankings)?),
            ("best.md".to_owned(), self.markdown(&rankings, args).into_bytes()),
            ("search.csv".to_owned(), self.search_csv(None, options)?),
            ("tuned.json".to_owned(), self.file.render()?),
        ];
        let written = self.studies.len().saturating_sub(1);
        report.write(folder, models, judge, written, more, None)
    }

    fn markdown(&self, rankings: &[Ranking<'_>], args: &TuneArgs) -> String {
        let mut text = "# Every filter at its own best\n".to_owned();
        for (contest, ranking) in self.contests.iter().zip(rankings) {
            let heading = heading(&contest.world, args);
            let legend = best::WIDE_LEGEND.replace('\n', "\n\n");
            text.push_str(&format!(
                "\n## {}\n\n{heading}\n\n{}\n{legend}\n",
                contest.world.name,
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
        out: &mut Out<'_>,
    ) -> Result<Verdict, HarnessError> {
        let report = Report::new(&[], &self.studies, &self.results, &[])?;
        let mut told = Vec::new();
        for (contest, ranking) in self.contests.iter().zip(self.rankings(&report, options)) {
            let heading = format!("{}: {}", contest.world.name, heading(&contest.world, args));
            out.say(&if args.wide {
                format!("{heading}\n{}\n{}\n", ranking.render_wide(), best::WIDE_LEGEND)
            } else {
                format!("{}\n{}\n{}\n", wrapped(&heading), ranking.render(), best::LEGEND)
            })?;
            told.push(json!({
                "scenario": contest.world.name, "objective": options.objective.name(), "filters": ranking.told(),
            }));
        }
        out.tell("ranking", told)?;
        out.tell("tuned", &self.file)?;
        closing(folder, files, out)?;
        Ok(Verdict::Done)
    }
}

fn heading(world: &World, args: &TuneArgs) -> String {
    format!(
        "least RMSE of {} with NEES of position and velocity from {} to {}, {} evaluations of {} runs from seed {}; judged by {} runs from seed {}, {} to {} s",
        args.objective.name(),
        args.nees_min,
        args.nees_max,
        args.evaluations,
        args.work.runs(),
        args.study.seed(),
        args.judge_runs,
        args.judge_seed,
        world.scored_from_s,
        world.duration_s,
    )
}

/// A filter's line in the table; `None` while it is not judged.
fn entry<'a>(searched: &'a Searched, world: &World, report: &'a Report<'_>, options: &Options) -> Option<Entry<'a>> {
    let row = |label: &str| {
        report
            .rows
            .iter()
            .find(|r| r.scenario == world.name && r.filter == label)
    };
    let timing = |label: &str| {
        report
            .timings
            .iter()
            .find(|t| t.scenario == world.name && t.filter == label)
    };
    let given = &searched.contender.base.label;
    let winner = searched.best();
    let label = winner.map_or_else(|| given.clone(), |_| searched.contender.tuned().label);
    let best = row(&label)?;
    let mut notes = notes(searched, options);
    if !options.limits.hold(best.nees6.mean) {
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
