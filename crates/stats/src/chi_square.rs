//! Normalised squares at each epoch, held to the chi-square bounds of as many as there are.

use std::collections::BTreeMap;

use crate::{Bounds, StatsError, mean_chi_square_bounds};

/// NEES or NIS over the runs of a study, one cell for each epoch; runs may differ in their degrees of freedom.
#[derive(Debug, Clone, Default)]
pub struct ChiSquareEnsemble {
    cells: Vec<Cell>,
    /// Values, and those of them beyond what one in a thousand exceeds.
    values: u64,
    beyond: u64,
    /// That bound by degrees of freedom; not a number where it is not known yet.
    rare: Vec<f64>,
}

/// Confidence of the two-sided bounds whose upper one a value exceeds once in a thousand.
const RARE: f64 = 0.998;

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    freedom: u32,
    sum: f64,
}

impl ChiSquareEnsemble {
    /// Adds the value of one run at one epoch.
    ///
    /// * `epoch`: its cell is made if need be.
    /// * `value`: over its degrees of freedom.
    ///
    /// # Errors
    /// [`StatsError::NotFinite`]; then the ensemble is unchanged.
    pub fn add(&mut self, epoch: usize, value: f64, freedom: u32) -> Result<(), StatsError> {
        if !value.is_finite() {
            return Err(StatsError::NotFinite {
                what: "normalised square",
                epoch,
                value,
            });
        }
        if self.cells.len() <= epoch {
            self.cells.resize(epoch + 1, Cell::default());
        }
        self.values += 1;
        self.beyond += u64::from(value > self.rare(freedom));
        let cell = &mut self.cells[epoch];
        cell.freedom += freedom;
        cell.sum += value * f64::from(freedom);
        Ok(())
    }

    /// Value over its degrees of freedom that one in a thousand exceeds.
    fn rare(&mut self, freedom: u32) -> f64 {
        let place = freedom as usize;
        if self.rare.len() <= place {
            self.rare.resize(place + 1, f64::NAN);
        }
        if self.rare[place].is_nan() {
            let bounds = mean_chi_square_bounds(1, place, RARE);
            self.rare[place] = bounds.map_or(f64::INFINITY, |bounds| bounds.high);
        }
        self.rare[place]
    }

    /// Share of the values, over runs and time, that are beyond what one in a thousand exceeds by chance; `None` without values.
    pub fn share_beyond(&self) -> Option<f64> {
        (self.values > 0).then(|| self.beyond as f64 / self.values as f64)
    }

    /// Bounds of the mean over the runs at the epoch that has most degrees of freedom; `None` without values.
    pub fn bounds(&self, confidence: f64) -> Option<Bounds> {
        let most = self.cells.iter().map(|c| c.freedom).max()?;
        mean_chi_square_bounds(1, most as usize, confidence).ok()
    }

    /// Share of the epochs at which the mean over the runs is inside the bounds of the degrees of freedom it has there; `None`
    /// without values.
    pub fn share_inside(&self, confidence: f64) -> Option<f64> {
        let mut known: BTreeMap<u32, Option<Bounds>> = BTreeMap::new();
        let (mut inside, mut all) = (0.0, 0.0);
        for cell in self.cells.iter().filter(|c| c.freedom > 0) {
            let bounds = known
                .entry(cell.freedom)
                .or_insert_with(|| mean_chi_square_bounds(1, cell.freedom as usize, confidence).ok());
            if let Some(bounds) = bounds {
                all += 1.0;
                inside += f64::from(u8::from(bounds.contains(cell.sum / f64::from(cell.freedom))));
            }
        }
        (all > 0.0).then(|| inside / all)
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    /// Chi-square tables, 2.5 % and 97.5 %: of 10 degrees 3.247 and 20.483, of 4 degrees 0.4844 and 11.143.
    #[test]
    fn epochs_are_held_to_the_bounds_of_their_own_degrees() {
        let mut e = ChiSquareEnsemble::default();
        // Epoch 0: 6 and 4 degrees, 18 + 2.4 = 20.4 inside; epoch 2: 4 degrees, 11.2 outside.
        e.add(0, 3.0, 6).unwrap();
        e.add(0, 0.6, 4).unwrap();
        e.add(2, 2.8, 4).unwrap();
        assert_eq!(e.share_inside(0.95), Some(0.5));
        let bounds = e.bounds(0.95).unwrap();
        assert!((bounds.low - 0.3247).abs() < 1e-4 && (bounds.high - 2.0483).abs() < 1e-4);
        assert!(e.add(1, f64::NAN, 3).is_err());
        assert_eq!(ChiSquareEnsemble::default().share_inside(0.95), None);
        assert_eq!(ChiSquareEnsemble::default().share_beyond(), None);
        assert!(ChiSquareEnsemble::default().bounds(0.95).is_none());
    }

    /// Chi-square tables, 99.9 %: of 6 degrees 22.458, of 3 degrees 16.266.
    #[test]
    fn rare_values_are_counted_by_their_own_degrees() {
        let mut e = ChiSquareEnsemble::default();
        for (value, freedom) in [(22.4, 6), (22.5, 6), (16.2, 3), (16.3, 3), (17.0, 6)] {
            e.add(0, value / f64::from(freedom), freedom).unwrap();
        }
        assert_eq!(e.share_beyond(), Some(0.4));
    }
}
