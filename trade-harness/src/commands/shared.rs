//! What several commands need.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use study::{
    Assignment, ForeignFilter, Models, NAV, OwnFmus, Plan, Study, TRUTH, Variation, read_mappings, stop, stop_asked,
};

use super::out::Out;
use crate::HarnessError;
use crate::cli::{BuildArgs, StudyArgs, WorkArgs, WorldArgs};
use crate::format::TERMINAL;
use crate::output::OutputFolder;
use crate::pack::{default_folder, fmu_path};
use crate::report::manifest::peak_memory_mib;
use crate::requirements::{check, missed_in};
use crate::tuning::sets::{TunedFile, add};

/// Exit code of a command that was asked to stop.
pub(super) const INTERRUPTED: u8 = 130;

/// How a command that could do its work ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Verdict {
    Done,
    BoundsMissed,
    StandardBroken,
}

/// Says that a folder holds a study, complete, and whether it misses requirements.
///
/// * `more`: what else there is to say of it.
pub(super) fn held(folder: &Path, more: &str, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let missed = missed_in(folder)?;
    let (told, verdict) = if missed == 0 {
        (String::new(), Verdict::Done)
    } else {
        let told = format!("; it misses {missed} of its requirements");
        (told, Verdict::BoundsMissed)
    };
    out.say(&format!("{} holds this study, complete{more}{told}", folder.display()))?;
    Ok(verdict)
}

/// A line on stderr. Nobody can be told when that fails.
pub(super) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// The last lines of a study: what it took, how to repeat it and where its results are.
pub(super) fn closing(folder: &OutputFolder, files: &[String], out: &mut Out<'_>) -> Result<(), HarnessError> {
    if let Some(peak) = peak_memory_mib() {
        out.say(&format!("Memory:  {peak:.0} MiB at most"))?;
    }
    let line: Vec<String> = std::env::args().skip(1).collect();
    out.say(&format!("Command: trade-harness {}", line.join(" ")))?;
    // One line for each folder: studies of many filters have a file for each.
    let (mut whole, mut inside) = (Vec::new(), BTreeMap::<&str, usize>::new());
    for name in files {
        match name.split_once('/') {
            Some((folder, _)) => *inside.entry(folder).or_default() += 1,
            None => whole.push(name.clone()),
        }
    }
    whole.extend(inside.iter().map(|(folder, count)| format!("{folder}/ ({count})")));
    out.say(&format!("Results: {}", folder.path().display()))?;
    out.say(&textwrap::fill(
        &whole.join(", "),
        textwrap::Options::new(TERMINAL)
            .initial_indent("         ")
            .subsequent_indent("         "),
    ))?;
    out.tell("folder", folder.path())?;
    out.tell("files", files)
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

/// The studies of a plan: each case of its grids in each of its worlds.
///
/// * `folder`: where the files of missions go that the plan changes.
pub(super) fn cast(plan: &Plan, models: &Models, folder: &Path) -> Result<Vec<Study>, HarnessError> {
    let mut studies = Vec::new();
    for case in plan.cases()? {
        let worlds = case.worlds(folder)?;
        models.check_effects(&case, &worlds)?;
        for world in &worlds {
            studies.push(models.study(&case, world)?);
        }
    }
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

/// What a command line changes of a plan; worlds, runs and case are the command's own.
///
/// Single values and lists of filters go before those of the plan; what is set, varied, mapped or added joins them, and
/// replaces what the plan says of the same variable.
///
/// # Errors
/// A file of tuned sets or of mappings that is none.
pub(super) fn changed(plan: Plan, study: &StudyArgs) -> Result<Plan, HarnessError> {
    let chosen = study.filters.iter().filter_map(|f| f.0.clone());
    let filters = (!study.filters.is_empty()).then(|| chosen.collect());
    let mut tuned = plan.tuned;
    for path in plan.tuned_files.iter().chain(&study.tuned) {
        add(&mut tuned, &TunedFile::read(path)?.sets);
    }
    let mut mappings = plan.mappings;
    for path in plan.map_files.iter().chain(&study.map_files) {
        mappings.extend(read_mappings(path)?);
    }
    mappings.extend(study.mappings.iter().cloned());
    let set = |model: &str, variable: &str| {
        let same = |a: &Assignment| a.model == model && a.variable == variable;
        study.assignments.iter().any(same)
    };
    let varied = |model: &str, variable: &str| {
        let same = |v: &Variation| v.model == model && v.variable == variable;
        study.variations.iter().any(same)
    };
    let taken = |model: &str, variable: &str| set(model, variable) || varied(model, variable);
    let kept = plan.assignments.into_iter().filter(|a| !taken(&a.model, &a.variable));
    let spread = plan.variations.into_iter().filter(|v| !taken(&v.model, &v.variable));
    let added = |own: Vec<ForeignFilter>, asked: &[ForeignFilter]| {
        let kept = own.into_iter().filter(|f| asked.iter().all(|g| g.label != f.label));
        kept.chain(asked.iter().cloned()).collect()
    };
    Ok(Plan {
        filters: filters.or(plan.filters),
        seed: study.seed.unwrap_or(plan.seed),
        step_s: study.step.or(plan.step_s),
        scheme: study.scheme.map_or(plan.scheme, Into::into),
        assignments: kept.chain(study.assignments.iter().cloned()).collect(),
        variations: spread.chain(study.variations.iter().cloned()).collect(),
        truth: study.truth.clone().or(plan.truth),
        foreign: added(plan.foreign, &study.foreign),
        drive: added(plan.drive, &study.drivers),
        allow_truth: plan.allow_truth || study.allow_truth,
        mappings,
        map_files: Vec::new(),
        tuned_files: Vec::new(),
        tuned,
        ..plan
    })
}

/// The same with worlds and work.
///
/// # Errors
/// As for [`changed`].
pub(super) fn plan_of(
    plan: Plan,
    study: &StudyArgs,
    worlds: &WorldArgs,
    work: &WorkArgs,
) -> Result<Plan, HarnessError> {
    let given = !worlds.scenarios.is_empty() || !worlds.missions.is_empty();
    let (scenarios, missions) = if given {
        (worlds.scenarios.clone(), worlds.missions.clone())
    } else {
        (plan.scenarios.clone(), plan.missions.clone())
    };
    let plan = Plan {
        scenarios,
        missions,
        runs: work.runs.unwrap_or(plan.runs),
        jobs: work.jobs.or(plan.jobs),
        ..plan
    };
    changed(plan, study)
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
