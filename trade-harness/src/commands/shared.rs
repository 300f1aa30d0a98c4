//! What several commands need.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use study::{Models, NAV, OwnFmus, Plan, Study, TRUTH, stop, stop_asked};

use crate::HarnessError;
use crate::cli::{BuildArgs, StudyArgs, WorkArgs, WorldArgs};
use crate::output::OutputFolder;
use crate::pack::{default_folder, fmu_path};
use crate::report::manifest::peak_memory_mib;
use crate::requirements::check;
use crate::tuning::sets::TunedFile;

/// Exit code of a command that was asked to stop.
pub(super) const INTERRUPTED: u8 = 130;

/// How a command that could do its work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Done,
    BoundsMissed,
}

/// A line on stderr. Nobody can be told when that fails.
pub(super) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// A line on the output.
pub(super) fn say(out: &mut dyn Write, text: &str) -> Result<(), HarnessError> {
    writeln!(out, "{text}").map_err(|source| HarnessError::Write {
        path: "the output".into(),
        source,
    })
}

/// The last lines of a study: what it took, how to repeat it and where its results are.
pub(super) fn closing(folder: &OutputFolder, files: &[String], out: &mut dyn Write) -> Result<(), HarnessError> {
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
pub(super) fn own_fmus(args: &BuildArgs, needed: &[&str]) -> Result<Vec<PathBuf>, HarnessError> {
    let folder = args.fmu_dir.clone().unwrap_or_else(|| default_folder(&args.workspace));
    if !args.no_build && !needed.is_empty() {
        crate::pack::pack(&args.workspace, &folder, None, args.quiet)?;
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

/// Lets studies end cleanly on Ctrl-C or TERM; a second time, at once.
///
/// # Errors
/// When the system does not allow it.
pub(super) fn end_when_asked() -> Result<(), HarnessError> {
    let handler = || {
        if stop_asked() {
            std::process::exit(INTERRUPTED.into());
        }
        stop();
    };
    match ctrlc::set_handler(handler) {
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        Err(source) => Err(HarnessError::Signals { source }),
    }
}

/// The studies of a plan.
///
/// * `folder`: where the files of missions go that the plan changes.
pub(super) fn cast(plan: &Plan, models: &Models, folder: &Path) -> Result<Vec<Study>, HarnessError> {
    let worlds = plan.worlds(folder)?;
    models.check_effects(plan, &worlds)?;
    let studies = worlds.iter().map(|world| Ok(models.study(plan, world)?));
    let studies: Vec<Study> = studies.collect::<Result<_, HarnessError>>()?;
    check(&plan.requirements, &studies)?;
    Ok(studies)
}

/// A folder for files that no one keeps.
///
/// # Errors
/// When the system has no room for one.
pub(super) fn scratch() -> Result<tempfile::TempDir, HarnessError> {
    tempfile::tempdir().map_err(|source| HarnessError::Write {
        path: std::env::temp_dir(),
        source,
    })
}

/// The plan of a command line, of which worlds, runs and case are the command's own.
///
/// # Errors
/// A file of tuned sets that is none.
pub(super) fn plan(study: &StudyArgs) -> Result<Plan, HarnessError> {
    let chosen = study.filters.iter().filter_map(|f| f.0.clone());
    let tuned = match &study.tuned {
        Some(path) => TunedFile::read(path)?.sets,
        None => Vec::new(),
    };
    Ok(Plan {
        filters: (!study.filters.is_empty()).then(|| chosen.collect()),
        seed: study.seed,
        step_s: study.step,
        scheme: study.scheme.into(),
        assignments: study.assignments.clone(),
        variations: study.variations.clone(),
        truth: study.truth.clone(),
        foreign: study.foreign.clone(),
        allow_truth: study.allow_truth,
        mappings: study.mappings.clone(),
        tuned,
        ..Plan::default()
    })
}

/// The same with worlds and work, and a case that says what differs.
///
/// # Errors
/// As for [`plan`].
pub(super) fn plan_of(study: &StudyArgs, worlds: &WorldArgs, work: &WorkArgs) -> Result<Plan, HarnessError> {
    let plan = Plan {
        scenarios: worlds.named(),
        missions: worlds.missions.clone(),
        runs: work.runs,
        jobs: work.jobs,
        ..plan(study)?
    };
    Ok(Plan {
        case: Some(plan.case_name()),
        ..plan
    })
}

/// The FMUs that a plan names; ours are built and packed first, unless that is not wanted.
///
/// # Errors
/// Building, packing and opening.
pub(super) fn models(plan: &Plan, build: &BuildArgs) -> Result<Models, HarnessError> {
    plan.check()?;
    let [truth, nav] = plan.needs();
    let needed: Vec<&str> = [(truth, TRUTH), (nav, NAV)]
        .into_iter()
        .filter_map(|(needed, name)| needed.then_some(name))
        .collect();
    let mut paths = own_fmus(build, &needed)?.into_iter();
    let own = OwnFmus {
        truth: if truth { paths.next() } else { None },
        nav: paths.next(),
    };
    Ok(Models::of(plan, &own)?)
}
