//! The files of finished studies.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use study::{Models, Plan, Study, StudyResult, Summary, Workers};

use crate::HarnessError;
use crate::output::OutputFolder;
use crate::report::manifest::{Manifest, StudyFacts};
use crate::report::measured::measured;
use crate::report::runs::Named;
use crate::report::timing::TimingRow;
use crate::report::{epochs, runs, summary, timing};

/// All results of the command, ready to be written.
pub(super) struct Report<'a> {
    pub(super) studies: &'a [Study],
    pub(super) results: &'a [StudyResult],
    pub(super) rows: Vec<Summary>,
    pub(super) timings: Vec<TimingRow>,
}

impl<'a> Report<'a> {
    /// * `workers`: of each study, where its FMUs are not called in this process.
    pub(super) fn new(studies: &'a [Study], results: &'a [StudyResult], workers: &[Workers]) -> Self {
        let mut rows = Vec::new();
        let mut timings = Vec::new();
        for (index, (study, result)) in studies.iter().zip(results).enumerate() {
            let (summary, cost) = measured(study, result, workers.get(index));
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
    /// * `plan`: what the studies are part of.
    /// * `identity`: for the manifest.
    /// * `written`: studies, from the first, whose `epochs` files are in the folder already.
    /// * returns: names of all files.
    pub(super) fn write(
        &self,
        folder: &OutputFolder,
        models: &Models,
        plan: &Plan,
        written: usize,
        more: Vec<(String, Vec<u8>)>,
        identity: Option<&str>,
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
        let mut to_write = Vec::new();
        for (index, study) in named.iter().enumerate() {
            for filter in study.filters {
                let name = format!("epochs/{}_{}_{}.csv", study.spec.world.name, filter.label, study.case);
                if index >= written {
                    to_write.push((name.clone(), study.spec, filter));
                }
                files.push(name);
            }
        }
        // Written as they are rendered: together they take more room than the results they show.
        in_parallel(&to_write, plan.threads(), |(name, spec, filter)| {
            folder.write(name, &epochs::render(spec, filter)?).map(drop)
        })?;
        files.extend(folder.write_all(more)?);
        let wall = self.results.iter().map(|r| r.wall).sum();
        let studies = self.studies.iter().map(|s| StudyFacts::new(plan, s)).collect();
        let mut manifest = Manifest::new(models, studies, plan.threads(), wall)?;
        manifest.identity = identity.map(str::to_owned);
        manifest.write(folder, &mut files)?;
        Ok(files)
    }
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
