//! How errors of both vehicles' states move over a step, and what that does to a covariance, by parts.
//!
//! The 18 states fall into parts of 6, 3, 6, 3: position and velocity of the target relative to the chaser, its acceleration a,
//! position and velocity of the chaser, its bias b. A vehicle alone has, by Eq. (5) of Mamich and Zanetti,
//!
//! ```text
//!     A = [0 I 0; G W M; 0 0 -k]     G, W: partials of gravity by position and velocity
//!                                    M: how the third acts on the velocity, I or -DCM
//! ```
//!
//! and dF/dt = F A = A F for F = exp(A t) says that all of it follows from B = F_rv, the answer of position to velocity:
//!
//! ```text
//!     F_rr = B' - B W     F_rv = B      F_ra = C M             C = integral of B(s) exp(-k (t - s)) over s from 0 to t
//!     F_vr = B G          F_vv = B'     F_va = (B - k C) M     F_aa = exp(-k t)
//!     B'' = B G + B' W,   B(0) = 0,   B'(0) = I
//! ```
//!
//! With r_t = r_tc + r_c the relative part inherits the difference of both vehicles, which is what A_t/c of Eq. (5) expresses:
//!
//! ```text
//!     F = [T  T_a  T-C  -C_b]      T, C: F_rr to F_vv of target and chaser, 6x6; T_a, C_b: their F_ra above F_va, 6x3
//!         [0  e_a   0     0 ]      e_a, e_b: their F_aa
//!         [0   0    C    C_b]
//!         [0   0    0    e_b]
//! ```
//!
//! F P F^T then takes 18 columns under the first row of this, nine under the third, and the same again from the right, of which
//! half is enough: 8 thousand operations where two products of 18x18 take 23 thousand.

use crate::state::{N, N_TARGET, StateMatrix, TargetMatrix};
use nalgebra::{Matrix3, SMatrix};
use numerics::spd::{self, gathered};
use numerics::{expm, math};

/// Above this, the series would need more terms than it has; a scaled one is taken, which a step of any sample never needs.
const LARGE: f64 = 0.25;

/// Terms beyond the first: 0.25^13 / 13! is 2e-18.
const TERMS: usize = 13;

/// exp(A t) of one vehicle: the four blocks of position and velocity, each less what it is without gravity, and those of the third.
pub(super) struct Flow {
    /// F_rr - I.
    rr: Matrix3<f64>,
    /// F_rv - t I.
    rv: Matrix3<f64>,
    /// F_vr.
    vr: Matrix3<f64>,
    /// F_vv - I.
    vv: Matrix3<f64>,
    /// F_ra and F_va, before M.
    by_third: [Matrix3<f64>; 2],
    /// exp(-k t).
    decay: f64,
}

impl Flow {
    /// * `by_r`, `by_v`: partials of the acceleration by position and velocity; `k`: inverse time constant of the third, not negative.
    pub(super) fn new(by_r: &Matrix3<f64>, by_v: &Matrix3<f64>, k: f64, t: f64) -> Self {
        let (g, w) = (by_r * (t * t), by_v * t);
        let turns = w != Matrix3::zeros();
        let size = g.abs().sum().sqrt() + w.abs().sum();
        // A rate that grows is none of ours, but a changed state may hold one.
        if size.is_nan() || size > LARGE || k < 0.0 {
            return Self::scaled(by_r, by_v, k, t);
        }
        // u_n = b_n t^n / n! of B = sum of u_n, with b_1 = I and b_(n+1) = b_n W + b_(n-1) G.
        let identity = Matrix3::identity();
        let mut u = [Matrix3::zeros(); TERMS + 1];
        u[0] = identity * t;
        let mut last = 0;
        for n in 1..=TERMS {
            let next = (n + 1) as f64;
            let mut term = Matrix3::zeros();
            if n > 1 {
                term += u[n - 2] * g * (1.0 / (next * n as f64));
            }
            if turns {
                term += u[n - 1] * w * (1.0 / next);
            }
            u[n] = term;
            // Of a field that does not turn, every other term is zero.
            if n > 1 && term.amax() + u[n - 1].amax() <= t * 1e-19 {
                break;
            }
            last = n;
        }
        let z = k * t;
        let weights = weights(z, last + 1);
        let (mut rv, mut vv) = (Matrix3::zeros(), Matrix3::zeros());
        let mut c = identity * (t * t * weights[1]);
        for (n, term) in u[..=last].iter().enumerate().skip(1) {
            rv += term;
            vv += term * ((n + 1) as f64);
            c += term * (t * weights[n + 1]);
        }
        vv /= t;
        let b = identity * t + rv;
        let mut rr = vv;
        if turns {
            rr -= b * by_v;
        }
        Self {
            rr,
            rv,
            vr: b * by_r,
            vv,
            by_third: [c, b - c * k],
            decay: math::exp(-z),
        }
    }

    /// exp(A t) whole, 9x9.
    ///
    /// * `third`: whether the third acts on the velocity, M = I or nothing.
    pub(super) fn nine(&self, third: bool, t: f64) -> TargetMatrix {
        let mut f = TargetMatrix::identity();
        let mut set = |i: usize, j: usize, block: &Matrix3<f64>| f.fixed_view_mut::<3, 3>(i, j).copy_from(block);
        let identity = Matrix3::identity();
        set(0, 0, &(identity + self.rr));
        set(0, 3, &(identity * t + self.rv));
        set(3, 0, &self.vr);
        set(3, 3, &(identity + self.vv));
        if third {
            set(0, 6, &self.by_third[0]);
            set(3, 6, &self.by_third[1]);
            set(6, 6, &(identity * self.decay));
        }
        f
    }

    /// The same by the exponential of the whole, with t as the unit of time: entries are then of one size, and squarings few.
    fn scaled(by_r: &Matrix3<f64>, by_v: &Matrix3<f64>, k: f64, t: f64) -> Self {
        let mut a = TargetMatrix::zeros();
        a.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        a.fixed_view_mut::<3, 3>(3, 0).copy_from(&(by_r * (t * t)));
        a.fixed_view_mut::<3, 3>(3, 3).copy_from(&(by_v * t));
        a.fixed_view_mut::<3, 3>(3, 6).fill_with_identity();
        a.fixed_view_mut::<3, 3>(6, 6).fill_diagonal(-k * t);
        let f = expm(&a);
        let block = |i: usize, j: usize| f.fixed_view::<3, 3>(3 * i, 3 * j).into_owned();
        let identity = Matrix3::identity();
        Self {
            rr: block(0, 0) - identity,
            rv: (block(0, 1) - identity) * t,
            vr: block(1, 0) / t,
            vv: block(1, 1) - identity,
            by_third: [block(0, 2) * (t * t), block(1, 2) * t],
            decay: f[(6, 6)],
        }
    }
}

/// Integrals of s^n exp(-z (1 - s)) over s from 0 to 1, for n from 0 to `last`: what a term of B leaves in C, less its own size.
///
/// By the recurrence z I_n = 1 - n I_(n-1): downwards from a series at the last where z is small, else upwards.
fn weights(z: f64, last: usize) -> [f64; TERMS + 2] {
    let mut all = [0.0; TERMS + 2];
    if z > 1.0 {
        all[0] = -math::exp_m1(-z) / z;
        for n in 1..=last {
            all[n] = (1.0 - n as f64 * all[n - 1]) / z;
        }
        return all;
    }
    let mut term = 1.0 / (last + 1) as f64;
    let mut over = (last + 2) as f64;
    // Twenty terms are enough for any z up to 1.
    for _ in 0..20 {
        all[last] += term;
        term *= -z / over;
        over += 1.0;
    }
    for n in (1..=last).rev() {
        all[n - 1] = (1.0 - z * all[n]) / n as f64;
    }
    all
}

/// F of both vehicles, by parts; see the head of this file.
#[derive(Clone, Debug)]
pub struct Transition {
    /// First row of F: what each of the 18 states does to relative position and velocity.
    relative: [[f64; 6]; N],
    /// Third row of F: what r_c, v_c and b_c do to r_c and v_c.
    chaser: [[f64; 6]; 9],
    /// e_a and e_b.
    decay: [f64; 2],
}

impl Transition {
    /// * `third`: how the chaser's bias acts on its velocity, M, if it does.
    pub(super) fn new(target: &Flow, chaser: &Flow, third: Option<&Matrix3<f64>>, t: f64) -> Self {
        let mut f = Self {
            relative: [[0.0; 6]; N],
            chaser: [[0.0; 6]; 9],
            decay: [target.decay, chaser.decay],
        };
        let by_bias = third.map(|m| [chaser.by_third[0] * m, chaser.by_third[1] * m]);
        for j in 0..3 {
            for i in 0..3 {
                let (one, step) = if i == j { (1.0, t) } else { (0.0, 0.0) };
                f.relative[j][i] = one + target.rr[(i, j)];
                f.relative[j][3 + i] = target.vr[(i, j)];
                f.relative[3 + j][i] = step + target.rv[(i, j)];
                f.relative[3 + j][3 + i] = one + target.vv[(i, j)];
                f.relative[6 + j][i] = target.by_third[0][(i, j)];
                f.relative[6 + j][3 + i] = target.by_third[1][(i, j)];
                f.relative[9 + j][i] = target.rr[(i, j)] - chaser.rr[(i, j)];
                f.relative[9 + j][3 + i] = target.vr[(i, j)] - chaser.vr[(i, j)];
                f.relative[12 + j][i] = target.rv[(i, j)] - chaser.rv[(i, j)];
                f.relative[12 + j][3 + i] = target.vv[(i, j)] - chaser.vv[(i, j)];
                f.chaser[j][i] = one + chaser.rr[(i, j)];
                f.chaser[j][3 + i] = chaser.vr[(i, j)];
                f.chaser[3 + j][i] = step + chaser.rv[(i, j)];
                f.chaser[3 + j][3 + i] = one + chaser.vv[(i, j)];
                if let Some([r, v]) = &by_bias {
                    f.chaser[6 + j][i] = r[(i, j)];
                    f.chaser[6 + j][3 + i] = v[(i, j)];
                    f.relative[15 + j][i] = -r[(i, j)];
                    f.relative[15 + j][3 + i] = -v[(i, j)];
                }
            }
        }
        f
    }

    /// Adds what relative position and velocity do to relative velocity, 3x6.
    pub(super) fn add_to_velocity(&mut self, by_x: &SMatrix<f64, 3, 6>) {
        for (column, more) in self.relative.iter_mut().zip(by_x.column_iter()) {
            for (value, more) in column[3..].iter_mut().zip(more.iter()) {
                *value += more;
            }
        }
    }

    /// The target's nine states by themselves, 9x9.
    pub fn of_target(&self) -> TargetMatrix {
        TargetMatrix::from_fn(|i, j| match (i < 6, i == j) {
            (true, _) => self.relative[j][i],
            (false, true) => self.decay[0],
            (false, false) => 0.0,
        })
    }

    /// All of F, 18x18.
    pub fn dense(&self) -> StateMatrix {
        let mut f = StateMatrix::zeros();
        f.fixed_view_mut::<9, 9>(0, 0).copy_from(&self.of_target());
        for j in N_TARGET..N {
            for i in 0..6 {
                f[(i, j)] = self.relative[j][i];
                f[(N_TARGET + i, j)] = self.chaser[j - N_TARGET][i];
            }
        }
        for axis in 15..18 {
            f[(axis, axis)] = self.decay[1];
        }
        f
    }

    /// Takes a covariance P, 18x18, symmetric, to F P F^T, symmetric to the bit.
    pub fn carry(&self, p: &mut StateMatrix) {
        let [e_a, e_b] = self.decay;
        let to = &mut p.data.0;
        // What comes from the left, by columns of P: all 18 of the first row, those of the chaser of the third.
        let relative: [[f64; 6]; N] = std::array::from_fn(|j| gathered(&self.relative, |k| to[j][k]));
        let chaser: [[f64; 6]; 9] = std::array::from_fn(|j| gathered(&self.chaser, |k| to[9 + j][9 + k]));
        // Then the lower triangle, column by column; what is still asked for of P is of the same column.
        for j in 0..6 {
            to[j][..6].copy_from_slice(&gathered(&relative, |k| self.relative[k][j]));
            for axis in 0..3 {
                to[j][6 + axis] = relative[6 + axis][j] * e_a;
                to[j][15 + axis] = relative[15 + axis][j] * e_b;
            }
            to[j][9..15].copy_from_slice(&gathered(&self.chaser, |k| relative[9 + k][j]));
        }
        for column in &mut to[6..9] {
            let of_chaser = gathered(&self.chaser, |k| column[9 + k]);
            for i in 0..3 {
                column[6 + i] *= e_a * e_a;
                column[15 + i] *= e_a * e_b;
            }
            for (value, carried) in column[9..15].iter_mut().zip(of_chaser) {
                *value = e_a * carried;
            }
        }
        for j in 0..6 {
            to[9 + j][9..15].copy_from_slice(&gathered(&chaser, |k| self.chaser[k][j]));
            for axis in 0..3 {
                to[9 + j][15 + axis] = chaser[6 + axis][j] * e_b;
            }
        }
        for column in &mut to[15..] {
            for value in &mut column[15..] {
                *value *= e_b * e_b;
            }
        }
        spd::mirror(p);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use numerics::{Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    /// Partials by position and by velocity.
    type Partials = (Matrix3<f64>, Matrix3<f64>);

    fn of_parts(target: &Partials, chaser: &Partials, k: [f64; 2], third: &Matrix3<f64>, t: f64) -> Transition {
        let flow = |of: &Partials, k: f64| Flow::new(&of.0, &of.1, k, t);
        Transition::new(&flow(target, k[0]), &flow(chaser, k[1]), Some(third), t)
    }

    /// Fields of a low orbit and of a three-body problem at its nearest to the Moon, for two vehicles a kilometre apart.
    fn fields() -> [(Partials, Partials); 2] {
        let zonal = |r: Vector3<f64>| (astro::earth::FILTER.gradient(&r), Matrix3::zeros());
        let system = astro::Cr3bpSystem::EARTH_MOON;
        let near_moon = Vector3::new(3.79e8, 2.1e6, -3.0e6);
        let low = Vector3::new(5.0e6, 4.2e6, 2.0e6);
        let apart = Vector3::new(600.0, -700.0, 400.0);
        [
            (zonal(low + apart), zonal(low)),
            (system.partials(&(near_moon + apart)), system.partials(&near_moon)),
        ]
    }

    /// What no mission states and a changed state may hold comes to an end.
    #[test]
    fn senseless_rates_end() {
        let (target, _) = fields()[0];
        for (k, finite) in [
            (-1e-3, true),
            (1e300, true),
            (-1e300, false),
            (f64::NAN, false),
            (f64::INFINITY, false),
        ] {
            let flow = Flow::new(&target.0, &target.1, k, 1.0).nine(true, 1.0);
            assert_eq!(flow.iter().all(|v| v.is_finite()), finite, "{k}");
        }
    }

    /// The weights by the integral that they are, in Simpson's sum.
    #[test]
    fn weights_are_their_integrals() {
        for z in [0.0, 1e-6, 0.3, 0.999, 1.001, 4.0, 50.0] {
            let ours = weights(z, 8);
            for (n, ours) in ours.iter().enumerate().take(9) {
                let parts = 4000;
                let sum: f64 = (0..=parts)
                    .map(|i| {
                        let s = f64::from(i) / f64::from(parts);
                        let weight = [1.0, 4.0, 2.0][if i == 0 || i == parts { 0 } else { 2 - (i % 2) as usize }];
                        weight * s.powi(n as i32) * (-z * (1.0 - s)).exp()
                    })
                    .sum();
                let expected = sum / f64::from(3 * parts);
                // Upwards, digits are lost with the order, where a term of B is lost in its sum.
                assert!(
                    (ours / expected - 1.0).abs() < 1e-9,
                    "z = {z}, n = {n}: {ours} {expected}"
                );
            }
        }
    }

    /// By nalgebra's products of whole matrices.
    #[test]
    fn carrying_is_both_products() {
        let g = &mut stream(7, 0, Source::Lidar);
        let (target, chaser) = fields()[0];
        let third = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner();
        let mut f = of_parts(&target, &chaser, [0.02, 0.1], &third, 30.0);
        let by_x = SMatrix::<f64, 3, 6>::from_fn(|_, _| StandardNormal.sample(g));
        f.add_to_velocity(&by_x);
        let a = StateMatrix::from_fn(|_, _| StandardNormal.sample(g));
        let p = a * a.transpose();
        let dense = f.dense();
        let expected = dense * p * dense.transpose();
        let mut ours = p;
        f.carry(&mut ours);
        assert_eq!(ours, ours.transpose());
        for i in 0..N {
            for j in 0..N {
                let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
                assert!((ours[(i, j)] - expected[(i, j)]).abs() < 1e-14 * scale, "{i} {j}");
            }
        }
        assert_eq!(f.of_target(), dense.fixed_view::<9, 9>(0, 0).into_owned());
        let once = of_parts(&target, &chaser, [0.02, 0.1], &third, 30.0).dense();
        assert!(((dense - once).fixed_view::<3, 6>(3, 0) - by_x).amax() < 1e-14);
    }
}
