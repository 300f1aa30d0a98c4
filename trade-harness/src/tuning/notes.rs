//! What to know of a search's result before trusting it.

use super::study::{Options, Searched};

/// Share of the objective gained late in a search that is worth a note.
const LATE_GAIN: f64 = 0.02;

/// The notes, in words; empty when there is nothing to say.
pub fn notes(searched: &Searched, options: &Options) -> Vec<String> {
    let Some(winner) = searched.best() else {
        return vec!["nothing to tune".to_owned()];
    };
    // The winner has the fewest bad runs of all.
    if winner.tally.failed == options.runs {
        let all_failed = searched.evaluations.iter().all(|e| e.tally.failed == options.runs);
        let what = if all_failed { "failed" } else { "failed or went wrong" };
        return vec![format!("every run of every candidate {what}: see search.csv")];
    }
    if winner.standing.objective.is_infinite() {
        return vec![format!("no {} to tune by", options.objective.name())];
    }
    let mut notes = Vec::new();
    if winner.values.is_none() {
        notes.push("no candidate was better than the given values".to_owned());
    }
    if !winner.standing.feasible() {
        notes.push("no candidate was without bad runs and within the NEES limits".to_owned());
    } else if winner.tally.nees6().is_none() {
        notes.push("no covariance, so the NEES limits do not apply".to_owned());
    }
    for (index, axis) in searched.contender.axes.iter().enumerate() {
        let value = winner.values.as_ref().map_or(axis.start, |v| v.get(index).copied());
        if let Some(end) = value.and_then(|v| axis.edge(v)) {
            notes.push(format!("{} is at the {end} edge of its range", axis.variable));
        }
    }
    let late = searched.late_gain();
    if late > LATE_GAIN {
        notes.push(format!(
            "the last quarter of the search still gained {:.0} %, so more evaluations may find better",
            100.0 * late
        ));
    }
    notes
}
