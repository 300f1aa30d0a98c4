//! Which filter has the least position error, and how surely.

use stats::{PairedDifference, paired_difference};

use crate::ReportError;
use crate::number::with_error;

/// What a filter achieved.
#[derive(Debug, Clone)]
pub struct RunValues {
    /// Name.
    pub filter: String,
    /// RMSE of position over runs and time, m; `None` when no run has a result.
    pub rmse: Option<f64>,
    /// Its standard error over the runs, m.
    pub standard_error: Option<f64>,
    /// RMSE of position of each run, m; `None` where it failed. Runs stand in the same order for all filters.
    pub runs: Vec<Option<f64>>,
    /// Runs that ended with an error.
    pub failed: u64,
    /// Runs that lost the target.
    pub diverged: u64,
}

/// A filter held beside the best one, in the runs both have a result of.
#[derive(Debug, Clone)]
pub struct Rival {
    /// Name.
    pub filter: String,
    /// Its RMSE minus that of the best, mean over the runs, m.
    pub difference: PairedDifference,
}

impl Rival {
    /// Whether it is worse than the best by more than two standard errors.
    pub fn is_worse(&self) -> bool {
        let d = &self.difference;
        d.standard_error.is_some_and(|error| d.mean > 2.0 * error)
    }
}

/// The best filter and the others beside it, least pooled RMSE first.
#[derive(Debug, Clone)]
pub struct Verdict {
    best: RunValues,
    /// The others.
    pub rivals: Vec<Rival>,
}

impl Verdict {
    /// `None` when no filter has a result.
    ///
    /// # Errors
    /// [`ReportError::Statistic`].
    pub fn new(filters: &[RunValues]) -> Result<Option<Self>, ReportError> {
        let mut order: Vec<&RunValues> = filters.iter().filter(|f| f.rmse.is_some()).collect();
        order.sort_by(|a, b| f64::total_cmp(&a.rmse.unwrap_or(f64::MAX), &b.rmse.unwrap_or(f64::MAX)));
        let Some((best, others)) = order.split_first() else {
            return Ok(None);
        };
        let mut rivals = Vec::new();
        for other in others {
            let both = |(a, b): (&Option<f64>, &Option<f64>)| Option::zip(*a, *b);
            let (theirs, ours): (Vec<f64>, Vec<f64>) = other.runs.iter().zip(&best.runs).filter_map(both).unzip();
            if let Some(difference) = paired_difference(&theirs, &ours)? {
                rivals.push(Rival {
                    filter: other.filter.clone(),
                    difference,
                });
            }
        }
        Ok(Some(Self {
            best: (*best).clone(),
            rivals,
        }))
    }

    /// The first sentence: the best filter and its error.
    pub fn headline(&self) -> String {
        let rmse = with_error(self.best.rmse.unwrap_or(f64::NAN), self.best.standard_error);
        format!("{} has the least position RMSE, {rmse}\u{a0}m", self.best.filter)
    }

    /// What follows it: the next filter, and which ones cannot be told from the best.
    pub fn sentences(&self) -> Vec<String> {
        let mut text = Vec::new();
        match self.rivals.first() {
            None => text.push("There is no other filter with a result to hold beside it.".to_owned()),
            Some(next) => text.push(beside(next)),
        }
        let tied: Vec<&str> = self
            .rivals
            .iter()
            .skip(1)
            .filter(|r| !r.is_worse())
            .map(|r| r.filter.as_str())
            .collect();
        if !tied.is_empty() {
            text.push(format!(
                "Not told apart from it at two standard errors either: {}.",
                tied.join(", ")
            ));
        }
        if self.best.failed > 0 {
            text.push(format!(
                "{} of its {} runs failed and are in no RMSE.",
                self.best.failed,
                self.best.runs.len()
            ));
        }
        if self.best.diverged > 0 {
            text.push(format!(
                "It lost the target in {} of {} runs.",
                self.best.diverged,
                self.best.runs.len()
            ));
        }
        text
    }
}

fn beside(next: &Rival) -> String {
    let d = &next.difference;
    let Some(error) = d.standard_error else {
        return format!(
            "The next, {}, differs by {}\u{a0}m in the one run they share; one run gives no uncertainty, so they cannot be told apart.",
            next.filter,
            with_error(d.mean, None)
        );
    };
    let measured = format!(
        "{}\u{a0}m (mean ± standard error, paired over {} runs)",
        with_error(d.mean, Some(error)),
        d.runs
    );
    if next.is_worse() {
        format!("The next, {}, is worse by {measured}.", next.filter)
    } else {
        format!(
            "It cannot be told apart from the next, {}, at two standard errors: the difference is {measured}.",
            next.filter
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter(name: &str, rmse: f64, runs: &[f64]) -> RunValues {
        RunValues {
            filter: name.to_owned(),
            rmse: Some(rmse),
            standard_error: None,
            runs: runs.iter().map(|r| r.is_finite().then_some(*r)).collect(),
            failed: runs.iter().filter(|r| !r.is_finite()).count() as u64,
            diverged: 0,
        }
    }

    /// Differences 1, 2, 3 have mean 2 and standard error 0.577; 0, 0, 3 have mean 1 and standard error 1.
    #[test]
    fn two_standard_errors_tell_filters_apart() {
        let best = filter("a", 1.0, &[1.0, 1.0, 1.0]);
        let clear = filter("b", 3.0, &[2.0, 3.0, 4.0]);
        let near = filter("c", 2.0, &[1.0, 1.0, 4.0]);
        let verdict = Verdict::new(&[clear.clone(), best.clone()]).unwrap().unwrap();
        assert_eq!(verdict.headline(), "a has the least position RMSE, 1.00\u{a0}m");
        assert_eq!(
            verdict.sentences(),
            ["The next, b, is worse by 2.00\u{a0}±\u{a0}0.58\u{a0}m (mean ± standard error, paired over 3 runs)."]
        );
        let verdict = Verdict::new(&[clear, near, best]).unwrap().unwrap();
        assert_eq!(
            verdict.rivals.iter().map(Rival::is_worse).collect::<Vec<_>>(),
            [false, true]
        );
        assert!(verdict.sentences()[0].contains("cannot be told apart from the next, c"));
    }

    #[test]
    fn failed_runs_of_the_best_are_told_and_pairs_leave_them_out() {
        let best = filter("a", 1.0, &[1.0, f64::NAN, 1.0]);
        let verdict = Verdict::new(&[best, filter("b", 3.0, &[2.0, 9.0, 4.0])])
            .unwrap()
            .unwrap();
        assert_eq!(verdict.rivals[0].difference.runs, 2);
        assert_eq!(verdict.sentences()[1], "1 of its 3 runs failed and are in no RMSE.");
    }

    #[test]
    fn a_single_run_and_no_result_say_so() {
        let one = Verdict::new(&[filter("a", 1.0, &[1.0]), filter("b", 2.0, &[2.0])])
            .unwrap()
            .unwrap();
        assert!(!one.rivals[0].is_worse() && one.sentences()[0].contains("one run gives no uncertainty"));
        let none = RunValues {
            rmse: None,
            ..filter("a", 1.0, &[])
        };
        assert!(Verdict::new(&[none]).unwrap().is_none());
    }
}
