//! Covariances that are found as differences, of which rounding may have left none.

use nalgebra::{Matrix6, SymmetricEigen};
use numerics::spd;

/// What rounding leaves of the difference of two covariances, of their size.
const ROUNDING: f64 = 1e-12;
/// What may be added to the variances instead of a search for the nearest covariance, of their size: a sample adds more.
const LIFTS: [f64; 3] = [1e-9, 1e-8, 1e-7];
/// Most steps in search of six eigenvalues.
const EIGEN_STEPS: usize = 200;

/// What was found as a difference of covariances and must be one, not only be added to one.
///
/// * `of`: the larger, 6x6.
pub(crate) fn positive(found: Matrix6<f64>, of: &Matrix6<f64>) -> Matrix6<f64> {
    if found.cholesky().is_some() {
        return found;
    }
    as_covariance(found, of) + Matrix6::from_diagonal(&(of.diagonal() * ROUNDING))
}

/// What was found as a difference of covariances, made one that can be added to any: where rounding, or news of the
/// accelerometer's bias on the way, has left it none, one with a little more of the variances of what it is a part of; where that is
/// not enough, the nearest one in units of its deviations.
pub(super) fn as_covariance(found: Matrix6<f64>, of: &Matrix6<f64>) -> Matrix6<f64> {
    let variances = of.diagonal();
    let lifted = |by: f64| found + Matrix6::from_diagonal(&(variances * by));
    if lifted(ROUNDING).cholesky().is_some() {
        return found;
    }
    let least = LIFTS.into_iter().map(lifted).find(|lifted| lifted.cholesky().is_some());
    if let Some(covariance) = least {
        return covariance;
    }
    let deviations = variances.map(f64::sqrt);
    let scales = deviations * deviations.transpose();
    let scaled = spd::symmetrised(&found.component_div(&scales));
    match SymmetricEigen::try_new(scaled, f64::EPSILON, EIGEN_STEPS) {
        Some(mut eigen) => {
            eigen.eigenvalues.apply(|value| *value = value.max(0.0));
            spd::symmetrised(&eigen.recompose().component_mul(&scales))
        }
        None => Matrix6::from_diagonal(&found.diagonal().map(|v| v.max(0.0))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    /// A difference that is a covariance stays as it is; of one that is none, what is negative goes, in units of the deviations: the
    /// rest keeps its correlations.
    #[test]
    fn a_difference_becomes_a_covariance_and_loses_no_more_than_it_must() {
        let scale = Vector6::new(1e3, 1e3, 1e3, 1e-3, 1e-3, 1e-3);
        let of = Matrix6::from_diagonal(&scale.component_mul(&scale));
        let along = Vector6::new(1.0, 0.5, 0.0, 0.3, 0.0, 0.0).component_mul(&scale);
        let found = along * along.transpose() * 0.01;
        assert_eq!(as_covariance(found, &of), found);
        // Perpendicular to it in units of the deviations.
        let across = Vector6::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0).component_mul(&scale);
        let spoilt = found - across * across.transpose() * 1e-4;
        let difference = (as_covariance(spoilt, &of) - found).component_div(&(scale * scale.transpose()));
        assert!(difference.amax() < 1e-15, "{difference}");
        assert_eq!(as_covariance(spoilt, &of), as_covariance(spoilt, &of).transpose());
    }

    /// What is added to nothing else must be the covariance of something, however much has gone.
    #[test]
    fn what_stands_alone_is_positive() {
        let of = Matrix6::from_diagonal(&Vector6::new(1e6, 1e6, 1e6, 1.0, 1.0, 1.0));
        let sound = of * 1e-3;
        assert_eq!(positive(sound, &of), sound);
        let along = Vector6::new(1e3, -1e3, 0.0, 1.0, 0.0, 1.0);
        for share in [1e-16, 1e-12, 1e-6, 1.0] {
            let spoilt = of * 1e-15 - along * along.transpose() * share;
            let found = positive(spoilt, &of);
            assert!(found.cholesky().is_some(), "share {share}: {found}");
        }
    }
}
