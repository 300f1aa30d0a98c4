//! What a study must show.

use std::fmt;

use serde::{Deserialize, Serialize};
use statrs::distribution::{Beta, ContinuousCDF, Normal};

/// A bound on a column of the summary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Column of `summary.csv` or `phases.csv`.
    pub metric: String,
    /// Label of the filter it is asked of; absent: of every filter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter: Option<String>,
    /// Phase that counts; absent: the scored time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<String>,
    /// Largest value, in the unit of the column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// Smallest value, in the unit of the column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// One-sided confidence, above 0.5 and below 1, with which the bound has to hold; absent: the value alone counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// Least share of the runs, above 0 and at most 1, that must each satisfy the bound by their own value; failed and diverged
    /// runs do not. With a confidence, the lower bound of Clopper and Pearson counts. Absent: the value over all runs counts,
    /// and no run may fail or diverge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
}

impl Requirement {
    /// Checks the numbers.
    ///
    /// # Errors
    /// What is wrong and what is allowed.
    pub(crate) fn check(&self) -> Result<(), String> {
        let ends = [self.at_least, self.at_most];
        if ends.iter().flatten().any(|end| !end.is_finite()) {
            return Err("has a bound that is no finite number".to_owned());
        }
        match ends {
            [None, None] => return Err("has no bound: give at_most, at_least or both".to_owned()),
            [Some(low), Some(high)] if low > high => {
                return Err(format!("leaves nothing: at least {low} and at most {high}"));
            }
            _ => (),
        }
        if let Some(share) = self.share.filter(|s| !(*s > 0.0 && *s <= 1.0)) {
            return Err(format!("share = {share}: give more than 0 and at most 1"));
        }
        match self.confidence {
            Some(c) if !(c > 0.5 && c < 1.0) => Err(format!("confidence = {c}: give more than 0.5 and less than 1")),
            _ => Ok(()),
        }
    }

    /// Whether a value is inside the bounds; what is absent is not.
    pub fn holds(&self, value: Option<f64>) -> bool {
        value.is_some_and(|v| self.at_least.is_none_or(|low| v >= low) && self.at_most.is_none_or(|high| v <= high))
    }

    /// Share of runs that satisfy the bound, as it counts: with a confidence the lower bound of Clopper and Pearson, below
    /// which the true share lies with no more than the rest of the probability.
    ///
    /// * `satisfied`: of `runs`, all of those that were asked for.
    pub fn share_of(&self, satisfied: u32, runs: u32) -> Option<f64> {
        let (k, n) = (f64::from(satisfied), f64::from(runs));
        if runs == 0 || satisfied > runs {
            return None;
        }
        match self.confidence {
            None => Some(k / n),
            Some(_) if satisfied == 0 => Some(0.0),
            Some(confidence) => {
                let beta = Beta::new(k, n - k + 1.0).ok()?;
                Some(beta.inverse_cdf(1.0 - confidence))
            }
        }
    }

    /// How far inside its bounds a value is, in its unit; negative outside. `None` where there is nothing to judge: no value, or
    /// no standard error to be confident with.
    ///
    /// * `error`: standard error of the value; read only with a confidence.
    pub fn margin(&self, value: Option<f64>, error: Option<f64>) -> Option<f64> {
        let value = value?;
        let away = match self.confidence {
            Some(confidence) => Normal::standard().inverse_cdf(confidence) * error?,
            None => 0.0,
        };
        let above = self.at_least.map(|low| value - low);
        let below = self.at_most.map(|high| high - value);
        let least = above.into_iter().chain(below).reduce(f64::min)?;
        Some(least - away).filter(|margin| !margin.is_nan())
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.metric)?;
        if let Some(low) = self.at_least {
            write!(f, " at least {low}")?;
        }
        if let Some(high) = self.at_most {
            write!(f, " at most {high}")?;
        }
        if let Some(share) = self.share {
            write!(f, " in {} % of runs", 100.0 * share)?;
        }
        if let Some(phase) = &self.phase {
            write!(f, " in {phase}")?;
        }
        if let Some(confidence) = self.confidence {
            write!(f, " with {} % confidence", 100.0 * confidence)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requirement(text: &str) -> Requirement {
        toml::from_str(&format!("metric = \"nees\"\n{text}")).unwrap()
    }

    /// 1.645 and 2.326: the one-sided 95 % and 99 % points of a Gaussian, from a printed table.
    #[test]
    fn margins() {
        let close = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-3, "{found:?}");
        close(requirement("at_most = 2.0").margin(Some(1.5), None), 0.5);
        close(requirement("at_least = 2.0").margin(Some(1.5), None), -0.5);
        close(
            requirement("at_least = 0.5\nat_most = 2.0").margin(Some(0.6), Some(9.0)),
            0.1,
        );
        close(
            requirement("at_most = 2.0\nconfidence = 0.95").margin(Some(1.5), Some(0.1)),
            0.5 - 0.1645,
        );
        close(
            requirement("at_least = 1.0\nconfidence = 0.99").margin(Some(1.5), Some(0.1)),
            0.5 - 0.2326,
        );
        assert_eq!(
            requirement("at_most = 2.0\nconfidence = 0.95").margin(Some(1.5), None),
            None
        );
        assert_eq!(requirement("at_most = 2.0").margin(None, None), None);
    }

    /// Of all n runs the lower bound is alpha^(1/n): 59 of 59 show 95 % with 95 % confidence (0.05^(1/59) = 0.9505), 58 do not.
    /// Of 8 in 10, the printed 95 % one-sided bound of Clopper and Pearson is 0.493.
    #[test]
    fn shares_of_runs() {
        let plain = requirement("at_most = 2.0\nshare = 0.9");
        assert_eq!((plain.share_of(9, 10), plain.share_of(0, 0)), (Some(0.9), None));
        assert!(plain.holds(Some(2.0)) && !plain.holds(Some(2.1)) && !plain.holds(None));
        let sure = requirement("at_most = 2.0\nshare = 0.95\nconfidence = 0.95");
        assert!((sure.share_of(59, 59).unwrap() - 0.05_f64.powf(1.0 / 59.0)).abs() < 1e-9);
        assert!(sure.share_of(58, 58).unwrap() < 0.95 && sure.share_of(59, 59).unwrap() > 0.95);
        assert!((sure.share_of(8, 10).unwrap() - 0.493).abs() < 5e-4);
        assert_eq!(sure.share_of(0, 10), Some(0.0));
    }

    #[test]
    fn what_no_study_can_meet_is_refused() {
        for (text, says) in [
            ("", "no bound"),
            ("at_most = nan", "finite"),
            ("at_least = 2.0\nat_most = 1.0", "nothing"),
            ("at_most = 1.0\nconfidence = 0.5", "more than 0.5"),
            ("at_most = 1.0\nshare = 1.5", "at most 1"),
        ] {
            let error = requirement(text).check().unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
        assert_eq!(requirement("at_most = 1.0\nconfidence = 0.9").check(), Ok(()));
    }
}
