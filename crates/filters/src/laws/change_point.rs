//! A quiet filter and the question whether the velocity has changed: the answer is left open until the data give it.

use super::adaptation::Setup;
use super::bank::velocity_change::{Parameters, VelocityChanges};
use super::bank::{Bank, CONSTANTS, Centre, Mixture, Shared};
use super::entry::{FilterEntry, Motion, Search, Update};
use crate::error::FilterError;
use crate::tunable::{Bound, Kind, Start, Tunable};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "change_point",
    about: "quiet filter with hypotheses of velocity changes at past times, weighed by the data",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: true,
    bound: false,
    tunables: &[QUIET, RATE, WINDOW, DECIDED, DIRECTIONS, SCHEDULE],
    presets: &[CONSTANTS],
    search: &[
        Search {
            tunable: QUIET.name,
            low: 1e-7,
            high: 1e-3,
            only_with: None,
        },
        Search {
            tunable: RATE.name,
            low: 1e-2,
            high: 1e2,
            only_with: None,
        },
    ],
};

/// Tunable `quiet`.
pub(super) const QUIET: Tunable = Tunable {
    name: "quiet",
    about: "square root of the acceleration density of the filter that knows of no change",
    kind: Kind::Real {
        start: Start::Fixed(5e-6),
        unit: "m/s^1.5",
        bound: Bound::Positive,
    },
};

/// Tunable `rate`.
pub(super) const RATE: Tunable = Tunable {
    name: "rate",
    about: "factor on the rates at which changes of velocity are expected before any has been seen",
    kind: Kind::Real {
        start: Start::Fixed(1.0),
        unit: "",
        bound: Bound::Positive,
    },
};

/// Tunable `window`.
pub(super) const WINDOW: Tunable = Tunable {
    name: "window",
    about: "time for which the question whether the velocity has changed is left open",
    kind: Kind::Real {
        start: Start::Fixed(320.0),
        unit: "s",
        bound: Bound::Positive,
    },
};

/// Longest window, s: memory and the cost of a step grow with it.
const LONGEST_WINDOW: f64 = 3600.0;

/// Tunable `decided`.
pub(super) const DECIDED: Tunable = Tunable {
    name: "decided",
    about: "probability of no change below which a change is taken for certain",
    kind: Kind::Real {
        start: Start::Fixed(0.02),
        unit: "",
        bound: Bound::Fraction,
    },
};

/// Tunable `directions`.
pub(super) const DIRECTIONS: Tunable = Tunable {
    name: "directions",
    about: "whether it learns where changes point, in axes of the line of sight and of the estimate",
    kind: Kind::Boolean { start: true },
};

/// Tunable `schedule`.
pub(super) const SCHEDULE: Tunable = Tunable {
    name: "schedule",
    about: "whether it learns when changes come",
    kind: Kind::Boolean { start: false },
};

/// The quiet filter and its hypotheses as the tunables say.
///
/// # Errors
/// When a tunable is out of range.
pub(super) fn velocity_changes(setup: &Setup<'_>) -> Result<VelocityChanges, FilterError> {
    let t = &setup.tunables;
    let window = t.real(WINDOW.name)?;
    if window > LONGEST_WINDOW {
        let permitted = format!("at most {LONGEST_WINDOW} s: a hypothesis stands for every 40 s of it");
        return Err(t.refused(WINDOW.name, window, permitted));
    }
    let decided = t.real(DECIDED.name)?;
    if decided <= 0.0 || decided >= 1.0 {
        let permitted = "above 0 and below 1: at 0 nothing is ever decided, at 1 everything at once";
        return Err(t.refused(DECIDED.name, decided, permitted.into()));
    }
    let parameters = Parameters {
        quiet: t.real(QUIET.name)? * setup.off_nominal.sqrt(),
        rate: t.real(RATE.name)?,
        window,
        decided,
        directions: t.boolean(DIRECTIONS.name)?,
        schedule: t.boolean(SCHEDULE.name)?,
    };
    Ok(VelocityChanges::new(&parameters, &setup.units))
}

/// Hypotheses of velocity changes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ChangePoint {
    centre: Centre,
    changes: VelocityChanges,
}

impl ChangePoint {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let changes = velocity_changes(setup)?;
        Ok(Self {
            centre: Centre::new(setup.r, changes.density()),
            changes,
        })
    }
}

impl Bank for ChangePoint {
    fn centre(&self) -> &Centre {
        &self.centre
    }

    fn centre_mut(&mut self) -> &mut Centre {
        &mut self.centre
    }

    fn take(&mut self, shared: &Shared) {
        self.changes.take(shared);
    }

    fn mixture(&self) -> Mixture {
        self.changes.mixture()
    }

    fn density(&self) -> f64 {
        self.changes.density()
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        self.changes.shift(by);
    }

    fn decisions(&self) -> i32 {
        self.changes.decisions()
    }
}
