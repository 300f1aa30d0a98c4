//! What a study keeps of one estimate.

use nalgebra::Vector3;

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
    /// Root of the jerk density in axes N, m/s^2.5: no error, but the value that the filter works with.
    JerkRoot,
}

/// Number of quantities.
pub const QUANTITIES: usize = Quantity::ALL.len();

impl Quantity {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::Position,
        Self::Velocity,
        Self::Acceleration,
        Self::Bias,
        Self::Residual,
        Self::ResidualRate,
        Self::JerkRoot,
    ];
}

/// One row of numbers of one filter in one run. A number that is absent is NaN inside and `None` to the outside: some twenty
/// thousand rows wait for each filter and thread, and an option would take a word more for each vector.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Place of the epoch on the study's grid, from 0.
    pub epoch: u32,
    /// Phases it belongs to, a bit each.
    pub phases: u32,
    /// Number of states of the NEES.
    pub dimension: u8,
    /// Rows of the NIS.
    pub nis_rows: u8,
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
            phases: 0,
            dimension: 0,
            nis_rows: 0,
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

    /// Estimate minus truth; the innovation and the root of the jerk density as they are.
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

/// Vectors of a row, one behind the other: errors, variances, by quantity.
const VECTORS: usize = 2 * QUANTITIES;

/// Rows as bytes. The true acceleration is left out: what is made of it stands in the line of the run.
///
/// First which vectors any row has, one bit each; then each row with those alone.
pub(crate) fn to_bytes(records: &[Record], bytes: &mut Vec<u8>) {
    let vectors = |r: &Record| r.errors.into_iter().chain(r.variances);
    let mut mask = 0_u16;
    for record in records {
        for (bit, vector) in vectors(record).enumerate() {
            mask |= u16::from(present(vector).is_some()) << bit;
        }
    }
    bytes.extend(mask.to_le_bytes());
    bytes.extend((records.len() as u32).to_le_bytes());
    bytes.reserve(records.len() * row_length(mask));
    for record in records {
        bytes.extend_from_slice(&record.epoch.to_le_bytes());
        bytes.extend_from_slice(&record.phases.to_le_bytes());
        bytes.extend([
            record.dimension,
            record.nis_rows,
            u8::from(record.covariance_broken),
            u8::from(record.lost),
        ]);
        for scalar in [record.nees, record.nees6, record.nis] {
            bytes.extend_from_slice(&scalar.to_le_bytes());
        }
        for (bit, vector) in vectors(record).enumerate() {
            if mask & (1 << bit) != 0 {
                vector.iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
            }
        }
    }
}

fn row_length(mask: u16) -> usize {
    2 * 4 + 4 + 3 * 8 + 24 * mask.count_ones() as usize
}

/// Rows from the front of such bytes, which then begin behind them; `None` when they are too short.
pub(crate) fn from_bytes(bytes: &mut &[u8]) -> Option<Vec<Record>> {
    let mask = u16::from_le_bytes(take(bytes)?);
    let count = u32::from_le_bytes(take(bytes)?) as usize;
    if bytes.len() < count.checked_mul(row_length(mask))? {
        return None;
    }
    let mut records = Vec::with_capacity(count);
    for _ in 0..count {
        let mut record = Record::new(u32::from_le_bytes(take(bytes)?) as usize);
        record.phases = u32::from_le_bytes(take(bytes)?);
        let [dimension, rows, broken, lost] = take(bytes)?;
        (record.dimension, record.nis_rows) = (dimension, rows);
        (record.covariance_broken, record.lost) = (broken != 0, lost != 0);
        for scalar in [&mut record.nees, &mut record.nees6, &mut record.nis] {
            *scalar = f64::from_le_bytes(take(bytes)?);
        }
        for (bit, vector) in record.errors.iter_mut().chain(&mut record.variances).enumerate() {
            if mask & (1 << bit) != 0 {
                for x in vector {
                    *x = f64::from_le_bytes(take(bytes)?);
                }
            }
        }
        records.push(record);
    }
    Some(records)
}

const _: () = assert!(VECTORS <= 16, "a bit for each");

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
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
