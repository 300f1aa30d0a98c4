//! What each command of the command line does.

mod compare;
mod inspect;
mod list;
mod pack;
mod progress;
mod replay;
mod reproduce;
mod tune;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::HarnessError;
use crate::cli::{BuildArgs, Cli, Command, StudyArgs};
use crate::models::{FilterChoice, Models, NAV, PAPER, TRUTH};
use crate::output::OutputFolder;
use crate::pack::{default_folder, fmu_path};
use crate::report::manifest::peak_memory_mib;
use crate::run::{Spec, chain};
use crate::scenarios::Scenario;
use crate::tuning::sets::TunedFile;

/// How a command that could do its work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Done,
    BoundsMissed,
}

/// Runs a command: exit code 0 when done, 1 when bounds were missed, 2 when it could not do its work.
pub fn execute(cli: Cli) -> ExitCode {
    let mut out = io::stdout().lock();
    let result = match cli.command {
        Command::List(args) => list::list(&args, &mut out),
        Command::Pack(args) => pack::pack(&args, &mut out),
        Command::Compare(args) => compare::compare(&args, &mut out),
        Command::Tune(args) => tune::tune(&args, &mut out),
        Command::Replay(args) => replay::replay(&args, &mut out),
        Command::Reproduce(args) => reproduce::reproduce(&args, &mut out),
        Command::Inspect(args) => inspect::inspect(&args, &mut out),
    };
    match result {
        Ok(Verdict::Done) => ExitCode::SUCCESS,
        Ok(Verdict::BoundsMissed) => ExitCode::from(1),
        // Whoever reads our output has seen enough, as in `list | head`.
        Err(HarnessError::Write { source, .. }) if source.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            note(&format!("error: {}", chain(&error)));
            ExitCode::from(2)
        }
    }
}

/// A line on stderr. Nobody can be told when that fails.
fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// A line on the output.
fn say(out: &mut dyn Write, text: &str) -> Result<(), HarnessError> {
    writeln!(out, "{text}").map_err(|source| HarnessError::Write {
        path: "the output".into(),
        source,
    })
}

/// The last lines of a study: what it took, how to repeat it and where its results are.
fn closing(folder: &OutputFolder, files: &[String], out: &mut dyn Write) -> Result<(), HarnessError> {
    if let Some(peak) = peak_memory_mib() {
        say(out, &format!("Memory:  {peak:.0} MiB at most"))?;
    }
    let line: Vec<String> = std::env::args().skip(1).collect();
    say(out, &format!("Command: trade-harness {}", line.join(" ")))?;
    let path = |name: &String| folder.path().join(name).display().to_string();
    let shown: Vec<String> = files.iter().map(path).collect();
    say(out, &format!("Files:   {}", shown.join("\n         ")))
}

/// Paths of our FMUs that are needed, built and packed unless that is not wanted.
fn own_fmus(args: &BuildArgs, needed: &[&str]) -> Result<Vec<PathBuf>, HarnessError> {
    let folder = args.fmu_dir.clone().unwrap_or_else(|| default_folder(&args.workspace));
    if !args.no_build && !needed.is_empty() {
        crate::pack::pack(&args.workspace, &folder, args.quiet)?;
    }
    let existing = |name: &&str| {
        let path = fmu_path(&folder, name);
        if path.is_file() {
            Ok(path)
        } else {
            Err(HarnessError::NoFmu { path })
        }
    };
    needed.iter().map(existing).collect()
}

/// Threads to use: as many as asked for, else one for each core.
fn threads(asked: Option<std::num::NonZeroUsize>) -> usize {
    asked
        .or_else(|| std::thread::available_parallelism().ok())
        .map_or(1, usize::from)
}

/// The FMUs that a study names.
struct Cast {
    models: Models,
}

/// Filters of fmu-nav to run in a scenario: those asked for, else the scenario's own.
fn choices(args: &StudyArgs, scenario: &Scenario) -> Vec<FilterChoice> {
    if args.filters.is_empty() {
        scenario.filters.iter().filter_map(|text| text.parse().ok()).collect()
    } else {
        args.filters.iter().filter_map(|f| f.0.clone()).collect()
    }
}

impl Cast {
    fn new(args: &StudyArgs) -> Result<Self, HarnessError> {
        let of_ours = |c: &FilterChoice| !(c.preset != PAPER && args.foreign.iter().any(|f| f.label == c.name));
        let needs_nav = args.filters.is_empty() || args.filters.iter().filter_map(|f| f.0.as_ref()).any(of_ours);
        let mut needed = Vec::new();
        needed.extend(args.truth.is_none().then_some(TRUTH));
        needed.extend(needs_nav.then_some(NAV));
        let own = own_fmus(&args.build, &needed)?;
        let path_of = |name: &str| needed.iter().position(|n| *n == name).map(|i| own[i].as_path());
        let truth = args
            .truth
            .as_deref()
            .or_else(|| path_of(TRUTH))
            .unwrap_or(Path::new(TRUTH));
        let mut models = Models::open(truth, path_of(NAV), &args.foreign, &args.mappings)?;
        if let Some(path) = &args.tuned {
            models.tuned = TunedFile::read(path)?.sets;
        }
        Ok(Self { models })
    }

    /// What the runs of one scenario share.
    fn spec(&self, args: &StudyArgs, scenario: &'static Scenario) -> Result<Spec, HarnessError> {
        self.spec_of(&choices(args, scenario), args, scenario)
    }

    /// The same with other filters of ours.
    fn spec_of(
        &self,
        choices: &[FilterChoice],
        args: &StudyArgs,
        scenario: &'static Scenario,
    ) -> Result<Spec, HarnessError> {
        let (mut truth, mut filters) = self.models.cast(scenario, choices, &args.assignments)?;
        self.models
            .vary(&mut truth, &mut filters, &args.variations, &args.assignments)?;
        let suggested = self.models.truth.fmu.description().default_experiment.step_size;
        // A foreign truth may keep its sample period to itself; then it is taken to sample at each step.
        let sample_period = self
            .models
            .sample_period(&truth)
            .or(args.step)
            .or(suggested)
            .unwrap_or(1.0);
        Ok(Spec {
            scenario,
            truth,
            filters,
            seed: args.seed,
            step: args.step.unwrap_or(sample_period),
            sample_period,
            scheme: args.scheme.into(),
        })
    }
}
