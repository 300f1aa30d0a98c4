//! What one estimate is worth against the truth at its epoch.

use nalgebra::{SMatrix, SVector, Vector3};
use stats::nees;

use crate::record::{Quantity, Record};
use crate::samples::{Estimate, TruthSample};
use crate::world::World;
use interface::Status;

/// Position error, m, below which a filter is never called diverged.
const LOST_BEYOND: f64 = 100.0;
/// Multiple of its own 3 sigma that a diverged filter exceeds.
const LOST_FACTOR: f64 = 10.0;

/// Compares an estimate with the truth at its epoch; `None` where the axes of the results are undefined.
pub fn score(world: &World, truth: &TruthSample, estimate: &Estimate) -> Option<Record> {
    let axes = world.axes.matrix(truth)?;
    let position = estimate.position - truth.position;
    let velocity = estimate.velocity - truth.velocity;
    let acceleration = Option::zip(estimate.acceleration, truth.acceleration).map(|(e, t)| e - t);
    let bias = Option::zip(estimate.bias, truth.bias).map(|(e, t)| e - t);

    let leading = 0..estimate.dimension;
    let mut elements = leading.clone().flat_map(|i| leading.clone().map(move |j| (i, j)));
    let covariance_finite = estimate
        .covariance
        .as_ref()
        .is_none_or(|p| elements.all(|at| p[at].is_finite()));
    let turned_variance = |block: usize| {
        let p = estimate.block(block).filter(|_| covariance_finite)?;
        Some((axes * p * axes.transpose()).diagonal())
    };
    let errors = [Some(position), Some(velocity), acceleration];
    let (nees, covariance_broken) = match &estimate.covariance {
        None => (None, false),
        Some(p) => normalised_error(p, estimate.dimension, &errors),
    };
    // Of a covariance that is none, no part is taken.
    let nees6 = match &estimate.covariance {
        Some(p) if estimate.dimension > 6 && !covariance_broken => normalised_error(p, 6, &errors).0,
        _ => nees.filter(|_| estimate.dimension == 6),
    };
    let measured = truth.measured && !matches!(estimate.status, Some(Status::Coasting | Status::Initialising));
    let finite = |v: Vector3<f64>| v.iter().all(|x| x.is_finite()).then_some(v);
    // Without a covariance there is none of the innovation either; what stands under those names is a start value.
    let has_covariance = estimate.dimension > 0;
    let position_variance = turned_variance(0);

    let mut record = Record::new(truth.epoch);
    // At most nine, as the rows of the covariance.
    record.dimension = estimate.dimension as u8;
    record.covariance_broken = covariance_broken;
    record.nis_rows = u8::try_from(estimate.nis_rows.unwrap_or(world.nis_rows)).unwrap_or(u8::MAX);
    record.lost = position.norm() > LOST_BEYOND
        && position_variance.is_none_or(|v| position.norm() > LOST_FACTOR * 3.0 * v.sum().max(0.0).sqrt());
    record.set(Quantity::Position, Some(axes * position), position_variance);
    record.set(Quantity::Velocity, Some(axes * velocity), turned_variance(1));
    record.set(
        Quantity::Acceleration,
        acceleration.map(|a| axes * a),
        turned_variance(2).filter(|_| acceleration.is_some()),
    );
    let bias_variance = estimate.bias_sigma.map(|s| s.component_mul(&s)).and_then(finite);
    record.set(Quantity::Bias, bias, bias_variance);
    for (part, quantity) in [Quantity::Residual, Quantity::ResidualRate].into_iter().enumerate() {
        let residual = estimate.residual[part].filter(|_| measured).and_then(finite);
        let variance = residual.and(estimate.residual_variance[part]).and_then(finite);
        record.set(quantity, residual, variance.filter(|_| has_covariance));
    }
    record.set(Quantity::JerkRoot, estimate.jerk_root.and_then(finite), None);
    record.set_true_acceleration(truth.acceleration.map(|a| axes * a));
    record.set_nees(nees, nees6);
    let rows = estimate.nis_rows.unwrap_or(world.nis_rows);
    let nis = estimate.nis.filter(|n| has_covariance && measured && n.is_finite());
    record.set_nis(nis.filter(|_| rows > 0).map(|n| n / f64::from(rows)));
    Some(record)
}

/// NEES divided by the dimension, and whether the covariance refused it.
fn normalised_error(
    covariance: &SMatrix<f64, 9, 9>,
    dimension: usize,
    errors: &[Option<Vector3<f64>>; 3],
) -> (Option<f64>, bool) {
    let mut stacked = SVector::<f64, 9>::zeros();
    for (block, error) in errors.iter().enumerate() {
        if let Some(error) = error {
            stacked.fixed_rows_mut::<3>(3 * block).copy_from(error);
        }
    }
    // Where the truth of a state is unknown its row has no error to normalise; the covariance is looked at all the same.
    let known = errors.iter().take(dimension.div_ceil(3)).all(Option::is_some);
    match nees(&stacked, covariance, dimension) {
        Ok(value) if value.is_finite() => (known.then_some(value / dimension as f64), false),
        _ => (None, true),
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::record::QUANTITIES;
    use crate::worlds;

    fn truth() -> TruthSample {
        TruthSample {
            count: 7,
            epoch: 6,
            time: 7.0,
            position: Vector3::new(10.0, 0.0, 0.0),
            acceleration: Some(Vector3::new(0.0, 3e-6, 0.0)),
            bias: Some(Vector3::zeros()),
            // R = -z, N = x, T = N x R = y.
            chaser: Some((Vector3::new(-10.0, 0.0, -7e6), Vector3::new(0.0, 7e3, 0.0))),
            measured: true,
            ..TruthSample::default()
        }
    }

    fn estimate() -> Estimate {
        Estimate {
            position: Vector3::new(11.0, 2.0, 3.0),
            velocity: Vector3::zeros(),
            acceleration: Some(Vector3::new(0.0, 3e-6, 0.0)),
            bias: Some(Vector3::new(1e-6, 0.0, 0.0)),
            covariance: Some(SMatrix::from_diagonal(&SVector::<f64, 9>::from_fn(|i, _| {
                (i + 1) as f64
            }))),
            dimension: 9,
            bias_sigma: Some(Vector3::repeat(2e-6)),
            residual: [Some(Vector3::repeat(0.5)), None],
            residual_variance: [Some(Vector3::repeat(0.25)), None],
            nis: Some(6.0),
            nis_rows: None,
            jerk_root: None,
            status: Some(Status::Tracking),
        }
    }

    #[test]
    fn a_case_worked_by_hand() {
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &estimate()).unwrap();
        assert_eq!(s.epoch, 6);
        assert_eq!(s.error(Quantity::Position), Some(Vector3::new(-3.0, 2.0, 1.0)));
        assert_eq!(s.variance(Quantity::Position), Some(Vector3::new(3.0, 2.0, 1.0)));
        assert_eq!(s.error(Quantity::Bias), Some(Vector3::new(1e-6, 0.0, 0.0)));
        assert_eq!(s.true_acceleration(), Some(Vector3::new(0.0, 3e-6, 0.0)));
        // 1/1 + 4/2 + 9/3 over nine states.
        assert!((s.nees().unwrap() - 6.0 / 9.0).abs() < 1e-15);
        // The acceleration is without error, so the sum is the same over six.
        assert!((s.nees6().unwrap() - 1.0).abs() < 1e-15);
        assert_eq!(s.nis(), Some(2.0));
        assert!(!s.lost && !s.covariance_broken);
    }

    #[test]
    fn rows_of_the_nis_are_the_filters_own_where_it_tells() {
        let nis = |rows| {
            let e = Estimate {
                nis_rows: rows,
                ..estimate()
            };
            score(&worlds::find("leo_venting").unwrap(), &truth(), &e)
                .unwrap()
                .nis()
        };
        assert_eq!([None, Some(2), Some(0)].map(nis), [Some(2.0), Some(3.0), None]);
    }

    #[test]
    fn coasting_samples_have_no_innovation() {
        let coasting = Estimate {
            status: Some(Status::Coasting),
            ..estimate()
        };
        let dropped = TruthSample {
            measured: false,
            ..truth()
        };
        for s in [
            score(&worlds::find("leo_venting").unwrap(), &truth(), &coasting),
            score(&worlds::find("leo_venting").unwrap(), &dropped, &estimate()),
        ] {
            let s = s.unwrap();
            assert_eq!(
                (s.nis(), s.error(Quantity::Residual), s.variance(Quantity::Residual)),
                (None, None, None)
            );
            assert!(s.nees().is_some());
        }
    }

    #[test]
    fn what_a_filter_lacks_is_absent() {
        let six = Estimate {
            dimension: 6,
            acceleration: None,
            ..estimate()
        };
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &six).unwrap();
        assert_eq!(
            (s.error(Quantity::Acceleration), s.variance(Quantity::Acceleration)),
            (None, None)
        );
        assert!((s.nees().unwrap() - 1.0).abs() < 1e-15);
        // Six states with a covariance, and an acceleration without one.
        let network = Estimate {
            dimension: 6,
            ..estimate()
        };
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &network).unwrap();
        assert_eq!(
            (s.error(Quantity::Acceleration), s.variance(Quantity::Acceleration)),
            (Some(Vector3::zeros()), None)
        );
        assert!((s.nees().unwrap() - 1.0).abs() < 1e-15);
        let none = Estimate {
            covariance: None,
            bias_sigma: None,
            nis: None,
            residual_variance: [None; 2],
            ..estimate()
        };
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &none).unwrap();
        assert_eq!(Quantity::ALL.map(|q| s.variance(q)), [None; QUANTITIES]);
        assert_eq!((s.nees(), s.nis(), s.covariance_broken), (None, None, false));
        let observer = Estimate {
            dimension: 0,
            covariance: None,
            ..estimate()
        };
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &observer).unwrap();
        assert_eq!((s.nis(), s.variance(Quantity::Residual)), (None, None));
        assert_eq!(s.error(Quantity::Residual), Some(Vector3::repeat(0.5)));
    }

    #[test]
    fn a_broken_covariance_is_told() {
        for value in [-1.0, f64::NAN] {
            let mut broken = estimate();
            broken.covariance.as_mut().unwrap()[(8, 8)] = value;
            let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &broken).unwrap();
            assert!(s.covariance_broken && s.nees().is_none() && s.nees6().is_none());
        }
        // Above the diagonal alone, and where the truth of a state is unknown.
        let mut broken = estimate();
        broken.covariance.as_mut().unwrap()[(1, 7)] = f64::NAN;
        let unknown = TruthSample {
            acceleration: None,
            ..truth()
        };
        for truth in [truth(), unknown] {
            let s = score(&worlds::find("leo_venting").unwrap(), &truth, &broken).unwrap();
            assert!(s.covariance_broken && s.nees().is_none() && s.nees6().is_none());
        }
        // What stands beyond the states of a filter is not its covariance.
        let six = Estimate {
            dimension: 6,
            acceleration: None,
            ..broken
        };
        let s = score(&worlds::find("leo_venting").unwrap(), &truth(), &six).unwrap();
        assert!(!s.covariance_broken && s.nees().is_some());
        assert!(s.variance(Quantity::Position).is_some() && s.variance(Quantity::Velocity).is_some());
    }

    #[test]
    fn lost_means_far_off_and_unaware_of_it() {
        let off = |metres: f64, sigma: f64, covariance: bool| {
            let mut e = estimate();
            e.position = truth().position + Vector3::new(metres, 0.0, 0.0);
            e.covariance = covariance.then(|| SMatrix::identity() * (sigma * sigma / 3.0));
            score(&worlds::find("leo_venting").unwrap(), &truth(), &e).unwrap().lost
        };
        assert!(!off(99.0, 1.0, true));
        assert!(off(101.0, 1.0, true));
        assert!(!off(101.0, 4.0, true));
        assert!(off(101.0, 0.0, false));
    }

    #[test]
    fn undefined_axes_give_no_score() {
        assert!(
            score(
                &worlds::find("leo_venting").unwrap(),
                &TruthSample::default(),
                &estimate()
            )
            .is_none()
        );
    }
}
