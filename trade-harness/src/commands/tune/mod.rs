//! `tune`: every filter at its own best, found by the same search and judged on other seeds.

mod plan;
mod results;

use std::io::Write;

use super::progress::Progress;
use super::{Cast, Verdict, threads};
use crate::HarnessError;
use crate::cli::TuneArgs;
use crate::output::OutputFolder;
use crate::scenarios;
use crate::tuning::standing::Limits;
use crate::tuning::study::Options;
use plan::{Plan, check_ranges};
use results::Done;

pub(super) fn tune(args: &TuneArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let worlds = scenarios::find_all(&args.worlds.scenarios)?;
    let options = options(args)?;
    let folder = OutputFolder::prepare(&args.out)?;
    let mut cast = Cast::new(&args.study)?;
    check_ranges(args, &cast)?;
    let plans = worlds
        .into_iter()
        .map(|scenario| Plan::new(args, options, &cast, scenario))
        .collect::<Result<Vec<_>, _>>()?;

    // Over the whole command, so that the time left covers the judging, too.
    let work = plans.iter().map(|p| p.work(args)).sum();
    let progress = Progress::new(work, "filter runs", args.study.build.quiet);
    let mut done = Done::new(args);
    let mut files = Vec::new();
    for mut plan in plans {
        progress.doing(format!("{} search", plan.scenario.name));
        while plan.tuning.round(|n| progress.advance(n))? {
            folder.write("search.csv", &done.search_csv(Some(&plan), &options)?)?;
        }
        let sets = plan.sets(&cast);
        done.file.sets.extend(sets.iter().cloned());
        folder.write("tuned.json", &done.file.render()?)?;
        cast.models.add_tuned(sets);

        progress.doing(format!("{} judge", plan.scenario.name));
        let study = plan.judge(args, &options, &cast)?;
        let beside = study.spec.filters.len() as u64;
        let result = study.run(|run, rows| {
            progress.failures(&study, run, rows);
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
        runs: args.work.runs,
        jobs: threads(args.work.jobs),
    })
}
