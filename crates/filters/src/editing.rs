//! Measurement editing: samples that cannot be, and samples that are most likely outliers, are passed by.
//!
//! An outlier is taken to have ten times the noise. With a share p of them, innovation v, its covariance S and noise R, a sample is
//! one with probability p N(v; S + 99 R) / [(1 - p) N(v; S) + p N(v; S + 99 R)]. It is passed by where that is above one half, but
//! not more than a few times in a row, and then not again until a sample fits: a filter that has lost its way must not take the truth
//! for outliers.

use crate::laws::Step;
use crate::layout::Layout;
use crate::sample::{Reading, Sample};
use crate::state::RowVector;
use interface::Sensor;
use interface::mission::Quantity;
use nalgebra::{Matrix6, SMatrix, SVector};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Variance of an outlier's noise over that of any other, less one.
const MORE: f64 = 99.0;
/// Time after the first sample in which nothing is taken for an outlier, s: the first estimate is too far off for the slopes that it is
/// updated with, and what it leaves is none of the sensors' doing.
pub(crate) const SETTLING: f64 = 30.0;
/// Most rows that a sensor has.
const MOST: usize = 6;

/// What is edited, and how often it was.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Editing {
    /// Share of outliers that is reckoned with; `None` where none are looked for.
    share: Option<f64>,
    /// Most samples of a sensor that are passed by one after the other.
    most: i32,
    /// Epoch of the first sample, s.
    first_s: Option<f64>,
    in_a_row: [i32; Sensor::COUNT],
    outliers: i32,
    impossible: i32,
}

impl Editing {
    /// * `share`: of outliers, between 0 and 1; `None` to look for none.
    /// * `most`: samples of a sensor that may be passed by one after the other.
    pub(crate) fn new(share: Option<f64>, most: i32) -> Self {
        Self {
            share,
            most,
            first_s: None,
            in_a_row: [0; Sensor::COUNT],
            outliers: 0,
            impossible: 0,
        }
    }

    /// Samples of a sensor that were passed by as outliers.
    pub(crate) fn outliers(&self) -> i32 {
        self.outliers
    }

    /// Samples of a sensor that were passed by since they cannot be.
    pub(crate) fn impossible(&self) -> i32 {
        self.impossible
    }

    /// Sensors whose sample cannot be: a range that is not positive, or anything that is no number.
    pub(crate) fn remove_impossible(&mut self, sample: &mut Cow<'_, Sample>, layout: Layout) {
        self.first_s.get_or_insert(sample.time);
        for sensor in Sensor::ALL {
            if let (Some(_), Some(z)) = (layout.of_sensor(sensor), sample[sensor].seen()) {
                let numbers = z.iter().take(sensor.rows()).all(|v| v.is_finite());
                let is_range = matches!(sensor, Sensor::Lidar | Sensor::Radio);
                if !numbers || (is_range && z[0] <= 0.0) {
                    sample.to_mut()[sensor] = Reading::Lost;
                    self.impossible += 1;
                }
            }
        }
    }

    /// Sensors whose sample is most likely an outlier; each is counted.
    ///
    /// * `t_s`: epoch of the sample.
    /// * `step`: as the update with all of them has left it.
    /// * `nis`: of that update.
    /// * `excess`: tells by how much the covariance of position and velocity that counts was larger than that of the update, 6x6.
    /// * `r`: noise variances of the rows.
    pub(crate) fn find(
        &mut self,
        t_s: f64,
        step: &Step,
        nis: f64,
        excess: impl Fn() -> Option<Matrix6<f64>>,
        layout: Layout,
        r: &RowVector,
    ) -> Vec<Sensor> {
        let settled = self.first_s.is_some_and(|first| t_s - first >= SETTLING);
        let Some(share) = self.share.filter(|_| settled) else {
            return Vec::new();
        };
        let odds = ((1.0 - share) / share).ln();
        let mut found = Vec::new();
        for sensor in Sensor::ALL {
            let Some(rows) = layout.of_sensor(sensor).filter(|rows| step.measured.has(rows.start)) else {
                continue;
            };
            // The quadratic form alone must make up for the odds; that of a part is not above that of the whole.
            let suspect = nis >= 2.0 * odds && is_outlier(step, rows, excess().as_ref(), r, odds);
            let count = &mut self.in_a_row[sensor as usize];
            if !suspect {
                *count = 0;
            } else if *count < self.most {
                *count += 1;
                self.outliers += 1;
                found.push(sensor);
            }
        }
        found
    }
}

/// Whether the rows of a sensor are more likely those of an outlier.
///
/// * `odds`: logarithm of the odds against one.
fn is_outlier(
    step: &Step,
    rows: std::ops::Range<usize>,
    excess: Option<&Matrix6<f64>>,
    r: &RowVector,
    odds: f64,
) -> bool {
    // Beyond the sensor's rows an identity and zeros, which change neither determinant nor quadratic form.
    let mut s = SMatrix::<f64, MOST, MOST>::identity();
    let mut more = SMatrix::<f64, MOST, MOST>::zeros();
    let mut v = SVector::<f64, MOST>::zeros();
    for (i, row) in rows.clone().enumerate().take(MOST) {
        v[i] = step.innovation[row];
        more[(i, i)] = MORE * r[row];
        for (j, column) in rows.clone().enumerate().take(MOST) {
            s[(i, j)] = step.s[(row, column)];
            if let Some(excess) = excess {
                let h = |row| step.h.fixed_view::<1, 6>(row, 0);
                s[(i, j)] += (h(row) * excess * h(column).transpose())[0];
            }
        }
    }
    let log_density = |s: SMatrix<f64, MOST, MOST>| {
        let factor = s.cholesky()?;
        let ln_root_det: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        Some(-0.5 * v.dot(&factor.solve(&v)) - ln_root_det)
    };
    match (log_density(s), log_density(s + more)) {
        (Some(plain), Some(outlier)) => outlier - plain > odds,
        _ => false,
    }
}

/// An angle's difference, turned to within half a turn; any other difference as it is.
pub(crate) fn wrapped(difference: f64, quantity: Quantity) -> f64 {
    if quantity == Quantity::Angle && difference.abs() > std::f64::consts::PI {
        difference - std::f64::consts::TAU * (difference / std::f64::consts::TAU).round()
    } else {
        difference
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::TargetMatrix;

    /// One row of a LiDAR, S = 2 R: the density of either written out.
    fn step(v: f64) -> Step {
        let mut step = Step::blank(1.0, TargetMatrix::identity());
        step.measured.mark(0..3);
        step.innovation[0] = v;
        (0..3).for_each(|i| step.s[(i, i)] = 2.0);
        step
    }

    fn settled(share: Option<f64>) -> Editing {
        let mut editing = Editing::new(share, 3);
        editing.first_s = Some(0.0);
        editing
    }

    fn finds(editing: &mut Editing, v: f64, excess: Option<&Matrix6<f64>>) -> bool {
        let layout = Layout::new(&[Sensor::Lidar]);
        !editing
            .find(
                100.0,
                &step(v),
                0.5 * v * v,
                || excess.copied(),
                layout,
                &RowVector::repeat(1.0),
            )
            .is_empty()
    }

    /// Three rows, of which one is off by v: -v^2 / 4 - 3/2 ln 2 against -v^2 / 202 - 3/2 ln 101, and odds of 99.
    #[test]
    fn an_outlier_is_what_is_more_likely_one() {
        let edge = ((99.0_f64.ln() + 1.5 * (101.0_f64 / 2.0).ln()) / (0.25 - 1.0 / 202.0)).sqrt();
        let mut editing = settled(Some(0.01));
        assert!(!finds(&mut editing, edge - 1e-9, None));
        assert!(finds(&mut editing, edge + 1e-9, None));
        assert_eq!(editing.outliers(), 1);
        assert!(!finds(&mut settled(None), 1e9, None));
    }

    #[test]
    fn nothing_is_an_outlier_before_the_filter_has_settled() {
        let mut editing = Editing::new(Some(0.01), 3);
        editing.first_s = Some(100.0 - SETTLING + 1.0);
        assert!(!finds(&mut editing, 1e3, None));
        editing.first_s = Some(100.0 - SETTLING);
        assert!(finds(&mut editing, 1e3, None));
    }

    #[test]
    fn not_more_than_three_in_a_row_are_passed_by() {
        let mut editing = settled(Some(0.01));
        let mut found = |v: f64| finds(&mut editing, v, None);
        let off: Vec<bool> = (0..9).map(|_| found(100.0)).collect();
        assert_eq!(off, [true, true, true, false, false, false, false, false, false]);
        // One that fits, and the filter may doubt again.
        assert!(!found(0.5) && found(100.0));
        assert_eq!(editing.outliers(), 4);
    }

    #[test]
    fn a_filter_that_knows_less_takes_more() {
        let mut step = step(20.0);
        step.h[(0, 0)] = 1.0;
        let layout = Layout::new(&[Sensor::Lidar]);
        let unsure = Matrix6::from_diagonal_element(400.0);
        let found = |excess: Option<&Matrix6<f64>>| {
            let mut editing = settled(Some(0.01));
            editing.find(100.0, &step, 200.0, || excess.copied(), layout, &RowVector::repeat(1.0))
        };
        assert_eq!(found(None), [Sensor::Lidar]);
        assert_eq!(found(Some(&unsure)), []);
    }

    #[test]
    fn what_cannot_be_is_passed_by() {
        let layout = Layout::new(&[Sensor::Lidar, Sensor::Camera]);
        let mut editing = Editing::new(None, 3);
        for (z, lost) in [
            ([100.0, 0.1, 0.2], false),
            ([0.0, 0.1, 0.2], true),
            ([-3.0, 0.1, 0.2], true),
            ([100.0, f64::NAN, 0.2], true),
            ([f64::INFINITY, 0.1, 0.2], true),
        ] {
            let mut sample = Sample::blank(1, 1.0);
            sample[Sensor::Lidar] = Reading::of(&z);
            sample[Sensor::Camera] = Reading::of(&[-0.1, -0.2]);
            let mut sample = Cow::Owned(sample);
            editing.remove_impossible(&mut sample, layout);
            assert_eq!(sample[Sensor::Lidar] == Reading::Lost, lost, "{z:?}");
            assert_ne!(sample[Sensor::Camera], Reading::Lost);
        }
        assert_eq!(editing.impossible(), 4);
    }

    #[test]
    fn angles_are_turned_to_the_predicted_one() {
        let tau = std::f64::consts::TAU;
        assert!((wrapped(tau - 0.1, Quantity::Angle) + 0.1).abs() < 1e-12);
        assert!((wrapped(0.2 - 2.0 * tau, Quantity::Angle) - 0.2).abs() < 1e-12);
        assert_eq!(wrapped(-3.0, Quantity::Angle).to_bits(), (-3.0_f64).to_bits());
        assert_eq!(wrapped(7.0, Quantity::Length).to_bits(), 7.0_f64.to_bits());
    }
}
