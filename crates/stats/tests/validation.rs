//! Ensembles drawn from known distributions: brute force over the stored draws, and what theory expects.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use numerics::{Source, stream};
use rand_distr::{Distribution, StandardNormal};
use stats::{
    Ensemble, FLIPS, ScalarEnsemble, SignFlips, mean_chi_square_bounds, mean_error_in_sigmas,
    mean_error_in_sigmas_about_zero, nees,
};

fn normal3(generator: &mut numerics::Generator) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(generator))
}

/// Every statistic against a second computation that keeps all errors and loops over them by definition.
#[test]
fn val_ensemble_against_brute_force() {
    let (runs, epochs, from) = (7, 12, 3);
    let mut generator = stream(5, 0, Source::Lidar);
    let mut errors = vec![vec![Vector3::zeros(); epochs]; runs];
    let mut variances = errors.clone();
    let mut ensemble = Ensemble::new(epochs);
    for run in 0..runs {
        for epoch in 0..epochs {
            errors[run][epoch] = normal3(&mut generator) * 2.0;
            variances[run][epoch] = normal3(&mut generator).map(|v| 0.5 + v * v);
            ensemble
                .add(epoch, &errors[run][epoch], Some(&variances[run][epoch]))
                .unwrap();
        }
    }
    let n = runs as f64;
    let mut ratios = Vec::new();
    let (mut norm2, mut score2, mut zero2, mut inside) = (0.0, 0.0, 0.0, 0.0);
    for epoch in from..epochs {
        let moments = ensemble.at(epoch).unwrap();
        for axis in 0..3 {
            let e: Vec<f64> = (0..runs).map(|r| errors[r][epoch][axis]).collect();
            let v: Vec<f64> = (0..runs).map(|r| variances[r][epoch][axis]).collect();
            let mean = e.iter().sum::<f64>() / n;
            // About zero = about the mean + the mean squared.
            let second = e.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n + mean * mean;
            let claimed = v.iter().sum::<f64>() / n;
            assert!((moments.mean[axis] - mean).abs() < 1e-13);
            assert!((moments.second_moment[axis] / second - 1.0).abs() < 1e-13);
            assert!((moments.mean_variance.unwrap()[axis] / claimed - 1.0).abs() < 1e-13);
            ratios.push((claimed / second).sqrt());
            norm2 += second * n;
            zero2 += mean * mean * n / second;
            let about_mean = e.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
            score2 += mean * mean * n / about_mean;
            inside += e.iter().zip(&v).filter(|(e, v)| e.abs() <= 3.0 * v.sqrt()).count() as f64;
        }
    }
    let samples = (epochs - from) as f64;
    let range = from..epochs;
    assert!((ensemble.rmse(range.clone()).unwrap() - (norm2 / n / samples).sqrt()).abs() < 1e-12);
    assert!((ensemble.coverage(range.clone()).unwrap() - inside / (3.0 * n * samples)).abs() < 1e-14);
    let score = mean_error_in_sigmas(&[&ensemble, &ensemble], range.clone()).unwrap();
    assert!((score - (score2 / (3.0 * samples)).sqrt()).abs() < 1e-12);
    let about_zero = mean_error_in_sigmas_about_zero(&[&ensemble], range.clone()).unwrap();
    assert!((about_zero - (zero2 / (3.0 * samples)).sqrt()).abs() < 1e-12);
    let by_axis = ensemble.ratio_by_axis(range.clone()).unwrap();
    for (axis, by_axis) in by_axis.into_iter().enumerate() {
        let mut own: Vec<f64> = ratios.iter().copied().skip(axis).step_by(3).collect();
        own.sort_by(f64::total_cmp);
        assert!((by_axis - own[own.len() / 2]).abs() < 1e-12);
    }
    ratios.sort_by(f64::total_cmp);
    assert!((ensemble.ratio(range).unwrap() - ratios[ratios.len() / 2]).abs() < 1e-12);
}

/// Errors drawn from the very covariance that is claimed: NEES, ratio and mean error agree with theory, and its mean
/// over the runs is inside the 95 % bounds at about 95 % of independent epochs.
#[test]
fn val_a_consistent_filter_looks_consistent() {
    let (runs, epochs) = (100, 400);
    let mut generator = stream(11, 0, Source::Lidar);
    let factor = SMatrix::<f64, 9, 9>::from_fn(|i, j| match i.cmp(&j) {
        std::cmp::Ordering::Less => 0.0,
        std::cmp::Ordering::Equal => 1.0 + i as f64,
        std::cmp::Ordering::Greater => 0.3 * (i as f64 - 2.0 * j as f64),
    });
    let covariance = factor * factor.transpose();
    let variance = Vector3::from(covariance.fixed_view::<3, 3>(0, 0).diagonal());
    let mut position = Ensemble::new(epochs);
    let mut normalised = ScalarEnsemble::new(epochs, 0);
    for _ in 0..runs {
        for epoch in 0..epochs {
            let w = SVector::<f64, 9>::from_fn(|_, _| StandardNormal.sample(&mut generator));
            let error = factor * w;
            position
                .add(epoch, &error.fixed_rows::<3>(0).into_owned(), Some(&variance))
                .unwrap();
            normalised
                .add(epoch, nees(&error, &covariance, 9).unwrap() / 9.0)
                .unwrap();
        }
    }
    // Sigma of the mean of 40 000 draws of chi2(9)/9 is sqrt(2/9/40000) = 0.0024.
    assert!((normalised.mean().unwrap() - 1.0).abs() < 3.0 * 0.0024);
    // Median of chi2(9) is 8.3428 (tables).
    assert!((normalised.median().unwrap() - 8.3428 / 9.0).abs() < 3.0 * 1.25 * 0.0024);
    let inside = normalised
        .share_of_epochs_inside(|n| mean_chi_square_bounds(n as usize, 9, 0.95).ok())
        .unwrap();
    // Binomial: 400 epochs at 95 %, sigma 1.1 %.
    assert!((inside - 0.95).abs() < 3.0 * 0.011);
    // One ratio has sigma 1/sqrt(2 * 100) = 7 %; 1200 of them (axes correlated, say 400) leave 0.45 % of a median.
    assert!((position.ratio(0..epochs).unwrap() - 1.0).abs() < 3.0 * 0.0045);
    // 99.73 % inside 3 sigma; 40 000 independent epochs, sigma below 0.03 %.
    assert!((position.coverage(0..epochs).unwrap() - 0.9973).abs() < 3.0 * 3e-4);
    // Mean square of 1200 standard normals (say 400 independent): 1, sigma of the root 1/sqrt(800) = 3.5 %.
    assert!((mean_error_in_sigmas(&[&position], 0..epochs).unwrap() - 1.0).abs() < 3.0 * 0.035);
}

/// Studies whose epochs are one and the same error, and studies whose epochs are independent: of both, chance puts 5 % above
/// the bound. Of 400 studies that is 20, sigma sqrt(400 * 0.05 * 0.95) = 4.4. A bias of one sigma of a run is found.
#[test]
fn val_chance_exceeds_the_bound_of_the_mean_error_in_one_study_of_twenty() {
    let (studies, runs, epochs) = (400, 8, 6);
    for (follow, bias) in [(true, 0.0), (false, 0.0), (true, 1.5)] {
        let mut above = 0;
        for study in 0..studies {
            let mut generator = stream(17, study, Source::Lidar);
            let mut ensembles = [Ensemble::new(epochs), Ensemble::new(epochs)];
            let mut flips = SignFlips::new(epochs, 0);
            for _ in 0..runs {
                let signs: [bool; FLIPS] = std::array::from_fn(|_| normal3(&mut generator).x > 0.0);
                let mut errors = [normal3(&mut generator), normal3(&mut generator)];
                for epoch in 0..epochs {
                    if !follow {
                        errors = [normal3(&mut generator), normal3(&mut generator)];
                    }
                    let shifted = errors.map(|e| e.add_scalar(bias));
                    for (ensemble, error) in ensembles.iter_mut().zip(&shifted) {
                        ensemble.add(epoch, error, None).unwrap();
                    }
                    flips.add(epoch, &shifted, &signs);
                }
            }
            let found = mean_error_in_sigmas(&[&ensembles[0], &ensembles[1]], 0..epochs).unwrap();
            above += i32::from(found > flips.bound().unwrap());
        }
        if bias > 0.0 {
            assert!(above > 390, "{above}");
        } else {
            assert!((above - 20).abs() < 14, "{above} of 400");
        }
    }
    let mut few = SignFlips::new(1, 0);
    for _ in 0..5 {
        few.add(0, &[Vector3::repeat(1.0); 2], &[true; FLIPS]);
    }
    assert_eq!(few.bound(), None);
}

/// NEES does not depend on the axes in which error and covariance are given.
#[test]
fn val_nees_is_the_same_in_any_axes() {
    let mut generator = stream(3, 0, Source::Lidar);
    let turn = *nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).matrix();
    let mut rotation = SMatrix::<f64, 9, 9>::zeros();
    for block in 0..3 {
        rotation.fixed_view_mut::<3, 3>(3 * block, 3 * block).copy_from(&turn);
    }
    assert!((turn * turn.transpose() - Matrix3::identity()).amax() < 1e-14);
    let a = SMatrix::<f64, 9, 9>::from_fn(|_, _| StandardNormal.sample(&mut generator));
    let p = a * a.transpose();
    let e = SVector::<f64, 9>::from_fn(|_, _| StandardNormal.sample(&mut generator));
    let turned = nees(&(rotation * e), &(rotation * p * rotation.transpose()), 9).unwrap();
    assert!((turned / nees(&e, &p, 9).unwrap() - 1.0).abs() < 1e-7);
}
