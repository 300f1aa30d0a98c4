//! Process noise given as variances of position and velocity per second, as the network filters have it.
//!
//! Their starts are those of white acceleration of density q: in a second it adds q to the variance of velocity, and in a sample
//! period T it adds q T^3 / 3 to that of position.

use super::adaptation::Setup;
use super::entry::Search;
use crate::error::FilterError;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Start, Tunable};

/// Tunable `q_position`.
pub(super) const Q_POSITION: Tunable = Tunable {
    name: "q_position",
    about: "position variance that process noise adds per second, per axis",
    kind: Kind::Real {
        start: Start::Derived(|scales| scales.root_acceleration_density().powi(2) * scales.period.powi(2) / 3.0),
        unit: "m2",
        bound: Bound::NonNegative,
    },
};

/// Tunable `q_velocity`.
pub(super) const Q_VELOCITY: Tunable = Tunable {
    name: "q_velocity",
    about: "velocity variance that process noise adds per second, per axis",
    kind: Kind::Real {
        start: Start::Derived(|scales| scales.root_acceleration_density().powi(2)),
        unit: "m2/s2",
        bound: Bound::NonNegative,
    },
};

/// How a search varies [`Q_POSITION`].
pub(super) const SEARCH_Q_POSITION: Search = Search {
    tunable: Q_POSITION.name,
    low: 1e-16,
    high: 1e-3,
    only_with: None,
};

/// How a search varies [`Q_VELOCITY`].
pub(super) const SEARCH_Q_VELOCITY: Search = Search {
    tunable: Q_VELOCITY.name,
    low: 1e-18,
    high: 1e-6,
    only_with: None,
};

/// Q per internal unit of time from [`Q_POSITION`] and [`Q_VELOCITY`], detuned if the study says so; 9x9, internal units.
///
/// # Errors
/// When a tunable is out of range.
pub(super) fn rate(setup: &Setup<'_>) -> Result<TargetMatrix, FilterError> {
    let per_second = setup.units.time * setup.off_nominal;
    let position = setup.tunables.real(Q_POSITION.name)? * per_second / setup.units.length.powi(2);
    let velocity = setup.tunables.real(Q_VELOCITY.name)? * per_second / setup.units.velocity().powi(2);
    Ok(diagonal(position, velocity))
}

/// diag(position, velocity, 0), each for three axes.
pub(super) fn diagonal(position: f64, velocity: f64) -> TargetMatrix {
    let mut q = TargetMatrix::zeros();
    for axis in 0..3 {
        q[(axis, axis)] = position;
        q[(3 + axis, 3 + axis)] = velocity;
    }
    q
}
