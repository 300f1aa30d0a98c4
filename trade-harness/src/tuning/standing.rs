//! What makes one candidate better than another.

use std::cmp::Ordering;

use clap::ValueEnum;

use study::{Quantity, Summary, Tally};

use crate::HarnessError;

/// The error that a search makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Objective {
    /// RMSE of relative position
    Position,
    /// RMSE of relative velocity
    Velocity,
    /// RMSE of the unmodelled acceleration
    Acceleration,
}

impl Objective {
    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
        }
    }

    /// Its value in a judged study, m, m/s or m/s2.
    pub fn of(self, row: &Summary) -> Option<f64> {
        match self {
            Self::Position => row.position.rmse,
            Self::Velocity => row.velocity.rmse,
            Self::Acceleration => row.acceleration.rmse,
        }
    }

    /// What the ensembles call it.
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Position => Quantity::Position,
            Self::Velocity => Quantity::Velocity,
            Self::Acceleration => Quantity::Acceleration,
        }
    }
}

/// Range of NEES over its dimension in which a filter counts as consistent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    low: f64,
    high: f64,
}

impl Limits {
    /// # Errors
    /// [`HarnessError::NeesLimits`] unless 0 < low < high, both finite.
    pub fn new(low: f64, high: f64) -> Result<Self, HarnessError> {
        if low > 0.0 && low < high && high.is_finite() {
            Ok(Self { low, high })
        } else {
            Err(HarnessError::NeesLimits { low, high })
        }
    }

    /// How far outside, as the logarithm of a factor; 0 inside.
    pub fn violation(&self, nees: f64) -> f64 {
        let nees = nees.max(f64::MIN_POSITIVE);
        (self.low / nees).ln().max((nees / self.high).ln()).max(0.0)
    }

    /// Whether a value is inside; a filter without a covariance has none and is exempt.
    pub fn hold(&self, nees: Option<f64>) -> bool {
        nees.is_none_or(|n| self.violation(n) <= 0.0)
    }

    /// Smallest and largest value.
    pub fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }
}

/// What a candidate is ranked by, the first difference deciding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Runs that failed, diverged or had a covariance that is none.
    pub bad_runs: u32,
    /// How far the NEES is outside its limits, as the logarithm of a factor.
    pub violation: f64,
    /// RMSE; infinite where the filter estimates no such quantity or has no result.
    pub objective: f64,
}

impl Standing {
    /// Where a candidate with these results stands.
    pub fn new(tally: &Tally, objective: Objective, limits: &Limits) -> Self {
        Self {
            bad_runs: tally.bad_runs,
            violation: tally.nees6().map_or(0.0, |n| limits.violation(n)),
            objective: tally.rmse(objective.quantity()).unwrap_or(f64::INFINITY),
        }
    }

    /// No run went wrong and the NEES is within its limits.
    pub fn feasible(&self) -> bool {
        self.bad_runs == 0 && self.violation <= 0.0 && self.objective.is_finite()
    }

    /// `Less` is better: every feasible candidate before every other; among those the fewest bad runs, then the NEES
    /// nearest to its limits.
    pub fn total_cmp(&self, other: &Self) -> Ordering {
        self.bad_runs
            .cmp(&other.bad_runs)
            .then(self.violation.total_cmp(&other.violation))
            .then(self.objective.total_cmp(&other.objective))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feasible_comes_first_then_healthy_then_consistent_then_accurate() {
        let standing = |bad_runs, nees: f64, objective| Standing {
            bad_runs,
            violation: Limits::new(0.5, 2.0).unwrap().violation(nees),
            objective,
        };
        let best_first = [
            standing(0, 0.5, 3.0),
            standing(0, 2.0, 4.0),
            standing(0, 0.25 * 1.01, 0.1),
            standing(0, 4.0, 0.01),
            standing(0, 0.0, 0.01),
            standing(1, 1.0, 0.001),
            standing(2, 1.0, 0.0),
        ];
        for pair in best_first.windows(2) {
            assert_eq!(pair[0].total_cmp(&pair[1]), Ordering::Less, "{pair:?}");
        }
        let feasible: Vec<_> = best_first.iter().map(Standing::feasible).collect();
        assert_eq!(feasible, [true, true, false, false, false, false, false]);
    }

    #[test]
    fn limits_are_a_range_of_positive_numbers() {
        for (low, high) in [
            (0.0, 2.0),
            (-1.0, 2.0),
            (2.0, 2.0),
            (2.0, 1.0),
            (0.5, f64::INFINITY),
            (f64::NAN, 1.0),
        ] {
            assert!(
                matches!(Limits::new(low, high), Err(HarnessError::NeesLimits { .. })),
                "{low} {high}"
            );
        }
        let limits = Limits::new(0.5, 2.0).unwrap();
        assert!((limits.violation(8.0) - 4_f64.ln()).abs() < 1e-12);
        assert!((limits.violation(0.125) - 4_f64.ln()).abs() < 1e-12);
        assert!(limits.hold(None) && limits.hold(Some(2.0)) && !limits.hold(Some(2.1)));
    }
}
