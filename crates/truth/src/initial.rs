//! The navigation's first estimate, drawn around the truth.

use interface::mission::InitialSigma;
use nalgebra::{SVector, Vector3};
use numerics::{Source, stream};
use sensors::{metrology, normal3};

use crate::overrides::Run;
use crate::{Relative, Vehicles};

/// Initial estimate of a filter in the LVLH frame: rows 1 to 6 are a measurement of their own (rho, rho_dot, LVLH), the rest 0.
///
/// * `relative`: the truth at the start time.
/// * `sigma`: standard deviations of the errors.
pub(crate) fn draw_measurement(run: &Run, sigma: &InitialSigma, relative: &Relative) -> SVector<f64, 18> {
    let mut rng = stream(run.study_seed, run.run, Source::InitialError);
    let unit = metrology::measure(&normal3(&mut rng), &normal3(&mut rng));
    let truth = metrology::measure(&relative.rho_lvlh, &relative.rho_dot_lvlh);
    let deviations = metrology::measure(&Vector3::repeat(sigma.position), &Vector3::repeat(sigma.velocity));
    let measured = truth + unit.component_mul(&deviations);
    measured.fixed_resize(0.0)
}

/// Initial estimate of the state r_tc, v_tc, a_t, r_c, v_c, b_c (SI, axes N; b_c in chaser body axes).
///
/// Target and chaser are mistaken independently of each other, so the relative error is the difference of both errors.
///
/// * `state`, `a_t_n`, `b_c_bc`: the truth at the start time.
/// * `sigma`: standard deviations of the errors.
///
/// Source: Mamich and Zanetti, Eqs. (35) and (37).
pub(crate) fn draw_estimate(
    run: &Run,
    sigma: &InitialSigma,
    state: &Vehicles,
    a_t_n: &Vector3<f64>,
    b_c_bc: &Vector3<f64>,
) -> SVector<f64, 18> {
    let mut rng = stream(run.study_seed, run.run, Source::InitialError);
    let mut error = |sigma: f64| normal3(&mut rng) * sigma;
    let (r_t, v_t, a_t) = (error(sigma.position), error(sigma.velocity), error(sigma.acceleration));
    let (r_c, v_c, b_c) = (error(sigma.position), error(sigma.velocity), error(sigma.bias));
    let mut x = SVector::<f64, 18>::zeros();
    let parts = [
        state.r_tc() + r_t - r_c,
        state.v_tc() + v_t - v_c,
        a_t_n + a_t,
        state.r_c + r_c,
        state.v_c + v_c,
        b_c_bc + b_c,
    ];
    for (i, part) in parts.iter().enumerate() {
        x.fixed_rows_mut::<3>(3 * i).copy_from(part);
    }
    x
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::Params;
    use nalgebra::SMatrix;

    const OWN: InitialSigma = InitialSigma {
        position: 8.0,
        velocity: 0.5,
        acceleration: 2e-9,
        bias: 3e-9,
    };

    fn drawn(
        run: u32,
        sigma: &InitialSigma,
        state: &Vehicles,
        a_t_n: &Vector3<f64>,
        b: &Vector3<f64>,
    ) -> SVector<f64, 18> {
        let mut params = Params::of_scenario(1);
        params.run = run;
        draw_estimate(&params.run().unwrap(), sigma, state, a_t_n, b)
    }

    fn still() -> Vehicles {
        Vehicles::from_vector(&SVector::zeros())
    }

    #[test]
    fn errors_of_target_and_chaser_are_independent() {
        let n = 4000;
        let mut p = SMatrix::<f64, 18, 18>::zeros();
        let mut run = Params::default().run().unwrap();
        for number in 0..n {
            run.run = number;
            let e = draw_estimate(&run, &OWN, &still(), &Vector3::zeros(), &Vector3::zeros());
            p += e * e.transpose() / n as f64;
        }
        // By hand: x = (e_t - e_c, ..., e_c, ...) with equal variances.
        let block = |i: usize, j: usize| match (i, j) {
            (0, 0) => 2.0 * 64.0,
            (1, 1) => 2.0 * 0.25,
            (2, 2) => 4e-18,
            (3, 3) => 64.0,
            (4, 4) => 0.25,
            (5, 5) => 9e-18,
            (0, 3) | (3, 0) => -64.0,
            (1, 4) | (4, 1) => -0.25,
            _ => 0.0,
        };
        for i in 0..18 {
            for j in 0..18 {
                let expected = if i % 3 == j % 3 { block(i / 3, j / 3) } else { 0.0 };
                // Sampling error of a covariance: sqrt((p_ii p_jj + p_ij^2) / n); 5 sigma for 324 entries.
                let variances = block(i / 3, i / 3) * block(j / 3, j / 3);
                let bound = 5.0 * ((variances + expected * expected) / n as f64).sqrt();
                assert!(
                    (p[(i, j)] - expected).abs() < bound,
                    "({i}, {j}): {} and {expected}",
                    p[(i, j)]
                );
            }
        }
    }

    #[test]
    fn each_deviation_scales_its_own_errors() {
        let of = |sigma: &InitialSigma| drawn(0, sigma, &still(), &Vector3::zeros(), &Vector3::zeros());
        let mut expected = of(&OWN);
        for i in [3, 4, 5, 12, 13, 14] {
            expected[i] *= 2.0;
        }
        expected.fixed_rows_mut::<3>(15).fill(0.0);
        let changed = of(&InitialSigma {
            velocity: 1.0,
            bias: 0.0,
            ..OWN
        });
        assert!((changed - expected).amax() < 1e-15);
    }

    #[test]
    fn estimate_stands_around_the_truth() {
        let part = |x: f64| Vector3::new(x, 2.0 * x, 3.0 * x);
        let state = Vehicles {
            r_t: part(1.0),
            v_t: part(10.0),
            r_c: part(100.0),
            v_c: part(1000.0),
        };
        let exact = InitialSigma {
            position: 0.0,
            velocity: 0.0,
            acceleration: 0.0,
            bias: 0.0,
        };
        let x = drawn(0, &exact, &state, &part(7.0), &part(8.0));
        let first_axis: Vec<f64> = x.iter().copied().step_by(3).collect();
        assert_eq!(first_axis, [-99.0, -990.0, 7.0, 100.0, 1000.0, 8.0]);
        assert!(x.iter().skip(2).step_by(3).zip(first_axis).all(|(z, x)| *z == 3.0 * x));
    }
}
