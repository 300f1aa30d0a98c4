//! Comparison of two filters that met the same worlds.

use crate::{StatsError, standard_error};

/// Mean over runs of a difference, with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairedDifference {
    /// Runs compared.
    pub runs: usize,
    /// Mean of first minus second.
    pub mean: f64,
    /// Standard error of that mean: sample deviation of the differences over the root of their number. `None` for a
    /// single run.
    pub standard_error: Option<f64>,
}

/// Mean difference of two series that hold one value for each of the same runs; `None` for no runs.
///
/// What makes a world hard is hard for both filters and cancels, so the error is smaller than that of two
/// independent studies.
///
/// # Errors
/// [`StatsError::Unpaired`] when the series differ in length.
pub fn paired_difference(first: &[f64], second: &[f64]) -> Result<Option<PairedDifference>, StatsError> {
    if first.len() != second.len() {
        return Err(StatsError::Unpaired {
            left: first.len(),
            right: second.len(),
        });
    }
    if first.is_empty() {
        return Ok(None);
    }
    let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    Ok(Some(PairedDifference {
        runs: differences.len(),
        mean: differences.iter().sum::<f64>() / differences.len() as f64,
        standard_error: standard_error(&differences),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_by_hand() {
        // Differences 1, 2, 3: mean 2, sample variance 1, standard error 1/sqrt(3).
        let d = paired_difference(&[11.0, 22.0, 33.0], &[10.0, 20.0, 30.0])
            .unwrap()
            .unwrap();
        assert_eq!((d.runs, d.mean), (3, 2.0));
        assert!((d.standard_error.unwrap() - 3.0_f64.sqrt().recip()).abs() < 1e-15);
        assert_eq!(paired_difference(&[5.0], &[3.0]).unwrap().unwrap().standard_error, None);
        assert_eq!(paired_difference(&[], &[]), Ok(None));
    }

    #[test]
    fn series_of_different_runs_are_refused() {
        assert_eq!(
            paired_difference(&[1.0], &[]),
            Err(StatsError::Unpaired { left: 1, right: 0 })
        );
    }
}
