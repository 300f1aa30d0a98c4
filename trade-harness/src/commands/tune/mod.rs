//! `tune`: every filter at its own best, found by the same search and judged on other seeds.

mod plan;
mod results;

use std::io::Write;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::compare::failure_notes;
use super::{Cast, Verdict, note, threads};
use crate::HarnessError;
use crate::cli::TuneArgs;
use crate::output::OutputFolder;
use crate::scenarios::{self, Scenario};
use crate::tuning::standing::Limits;
use crate::tuning::study::Options;
use plan::{Plan, check_ranges};
use results::Done;

pub(super) fn tune(args: &TuneArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let worlds = scenarios::find_all(&args.scenarios)?;
    let options = options(args)?;
    let folder = OutputFolder::prepare(&args.out)?;
    let mut cast = Cast::new(&args.study)?;
    check_ranges(args, &cast)?;
    let plans = worlds
        .into_iter()
        .map(|scenario| Plan::new(args, options, &cast, scenario))
        .collect::<Result<Vec<_>, _>>()?;

    let progress = Progress::new(plans.iter().map(|p| p.work(args)).sum(), args.study.build.quiet);
    let mut done = Done::new(args);
    let mut files = Vec::new();
    for mut plan in plans {
        progress.doing(plan.scenario, "search");
        while plan.tuning.round(|n| progress.advance(n))? {
            folder.write("search.csv", &done.search_csv(Some(&plan), &options)?)?;
        }
        let sets = plan.sets(&cast);
        done.file.sets.extend(sets.iter().cloned());
        folder.write("tuned.json", &done.file.render()?)?;
        cast.models.add_tuned(sets);

        progress.doing(plan.scenario, "judge");
        let study = plan.judge(args, &options, &cast)?;
        let beside = study.spec.filters.len() as u64;
        let result = study.run(|run, rows| {
            failure_notes(&study, run, rows).for_each(|text| progress.note(&text));
            progress.advance(beside);
        })?;
        done.plans.push(plan);
        done.studies.push(study);
        done.results.push(result);
        // With every scenario, so that an interrupted command leaves whole tables of those that are through.
        files = done.write(&folder, &cast, args, &options)?;
    }
    progress.end();
    done.print(args, &options, &folder, &files, out)
}

fn options(args: &TuneArgs) -> Result<Options, HarnessError> {
    if args.study.seed == args.judge_seed {
        return Err(HarnessError::SameSeeds { seed: args.judge_seed });
    }
    Ok(Options {
        objective: args.objective,
        limits: Limits::new(args.nees_min, args.nees_max)?,
        evaluations: args.evaluations,
        runs: args.runs,
        jobs: threads(args.jobs),
    })
}

/// The live line on stderr: runs of filters over the whole command, so that the time left covers the judging, too.
struct Progress {
    bar: ProgressBar,
}

impl Progress {
    fn new(work: u64, quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(work), target);
        let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} filter runs, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(500));
        Self { bar }
    }

    fn doing(&self, scenario: &Scenario, what: &str) {
        self.bar.set_message(format!("{} {what}", scenario.name));
    }

    fn advance(&self, filter_runs: u64) {
        self.bar.inc(filter_runs);
    }

    fn note(&self, text: &str) {
        self.bar.suspend(|| note(text));
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}
