//! `reproduce`: both papers rerun and held beside what they print.

use serde_json::json;
use study::{Engine, Models, Plan, Study, StudyError, StudyResult, rehearse, run_once};

use super::out::Out;
use super::progress::run_watched;
use super::shared::{Verdict, closing, models, note};
use crate::HarnessError;
use crate::cli::ReproduceArgs;
use crate::format::number;
use crate::output::OutputFolder;
use crate::report::manifest::Manifest;
use crate::report::{summary, timing};
use crate::reproduce::{CHAPTERS, FirstRun, Laboratory, MEANT_RUNS, Notebook, Request, csv, fill, line_text, markdown};

/// Below this, standard errors are so large that a bound says little.
const FEW_RUNS: u32 = 30;

pub(super) fn reproduce(args: &ReproduceArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let folder = OutputFolder::prepare(&args.out)?;
    let mut bench = Bench::new(args)?;
    if args.work.runs() < FEW_RUNS {
        note(&format!(
            "note: the bounds are meant for {MEANT_RUNS} runs; with {} a bound may be missed, or held, by chance",
            args.work.runs()
        ));
    }
    // Everything is set up once before the first run, so that a mistake shows at once.
    for request in CHAPTERS.iter().flat_map(|chapter| (chapter.requests)()) {
        rehearse(&bench.set_up(&request)?.spec)?;
    }
    let heading = format!("{} runs of each study from seed {}.", args.work.runs(), args.seed);
    let (mut said, mut chapter) = (0, "");
    let notebook = fill(&mut bench, |notebook| {
        for (title, line) in &notebook.lines[said..] {
            if *title != chapter {
                chapter = title;
                out.say(&format!("\n{title}"))?;
            }
            out.say(&line_text(line))?;
        }
        said = notebook.lines.len();
        write(&folder, notebook, &heading).map(|_| ())
    })?;
    out.say("\nCPU time per step of each filter")?;
    for row in &notebook.timings {
        let cost = number(Some(row.nav_us_per_step));
        out.say(&format!("{cost:>8} us  {}, {}: {}", row.scenario, row.case, row.filter))?;
    }

    let mut files = write(&folder, &notebook, &heading)?;
    let studies = notebook.studies.clone();
    Manifest::new(&bench.models, studies, bench.jobs, notebook.wall)?.write(&folder, &mut files)?;
    let missed = notebook.missed().count();
    out.tell("missed", missed)?;
    let lines = notebook.lines.iter().map(|(chapter, line)| {
        json!({
            "chapter": chapter, "paper": line.paper, "item": line.item, "quantity": line.quantity, "unit": line.unit,
            "paper_value": line.printed, "value": line.value, "standard_error": line.standard_error,
            "required": line.required, "verdict": line.verdict().text(), "note": line.note,
        })
    });
    out.tell("lines", lines.collect::<Vec<_>>())?;
    out.say(&format!(
        "\n{missed} of {} required bounds missed; {:.0} s on {} threads",
        notebook.lines.iter().filter(|(_, line)| line.required).count(),
        notebook.wall.as_secs_f64(),
        bench.jobs
    ))?;
    closing(&folder, &files, out)?;
    Ok(if missed > 0 {
        Verdict::BoundsMissed
    } else {
        Verdict::Done
    })
}

/// Writes what has been found so far; `timing.csv` alone differs on repeat.
fn write(folder: &OutputFolder, notebook: &Notebook, heading: &str) -> Result<Vec<String>, HarnessError> {
    let mut files = vec![
        ("reproduce.md".to_owned(), markdown(notebook, heading).into_bytes()),
        ("reproduce.csv".to_owned(), csv(notebook)?),
        ("summary.csv".to_owned(), summary::render(&notebook.rows)?),
        ("timing.csv".to_owned(), timing::render(&notebook.timings)?),
    ];
    files.extend(notebook.files.iter().cloned());
    folder.write_all(files)
}

/// Runs studies of our FMUs.
struct Bench<'a> {
    args: &'a ReproduceArgs,
    models: Models,
    jobs: usize,
}

impl<'a> Bench<'a> {
    fn new(args: &'a ReproduceArgs) -> Result<Self, HarnessError> {
        let plan = Plan {
            jobs: args.work.jobs,
            ..Plan::default()
        };
        Ok(Self {
            args,
            models: models(&plan, &args.build)?,
            jobs: plan.threads(),
        })
    }

    /// The plan of a request, with what the command line says of all of them.
    fn plan(&self, request: &Request) -> Plan {
        Plan {
            seed: self.args.seed,
            runs: self.args.work.runs().div_ceil(request.one_run_in),
            jobs: self.args.work.jobs,
            ..request.plan.clone()
        }
    }

    fn set_up(&self, request: &Request) -> Result<Study, HarnessError> {
        let plan = self.plan(request);
        // No chapter changes a mission, so nothing is written.
        let worlds = plan.worlds(&self.args.out)?;
        let world = worlds.first().ok_or(StudyError::NoWorld)?;
        Ok(self.models.study(&plan, world)?)
    }
}

impl Laboratory for Bench<'_> {
    fn study(&mut self, request: &Request) -> Result<(Plan, Study, StudyResult), HarnessError> {
        let study = self.set_up(request)?;
        let result = run_watched(&study, Engine::default(), self.args.build.quiet)?;
        Ok((self.plan(request), study, result))
    }

    fn first_run(&mut self, request: &Request) -> Result<FirstRun, HarnessError> {
        let spec = self.set_up(request)?.spec;
        let mut samples = Vec::with_capacity(spec.epochs());
        let report = run_once(&spec, 0, |filter, truth, _| {
            if filter == 0 {
                samples.push(*truth);
            }
            Ok(())
        });
        let mut failed = 0;
        for failure in report.endings.iter().filter_map(|e| e.failure.as_ref()) {
            failed += 1;
            note(&format!("failed: {} run 0: {}", request.case(), failure.message));
        }
        Ok(FirstRun { samples, failed })
    }
}
