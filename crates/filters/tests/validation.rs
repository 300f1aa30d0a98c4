//! Figures derived on paper, against which the code is held.

use filters::jerk;
use nalgebra::{Matrix3, RowVector3, Vector3};

/// What a filter with three integrators claims and what it does when the jerk that it assumes does not exist.
///
/// In continuous time, with unit jerk density and unit measurement noise, its covariance is
/// P = [2 2 1; 2 3 2; 1 2 2], its gain (2, 2, 1), and the covariance of its errors under measurement noise alone solves a
/// Lyapunov equation: [5/3 4/3 1/2; 4/3 3/2 2/3; 1/2 2/3 1/3]. So the claimed variances exceed the true ones by 6/5, 2 and
/// 6, whatever the density, and NEES per state is tr(P^-1 Sigma) / 3 = 1/2. These are the ratios that every Q far too large
/// shows in the study.
#[test]
fn val_a_filter_that_assumes_a_jerk_which_is_not_there_overstates_by_known_factors() {
    for density in [1.0, 1e-8] {
        // Short steps against the time constant (R / q)^(1/6) of the filter.
        let dt = 2e-3 * f64::powf(1.0 / density, 1.0 / 6.0);
        let f = Matrix3::new(1.0, dt, dt * dt / 2.0, 0.0, 1.0, dt, 0.0, 0.0, 1.0);
        let h = RowVector3::new(1.0, 0.0, 0.0);
        let r = 1.0 / dt;
        let q = jerk::gamma(dt) * density;
        let (mut p, mut errors) = (Matrix3::identity(), Matrix3::zeros());
        for _ in 0..40_000 {
            let prior = f * p * f.transpose() + q;
            let gain: Vector3<f64> = prior * h.transpose() / ((h * prior * h.transpose())[0] + r);
            let keep = Matrix3::identity() - gain * h;
            p = keep * prior * keep.transpose() + gain * gain.transpose() * r;
            // The same gain on errors that no jerk drives.
            errors = keep * f * errors * f.transpose() * keep.transpose() + gain * gain.transpose() * r;
        }
        for (state, factor) in [6.0 / 5.0, 2.0, 6.0].into_iter().enumerate() {
            let ratio = p[(state, state)] / errors[(state, state)];
            // The step is finite.
            assert!(
                (ratio / factor - 1.0).abs() < 0.01,
                "density {density}, state {state}: {ratio}"
            );
        }
        let nees = (p.try_inverse().map_or(f64::NAN, |inverse| (inverse * errors).trace())) / 3.0;
        assert!((nees - 0.5).abs() < 0.005, "density {density}: {nees}");
    }
}
