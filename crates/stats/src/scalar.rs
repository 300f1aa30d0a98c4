//! Ensemble of a non-negative scalar such as NEES or NIS.

use crate::{Bounds, LogHistogram, StatsError};

/// A non-negative scalar over the runs of a study: its mean at each epoch, and mean and median over runs and time.
#[derive(Debug, Clone)]
pub struct ScalarEnsemble {
    cells: Vec<(u32, f64)>,
    from: usize,
    histogram: LogHistogram,
}

impl ScalarEnsemble {
    /// An empty ensemble of `epochs` epochs, of which those before `from` do not count towards mean and median over time.
    pub fn new(epochs: usize, from: usize) -> Self {
        Self {
            cells: vec![(0, 0.0); epochs],
            from,
            histogram: LogHistogram::default(),
        }
    }

    /// Adds the value of one run at one epoch.
    ///
    /// # Errors
    /// [`StatsError::EpochOutOfRange`], [`StatsError::NotFinite`]; then the ensemble is unchanged.
    pub fn add(&mut self, epoch: usize, value: f64) -> Result<(), StatsError> {
        let epochs = self.cells.len();
        let (runs, sum) = self
            .cells
            .get_mut(epoch)
            .ok_or(StatsError::EpochOutOfRange { epoch, epochs })?;
        if !value.is_finite() {
            return Err(StatsError::NotFinite {
                what: "scalar",
                epoch,
                value,
            });
        }
        *runs += 1;
        *sum += value;
        if epoch >= self.from {
            self.histogram.add(value);
        }
        Ok(())
    }

    /// Number of runs and their mean at one epoch; `None` beyond the last epoch or where no run has been added.
    pub fn at(&self, epoch: usize) -> Option<(u32, f64)> {
        let (runs, sum) = *self.cells.get(epoch)?;
        (runs > 0).then(|| (runs, sum / f64::from(runs)))
    }

    /// Mean over runs and time; `None` without values.
    pub fn mean(&self) -> Option<f64> {
        let mut values = 0.0;
        let mut total = 0.0;
        for (runs, sum) in self.cells.iter().skip(self.from) {
            values += f64::from(*runs);
            total += sum;
        }
        (values > 0.0).then(|| total / values)
    }

    /// Median over runs and time, to 0.024 %; `None` without values.
    pub fn median(&self) -> Option<f64> {
        self.histogram.median()
    }

    /// Share of epochs at which the mean over the runs is within bounds; `None` without values.
    ///
    /// * `bounds`: for a given number of runs; epochs differ in it when some runs have no value.
    pub fn share_of_epochs_inside(&self, bounds: impl Fn(u32) -> Option<Bounds>) -> Option<f64> {
        let mut known: Option<(u32, Option<Bounds>)> = None;
        let (mut inside, mut all) = (0.0, 0.0);
        for epoch in self.from..self.cells.len() {
            let Some((runs, mean)) = self.at(epoch) else { continue };
            let current = match known {
                Some((for_runs, bounds)) if for_runs == runs => bounds,
                _ => bounds(runs),
            };
            known = Some((runs, current));
            if let Some(bounds) = current {
                all += 1.0;
                inside += if bounds.contains(mean) { 1.0 } else { 0.0 };
            }
        }
        (all > 0.0).then(|| inside / all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn early_epochs_count_by_epoch_only() {
        let mut s = ScalarEnsemble::new(3, 1);
        for (epoch, value) in [(0, 100.0), (1, 1.0), (1, 3.0), (2, 8.0)] {
            s.add(epoch, value).unwrap();
        }
        assert_eq!(s.at(0), Some((1, 100.0)));
        assert_eq!(s.at(1), Some((2, 2.0)));
        assert_eq!(s.mean(), Some(4.0));
        // Epoch 1 (two runs) inside [1, 3], epoch 2 (one run) outside [0, 7].
        let bounds = |runs| {
            Some(if runs == 2 {
                Bounds { low: 1.0, high: 3.0 }
            } else {
                Bounds { low: 0.0, high: 7.0 }
            })
        };
        assert_eq!(s.share_of_epochs_inside(bounds), Some(0.5));
        assert_eq!(s.share_of_epochs_inside(|_| None), None);
    }

    #[test]
    fn bad_values_are_refused() {
        let mut s = ScalarEnsemble::new(1, 0);
        assert!(matches!(s.add(0, f64::INFINITY), Err(StatsError::NotFinite { .. })));
        assert!(matches!(
            s.add(1, 1.0),
            Err(StatsError::EpochOutOfRange { epoch: 1, epochs: 1 })
        ));
        assert!(s.at(0).is_none() && s.mean().is_none() && s.median().is_none());
    }
}
