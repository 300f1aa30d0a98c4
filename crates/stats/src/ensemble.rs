//! Ensemble of 3-vector errors: over the runs at each epoch, then over time.

use std::ops::Range;

use nalgebra::Vector3;

use crate::StatsError;
use crate::median::median;

/// Fewest runs that a sample sigma is formed from. Of four its relative standard error, 1 / sqrt(2 (n - 1)), is 41 %, and the
/// square of a mean over its standard error has an expectation of (n - 1) / (n - 3) = 3; from five on both are below 36 % and 2.
pub const LEAST_RUNS: u32 = 5;

/// Errors of one 3-vector quantity over the runs of a study, one cell for each epoch.
///
/// Fed run by run with [`Ensemble::add`]; holds sums only, so its size does not depend on the number of runs.
#[derive(Debug, Clone)]
pub struct Ensemble {
    cells: Vec<Cell>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    runs: u32,
    sum: Vector3<f64>,
    sum_of_squares: Vector3<f64>,
    runs_with_variance: u32,
    sum_of_variances: Vector3<f64>,
    inside_3_sigma: [u32; 3],
}

/// Moments of an error over the runs, at one epoch. Same axes and unit as the errors fed in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpochMoments {
    /// Number of runs.
    pub runs: u32,
    /// Mean error, Eq. (31).
    pub mean: Vector3<f64>,
    /// Second moment about zero, not about the mean: the diagonal of Eq. (32).
    pub second_moment: Vector3<f64>,
    /// Mean of the variances the filter claimed: the diagonal of Eq. (33). `None` when it claimed none.
    pub mean_variance: Option<Vector3<f64>>,
    /// Share of the runs whose error was within three of the filter's own sigmas, by axis.
    pub inside_3_sigma: Option<Vector3<f64>>,
}

impl EpochMoments {
    /// Root of the second moment, by axis.
    pub fn sample_sigma(&self) -> Vector3<f64> {
        self.second_moment.map(f64::sqrt)
    }

    /// Root of the mean claimed variance, by axis; NaN where that mean is negative.
    pub fn estimated_sigma(&self) -> Option<Vector3<f64>> {
        self.mean_variance.map(|v| v.map(f64::sqrt))
    }

    /// Estimated over sample sigma, by axis. Above 1 the filter is too modest, below 1 too sure of itself.
    pub fn ratio(&self) -> Option<Vector3<f64>> {
        self.estimated_sigma().map(|s| s.component_div(&self.sample_sigma()))
    }
}

impl Ensemble {
    /// An empty ensemble of `epochs` epochs.
    pub fn new(epochs: usize) -> Self {
        Self {
            cells: vec![Cell::default(); epochs],
        }
    }

    /// Number of epochs.
    pub fn epochs(&self) -> usize {
        self.cells.len()
    }

    /// Adds the error of one run at one epoch.
    ///
    /// * `error`: estimate minus truth.
    /// * `variance`: what the filter claims for it, same axes; `None` for a filter without a covariance.
    ///
    /// # Errors
    /// [`StatsError::EpochOutOfRange`], [`StatsError::NotFinite`]; then the ensemble is unchanged.
    pub fn add(
        &mut self,
        epoch: usize,
        error: &Vector3<f64>,
        variance: Option<&Vector3<f64>>,
    ) -> Result<(), StatsError> {
        let epochs = self.cells.len();
        let cell = self
            .cells
            .get_mut(epoch)
            .ok_or(StatsError::EpochOutOfRange { epoch, epochs })?;
        require_finite("error", epoch, error)?;
        if let Some(variance) = variance {
            require_finite("variance", epoch, variance)?;
        }
        cell.runs += 1;
        cell.sum += error;
        cell.sum_of_squares += error.component_mul(error);
        if let Some(variance) = variance {
            cell.runs_with_variance += 1;
            cell.sum_of_variances += variance;
            for axis in 0..3 {
                // Squares, so that a negative variance holds no error inside.
                if error[axis] * error[axis] <= 9.0 * variance[axis] {
                    cell.inside_3_sigma[axis] += 1;
                }
            }
        }
        Ok(())
    }

    /// Moments at one epoch; `None` beyond the last epoch or where no run has been added.
    pub fn at(&self, epoch: usize) -> Option<EpochMoments> {
        let cell = self.cells.get(epoch).filter(|c| c.runs > 0)?;
        let n = f64::from(cell.runs);
        let with_variance = f64::from(cell.runs_with_variance);
        let has_variance = cell.runs_with_variance > 0;
        Some(EpochMoments {
            runs: cell.runs,
            mean: cell.sum / n,
            second_moment: cell.sum_of_squares / n,
            mean_variance: has_variance.then(|| cell.sum_of_variances / with_variance),
            inside_3_sigma: has_variance
                .then(|| Vector3::from(cell.inside_3_sigma.map(|inside| f64::from(inside) / with_variance))),
        })
    }

    /// Moments of every epoch of the range that has runs, in order of time; the range may reach beyond the last epoch.
    pub fn over(&self, epochs: Range<usize>) -> impl Iterator<Item = EpochMoments> + '_ {
        clip(epochs, self.cells.len()).filter_map(|epoch| self.at(epoch))
    }

    /// Moments of the epochs that have runs enough for a sample sigma.
    fn carrying(&self, epochs: Range<usize>) -> impl Iterator<Item = EpochMoments> + '_ {
        self.over(epochs).filter(|m| m.runs >= LEAST_RUNS)
    }

    /// Root mean square, over runs and epochs, of the norm of the error; `None` without any error.
    pub fn rmse(&self, epochs: Range<usize>) -> Option<f64> {
        let mut runs = 0.0;
        let mut sum = 0.0;
        for cell in self.cells.get(clip(epochs, self.cells.len())).unwrap_or_default() {
            runs += f64::from(cell.runs);
            sum += cell.sum_of_squares.sum();
        }
        (runs > 0.0).then(|| (sum / runs).sqrt())
    }

    /// Root mean square, over runs and epochs, of the error on each axis; `None` without any error.
    pub fn rmse_by_axis(&self, epochs: Range<usize>) -> Option<Vector3<f64>> {
        let mut runs = 0.0;
        let mut sum = Vector3::zeros();
        for cell in self.cells.get(clip(epochs, self.cells.len())).unwrap_or_default() {
            runs += f64::from(cell.runs);
            sum += cell.sum_of_squares;
        }
        (runs > 0.0).then(|| (sum / runs).map(f64::sqrt))
    }

    /// Median over epochs of estimated over sample sigma, for each axis alone, from epochs with [`LEAST_RUNS`]; `None` without
    /// any or without variances.
    pub fn ratio_by_axis(&self, epochs: Range<usize>) -> Option<[f64; 3]> {
        let ratios: Vec<Vector3<f64>> = self.carrying(epochs).filter_map(|m| m.ratio()).collect();
        let axis = |a: usize| median(ratios.iter().map(|r| r[a]));
        Some([axis(0)?, axis(1)?, axis(2)?])
    }

    /// The same over epochs and axes together.
    pub fn ratio(&self, epochs: Range<usize>) -> Option<f64> {
        median(
            self.carrying(epochs)
                .filter_map(|m| m.ratio())
                .flat_map(|r| [r[0], r[1], r[2]]),
        )
    }

    /// Share, over runs, epochs and axes, of errors within three of the filter's own sigmas; `None` without variances.
    pub fn coverage(&self, epochs: Range<usize>) -> Option<f64> {
        let mut inside = 0.0;
        let mut all = 0.0;
        for cell in self.cells.get(clip(epochs, self.cells.len())).unwrap_or_default() {
            inside += cell.inside_3_sigma.iter().copied().map(f64::from).sum::<f64>();
            all += 3.0 * f64::from(cell.runs_with_variance);
        }
        (all > 0.0).then(|| inside / all)
    }
}

/// Root mean square, over epochs, axes and the given quantities, of mean error / (sample sigma about the mean / sqrt(runs)).
///
/// About 1 when the mean error is nothing but the noise of a finite sample. Epochs of fewer than [`LEAST_RUNS`] runs do not
/// count; `None` when there is nothing to average.
pub fn mean_error_in_sigmas(quantities: &[&Ensemble], epochs: Range<usize>) -> Option<f64> {
    root_mean_square(quantities, epochs, |m| student(&m.mean, &m.second_moment, m.runs))
}

/// The same with the sample sigma about zero, the root of Eq. (32) of Mamich and Zanetti: never above sqrt(runs).
pub fn mean_error_in_sigmas_about_zero(quantities: &[&Ensemble], epochs: Range<usize>) -> Option<f64> {
    root_mean_square(quantities, epochs, |m| {
        let scores = (m.mean * f64::from(m.runs).sqrt()).component_div(&m.sample_sigma());
        scores.component_mul(&scores)
    })
}

/// Square of Student's t of a mean, by axis.
pub(crate) fn student(mean: &Vector3<f64>, second_moment: &Vector3<f64>, runs: u32) -> Vector3<f64> {
    let freedom = f64::from(runs) - 1.0;
    let squares = mean.component_mul(mean);
    let about_mean = (second_moment - squares).map(|v| v.max(0.0));
    squares.component_div(&about_mean) * freedom
}

fn root_mean_square(
    quantities: &[&Ensemble],
    epochs: Range<usize>,
    squares: impl Fn(&EpochMoments) -> Vector3<f64>,
) -> Option<f64> {
    let mut n = 0.0;
    let mut sum = 0.0;
    for moments in quantities.iter().flat_map(|q| q.carrying(epochs.clone())) {
        // 0/0 where every run was exact: no noise to measure against.
        for square in squares(&moments).iter().filter(|s| s.is_finite()) {
            n += 1.0;
            sum += square;
        }
    }
    (n > 0.0).then(|| f64::sqrt(sum / n))
}

fn clip(range: Range<usize>, len: usize) -> Range<usize> {
    range.start.min(len)..range.end.min(len)
}

fn require_finite(what: &'static str, epoch: usize, v: &Vector3<f64>) -> Result<(), StatsError> {
    match v.iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(StatsError::NotFinite { what, epoch, value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_case_worked_by_hand() {
        let mut e = Ensemble::new(2);
        let one = Vector3::new(1.0, 1.0, 1.0);
        e.add(0, &Vector3::new(1.0, -2.0, 4.0), Some(&one)).unwrap();
        e.add(0, &Vector3::new(3.0, -2.0, 0.0), Some(&(3.0 * one))).unwrap();
        let m = e.at(0).unwrap();
        assert_eq!(m.mean, Vector3::new(2.0, -2.0, 2.0));
        assert_eq!(m.second_moment, Vector3::new(5.0, 4.0, 8.0));
        assert_eq!(m.mean_variance, Some(Vector3::new(2.0, 2.0, 2.0)));
        // 4 > 3 sigma = 3 in the first run only.
        assert_eq!(m.inside_3_sigma, Some(Vector3::new(1.0, 1.0, 0.5)));
        assert_eq!(e.rmse(0..2), Some(17.0_f64.sqrt()));
        let by_axis = Vector3::new(5.0_f64.sqrt(), 2.0, 8.0_f64.sqrt());
        assert_eq!((e.rmse_by_axis(0..2), e.rmse_by_axis(1..2)), (Some(by_axis), None));
        assert!(e.at(1).is_none() && e.rmse(1..2).is_none() && e.ratio(1..2).is_none());
        // A range open at the end costs no more than the epochs there are.
        assert_eq!(e.over(0..usize::MAX).count(), 1);
        assert_eq!(e.ratio(0..usize::MAX), e.ratio(0..1));
    }

    #[test]
    fn refused_values_leave_no_trace() {
        let mut e = Ensemble::new(1);
        let ok = Vector3::repeat(1.0);
        let bad = Vector3::new(0.0, f64::NAN, 0.0);
        assert!(matches!(
            e.add(0, &bad, None),
            Err(StatsError::NotFinite { what: "error", .. })
        ));
        assert!(matches!(
            e.add(0, &ok, Some(&bad)),
            Err(StatsError::NotFinite { what: "variance", .. })
        ));
        assert_eq!(
            e.add(1, &ok, None),
            Err(StatsError::EpochOutOfRange { epoch: 1, epochs: 1 })
        );
        assert!(e.at(0).is_none());
    }

    #[test]
    fn without_variances_there_is_no_ratio() {
        let mut e = Ensemble::new(1);
        e.add(0, &Vector3::repeat(1.0), None).unwrap();
        assert!(e.ratio(0..1).is_none() && e.ratio_by_axis(0..1).is_none() && e.coverage(0..1).is_none());
        assert_eq!(e.rmse(0..9), Some(3.0_f64.sqrt()));
    }
}
