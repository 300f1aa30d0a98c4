//! What an earlier case of a study has flown already: filters that are the same in both, in the same worlds.

use std::path::Path;
use std::sync::Arc;

use cosim::Value;

use crate::error::StudyError;
use crate::journal::Journal;
use crate::outcome::{Outcome, Part};
use crate::participant::Participant;
use crate::spec::Spec;

/// Where the filters of one case stand in the journals of earlier ones.
///
/// Nothing that a filter says reaches the world or another filter, so a filter that two cases have in common does the same
/// in both, to the last bit, and is run once.
#[derive(Debug)]
pub struct Flown<'a> {
    cases: Vec<Case<'a>>,
}

/// One earlier case.
#[derive(Debug)]
struct Case<'a> {
    journal: &'a Journal,
    /// How many filters and epochs its runs have.
    filters: usize,
    epochs: usize,
    /// Place of a filter in that case, and in this one.
    places: Vec<(usize, usize)>,
}

impl<'a> Flown<'a> {
    /// Finds what a case shares with earlier ones.
    ///
    /// * `earlier`: cases whose runs are over, with what keeps them.
    pub fn of(spec: &Spec, earlier: impl IntoIterator<Item = (&'a Spec, &'a Journal)>) -> Self {
        let mut found = vec![false; spec.filters.len()];
        let mut cases = Vec::new();
        for (other, journal) in earlier {
            if !same_worlds(spec, other) {
                continue;
            }
            let mut places = Vec::new();
            for (here, filter) in spec.filters.iter().enumerate().filter(|(here, _)| !found[*here]) {
                let there = other.filters.iter().position(|known| same(filter, known));
                places.extend(there.map(|there| (there, here)));
            }
            for (_, here) in &places {
                found[*here] = true;
            }
            if !places.is_empty() {
                cases.push(Case {
                    journal,
                    filters: other.filters.len(),
                    epochs: other.epochs(),
                    places,
                });
            }
        }
        Self { cases }
    }

    /// Puts into a run what its filters have done in earlier cases.
    ///
    /// * `parts`: by filter of this case; what is found is filled in.
    ///
    /// # Errors
    /// [`StudyError::Journal`], [`StudyError::DamagedJournal`].
    pub(crate) fn fill(&self, whole: &mut Outcome, parts: &mut [Option<Part>]) -> Result<(), StudyError> {
        for case in &self.cases {
            let Some(mut outcome) = case.journal.read(whole.run)? else {
                continue;
            };
            let fits = outcome.fits(whole.run, case.filters, case.epochs);
            fits.map_err(|problem| case.journal.damaged(problem))?;
            let mut known: Vec<_> = std::mem::take(&mut outcome.parts).into_iter().map(Some).collect();
            whole.join(outcome);
            for (there, here) in &case.places {
                parts[*here] = known.get_mut(*there).and_then(Option::take);
            }
        }
        Ok(())
    }
}

/// Whether run j of one study flies in the same world as run j of another, and its records are taken alike.
fn same_worlds(a: &Spec, b: &Spec) -> bool {
    let bits = |spec: &Spec| {
        [
            spec.step,
            spec.sample_period,
            spec.world.duration_s,
            spec.world.scored_from_s,
        ]
        .map(f64::to_bits)
    };
    let drivers = || a.drivers.iter().zip(&b.drivers).all(|(a, b)| same(a, b));
    // A driver that reads a filter gives each filter a world of its own.
    !(a.closed_loop || b.closed_loop)
        && a.drivers.len() == b.drivers.len()
        && bits(a) == bits(b)
        && (a.seed, a.scheme, a.allow_truth) == (b.seed, b.scheme, b.allow_truth)
        && a.world.mission == b.world.mission
        && a.phases == b.phases
        && same(&a.truth, &b.truth)
        && drivers()
}

/// Whether two slaves do the same in every run, given the same inputs.
fn same(a: &Participant, b: &Participant) -> bool {
    let starts = || {
        let pairs = || a.starts.iter().zip(&b.starts);
        pairs().all(|((a_name, a), (b_name, b))| a_name == b_name && same_value(a, b))
    };
    Arc::ptr_eq(&a.source, &b.source)
        && a.label == b.label
        && a.aliases == b.aliases
        && a.varied == b.varied
        && a.starts.len() == b.starts.len()
        && starts()
}

/// Equal values, or two files of the study's own that say the same: a mission that is changed has a file for each case.
fn same_value(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Real(a), Value::Real(b)) => a.to_bits() == b.to_bits(),
        (Value::String(a), Value::String(b)) if a != b => {
            let [a, b] = [a, b].map(Path::new);
            let read = |path: &Path| std::fs::read(path).ok();
            a.is_absolute() && a.parent() == b.parent() && read(a).is_some_and(|text| Some(text) == read(b))
        }
        (a, b) => a == b,
    }
}
