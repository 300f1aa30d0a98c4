//! The files of finished studies.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use study::{Calibration, Models, PhaseSummary, Plan, Requirement, Study, StudyResult, Summary, Workers, calibrate};

use crate::HarnessError;
use crate::digest::of_file;
use crate::output::OutputFolder;
use crate::report::manifest::{Manifest, StudyFacts};
use crate::report::measured::measured;
use crate::report::runs::Named;
use crate::report::timing::TimingRow;
use crate::report::{epochs, kept, phases, runs, summary, timing};
use crate::requirements::{self, Verdict, evaluate};

/// All results of the command, ready to be written.
pub(super) struct Report<'a> {
    pub(super) studies: &'a [Study],
    pub(super) results: &'a [StudyResult],
    pub(super) rows: Vec<Summary>,
    pub(super) timings: Vec<TimingRow>,
    /// By study and filter, phase by phase.
    pub(super) phases: Vec<PhaseSummary>,
    /// Of the statistics themselves.
    pub(super) calibration: Calibration,
    /// Of what the plan requires.
    pub(super) verdicts: Vec<Verdict>,
}

impl<'a> Report<'a> {
    /// * `workers`: of each study, where its FMUs are not called in this process.
    /// * `required`: of every case.
    ///
    /// # Errors
    /// What a requirement names and no study has.
    pub(super) fn new(
        required: &[Requirement],
        studies: &'a [Study],
        results: &'a [StudyResult],
        workers: &[Workers],
    ) -> Result<Self, HarnessError> {
        let mut phases = Vec::new();
        let mut rows = Vec::new();
        let mut timings = Vec::new();
        for (index, (study, result)) in studies.iter().zip(results).enumerate() {
            let (summary, cost) = measured(study, result, workers.get(index))?;
            rows.extend(summary);
            timings.extend(cost);
            let of = |filter| PhaseSummary::of(&study.spec.world.name, &study.case, filter);
            phases.extend(result.filters.iter().flat_map(of));
        }
        let verdicts = evaluate(required, studies, results, &rows, &phases)?;
        Ok(Self {
            studies,
            results,
            rows,
            timings,
            phases,
            calibration: calibrate()?,
            verdicts,
        })
    }

    /// Writes every file and what else the command has; `manifest.json` last, so that it stands for a complete set.
    ///
    /// * `plan`: what the studies are part of.
    /// * `study`: of a folder that holds one alone, for the manifest.
    /// * `written`: studies, from the first, whose `epochs` files are in the folder already.
    /// * returns: names of all files.
    pub(super) fn write(
        &self,
        folder: &OutputFolder,
        models: &Models,
        plan: &Plan,
        written: usize,
        more: Vec<(String, Vec<u8>)>,
        study: Option<Told<'_>>,
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
            ("phases.csv".to_owned(), phases::render(&self.phases)?),
            ("paired.csv".to_owned(), runs::render_paired(&named)?),
            ("runs.csv".to_owned(), runs::render_runs(&named)?),
            ("failures.csv".to_owned(), runs::render_failures(&named)?),
            ("timing.csv".to_owned(), timing::render(&self.timings)?),
        ])?;
        if !self.verdicts.is_empty() {
            let required = requirements::render_csv(&self.verdicts)?;
            files.extend(folder.write_all(vec![(requirements::FILE.to_owned(), required)])?);
        }
        let mut to_write = Vec::new();
        for (index, study) in named.iter().enumerate() {
            let world = &study.spec.world.name;
            let path = format!("paths/{world}_{}.csv", study.case);
            if index >= written {
                let contents = kept::render_path(study.spec, &self.results[index].path)?;
                folder.write(&path, &contents)?;
            }
            files.push(path);
            for filter in study.filters {
                let name = format!("{world}_{}_{}.csv", filter.label, study.case);
                if index >= written {
                    to_write.push((name.clone(), study.spec, filter));
                }
                files.extend(["epochs", "run_errors"].map(|kind| format!("{kind}/{name}")));
            }
        }
        // Written as they are rendered: together they take more room than the results they show.
        in_parallel(&to_write, plan.threads(), |(name, spec, filter)| {
            folder.write(&format!("epochs/{name}"), &epochs::render(spec, filter)?)?;
            let errors = kept::render_run_errors(spec, filter)?;
            folder.write(&format!("run_errors/{name}"), &errors).map(drop)
        })?;
        files.extend(folder.write_all(more)?);
        let wall = self.results.iter().map(|r| r.wall).sum();
        let studies = self
            .studies
            .iter()
            .zip(self.results)
            .map(|(s, r)| StudyFacts::new(plan, s, &r.filters))
            .collect();
        let mut manifest = Manifest::new(models, studies, plan.threads(), wall)?;
        manifest.calibration = Some(self.calibration.clone());
        if let Some(told) = study {
            manifest.identity = Some(told.identity.to_owned());
            manifest.study = Some(told.plan.clone());
            manifest.inputs = inputs(told.plan, self.studies)?;
        }
        manifest.write(folder, &mut files)?;
        Ok(files)
    }
}

/// A study that a folder holds alone.
#[derive(Clone, Copy)]
pub(super) struct Told<'a> {
    pub(super) identity: &'a str,
    /// Whole, as `study.toml` has it.
    pub(super) plan: &'a Plan,
}

/// SHA-256 of the files that a study reads beside FMUs.
fn inputs(plan: &Plan, studies: &[Study]) -> Result<BTreeMap<String, String>, HarnessError> {
    let read = |study: &Study| study.spec.world.mission.files().into_iter().map(|(_, path)| path);
    let digest = |path: PathBuf| Ok((path.display().to_string(), of_file(&path)?));
    // Tuned sets and mappings stand in the plan itself.
    plan.missions
        .iter()
        .cloned()
        .chain(studies.iter().flat_map(read))
        .map(digest)
        .collect()
}

/// Does something with every item, on some threads.
fn in_parallel<T: Sync>(
    items: &[T],
    threads: usize,
    work: impl Fn(&T) -> Result<(), HarnessError> + Sync,
) -> Result<(), HarnessError> {
    let next = AtomicUsize::new(0);
    let worker = || -> Result<(), HarnessError> {
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            work(item)?;
        }
        Ok(())
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (1..threads.min(items.len())).map(|_| scope.spawn(worker)).collect();
        let own = worker();
        let theirs = workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic)));
        theirs.fold(own, Result::and)
    })
}
