//! Measurement editing: samples that cannot be, and samples that are most likely outliers, are passed by.
//!
//! An outlier is taken to have ten times the noise. With a share p of them, innovation v, its covariance S and noise R, a sample is
//! one with probability p N(v; S + 99 R) / [(1 - p) N(v; S) + p N(v; S + 99 R)]. It is suspected where that is above one half.
//!
//! That S is right is what the filter believes, and a filter that has lost its way believes it too: to it the truth is an outlier, and
//! every sample passed by takes it further off. So a suspect is passed by
//!
//! * where it stands out from the samples before, too. With e the mean of what the last n of them left, v - e is the change that was
//!   measured less the one that was predicted; it has the noise R (1 + 1/n) and next to nothing of what a filter that lags is off by.
//!   There are four of them, or as many as are fresh and have come since the last suspect; where none is, only what is beyond all
//!   bounds is passed by;
//! * where the filter's record speaks for it: of the sensor's last samples at most a third were suspected;
//! * not more than a few times in a row, and then not again until a sample fits. Where a filter has lost its way, suspects lie on a line,
//!   and outliers do not: one that stands out from the line through the two before it is passed by, too, for as long again. Where
//!   anything else was used meanwhile, the filter has moved, and there is no line.
//!
//! Without a record, at the start above all, only what is beyond all bounds and far from the measurement before is passed by.

use numerics::math;

use crate::laws::Step;
use crate::layout::Layout;
use crate::sample::{Reading, Sample, SpecificForce};
use crate::state::{RowVector, Target};
use interface::mission::Quantity;
use interface::{Navigation, Sensor};
use nalgebra::{Matrix6, SMatrix, SVector};
use sensors::Rows;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// Variance of an outlier's noise over that of any other, less one.
const MORE: f64 = 99.0;
/// Standard deviations beyond which nothing is chance, nor an outlier of ten times the noise.
const GROSS: f64 = 50.0;
/// Samples of a sensor that make up its record.
const RECORD: u32 = 24;
/// Samples used last against which one that is suspected must stand out.
const BEFORE: usize = 4;
/// Periods of a sensor after which what a sample left says nothing any more of the one that comes: a filter that lags has moved on.
const FRESH: f64 = 8.0;
/// Rounding of times, s.
const TICK: f64 = 1e-6;
/// Most rows that a sensor has.
const MOST: usize = Sensor::MOST_ROWS;

/// What is edited, and how often it was.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Editing {
    /// Share of outliers that is reckoned with; `None` where none are looked for.
    share: Option<f64>,
    /// Most samples of a sensor that are passed by one after the other; twice as many where they disagree.
    most: i32,
    watched: [Watched; Sensor::COUNT],
    /// Whether the mission has an accelerometer.
    accelerometer: bool,
    outliers: i32,
    impossible: i32,
}

/// A sensor as it has done so far.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Watched {
    /// Standard deviations of its rows, SI.
    sigma: Rows,
    period_s: f64,
    /// One bit for each of its last samples, the newest lowest: set where it was suspected, and before the first.
    suspected: u32,
    /// Samples passed by since the last that fitted.
    in_a_row: i32,
    /// The last two that were passed by since anything was used, the newest first.
    passed: [Option<Past>; 2],
    /// The last that were not passed by, the newest first.
    used: [Option<Past>; BEFORE],
}

/// A sample that was used or passed by.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Past {
    time_s: f64,
    /// What was measured, SI.
    z: Rows,
    /// What it left: measured less what the estimate after it says, which one that is passed by does not move; internal units.
    left: Rows,
}

impl Watched {
    fn new(sigma: Rows, period_s: f64) -> Self {
        Self {
            sigma,
            period_s,
            suspected: (1 << RECORD) - 1,
            in_a_row: 0,
            passed: [None; 2],
            used: [None; BEFORE],
        }
    }

    /// Whether its samples have fitted, by and large: at most a third of them were suspected.
    fn has_fitted(&self) -> bool {
        3 * self.suspected.count_ones() <= RECORD
    }

    /// Whether a sample still says something of the one that comes at this time.
    fn is_fresh(&self, past: &Past, time_s: f64) -> bool {
        time_s - past.time_s <= FRESH * self.period_s + TICK
    }

    /// What the last samples used have left, by their mean, and the variance of that over the variance of one; `None` where there
    /// is none that is fresh.
    fn left(&self, time_s: f64) -> Option<(Rows, f64)> {
        let fresh = self.used.iter().flatten().filter(|used| self.is_fresh(used, time_s));
        let (count, sum) = fresh.fold((0.0, Rows::zeros()), |(count, sum), used| {
            (count + 1.0, sum + used.left)
        });
        (count > 0.0).then(|| (sum / count, 1.0 / count))
    }

    /// What a filter that has lost its way would leave now, on the line through what the last two that were passed by have left, and
    /// the variance of that over the variance of one; `None` where there are no two that are fresh.
    fn astray(&self, time_s: f64) -> Option<(Rows, f64)> {
        let [Some(newer), Some(older)] = self.passed else {
            return None;
        };
        let on = (time_s - newer.time_s) / (newer.time_s - older.time_s);
        let left = newer.left + (newer.left - older.left) * on;
        self.is_fresh(&older, time_s)
            .then_some((left, (1.0 + on).powi(2) + on * on))
    }

    /// Takes note of a sample that was used. A suspect that is used speaks of a filter that has begun to lag, and what the samples
    /// before it have left says nothing of what it will be off by next.
    fn remember(&mut self, last: Past) {
        if self.suspected & 1 == 1 {
            self.used = [None; BEFORE];
        }
        self.used.rotate_right(1);
        self.used[0] = Some(last);
    }

    /// Whether a measurement is far from the last one used, if that is fresh, whatever a filter thinks of either.
    fn is_far(&self, z: &Rows, sensor: Sensor, time_s: f64) -> bool {
        let fresh = self.used[0].filter(|used| self.is_fresh(used, time_s));
        fresh.is_some_and(|used| {
            let mut rows = sensor.quantities().enumerate().take(MOST);
            rows.any(|(row, quantity)| {
                wrapped(z[row] - used.z[row], quantity).abs() > GROSS * 2.0_f64.sqrt() * self.sigma[row]
            })
        })
    }
}

impl Editing {
    /// * `share`: of outliers, between 0 and 1; `None` to look for none.
    /// * `most`: samples of a sensor that may be passed by one after the other; twice as many where those beyond it disagree with those
    ///   before.
    /// * `told`: the mission, what a user believes included.
    pub(crate) fn new(share: Option<f64>, most: i32, told: &Navigation) -> Self {
        let mut watched = [Watched::new(Rows::zeros(), f64::INFINITY); Sensor::COUNT];
        for known in &told.sensors {
            let mut sigma = Rows::zeros();
            sigma
                .iter_mut()
                .zip(known.deviations())
                .for_each(|(to, sigma)| *to = sigma);
            watched[known.sensor as usize] = Watched::new(sigma, known.period_s);
        }
        Self {
            share,
            most,
            watched,
            accelerometer: told.accelerometer.is_some(),
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

    /// Takes away what cannot be: a range that is not positive, or anything that is no number, of the accelerometer too.
    pub(crate) fn remove_impossible(&mut self, sample: &mut Cow<'_, Sample>, layout: Layout) {
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
        let is_number = |force: &SpecificForce| force.alpha_c_bc().iter().all(|v| v.is_finite());
        if self.accelerometer && sample.accelerometer.as_ref().is_some_and(|force| !is_number(force)) {
            sample.to_mut().accelerometer = None;
            self.impossible += 1;
        }
    }

    /// Of each sensor, whether its sample is most likely an outlier; those are counted.
    ///
    /// * `step`: as the update with all of them has left it.
    /// * `nis`: of that update.
    /// * `excess`: tells by how much the covariance of position and velocity that counts was larger than that of the update, 6x6.
    /// * `r`: noise variances of the rows.
    pub(crate) fn find(
        &mut self,
        sample: &Sample,
        step: &Step,
        nis: f64,
        excess: impl Fn() -> Option<Matrix6<f64>>,
        layout: Layout,
        r: &RowVector,
    ) -> [bool; Sensor::COUNT] {
        let mut found = [false; Sensor::COUNT];
        let Some(share) = self.share else {
            return found;
        };
        let odds = math::ln((1.0 - share) / share);
        for sensor in Sensor::ALL {
            let (Some(rows), Some(z)) = (layout.of_sensor(sensor), sample[sensor].seen()) else {
                continue;
            };
            // The quadratic form must make up for the odds, of which half is asked here: the S of a bank's mixture may be somewhat below
            // that of its own update.
            let watched = &mut self.watched[sensor as usize];
            let (outlier, gross) = if nis >= odds {
                let seen = Seen::new(step, rows.clone(), excess().as_ref(), r);
                (seen.is_outlier(odds), seen.is_gross())
            } else {
                (false, false)
            };
            let suspect = outlier || gross;
            // That outliers are rare has been counted already.
            let stands_out = |from: &(Rows, f64)| Seen::change(step, rows.clone(), from, r).is_outlier(0.0);
            let disagrees = || watched.astray(sample.time).is_some_and(|left| stands_out(&left));
            let doubted = suspect
                && (watched.in_a_row < self.most || (watched.in_a_row < self.most.saturating_mul(2) && disagrees()))
                && if watched.has_fitted() {
                    watched.left(sample.time).map_or(gross, |left| stands_out(&left))
                } else {
                    gross && watched.is_far(&z, sensor, sample.time)
                };
            watched.suspected = (watched.suspected << 1 | u32::from(suspect)) & ((1 << RECORD) - 1);
            if doubted {
                watched.in_a_row += 1;
                watched.passed.rotate_right(1);
                watched.passed[0] = Some(Past {
                    time_s: sample.time,
                    z,
                    left: innovation(step, rows),
                });
                self.outliers += 1;
                found[sensor as usize] = true;
            } else if !suspect {
                watched.in_a_row = 0;
            }
        }
        found
    }

    /// Takes note of what was used.
    ///
    /// * `step`: as the update with it has left it.
    /// * `moved`: by how much update and law moved the target's nine states.
    pub(crate) fn remember(&mut self, sample: &Sample, step: &Step, moved: &Target, layout: Layout) {
        if self.share.is_none() {
            return;
        }
        for sensor in Sensor::ALL {
            if let (Some(rows), Some(z)) = (layout.of_sensor(sensor), sample[sensor].seen()) {
                let mut left = Rows::zeros();
                for (left, row) in left.iter_mut().zip(rows) {
                    *left = step.innovation[row] - (step.h.row(row) * moved)[0];
                }
                let last = Past {
                    time_s: sample.time,
                    z,
                    left,
                };
                // The estimate has moved, and with it what suspects of any sensor have left.
                self.watched.iter_mut().for_each(|watched| watched.passed = [None; 2]);
                self.watched[sensor as usize].remember(last);
            }
        }
    }
}

/// The rows of one sensor; beyond them an identity and zeros, which change neither determinant nor quadratic form.
struct Seen {
    innovation: SVector<f64, MOST>,
    s: SMatrix<f64, MOST, MOST>,
    /// What an outlier adds.
    more: SMatrix<f64, MOST, MOST>,
}

impl Seen {
    fn new(step: &Step, rows: Range<usize>, excess: Option<&Matrix6<f64>>, r: &RowVector) -> Self {
        let mut seen = Self {
            innovation: innovation(step, rows.clone()),
            s: SMatrix::identity(),
            more: SMatrix::zeros(),
        };
        for (i, row) in rows.clone().enumerate().take(MOST) {
            seen.more[(i, i)] = MORE * r[row];
            for (j, column) in rows.clone().enumerate().take(MOST) {
                seen.s[(i, j)] = step.s[(row, column)];
                if let Some(excess) = excess {
                    let h = |row| step.h.fixed_view::<1, 6>(row, 0);
                    seen.s[(i, j)] += (h(row) * excess * h(column).transpose())[0];
                }
            }
        }
        seen
    }

    /// What has changed since samples before, if the filter's motion is right: the noise of this one, and of what they have left.
    ///
    /// * `left`: as [`Watched::left`] or [`Watched::astray`].
    fn change(step: &Step, rows: Range<usize>, (left, share): &(Rows, f64), r: &RowVector) -> Self {
        let mut seen = Self {
            innovation: innovation(step, rows.clone()) - left,
            s: SMatrix::identity(),
            more: SMatrix::zeros(),
        };
        for (i, row) in rows.enumerate().take(MOST) {
            seen.s[(i, i)] = (1.0 + share) * r[row];
            seen.more[(i, i)] = MORE * r[row];
        }
        seen
    }

    /// Whether they are more likely those of an outlier.
    ///
    /// * `odds`: logarithm of the odds against one.
    fn is_outlier(&self, odds: f64) -> bool {
        let v = &self.innovation;
        let log_density = |s: SMatrix<f64, MOST, MOST>| {
            let factor = s.cholesky()?;
            let ln_root_det: f64 = factor.l_dirty().diagonal().iter().map(|d| math::ln(*d)).sum();
            Some(-0.5 * v.dot(&factor.solve(v)) - ln_root_det)
        };
        match (log_density(self.s), log_density(self.s + self.more)) {
            (Some(plain), Some(outlier)) => outlier - plain > odds,
            _ => false,
        }
    }

    /// Whether one of them is beyond anything that S allows for.
    fn is_gross(&self) -> bool {
        let variances = self.s.diagonal();
        let mut rows = self.innovation.iter().zip(&variances);
        rows.any(|(v, s)| v.abs() > GROSS * s.sqrt())
    }
}

/// Innovation of the rows of one sensor; zeros beyond them.
fn innovation(step: &Step, rows: Range<usize>) -> Rows {
    let mut of_sensor = Rows::zeros();
    of_sensor
        .iter_mut()
        .zip(rows)
        .for_each(|(to, row)| *to = step.innovation[row]);
    of_sensor
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
        step.h[(0, 0)] = 1.0;
        (0..3).for_each(|i| step.s[(i, i)] = 2.0);
        step
    }

    const LIDAR: usize = Sensor::Lidar as usize;

    /// A LiDAR of unit noise whose samples have fitted, the last one, of the second before, to the digit.
    fn settled(share: Option<f64>) -> Editing {
        let told = lidar();
        let mut editing = Editing::new(share, 3, &told);
        editing.watched[LIDAR] = Watched::new(Rows::repeat(1.0), 1.0);
        editing.watched[LIDAR].suspected = 0;
        editing.watched[LIDAR].used[0] = Some(Past {
            time_s: 0.0,
            z: Rows::zeros(),
            left: Rows::zeros(),
        });
        editing
    }

    fn lidar() -> Navigation {
        let mission = interface::mission::embedded("leo_venting").unwrap();
        mission.mission().unwrap().navigation()
    }

    /// A sample of a LiDAR that sees the range `z` straight ahead.
    fn ranged(time_s: f64, z: f64) -> Sample {
        let mut sample = Sample::blank(1, time_s);
        sample[Sensor::Lidar] = Reading::of(&[z, 0.0, 0.0]);
        sample
    }

    /// Such a sample that is used: it is off by this, of which the update takes a tenth.
    fn use_one(editing: &mut Editing, time_s: f64, off: f64) {
        let layout = Layout::new(&[Sensor::Lidar]);
        editing.remember(
            &ranged(time_s, 1000.0),
            &step(off),
            &(Target::x() * (0.1 * off)),
            layout,
        );
    }

    /// * `z`: the range that is measured.
    /// * `v`: by how much it is off.
    fn finds_at(editing: &mut Editing, time_s: f64, z: f64, v: f64, excess: Option<&Matrix6<f64>>) -> bool {
        let layout = Layout::new(&[Sensor::Lidar]);
        let sample = ranged(time_s, z);
        let (step, r) = (step(v), RowVector::repeat(1.0));
        let found = editing.find(&sample, &step, 0.5 * v * v, || excess.copied(), layout, &r);
        let found = found.contains(&true);
        if !found {
            // It takes nine tenths of a range in.
            editing.remember(&sample, &step, &(Target::x() * (0.9 * v)), layout);
        }
        found
    }

    fn finds(editing: &mut Editing, v: f64, excess: Option<&Matrix6<f64>>) -> bool {
        finds_at(editing, 1.0, 1000.0, v, excess)
    }

    /// Three rows, of which one is off by v: -v^2 / 4 - 3/2 ln 2 against -v^2 / 202 - 3/2 ln 101, and odds of 99.
    #[test]
    fn an_outlier_is_what_is_more_likely_one() {
        let edge = ((99.0_f64.ln() + 1.5 * (101.0_f64 / 2.0).ln()) / (0.25 - 1.0 / 202.0)).sqrt();
        assert!(!finds(&mut settled(Some(0.01)), edge - 1e-9, None));
        let mut editing = settled(Some(0.01));
        assert!(finds(&mut editing, edge + 1e-9, None));
        assert_eq!(editing.outliers(), 1);
        assert!(!finds(&mut settled(None), 1e9, None));
    }

    /// Sixteen of twenty-four: from then on a third or less has not fitted.
    #[test]
    fn nothing_is_doubted_by_a_filter_whose_samples_have_not_fitted() {
        let mut editing = settled(Some(0.01));
        editing.watched[LIDAR] = Watched::new(Rows::repeat(1.0), 1.0);
        for _ in 0..15 {
            assert!(!finds(&mut editing, 0.5, None));
        }
        assert!(!finds(&mut editing, 30.0, None));
        assert!(!finds(&mut editing, 0.5, None) && !finds(&mut editing, 0.5, None));
        assert!(finds(&mut editing, 30.0, None));
        // Lost: after three it takes what comes, and eight that did not fit are too many to begin again after the first that does.
        for _ in 0..20 {
            finds(&mut editing, 30.0, None);
        }
        assert!(!finds(&mut editing, 0.5, None) && !finds(&mut editing, 30.0, None));
        assert_eq!(editing.outliers(), 3);
    }

    /// Samples of a LiDAR that were used, the newest last, each by the time since then and how far it was off; the update takes a
    /// tenth.
    fn after(samples: &[(f64, f64)]) -> Editing {
        let mut editing = settled(Some(0.01));
        editing.watched[LIDAR].used = [None; BEFORE];
        for (since, off) in samples {
            use_one(&mut editing, 1.0 - since, *off);
        }
        editing
    }

    /// Off by 30 and by 29 before, of which the update takes a tenth: a filter that lags. One that jumps by as much is none.
    #[test]
    fn what_goes_on_as_the_sample_before_is_no_outlier() {
        for (before, doubted) in [(29.0, false), (33.0, false), (0.0, true), (-27.0, true)] {
            assert_eq!(finds(&mut after(&[(1.0, before)]), 30.0, None), doubted, "{before}");
        }
    }

    /// Three rows, of which one is off by x = v - e: -x^2 / (2 c) - 3/2 ln c against the same with c + 99, where c = 1 + 1 / n.
    #[test]
    fn a_sample_must_stand_out_from_the_mean_of_the_four_before() {
        for n in 1..=6_u32 {
            let c = 1.0 + 1.0 / f64::from(n.min(4));
            let edge = (3.0 * ((c + 99.0) / c).ln() / (1.0 / c - 1.0 / (c + 99.0))).sqrt();
            let samples: Vec<(f64, f64)> = (1..=n).rev().map(|k| (f64::from(k), 20.0)).collect();
            for (v, doubted) in [(18.0 + edge - 1e-9, false), (18.0 + edge + 1e-9, true)] {
                assert_eq!(finds(&mut after(&samples), v, None), doubted, "{n} {v}");
            }
        }
    }

    /// Eight periods, of 1 s; the odd one out is the one before them.
    #[test]
    fn what_was_long_ago_says_nothing() {
        let samples = |since: f64| [(since + 1.0, 400.0), (since, 0.0)];
        assert!(!finds(&mut after(&samples(7.0)), 180.0, None), "the mean of both");
        assert!(finds(&mut after(&samples(8.0)), 180.0, None), "the newer alone");
        // Neither: 50 times the root of two, and no less.
        assert!(!finds(&mut after(&samples(9.0)), 70.0, None) && finds(&mut after(&samples(9.0)), 71.0, None));
    }

    #[test]
    fn without_a_record_only_what_is_beyond_all_bounds_and_unlike_the_sample_before_is_doubted() {
        let start = || {
            let mut editing = settled(Some(0.01));
            editing.watched[LIDAR] = Watched::new(Rows::repeat(1.0), 1.0);
            editing
        };
        let (s, jump) = (50.0 * 2.0_f64.sqrt(), 50.0 * 2.0_f64.sqrt());
        for (v, moved, doubted) in [
            (s + 0.1, jump + 0.1, true),
            (s - 0.1, jump + 0.1, false),
            (s + 0.1, jump - 0.1, false),
            (1e6, 0.0, false),
            (1e6, -1e6, true),
        ] {
            let mut editing = start();
            // There is nothing before the first.
            assert!(!finds_at(&mut editing, 1.0, 1000.0, 1e6, None));
            assert_eq!(
                finds_at(&mut editing, 1.0, 1000.0 + moved, v, None),
                doubted,
                "{v} {moved}"
            );
        }
    }

    /// Off by nothing twice, then by 30, of which a tenth is taken in: 31 is the same change as 30, if that was used as a suspect, and
    /// a new one against the mean of all three if it was not.
    #[test]
    fn after_a_suspect_that_was_used_only_what_came_since_counts() {
        for (suspected, doubted) in [(0, true), (1, false)] {
            let mut editing = after(&[(3.0, 0.0), (2.0, 0.0)]);
            editing.watched[LIDAR].suspected = suspected;
            use_one(&mut editing, 0.0, 30.0);
            assert_eq!(finds(&mut editing, 31.0, None), doubted);
        }
    }

    /// Suspects that say the same, and suspects of which each says something else.
    #[test]
    fn not_more_than_three_in_a_row_are_passed_by_or_six_that_disagree() {
        let each = |v: &dyn Fn(f64) -> f64| {
            let mut editing = settled(Some(0.01));
            let at = |k| finds_at(&mut editing, f64::from(k), 1000.0, v(f64::from(k)), None);
            (1..=9).map(at).collect::<Vec<bool>>()
        };
        let outliers = each(&|t| if t % 2.0 > 0.5 { 30.0 } else { -40.0 });
        assert_eq!(outliers, [true, true, true, true, true, true, false, false, false]);
        // Off by a place, or by a velocity.
        for astray in [each(&|_| 30.0), each(&|t| 20.0 + 10.0 * t)] {
            assert_eq!(astray, [true, true, true, false, false, false, false, false, false]);
        }
        let mut editing = settled(Some(0.01));
        let mut found = |v: f64| finds(&mut editing, v, None);
        assert_eq!([30.0; 4].map(&mut found), [true, true, true, false]);
        // One that is used ends the row, whatever the next one says.
        assert!(!found(-40.0));
        // One that fits, and the filter may doubt again.
        assert!(!found(0.5) && found(30.0));
        assert_eq!(editing.outliers(), 4);
    }

    #[test]
    fn a_filter_that_knows_less_takes_more() {
        let step = step(20.0);
        let layout = Layout::new(&[Sensor::Lidar]);
        let unsure = Matrix6::from_diagonal_element(400.0);
        let sample = ranged(1.0, 1000.0);
        let found = |excess: Option<&Matrix6<f64>>| {
            let mut editing = settled(Some(0.01));
            editing.find(
                &sample,
                &step,
                200.0,
                || excess.copied(),
                layout,
                &RowVector::repeat(1.0),
            )
        };
        assert!(found(None)[Sensor::Lidar as usize]);
        assert_eq!(found(Some(&unsure)), [false; Sensor::COUNT]);
    }

    #[test]
    fn what_cannot_be_is_passed_by() {
        let layout = Layout::new(&[Sensor::Lidar, Sensor::Camera]);
        let mut editing = Editing::new(None, 3, &lidar());
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
        let mut sample = Sample::blank(1, 1.0);
        sample.accelerometer = Some(SpecificForce::Instant(nalgebra::Vector3::new(0.0, f64::NAN, 0.0)));
        let mut sample = Cow::Owned(sample);
        editing.remove_impossible(&mut sample, layout);
        assert!(sample.accelerometer.is_none() && editing.impossible() == 5);
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
