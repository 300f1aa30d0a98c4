//! `compare`: the Monte Carlo study.

use std::io::Write;

use super::progress::run_watched;
use super::{Cast, Verdict, closing, note, say, threads};
use crate::HarnessError;
use crate::cli::CompareArgs;
use crate::output::OutputFolder;
use crate::report::claims::verdicts;
use crate::report::manifest::{Manifest, StudyFacts};
use crate::report::runs::Named;
use crate::report::summary::SummaryRow;
use crate::report::timing::TimingRow;
use crate::report::{epochs, measured, runs, summary, table, timing};
use crate::run::rehearse;
use crate::scenarios;
use crate::study::{Study, StudyResult};

pub(super) fn compare(args: &CompareArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let worlds = scenarios::find_all(&args.worlds.scenarios)?;
    let folder = OutputFolder::prepare(&args.out)?;
    let cast = Cast::new(&args.study)?;
    let jobs = threads(args.work.jobs);
    let mut studies = Vec::new();
    for scenario in worlds {
        let spec = cast.spec(&args.study, scenario)?;
        for open in rehearse(&spec)? {
            note(&format!("note: nothing feeds {open}; it keeps its start value"));
        }
        studies.push(Study {
            spec,
            runs: args.work.runs,
            jobs,
            case: args.case.clone(),
        });
    }

    let mut results = Vec::new();
    for study in &studies {
        results.push(run_watched(study, args.study.build.quiet)?);
    }
    let report = Report::new(&studies, &results);
    let files = report.write(&folder, &cast, jobs, 0, Vec::new())?;
    report.print(args, &folder, &files, out)
}

/// All results of the command, ready to be written.
pub(super) struct Report<'a> {
    studies: &'a [Study],
    results: &'a [StudyResult],
    pub(super) rows: Vec<SummaryRow>,
    pub(super) timings: Vec<TimingRow>,
}

impl<'a> Report<'a> {
    pub(super) fn new(studies: &'a [Study], results: &'a [StudyResult]) -> Self {
        let mut rows = Vec::new();
        let mut timings = Vec::new();
        for (study, result) in studies.iter().zip(results) {
            let (summary, cost) = measured(study, result);
            rows.extend(summary);
            timings.extend(cost);
        }
        Self {
            studies,
            results,
            rows,
            timings,
        }
    }

    /// Writes every file and what else the command has; `manifest.json` last, so that it stands for a complete set.
    ///
    /// * `written`: studies, from the first, whose `epochs` files are in the folder already.
    /// * returns: names of all files.
    pub(super) fn write(
        &self,
        folder: &OutputFolder,
        cast: &Cast,
        jobs: usize,
        written: usize,
        more: Vec<(String, Vec<u8>)>,
    ) -> Result<Vec<String>, HarnessError> {
        let named: Vec<Named<'_>> = self
            .studies
            .iter()
            .zip(self.results)
            .map(|(study, result)| Named {
                spec: &study.spec,
                case: &study.case,
                filters: &result.filters,
            })
            .collect();
        let mut files = folder.write_all(vec![
            ("summary.csv".to_owned(), summary::render(&self.rows)?),
            ("paired.csv".to_owned(), runs::render_paired(&named)?),
            ("runs.csv".to_owned(), runs::render_runs(&named)?),
            ("failures.csv".to_owned(), runs::render_failures(&named)?),
            ("timing.csv".to_owned(), timing::render(&self.timings)?),
        ])?;
        for (index, study) in named.iter().enumerate() {
            for filter in study.filters {
                let name = format!(
                    "epochs/{}_{}_{}.csv",
                    study.spec.scenario.name, filter.label, study.case
                );
                // Written as they are rendered: together they take more room than the results they show.
                if index >= written {
                    folder.write(&name, &epochs::render(study.spec, filter)?)?;
                }
                files.push(name);
            }
        }
        files.extend(folder.write_all(more)?);
        let wall = self.results.iter().map(|r| r.wall).sum();
        let studies = self.studies.iter().map(StudyFacts::new).collect();
        Manifest::new(&cast.models, studies, jobs, wall).write(folder, &mut files)?;
        Ok(files)
    }

    fn print(
        &self,
        args: &CompareArgs,
        folder: &OutputFolder,
        files: &[String],
        out: &mut dyn Write,
    ) -> Result<Verdict, HarnessError> {
        // What a source claims is claimed of its own world, not of a changed one.
        let as_published =
            args.study.assignments.is_empty() && args.study.variations.is_empty() && args.study.truth.is_none();
        let mut missed = false;
        for (study, result) in self.studies.iter().zip(self.results) {
            let scenario = study.spec.scenario;
            let rows: Vec<SummaryRow> = self
                .rows
                .iter()
                .filter(|r| r.scenario == scenario.name)
                .cloned()
                .collect();
            let heading = format!(
                "{}, case {}: {} runs from seed {}, {} to {} s, {:.1} s on {} threads",
                scenario.name,
                study.case,
                study.runs,
                study.spec.seed,
                scenario.scored_from,
                scenario.duration,
                result.wall.as_secs_f64(),
                study.jobs
            );
            say(
                out,
                &format!("{heading}\n{}\n{}", table::render(&rows, &self.timings), table::LEGEND),
            )?;
            let verdicts = if as_published {
                verdicts(scenario, &rows)
            } else {
                Vec::new()
            };
            say(out, &format!("\n{}", table::render_axes(&rows, scenario.signals.axes)))?;
            if !verdicts.is_empty() {
                say(
                    out,
                    &format!("\n{}\n{}", scenario.reference, table::render_claims(&verdicts)),
                )?;
            }
            missed |= verdicts.iter().any(|v| !v.holds());
            say(out, "")?;
        }
        closing(folder, files, out)?;
        Ok(if missed && args.check {
            Verdict::BoundsMissed
        } else {
            Verdict::Done
        })
    }
}
