//! Three-axis accelerometer with a bias that walks as a first-order Gauss-Markov process.

use nalgebra::{Matrix3, Vector3};
use numerics::math;

/// Reading of the accelerometer.
///
/// * `specific_force_n`: acceleration of the chaser without gravity, N, m/s2.
/// * `dcm_bc_n`: maps N to chaser body axes.
/// * `b_c_bc`: bias; `noise`: noise of this sample; both chaser body axes, m/s2.
/// * returns: `alpha_c_bc`, chaser body axes, m/s2.
pub fn reading(
    specific_force_n: &Vector3<f64>,
    dcm_bc_n: &Matrix3<f64>,
    b_c_bc: &Vector3<f64>,
    noise: &Vector3<f64>,
) -> Vector3<f64> {
    dcm_bc_n * specific_force_n + b_c_bc + noise
}

/// Bias after `dt`: decay and a random step.
///
/// * `b_c_bc`: bias now, m/s2.
/// * `dt`: s, not negative.
/// * `time_constant`: of the decay, s, positive; infinity makes a random walk.
/// * `sigma`: standard deviation gained in the first second, m/s2 per sqrt(s).
/// * `w`: unit noise.
/// * returns: exp(-dt/tau) b + sigma sqrt(dt) w, m/s2. Two steps of dt/2 differ from one of dt by a relative dt/tau.
///
/// Source: Mamich and Zanetti, Sec. IV (a Gauss-Markov bias whose discrete noise is given per 1 s step).
pub fn bias_step(b_c_bc: &Vector3<f64>, dt: f64, time_constant: f64, sigma: f64, w: &Vector3<f64>) -> Vector3<f64> {
    b_c_bc * math::exp(-dt / time_constant) + w * (sigma * dt.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal3;
    use numerics::{Source, stream};

    #[test]
    fn reading_turns_the_force_and_adds_bias_and_noise() {
        // Body x is N y, body y is N z, body z is N x.
        let dcm = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
        let alpha = reading(
            &Vector3::new(1.0, 2.0, 4.0),
            &dcm,
            &Vector3::new(0.5, 0.25, 0.125),
            &Vector3::new(-0.0625, 0.0, 8.0),
        );
        assert!((alpha - Vector3::new(2.4375, 4.25, 9.125)).amax() < 1e-15, "{alpha}");
    }

    #[test]
    fn bias_decays_to_a_third_in_a_time_constant() {
        let (b, dt) = (Vector3::new(1.0, -2.0, 3.0), 0.01);
        let end = (0..360_000).fold(b, |b, _| bias_step(&b, dt, 3600.0, 1.0, &Vector3::zeros()));
        assert!((end - b / std::f64::consts::E).amax() < 1e-9, "{end}");
    }

    /// Steady variance and autocorrelation of the first-order process against theory, in units of sampling error.
    #[test]
    fn bias_statistics_match_a_gauss_markov_process() {
        let (dt, tau, sigma) = (2.0, 20.0, 3.0);
        let phi: f64 = f64::exp(-dt / tau);
        // b+ = phi b + sigma sqrt(dt) w has the variance sigma^2 dt / (1 - phi^2).
        let variance = sigma * sigma * dt / (1.0 - phi * phi);
        let mut rng = stream(1, 0, Source::AccelerometerBias);
        let n = 200_000_usize;
        let mut b = normal3(&mut rng) * variance.sqrt();
        let path: Vec<Vector3<f64>> = (0..n)
            .map(|_| {
                b = bias_step(&b, dt, tau, sigma, &normal3(&mut rng));
                b
            })
            .collect();
        for lag in [0, 1, 5, 10, 30] {
            for axis in 0..3 {
                let pairs = n - lag;
                let products = path.iter().zip(&path[lag..]).map(|(b, later)| b[axis] * later[axis]);
                let sample = products.sum::<f64>() / (pairs as f64 * variance);
                let theory = phi.powi(lag as i32);
                // Bartlett: the sampling variance of an autocovariance is at most 2 sum rho^2 / N.
                let bound = 3.0 * (2.0 * (1.0 + phi * phi) / (1.0 - phi * phi) / pairs as f64).sqrt();
                assert!(
                    (sample - theory).abs() < bound,
                    "lag {lag}, axis {axis}: {sample} and {theory} within {bound}"
                );
            }
        }
    }
}
