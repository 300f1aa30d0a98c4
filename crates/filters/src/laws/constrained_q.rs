//! A process noise that clarabel finds, within bounds: by the likelihoods of a bank ([`likelihood`]), or by the correlations of the
//! innovations ([`regression`]).

mod conic;
mod diagonal;
mod full;
mod likelihood;
mod programme;
mod regression;

use super::adaptation::{Setup, one_of_laws};
use super::bank::CONSTANTS;
use super::entry::{FilterEntry, Motion, Search, Update};
use super::window::{M_B, RESIDUALS, WHITEN, regression_variance};
use crate::error::FilterError;
use crate::tunable::{Bound, Kind, Preset, Start, Tunable};
use likelihood::{ByLikelihood, LONG_MEMORY, Q_MAX, Q_MIN, SHORT_MEMORY};
use regression::{ByRegression, ROOT_DENSITY};
use serde::{Deserialize, Serialize};

/// What makes it the law that it was before it kept a bank.
const REGRESSION: (&str, &str) = ("law", "regression");

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "constrained_q",
    about: "a bank of snc filters half a decade of q apart, weighed by a conic programme with bounds on q; or its density by regression",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[
        Tunable {
            name: "law",
            about: "how the density is found: by likelihood, to which q_min to short_memory belong, or by regression, to which all that follow do",
            kind: Kind::Choice {
                type_name: "QLaw",
                about: "how constrained_q finds its density",
                items: &[
                    (
                        "likelihood",
                        "weights of a bank of filters, by an exponential-cone programme",
                    ),
                    (
                        "regression",
                        "MILTON's regression of residuals, by a quadratic or semidefinite programme",
                    ),
                ],
            },
        },
        Q_MIN,
        Q_MAX,
        LONG_MEMORY,
        SHORT_MEMORY,
        M_B,
        RESIDUALS,
        WHITEN,
        Tunable {
            name: "shape",
            about: "jerk density: one number per axis (diagonal) or a symmetric matrix (full)",
            kind: Kind::Choice {
                type_name: "QShape",
                about: "form of the jerk density",
                items: &[
                    ("diagonal", "one number for each axis"),
                    ("full", "a symmetric, positive semidefinite matrix"),
                ],
            },
        },
        Tunable {
            name: "r_w",
            about: "weight of the regression: variance of one entry of the autocorrelation, in the units the law adapts in",
            kind: Kind::Real {
                start: Start::Derived(regression_variance),
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "memory",
            about: "updates after which old evidence has faded to 1/e",
            kind: Kind::Real {
                start: Start::Fixed(10.0),
                unit: "1",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s_min",
            about: "lower bound of s, in every direction",
            kind: Kind::Real {
                start: Start::Fixed(1e-7),
                unit: ROOT_DENSITY,
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "s_max",
            about: "upper bound of s, in every direction",
            kind: Kind::Real {
                start: Start::Fixed(1.0),
                unit: ROOT_DENSITY,
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s_prior",
            about: "s before any evidence, all axes: the square is the prior's mean of q",
            kind: Kind::Real {
                start: Start::Fixed(1e-6),
                unit: ROOT_DENSITY,
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "s_spread",
            about: "the square is the prior's standard deviation of q",
            kind: Kind::Real {
                start: Start::Fixed(1e-2),
                unit: ROOT_DENSITY,
                bound: Bound::Positive,
            },
        },
    ],
    presets: &[
        CONSTANTS,
        Preset {
            name: "regression",
            about: "the paper's regression on innovations, and its buffer",
            other_reading: true,
            sets: &[REGRESSION],
        },
        Preset {
            name: "consistent",
            about: "as regression, with open-loop residuals, rows divided by their standard deviations",
            other_reading: false,
            sets: &[REGRESSION, ("residuals", "consistent"), ("whiten", "true")],
        },
        Preset {
            name: "full",
            about: "as consistent, with a full symmetric density",
            other_reading: false,
            sets: &[
                REGRESSION,
                ("residuals", "consistent"),
                ("whiten", "true"),
                ("shape", "full"),
            ],
        },
    ],
    // All are of the regression; nothing of the law by likelihood is searched.
    search: &[
        // As of MILTON, and on to where the prior decides: only the ratio of r_w to s_spread^4 matters.
        Search {
            tunable: "r_w",
            low: 1e-10,
            high: 1e8,
            only_with: Some(REGRESSION),
        },
        // An update comes every m_b + 1 samples, a run has some hundreds.
        Search {
            tunable: "memory",
            low: 1.0,
            high: 1e3,
            only_with: Some(REGRESSION),
        },
        Search {
            tunable: "s_prior",
            low: 1e-9,
            high: 1e-3,
            only_with: Some(REGRESSION),
        },
        // From just above s_min, where Q is all but fixed.
        Search {
            tunable: "s_max",
            low: 2e-7,
            high: 1e-1,
            only_with: Some(REGRESSION),
        },
    ],
};

/// The law chosen.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum ConstrainedQ {
    /// By the likelihoods of a bank.
    Likelihood(Box<ByLikelihood>),
    /// By the correlations of the innovations.
    Regression(Box<ByRegression>),
}

impl ConstrainedQ {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(match setup.tunables.choice("law")? {
            0 => Self::Likelihood(Box::new(ByLikelihood::new(setup)?)),
            _ => Self::Regression(Box::new(ByRegression::new(setup)?)),
        })
    }
}

one_of_laws!(ConstrainedQ: Likelihood, Regression);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use crate::state::RowVector;
    use crate::tunable::{Tunables, Value};
    use crate::units::Units;
    use interface::Sensor;

    /// Builds a law with tunables of these names set, the last of a name, the others at their start.
    pub(super) fn set_up<T>(rows: usize, changes: &[(&str, Value)], new: impl FnOnce(&Setup<'_>) -> T) -> T {
        let value = |t: &Tunable| {
            let change = changes.iter().rfind(|(name, _)| *name == t.name);
            change.map_or(t.kind.start(), |(_, value)| *value)
        };
        let values: Vec<Value> = ENTRY.tunables.iter().map(value).collect();
        let mission = interface::mission::embedded("leo_venting").unwrap();
        let told = mission.mission().unwrap().navigation();
        let sensor = if rows == 3 { Sensor::Lidar } else { Sensor::Metrology };
        new(&Setup {
            tunables: Tunables {
                law: ENTRY.name,
                declared: ENTRY.tunables,
                values: &values,
                told: &told,
            },
            layout: Layout::new(&[sensor]),
            r: RowVector::from_fn(|row, _| if row < rows { 0.09 } else { 0.0 }),
            state_measured: false,
            units: Units::SI,
            off_nominal: 1.0,
            study_seed: 1,
            run: 0,
        })
    }

    #[test]
    fn each_law_is_had_by_its_name() {
        let law = |choice| set_up(3, &[("law", Value::Choice(choice))], ConstrainedQ::new).unwrap();
        assert!(matches!(law(0), ConstrainedQ::Likelihood(_)));
        assert!(matches!(law(1), ConstrainedQ::Regression(_)));
    }
}
