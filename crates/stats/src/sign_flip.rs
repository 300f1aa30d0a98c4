//! What chance alone makes of a mean error whose epochs follow one another.

use nalgebra::Vector3;

use crate::ensemble::{LEAST_RUNS, student};

/// Ways to flip the signs of the runs that are tried.
pub const FLIPS: usize = 199;
/// Most epochs that are looked at, evenly spaced: neighbours say much the same.
const EPOCHS: usize = 256;
/// Vectors of an epoch.
const VECTORS: usize = 2;
/// Of six runs there are 32 different ways to flip; of five, 16, of which none is one in twenty.
const LEAST_FLIPPED: u32 = LEAST_RUNS + 1;

/// Sums of errors over runs, with the signs of whole runs flipped at random.
///
/// Where the errors of a run are as likely as their negatives, flipping the sign of a whole run changes no distribution and keeps
/// what its epochs and axes have to do with one another. So the mean error in sigmas of many flips shows what chance alone makes
/// of it, however few of the epochs are independent. It needs no model of the noise; of a skewed error it is an approximation.
#[derive(Debug, Clone)]
pub struct SignFlips {
    from: usize,
    stride: usize,
    cells: Vec<Cell>,
    flips: Vec<[Vector3<f64>; VECTORS]>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    runs: u32,
    squares: [Vector3<f64>; VECTORS],
}

impl SignFlips {
    /// Nothing yet.
    ///
    /// * `epochs`: of a run; those before `from` do not count.
    pub fn new(epochs: usize, from: usize) -> Self {
        let counting = epochs.saturating_sub(from);
        let stride = counting.div_ceil(EPOCHS).max(1);
        let cells = counting.div_ceil(stride);
        Self {
            from,
            stride,
            cells: vec![Cell::default(); cells],
            flips: vec![[Vector3::zeros(); VECTORS]; cells * FLIPS],
        }
    }

    /// Adds the errors of one run at one epoch; one that does not count or is not looked at changes nothing.
    ///
    /// * `signs`: true flips, the same at every epoch of the run.
    pub fn add(&mut self, epoch: usize, errors: &[Vector3<f64>; VECTORS], signs: &[bool; FLIPS]) {
        let Some(counting) = epoch.checked_sub(self.from).filter(|e| e.is_multiple_of(self.stride)) else {
            return;
        };
        let place = counting / self.stride;
        let Some(cell) = self.cells.get_mut(place) else { return };
        cell.runs += 1;
        for (sum, error) in cell.squares.iter_mut().zip(errors) {
            *sum += error.component_mul(error);
        }
        for (sums, flipped) in self.flips[place * FLIPS..].iter_mut().zip(signs) {
            for (sum, error) in sums.iter_mut().zip(errors) {
                if *flipped {
                    *sum -= error;
                } else {
                    *sum += error;
                }
            }
        }
    }

    /// Value that [`crate::mean_error_in_sigmas`] of these vectors exceeds in 5 % of studies by chance alone; `None` where no
    /// epoch has six runs.
    pub fn bound(&self) -> Option<f64> {
        let mut sums = [(0.0, 0.0); FLIPS];
        for (cell, flips) in self.cells.iter().zip(self.flips.chunks_exact(FLIPS)) {
            if cell.runs < LEAST_FLIPPED {
                continue;
            }
            let n = f64::from(cell.runs);
            for ((count, total), flip) in sums.iter_mut().zip(flips) {
                for (sum, squares) in flip.iter().zip(&cell.squares) {
                    let scores = student(&(sum / n), &(squares / n), cell.runs);
                    for score in scores.iter().filter(|s| s.is_finite()) {
                        *count += 1.0;
                        *total += score;
                    }
                }
            }
        }
        let mut found: Vec<f64> = sums
            .iter()
            .filter(|(n, _)| *n > 0.0)
            .map(|(n, sum)| f64::sqrt(sum / n))
            .collect();
        found.sort_by(f64::total_cmp);
        // With the study's own, 200 equally likely places; ten of them lie above the 190th.
        (found.len() == FLIPS).then(|| found[FLIPS - 10])
    }
}
