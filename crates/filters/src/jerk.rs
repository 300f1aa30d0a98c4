//! Process noise of the target's three states per axis: r, v, a driven by white jerk or white acceleration.

use crate::dynamics::decay::Answer;
use crate::state::TargetMatrix;
use nalgebra::{Matrix3, Vector3};
use numerics::math;

/// Covariance of (r, v, a) of one axis after white jerk of unit density has acted over `dt`.
///
/// Source: Mamich and Zanetti, Eq. (27).
pub fn gamma(dt: f64) -> Matrix3<f64> {
    let (d2, d3, d4, d5) = (dt.powi(2) / 2.0, dt.powi(3), dt.powi(4) / 8.0, dt.powi(5) / 20.0);
    Matrix3::new(d5, d4, d3 / 6.0, d4, d3 / 3.0, d2, d3 / 6.0, d2, dt)
}

/// Lower Cholesky factor of [`gamma`], in closed form and therefore without loss for any `dt`.
pub fn gamma_factor(dt: f64) -> Matrix3<f64> {
    let (r5, r3) = (5.0_f64.sqrt(), 3.0_f64.sqrt());
    let unit = Matrix3::new(
        r5 / 10.0,
        0.0,
        0.0,
        r5 / 4.0,
        r3 / 12.0,
        0.0,
        r5 / 3.0,
        r3 / 3.0,
        1.0 / 3.0,
    );
    let scale = Vector3::new(math::powf(dt, 2.5), math::powf(dt, 1.5), dt.sqrt());
    Matrix3::from_diagonal(&scale) * unit
}

/// Discrete process noise of a random jerk acting over one step.
///
/// * `q_psd`: jerk power spectral density of the three axes N (the diagonal of Q), internal units (m2/s5 in SI).
/// * `dt`: propagation interval, positive.
/// * returns: `q_hat`, 9x9, ordered r, v, a; positive definite when every entry of `q_psd` is positive.
///
/// Source: Mamich and Zanetti, Eq. (27).
pub fn process_noise(q_psd: &Vector3<f64>, dt: f64) -> TargetMatrix {
    on_every_axis(&gamma(dt), q_psd)
}

/// Discrete process noise of a random jerk whose axes are correlated.
///
/// * `q_psd`: jerk power spectral density, 3x3, axes N, symmetric, internal units (m2/s5 in SI).
/// * `dt`: propagation interval, positive.
/// * returns: `q_hat`, 9x9, ordered r, v, a; positive (semi)definite when `q_psd` is.
///
/// Source: Mamich and Zanetti, Eq. (27).
pub fn process_noise_full(q_psd: &Matrix3<f64>, dt: f64) -> TargetMatrix {
    let block = gamma(dt);
    TargetMatrix::from_fn(|i, j| block[(i / 3, j / 3)] * q_psd[(i % 3, j % 3)])
}

/// Covariance of (r, v, a) of unit density, 3x3, spread over the axes and scaled by the density of each, 9x9.
fn on_every_axis(block: &Matrix3<f64>, density: &Vector3<f64>) -> TargetMatrix {
    TargetMatrix::from_fn(|i, j| {
        if i % 3 == j % 3 {
            block[(i / 3, j / 3)] * density[i % 3]
        } else {
            0.0
        }
    })
}

/// Discrete process noise of white acceleration of density `q` (m2/s3 in SI) on every axis, 9x9; rows of a are zero.
pub fn white_acceleration(q: f64, dt: f64) -> TargetMatrix {
    let d2 = dt * dt / 2.0;
    let block = Matrix3::new(dt.powi(3) / 3.0, d2, 0.0, d2, dt, 0.0, 0.0, 0.0, 0.0);
    on_every_axis(&block, &Vector3::repeat(q))
}

/// Discrete process noise of an acceleration da/dt = -beta a + w, w white of density `q`, on every axis, 9x9.
///
/// * `q`: density of the driving jerk, m2/s5 in SI; `beta`: decay rate; `dt`: interval.
pub fn gauss_markov(q: f64, beta: f64, dt: f64) -> TargetMatrix {
    let block = if beta * dt > 1.0 {
        short_lived(beta, dt)
    } else {
        long_lived(beta, dt)
    };
    on_every_axis(&block, &Vector3::repeat(q))
}

/// The same for one axis and unit density, in closed form: with (r, v, a) the answer to a unit jerk `dt` ago, r' = v and v' = a
/// leave one integral, that of v^2. All digits go for small beta dt.
fn short_lived(beta: f64, dt: f64) -> Matrix3<f64> {
    let z = beta * dt;
    let Answer {
        position: r,
        velocity: v,
        left: a,
    } = Answer::after(dt, beta);
    let vv = (z - 2.0 * beta * v + (1.0 - a * a) / 2.0) / beta.powi(3);
    // The integral of r^2, by r = (dt - v) / beta.
    let rr = (z.powi(3) / 3.0 - z * z + z - 2.0 * z * a + (1.0 - a * a) / 2.0) / beta.powi(5);
    let (rv, va, ra) = (r * r / 2.0, v * v / 2.0, r * v - vv);
    let aa = (1.0 - a * a) / (2.0 * beta);
    Matrix3::new(rr, rv, ra, rv, vv, va, ra, va, aa)
}

/// The same by Gauss-Legendre points of the integral of F(t) L L^T F(t)^T, exact to rounding for beta dt up to one.
fn long_lived(beta: f64, dt: f64) -> Matrix3<f64> {
    // Nodes and weights of the eight-point rule on [-1, 1], positive half.
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let mut block = Matrix3::zeros();
    for (node, weight) in POINTS.iter().flat_map(|(x, w)| [(-x, *w), (*x, *w)]) {
        let ago = Answer::after(dt * (1.0 + node) / 2.0, beta);
        let answer = Vector3::new(ago.position, ago.velocity, ago.left);
        block += answer * answer.transpose() * (weight * dt / 2.0);
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

    /// Van Loan's construction: exp([[-A, L q L^T], [0, A^T]] dt) holds F^T and F^-1 Q_hat.
    ///
    /// * `decay`: of the acceleration; `driven`: slot of the block (0 r, 1 v, 2 a) that white noise drives.
    fn van_loan(q: &Matrix3<f64>, decay: f64, driven: usize, with_acceleration: bool, dt: f64) -> TargetMatrix {
        let mut a = TargetMatrix::zeros();
        for i in 0..if with_acceleration { 6 } else { 3 } {
            a[(i, i + 3)] = 1.0;
        }
        let mut lq = TargetMatrix::zeros();
        for i in 0..3 {
            a[(6 + i, 6 + i)] = -decay;
        }
        lq.fixed_view_mut::<3, 3>(3 * driven, 3 * driven).copy_from(q);
        let mut m = SMatrix::<f64, 18, 18>::zeros();
        m.fixed_view_mut::<9, 9>(0, 0).copy_from(&(-a * dt));
        m.fixed_view_mut::<9, 9>(0, 9).copy_from(&(lq * dt));
        m.fixed_view_mut::<9, 9>(9, 9).copy_from(&(a.transpose() * dt));
        let e = numerics::expm(&m);
        e.fixed_view::<9, 9>(9, 9).transpose() * e.fixed_view::<9, 9>(0, 9)
    }

    fn agree(ours: &TargetMatrix, expected: &TargetMatrix) -> bool {
        (ours - expected).amax() < 1e-12 * expected.amax()
    }

    #[test]
    fn process_noise_agrees_with_van_loan() {
        let q = Vector3::new(2.0, 0.5, 3e-4);
        let full = Matrix3::new(2.0, -0.4, 0.1, -0.4, 0.5, 0.2, 0.1, 0.2, 0.3);
        let one = Matrix3::identity() * 0.7;
        for dt in [0.25, 1.0, 7.0] {
            assert!(
                agree(
                    &process_noise(&q, dt),
                    &van_loan(&Matrix3::from_diagonal(&q), 0.0, 2, true, dt)
                ),
                "dt = {dt}"
            );
            assert!(
                agree(&process_noise_full(&full, dt), &van_loan(&full, 0.0, 2, true, dt)),
                "dt = {dt}"
            );
            assert!(
                agree(&white_acceleration(0.7, dt), &van_loan(&one, 0.0, 1, false, dt)),
                "dt = {dt}"
            );
            for beta in [0.0, 1e-5, 0.02, 0.14] {
                let expected = van_loan(&one, beta, 2, true, dt);
                assert!(
                    agree(&gauss_markov(0.7, beta, dt), &expected),
                    "dt = {dt}, beta = {beta}"
                );
            }
        }
    }

    /// A long interval is many short ones: Q(2 t) = F(t) Q(t) F(t)^T + Q(t).
    #[test]
    fn noise_of_what_dies_away_fast_adds_up() {
        let (short, count) = (0.5, 40);
        for beta in [0.04, 0.5, 1.9, 2.1, 10.0, 1e3] {
            let mut f = TargetMatrix::identity();
            let answer = Answer::after(short, beta);
            f.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(short);
            f.fixed_view_mut::<3, 3>(0, 6).fill_diagonal(answer.position);
            f.fixed_view_mut::<3, 3>(3, 6).fill_diagonal(answer.velocity);
            f.fixed_view_mut::<3, 3>(6, 6).fill_diagonal(answer.left);
            let step = gauss_markov(0.7, beta, short);
            let expected = (0..count).fold(TargetMatrix::zeros(), |sum, _| f * sum * f.transpose() + step);
            let ours = gauss_markov(0.7, beta, short * f64::from(count));
            for (ours, expected) in ours.iter().zip(expected.iter()) {
                assert!(
                    (ours - expected).abs() <= 1e-11 * expected.abs(),
                    "beta = {beta}: {ours} {expected}"
                );
            }
            assert!(ours.cholesky().is_some(), "beta = {beta}");
        }
    }

    #[test]
    fn factor_reproduces_gamma() {
        for dt in [1e-3, 0.5, 1.0, 40.0] {
            let (l, g) = (gamma_factor(dt), gamma(dt));
            for (ours, expected) in (l * l.transpose()).iter().zip(g.iter()) {
                assert!((ours - expected).abs() <= 1e-14 * expected, "dt = {dt}");
            }
        }
    }
}
