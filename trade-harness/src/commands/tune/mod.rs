//! `tune`: every filter at its own best, found by the same search and judged on other seeds.

mod contest;
mod results;

use study::Plan;

use super::out::Out;
use super::preload::start_again_with;
use super::progress::Progress;
use super::shared::{Verdict, models, plan_of};
use crate::HarnessError;
use crate::cli::TuneArgs;
use crate::output::OutputFolder;
use crate::tuning::sets::add;
use crate::tuning::standing::Limits;
use crate::tuning::study::Options;
use contest::{Contest, check_ranges};
use results::Done;

pub(super) fn tune(args: &TuneArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    start_again_with(&args.preload)?;
    let plan = plan_of(Plan::default(), &args.study, &args.worlds, &args.work)?;
    let options = options(args, &plan)?;
    let folder = OutputFolder::prepare(&args.out)?;
    let worlds = plan.worlds(folder.path())?;
    let models = models(&plan, &args.study.build)?;
    check_ranges(&args.ranges, &plan, &models)?;
    let contests = worlds
        .into_iter()
        .map(|world| Contest::new(&args.ranges, options, &plan, &models, world))
        .collect::<Result<Vec<_>, _>>()?;

    // Over the whole command, so that the time left covers the judging, too.
    let work = contests.iter().map(|c| c.work(args.judge_runs)).sum();
    let progress = Progress::new(work, "filter runs", args.study.build.quiet);
    let conditions = plan.deviations();
    let mut judge = Plan {
        seed: args.judge_seed,
        runs: args.judge_runs,
        ..plan
    };
    let mut done = Done::new(args);
    let mut files = Vec::new();
    for mut contest in contests {
        progress.doing(format!("{} search", contest.world.name));
        while contest.tuning.round(|n| progress.advance(n)) {
            folder.write("search.csv", &done.search_csv(Some(&contest), &options)?)?;
        }
        let sets = contest.sets(&judge.tuned, &conditions);
        done.file.sets.extend(sets.iter().cloned());
        folder.write("tuned.json", &done.file.render()?)?;
        add(&mut judge.tuned, &sets);

        progress.doing(format!("{} judge", contest.world.name));
        judge.filters = Some(contest.judged());
        let study = models.study(&judge, &contest.world)?;
        let beside = study.spec.filters.len() as u64;
        let result = study.run(study::Engine::default(), |run, rows| {
            progress.failures(&study, run, rows);
            progress.advance(beside);
        })?;
        done.contests.push(contest);
        done.studies.push(study);
        done.results.push(result);
        // With every world, so that an interrupted command leaves whole tables of those that are through.
        files = done.write(&folder, &models, &judge, args, &options)?;
    }
    progress.end();
    done.print(args, &options, &folder, &files, out)
}

fn options(args: &TuneArgs, plan: &Plan) -> Result<Options, HarnessError> {
    if args.study.seed() == args.judge_seed {
        return Err(HarnessError::SameSeeds { seed: args.judge_seed });
    }
    Ok(Options {
        objective: args.objective,
        limits: Limits::new(args.nees_min, args.nees_max)?,
        evaluations: args.evaluations,
        runs: args.work.runs(),
        jobs: plan.threads(),
    })
}
