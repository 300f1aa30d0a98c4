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
    let measured = truth + unit.component_mul(&metrology::deviations(sigma.position, sigma.velocity));
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
