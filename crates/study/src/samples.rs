//! What truth and filter say about one sensor sample.

use std::collections::BTreeMap;

use crate::signals::Signals;
use interface::Status;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Differences of epochs below this are rounding, s.
pub(crate) const SAME_TIME: f64 = 1e-6;

/// True state at the epoch of one sensor sample, in the axes of the truth's variables, SI.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TruthSample {
    /// Ordinal of the sample, from 1: of the epochs at which any sensor samples.
    pub count: u32,
    /// Place of its epoch on the study's grid of sample periods, from 0.
    pub epoch: usize,
    /// Epoch, s.
    pub time: f64,
    /// Relative position, m.
    pub position: Vector3<f64>,
    /// Relative velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Unmodelled acceleration, m/s2.
    pub acceleration: Option<Vector3<f64>>,
    /// Accelerometer bias, m/s2, chaser body axes.
    pub bias: Option<Vector3<f64>>,
    /// Position, m, and velocity, m/s, of the chaser.
    pub chaser: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Whether a sensor that sees the target measured it at this sample.
    pub measured: bool,
    /// Whether something that no filter is told of pushes the target.
    pub pushed: bool,
    /// Time since it last has, s: 0 while it does and at the first sample after; `None` where it never has.
    pub since_push: Option<f64>,
}

/// What a filter answers after one sample, in the axes of its variables, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Relative position, m.
    pub position: Vector3<f64>,
    /// Relative velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Unmodelled acceleration, m/s2, if it estimates one.
    pub acceleration: Option<Vector3<f64>>,
    /// Accelerometer bias, m/s2, chaser body axes, if it estimates one.
    pub bias: Option<Vector3<f64>>,
    /// Covariance of position, velocity, acceleration, if it has one.
    pub covariance: Option<SMatrix<f64, 9, 9>>,
    /// Leading rows of the covariance that hold states.
    pub dimension: usize,
    /// Standard deviation of the bias, m/s2.
    pub bias_sigma: Option<Vector3<f64>>,
    /// Innovation, three rows at a time.
    pub residual: [Option<Vector3<f64>>; 2],
    /// Variance of the innovation as predicted.
    pub residual_variance: [Option<Vector3<f64>>; 2],
    /// Normalised innovation squared, not divided by its rows.
    pub nis: Option<f64>,
    /// Rows that `nis` is taken over, if the filter says so; else they are the world's.
    pub nis_rows: Option<u32>,
    /// Root of the jerk density, m/s^2.5.
    pub jerk_root: Option<Vector3<f64>>,
    /// What the filter says of itself.
    pub status: Option<Status>,
}

impl TruthSample {
    /// First number of the sample that is NaN or infinite, as in 'truth.r_tc_n[2] is NaN'.
    pub(crate) fn first_not_finite(&self, signals: &Signals) -> Option<String> {
        let names = |of: Option<[&'static str; 2]>, which: usize| of.map_or("", |names| names[which]);
        first_not_finite([
            (signals.position[0], Some(self.position)),
            (signals.velocity[0], Some(self.velocity)),
            (signals.acceleration[0], self.acceleration),
            (names(signals.bias, 0), self.bias),
            (names(signals.chaser, 0), self.chaser.map(|(r, _)| r)),
            (names(signals.chaser, 1), self.chaser.map(|(_, v)| v)),
        ])
    }
}

impl Estimate {
    /// First number of the estimate itself that is NaN or infinite, as in 'est.r_tc_n[2] is NaN'.
    pub(crate) fn first_not_finite(&self, signals: &Signals) -> Option<String> {
        first_not_finite([
            (signals.position[1], Some(self.position)),
            (signals.velocity[1], Some(self.velocity)),
            (signals.acceleration[1], self.acceleration),
            (signals.bias.map_or("", |names| names[1]), self.bias),
        ])
    }

    /// Block of the covariance that belongs to position (0), velocity (1) or acceleration (2).
    pub(crate) fn block(&self, index: usize) -> Option<Matrix3<f64>> {
        let p = self.covariance.as_ref().filter(|_| 3 * (index + 1) <= self.dimension)?;
        Some(p.fixed_view::<3, 3>(3 * index, 3 * index).into_owned())
    }
}

fn first_not_finite<const N: usize>(parts: [(&'static str, Option<Vector3<f64>>); N]) -> Option<String> {
    parts.into_iter().find_map(|(name, v)| {
        let v = v?;
        let axis = v.iter().position(|x| !x.is_finite())?;
        Some(format!("{name}[{}] is {}", axis + 1, v[axis]))
    })
}

/// Which number a filter gives each [`Status`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StatusItems(BTreeMap<i32, Status>);

impl StatusItems {
    /// Those of an enumeration, by the names of its items; other names mean nothing here.
    pub fn named<'a>(items: impl IntoIterator<Item = (&'a str, i32)>) -> Self {
        let known = |(name, number)| Some((number, Status::named(name)?));
        Self(items.into_iter().filter_map(known).collect())
    }

    /// The status of this number; `None` for one without a meaning.
    pub fn status(&self, number: i32) -> Option<Status> {
        self.0.get(&number).copied()
    }
}

/// Those of a plain Integer: counted from 1 in the order of [`Status::ALL`].
impl Default for StatusItems {
    fn default() -> Self {
        Self(
            Status::ALL
                .iter()
                .map(|(status, ..)| (status.number(), *status))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_integer_counts_in_the_order_of_the_interface() {
        let items = StatusItems::default();
        let found = [0, 1, 2, 3, 4, 5, 6].map(|n| items.status(n));
        let expected = [
            None,
            Some(Status::Initialising),
            Some(Status::Tracking),
            Some(Status::Coasting),
            Some(Status::Diverged),
            Some(Status::Stale),
            None,
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn an_enumeration_is_read_by_its_names() {
        let items = StatusItems::named([("lost_in_space", 1), ("diverged", 2), ("tracking", 7)]);
        assert_eq!(
            [1, 2, 7, 4].map(|n| items.status(n)),
            [None, Some(Status::Diverged), Some(Status::Tracking), None]
        );
    }
}
