//! What a study keeps of one estimate.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Vector quantities that statistics are kept of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Relative position in the axes of the results, m.
    Position,
    /// Relative velocity in the axes of the results, m/s.
    Velocity,
    /// Unmodelled acceleration in the axes of the results, m/s2.
    Acceleration,
    /// Accelerometer bias in chaser body axes, m/s2.
    Bias,
    /// First three rows of the filter's innovation, measured minus predicted.
    Residual,
    /// The next three, where the measurement has six.
    ResidualRate,
}

/// Number of quantities.
pub const QUANTITIES: usize = Quantity::ALL.len();

impl Quantity {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 6] = [
        Self::Position,
        Self::Velocity,
        Self::Acceleration,
        Self::Bias,
        Self::Residual,
        Self::ResidualRate,
    ];
}

/// One row of numbers of one filter in one run. A number that is absent is NaN inside and `None` to the outside: some twenty
/// thousand rows wait for each filter and thread, and an option would take a word more for each vector.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Record {
    /// Place of the epoch on the study's grid, from 0.
    pub epoch: u32,
    /// Number of states of the NEES.
    pub dimension: u8,
    /// The filter offers a covariance, but it is not symmetric, positive definite and finite.
    pub covariance_broken: bool,
    /// Position error beyond 100 m and, if a sigma is claimed, beyond ten times 3 sigma.
    pub lost: bool,
    errors: [Vector3<f64>; QUANTITIES],
    variances: [Vector3<f64>; QUANTITIES],
    true_acceleration: Vector3<f64>,
    nees: f64,
    nees6: f64,
    nis: f64,
}

impl Record {
    /// A row of an epoch that holds nothing yet.
    pub fn new(epoch: usize) -> Self {
        let nothing = Vector3::repeat(f64::NAN);
        Self {
            epoch: u32::try_from(epoch).unwrap_or(u32::MAX),
            dimension: 0,
            covariance_broken: false,
            lost: false,
            errors: [nothing; QUANTITIES],
            variances: [nothing; QUANTITIES],
            true_acceleration: nothing,
            nees: f64::NAN,
            nees6: f64::NAN,
            nis: f64::NAN,
        }
    }

    /// Estimate minus truth; the innovation as it is.
    pub fn error(&self, quantity: Quantity) -> Option<Vector3<f64>> {
        present(self.errors[quantity as usize])
    }

    /// Variance that the filter claims for it, same axes.
    pub fn variance(&self, quantity: Quantity) -> Option<Vector3<f64>> {
        present(self.variances[quantity as usize])
    }

    /// True acceleration in the axes of the results, m/s2: the error of an estimate of zero.
    pub fn true_acceleration(&self) -> Option<Vector3<f64>> {
        present(self.true_acceleration)
    }

    /// NEES divided by its dimension.
    pub fn nees(&self) -> Option<f64> {
        Some(self.nees).filter(|n| !n.is_nan())
    }

    /// NEES of position and velocity alone, divided by 6: the same states for every filter.
    pub fn nees6(&self) -> Option<f64> {
        Some(self.nees6).filter(|n| !n.is_nan())
    }

    /// NIS divided by its rows; absent while coasting and for a filter of no dimension.
    pub fn nis(&self) -> Option<f64> {
        Some(self.nis).filter(|n| !n.is_nan())
    }

    /// Puts an error and the variance claimed for it into the row.
    pub fn set(&mut self, quantity: Quantity, error: Option<Vector3<f64>>, variance: Option<Vector3<f64>>) {
        self.errors[quantity as usize] = or_nan(error);
        self.variances[quantity as usize] = or_nan(variance);
    }

    /// Puts the true acceleration into the row, m/s2.
    pub fn set_true_acceleration(&mut self, value: Option<Vector3<f64>>) {
        self.true_acceleration = or_nan(value);
    }

    /// Puts the NEES over its dimension, and that of position and velocity over 6, into the row.
    pub fn set_nees(&mut self, all: Option<f64>, six: Option<f64>) {
        self.nees = all.unwrap_or(f64::NAN);
        self.nees6 = six.unwrap_or(f64::NAN);
    }

    /// Puts the NIS over its rows into the row.
    pub fn set_nis(&mut self, value: Option<f64>) {
        self.nis = value.unwrap_or(f64::NAN);
    }
}

fn present(v: Vector3<f64>) -> Option<Vector3<f64>> {
    Some(v).filter(|v| !v.iter().all(|x| x.is_nan()))
}

fn or_nan(v: Option<Vector3<f64>>) -> Vector3<f64> {
    v.unwrap_or(Vector3::repeat(f64::NAN))
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_out_as_they_went_in_and_what_is_absent_is_absent() {
        let mut record = Record::new(7);
        for quantity in Quantity::ALL {
            assert_eq!((record.error(quantity), record.variance(quantity)), (None, None));
        }
        assert_eq!(
            (record.true_acceleration(), record.nees(), record.nis()),
            (None, None, None)
        );
        for (at, quantity) in (1..).zip(Quantity::ALL) {
            let error = Vector3::new(f64::from(at) / 7.0, -0.0, f64::MIN_POSITIVE);
            record.set(quantity, Some(error), (at % 2 == 0).then_some(2.0 * error));
        }
        record.set_nees(Some(0.1 + 0.2), None);
        for (at, quantity) in (1..).zip(Quantity::ALL) {
            let error = Vector3::new(f64::from(at) / 7.0, -0.0, f64::MIN_POSITIVE);
            assert_eq!(record.error(quantity), Some(error));
            assert_eq!(record.variance(quantity), (at % 2 == 0).then_some(2.0 * error));
        }
        assert_eq!((record.epoch, record.nees(), record.nis()), (7, Some(0.1 + 0.2), None));
        assert_eq!(record.nees6(), None);
        // A vector of which a part is no number is there, and whoever uses it will say so.
        let partly = Vector3::new(1.0, f64::NAN, 2.0);
        record.set_true_acceleration(Some(partly));
        assert_eq!(record.true_acceleration().map(|v| v.x), Some(1.0));
    }
}
