//! How well a finite number of independent runs fixes a mean or an RMSE.

/// Standard error of the mean of independent values, in their unit: sample deviation over the root of their number.
///
/// `None` for fewer than two values, which show no spread.
pub fn standard_error(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (values.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt())
}

/// Standard error of an RMSE pooled over runs, from the mean square error of each run.
///
/// Errors within a run follow one another, so only the runs count as independent. To first order the root of a mean m
/// has the standard error of m over twice the root of m.
///
/// * `mean_squares`: one for each run, in the square of the unit of the RMSE.
/// * returns: in the unit of the RMSE; `None` for fewer than two runs or where all are without error.
pub fn rmse_standard_error(mean_squares: &[f64]) -> Option<f64> {
    let pooled = mean_squares.iter().sum::<f64>() / mean_squares.len() as f64;
    standard_error(mean_squares)
        .map(|error| error / (2.0 * pooled.sqrt()))
        .filter(|error| error.is_finite())
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    #[test]
    fn worked_by_hand() {
        // 1, 2, 3: sample variance 1, error of the mean 1/sqrt(3); RMSE sqrt(2), so 1/sqrt(3)/(2 sqrt(2)).
        assert!((standard_error(&[3.0, 1.0, 2.0]).unwrap() - 3.0_f64.sqrt().recip()).abs() < 1e-15);
        assert!((rmse_standard_error(&[3.0, 1.0, 2.0]).unwrap() - 24.0_f64.sqrt().recip()).abs() < 1e-15);
        assert_eq!(standard_error(&[5.0, 5.0]), Some(0.0));
    }

    #[test]
    fn too_few_runs_or_no_error_have_none() {
        assert_eq!((standard_error(&[]), standard_error(&[1.0])), (None, None));
        assert_eq!(
            (rmse_standard_error(&[1.0]), rmse_standard_error(&[0.0, 0.0])),
            (None, None)
        );
    }
}
