//! From a window of samples to the regression c = D q for the jerk density (Mamich and Zanetti, Eqs. 13 to 28).
//!
//! The measurement has M rows, three of a LiDAR or six of a metrology; q has K entries of the 3x3 density Q, its diagonal
//! ([`DIAGONAL`], as in the paper) or all of it ([`FULL`]).
//!
//! Samples are counted 0..=2 m_b from the oldest. Two least-squares windows of m_b samples, one sample apart, estimate the
//! error at their own first sample; carried to the same epoch and subtracted they leave a sequence Z without any state
//! error, only noise:
//!
//! `Z_w = O+_{w+1} Y_{w+1} - F_w O+_w Y_w = sum_l A_w[l] eta_l + sum_j B_w[j] nu_j`
//!
//! with w the older window's first sample, O+ = (O^T O)^-1 O^T the pseudo-inverse, eta_l the measurement noise of sample l and
//! nu_j the process noise of the step from j to j + 1. A_w and B_w follow from that definition (Eqs. 22 and 23 print some
//! indices and transposes wrongly); tests check both by perturbing one sample. In the paper's indices k = w + m_b, A_i of
//! k is `a[k - i]` and B_j of k is `b[k - j]`.
//!
//! Only D^T D (KxK) and D^T c (K) leave this file; the 2475 x 3 matrix D of m_b = 30 is never formed. The window's
//! pseudo-inverse comes from an orthogonal factorisation of O, since forming O^T O squares a condition number that is
//! large already (three integrations, seen through angles at kilometres).

use crate::jerk;
use crate::state::{N_TARGET, Target, TargetMatrix};
use nalgebra::{DMatrix, Matrix3, SMatrix, SVector};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Nine states by the rows of a measurement.
pub type Gain<const M: usize> = SMatrix<f64, N_TARGET, M>;
/// The rows of a measurement by nine states.
pub type Observation<const M: usize> = SMatrix<f64, M, N_TARGET>;

/// Row and column of an entry of the jerk density that the regression solves for; off the diagonal it stands for both
/// entries that symmetry makes equal.
pub type Entry = (usize, usize);
/// The entries of a diagonal density.
pub const DIAGONAL: [Entry; 3] = [(0, 0), (1, 1), (2, 2)];
/// The entries of a symmetric density, in the order of vech.
pub const FULL: [Entry; 6] = [(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)];

/// One sample of the window, in the units (and with the row scaling) the law adapts in.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sampled<const M: usize> {
    /// Time since the previous sample.
    pub dt: f64,
    /// Transition from the previous sample to this one, 9x9.
    pub f: TargetMatrix,
    /// Measurement rows, Mx9; zero rows where nothing was measured.
    pub h: Observation<M>,
    /// Innovation, M; zero where nothing was measured.
    pub residual: SVector<f64, M>,
    /// What the filter's update added to the nine states.
    pub correction: Target,
}

/// The normal equations of c = D q.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression<const K: usize> {
    /// D^T D, KxK.
    pub dt_d: SMatrix<f64, K, K>,
    /// D^T c, K, where c is the measured autocorrelation less the part that measurement noise explains.
    pub dt_c: SVector<f64, K>,
}

/// Coefficients of Z_w for one w.
#[derive(Clone, Debug, Default)]
pub struct Difference<const M: usize> {
    /// First sample of the older window.
    pub first: usize,
    /// The difference itself, 9.
    pub z: Target,
    /// `A_w[l]` for l = w..=w+m_b, each 9xM.
    pub a: Vec<Gain<M>>,
    /// `B_w[j]` for j = w..w+m_b, each 9x9.
    pub b: Vec<TargetMatrix>,
}

/// Residuals as they would have been had the filter not corrected itself since the oldest sample.
///
/// d_{j+1} = F_j (d_j + correction_j) from d = 0, and each residual gains H_j d_j. Z does not depend on where d starts.
pub fn open_loop_residuals<const M: usize>(samples: &[Sampled<M>]) -> impl Iterator<Item = SVector<f64, M>> {
    let mut d = Target::zeros();
    samples.iter().enumerate().map(move |(j, sample)| {
        if j > 0 {
            d = sample.f * (d + samples[j - 1].correction);
        }
        sample.residual + sample.h * d
    })
}

/// Room in which regressions are worked out, so that only the first of a length asks for memory. Nothing in it outlives one: a copy
/// begins with none.
#[derive(Debug, Default)]
pub struct Work<const M: usize> {
    residuals: Vec<SVector<f64, M>>,
    /// Roots of the process noise of the newer steps, for a unit jerk density.
    factors: Vec<Matrix3<f64>>,
    windows: Windows<M>,
    newest: Difference<M>,
    earlier: Difference<M>,
}

impl<const M: usize> Clone for Work<M> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Pseudo-inverse of the stacked rows of one window.
///
/// * `rows`: O, one Mx9 block for each sample.
/// * `q`: room for the factorisation.
/// * `out`: (O^T O)^-1 O^T as one 9xM block for each sample.
/// * returns: `None` when the window does not observe all nine states.
fn pseudo_inverse<const M: usize>(
    rows: &VecDeque<Observation<M>>,
    q: &mut DMatrix<f64>,
    out: &mut Vec<Gain<M>>,
) -> Option<()> {
    if q.nrows() != M * rows.len() {
        *q = DMatrix::zeros(M * rows.len(), N_TARGET);
    }
    for (sample, row) in rows.iter().enumerate() {
        q.rows_mut(M * sample, M).copy_from(row);
    }
    let mut r = TargetMatrix::zeros();
    // O = Q R by Gram-Schmidt, each column orthogonalised twice: as accurate as Householder and as short as the definition.
    for j in 0..N_TARGET {
        let length = q.column(j).norm();
        for _ in 0..2 {
            for i in 0..j {
                let (done, mut column) = q.columns_range_pair_mut(i, j);
                let dot = done.dot(&column);
                r[(i, j)] += dot;
                column.axpy(-dot, &done, 1.0);
            }
        }
        let rest = q.column(j).norm();
        // Below this nothing but rounding is left of the column.
        if rest.is_nan() || rest <= 1e-13 * length {
            return None;
        }
        r[(j, j)] = rest;
        q.column_mut(j).unscale_mut(rest);
    }
    // R X = Q^T from its last row up; the rows of X take the place of the columns of Q.
    for i in (0..N_TARGET).rev() {
        for k in i + 1..N_TARGET {
            let (mut row, solved) = q.columns_range_pair_mut(i, k);
            row.axpy(-r[(i, k)], &solved, 1.0);
        }
        q.column_mut(i).unscale_mut(r[(i, i)]);
    }
    let gain = |sample: usize| Gain::from_fn(|i, row| q[(M * sample + row, i)]);
    out.clear();
    out.extend((0..rows.len()).map(gain));
    Some(())
}

/// Two least-squares windows, one sample apart, on their way from the newest samples to the oldest.
#[derive(Debug, Default)]
struct Windows<const M: usize> {
    /// Rows H_l Phi_{l,start} of the older window, and the factorisation of its O.
    rows: VecDeque<Observation<M>>,
    q: DMatrix<f64>,
    /// Pseudo-inverse of either window, one block for each sample.
    older: Vec<Gain<M>>,
    newer: Vec<Gain<M>>,
}

impl<const M: usize> Windows<M> {
    /// Begins with the window that starts at sample m_b + 1 as the older one.
    ///
    /// * `samples`: 2 m_b + 1, oldest first.
    /// * returns: `None` when it is singular.
    fn begin(&mut self, samples: &[Sampled<M>], m_b: usize) -> Option<()> {
        self.rows.clear();
        for start in (m_b + 2..samples.len()).rev() {
            self.prepend(samples, start, m_b);
        }
        self.back(samples, m_b + 1, m_b)
    }

    /// The older window becomes the newer one, and that which starts at sample `start`, one before it, the older.
    ///
    /// * returns: `None` when that is singular.
    fn back(&mut self, samples: &[Sampled<M>], start: usize, m_b: usize) -> Option<()> {
        self.prepend(samples, start, m_b);
        std::mem::swap(&mut self.older, &mut self.newer);
        pseudo_inverse(&self.rows, &mut self.q, &mut self.older)
    }

    /// Each window inherits the rows of the one after it times one transition.
    fn prepend(&mut self, samples: &[Sampled<M>], start: usize, m_b: usize) {
        if let Some(next) = samples.get(start + 1) {
            self.rows.iter_mut().for_each(|row| *row *= next.f);
        }
        self.rows.push_front(samples[start].h);
        self.rows.truncate(m_b);
    }
}

/// The difference Z_w; its `a` and `z` are whole, its `b` starts at step `b_from`.
///
/// * `samples`: 2 m_b + 1, oldest first.
/// * `residuals`: one for each.
/// * `windows`: those that start at samples w and w + 1.
/// * `w`: first sample of the older window, 0..=m_b.
/// * `b_from`: coefficients of process noise before this step are not needed and left out of `b`.
fn difference<const M: usize>(
    samples: &[Sampled<M>],
    residuals: &[SVector<f64, M>],
    windows: &Windows<M>,
    w: usize,
    b_from: usize,
    out: &mut Difference<M>,
) {
    let m_b = windows.older.len();
    let f = &samples[w + 1].f;
    let Difference { first, z, a, b } = out;
    *first = w;
    a.clear();
    a.resize(m_b + 1, Gain::zeros());
    for (i, (older, newer)) in windows.older.iter().zip(&windows.newer).enumerate() {
        a[i] -= f * older;
        a[i + 1] += newer;
    }
    *z = a
        .iter()
        .zip(&residuals[w..])
        .fold(Target::zeros(), |z, (a, y)| z + a * y);
    // What a window makes of an error e at sample j that enters there: sum over l >= j of its gain times
    // H_l Phi_{l,j}. The difference of both windows' answers to nu_j at sample j + 1 is B_w[j]; A holds that
    // difference of gains, but for the older window's first sample, which precedes every nu_j.
    let first_step = b_from.max(w);
    b.clear();
    b.resize(w + m_b - first_step, TargetMatrix::zeros());
    let mut seen = TargetMatrix::zeros();
    for j in (first_step..w + m_b).rev() {
        if j + 2 <= w + m_b {
            seen *= samples[j + 2].f;
        }
        seen += a[j + 1 - w] * samples[j + 1].h;
        b[j - first_step] = seen;
    }
}

/// Every difference Z_w of a window with all its coefficients, for tests and for the curious.
///
/// * `samples`: 2 m_b + 1, oldest first.
/// * returns: `None` when there are too few samples or a window is singular.
pub fn all_differences<const M: usize>(
    samples: &[Sampled<M>],
    m_b: usize,
    open_loop: bool,
) -> Option<Vec<Difference<M>>> {
    if samples.len() != 2 * m_b + 1 || m_b == 0 {
        return None;
    }
    let (mut residuals, mut windows, mut all) = (Vec::new(), Windows::default(), Vec::new());
    residuals_of(samples, open_loop, &mut residuals);
    windows.begin(samples, m_b)?;
    for w in (0..=m_b).rev() {
        windows.back(samples, w, m_b)?;
        let mut one = Difference::default();
        difference(samples, &residuals, &windows, w, 0, &mut one);
        all.push(one);
    }
    all.reverse();
    Some(all)
}

fn residuals_of<const M: usize>(samples: &[Sampled<M>], open_loop: bool, out: &mut Vec<SVector<f64, M>>) {
    out.clear();
    if open_loop {
        out.extend(open_loop_residuals(samples));
    } else {
        out.extend(samples.iter().map(|s| s.residual));
    }
}

/// The normal equations of Eq. (28) before the square root: c = D q with one column of D for each entry of q.
///
/// * `samples`: 2 m_b + 1, oldest first.
/// * `r`: measurement noise covariance in the units (and row scaling) of the samples, MxM.
/// * `open_loop`: whether to undo the filter's corrections first.
/// * `entries`: of the density, those that q holds; the others are zero.
/// * `work`: of any earlier regression, or none.
/// * returns: `None` when there are too few samples or a window does not observe all nine states.
pub fn regression<const M: usize, const K: usize>(
    samples: &[Sampled<M>],
    m_b: usize,
    r: &SMatrix<f64, M, M>,
    open_loop: bool,
    entries: &[Entry; K],
    work: &mut Work<M>,
) -> Option<Regression<K>> {
    if samples.len() != 2 * m_b + 1 || m_b == 0 {
        return None;
    }
    let Work {
        residuals,
        factors,
        windows,
        newest,
        earlier,
    } = work;
    residuals_of(samples, open_loop, residuals);
    factors.clear();
    factors.extend(samples[m_b + 1..].iter().map(|s| jerk::gamma_factor(s.dt)));
    // Z_k is correlated with its predecessors through samples m_b..=2 m_b only. What a unit density on one
    // axis does has rank three: B times (factor of Gamma x e_axis), 9x3 for each axis, side by side in place of B.
    let driven = |windows: &Windows<M>, w: usize, one: &mut Difference<M>| {
        difference(samples, residuals, windows, w, m_b, one);
        for (b, factor) in one.b.iter_mut().zip(factors.iter()) {
            *b = through_jerk(b, factor);
        }
    };
    windows.begin(samples, m_b)?;
    let mut out = Regression {
        dt_d: SMatrix::zeros(),
        dt_c: SVector::zeros(),
    };
    for p in 0..=m_b {
        windows.back(samples, m_b - p, m_b)?;
        if p == 0 {
            driven(windows, m_b, newest);
        }
        driven(windows, m_b - p, earlier);
        let mut noise = TargetMatrix::zeros();
        for l in m_b..=2 * m_b - p {
            noise += newest.a[l - m_b] * r * earlier.a[l - earlier.first].transpose();
        }
        let c = newest.z * earlier.z.transpose() - noise;
        let mut columns = [TargetMatrix::zeros(); K];
        for (now, then) in newest.b.iter().zip(&earlier.b) {
            for (&(i, j), column) in entries.iter().zip(&mut columns) {
                let mut add = |i: usize, j: usize| {
                    let (now, then) = (now.fixed_columns::<3>(3 * i), then.fixed_columns::<3>(3 * j));
                    column.gemm(1.0, &now, &then.transpose(), 1.0);
                };
                add(i, j);
                if i != j {
                    add(j, i);
                }
            }
        }
        for i in 0..K {
            out.dt_c[i] += inner(&columns[i], &c, p == 0);
            for j in 0..=i {
                let d = inner(&columns[i], &columns[j], p == 0);
                out.dt_d[(i, j)] += d;
                if i != j {
                    out.dt_d[(j, i)] += d;
                }
            }
        }
    }
    Some(out)
}

/// B (Gamma^1/2 x I), its columns sorted by axis.
fn through_jerk(b: &TargetMatrix, factor: &Matrix3<f64>) -> TargetMatrix {
    let mut out = TargetMatrix::zeros();
    for axis in 0..3 {
        for m in 0..3 {
            for n in m..3 {
                let weight = factor[(n, m)];
                for row in 0..N_TARGET {
                    out[(row, 3 * axis + m)] += b[(row, 3 * n + axis)] * weight;
                }
            }
        }
    }
    out
}

/// Inner product of two blocks of Eq. (28): over all entries, or over one triangle where the block is stacked by vech.
fn inner(a: &TargetMatrix, b: &TargetMatrix, vech: bool) -> f64 {
    if vech {
        (0..N_TARGET)
            .map(|j| (j..N_TARGET).map(|i| a[(i, j)] * b[(i, j)]).sum::<f64>())
            .sum()
    } else {
        a.dot(b)
    }
}

#[cfg(test)]
#[allow(clippy::needless_range_loop, reason = "indices are the paper's")]
pub(super) mod tests {
    use super::*;
    use nalgebra::{DVector, Vector3, Vector6};
    use numerics::{Generator, Source, expm, spd, stream};
    use rand_distr::{Distribution, StandardNormal};

    const M_B: usize = 5;

    fn regression<const M: usize, const K: usize>(
        samples: &[Sampled<M>],
        m_b: usize,
        r: &SMatrix<f64, M, M>,
        open_loop: bool,
        entries: &[Entry; K],
    ) -> Option<Regression<K>> {
        super::regression(samples, m_b, r, open_loop, entries, &mut Work::default())
    }

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    /// A window of a time-varying system that resembles the real one: three integrators with a gravity gradient, seen
    /// through rows that turn, three of the position or six of position and velocity. Steps are of unequal length.
    fn window<const M: usize>(g: &mut Generator) -> Vec<Sampled<M>> {
        (0..2 * M_B + 1)
            .map(|k| {
                let dt = 1.0 + 0.25 * (k % 3) as f64;
                let mut a = TargetMatrix::zeros();
                for i in 0..6 {
                    a[(i, i + 3)] = 1.0;
                }
                for i in 0..3 {
                    for j in 0..3 {
                        a[(3 + i, j)] = 0.02 * normal(g);
                    }
                }
                let mut h = Observation::zeros();
                for i in 0..M {
                    for j in 0..M {
                        h[(i, j)] = normal(g);
                    }
                }
                Sampled {
                    dt,
                    f: expm(&(a * dt)),
                    h,
                    residual: SVector::from_fn(|_, _| normal(g)),
                    correction: Target::from_fn(|_, _| normal(g)),
                }
            })
            .collect()
    }

    /// Z as the paper defines it, Eqs. (16) to (19), by normal equations.
    fn z_by_definition<const M: usize>(samples: &[Sampled<M>], w: usize) -> Target {
        let estimate = |start: usize| {
            let (mut m, mut oy, mut phi) = (TargetMatrix::zeros(), Target::zeros(), TargetMatrix::identity());
            for l in start..start + M_B {
                if l > start {
                    phi = samples[l].f * phi;
                }
                let o = samples[l].h * phi;
                m += o.transpose() * o;
                oy += o.transpose() * samples[l].residual;
            }
            m.try_inverse().unwrap() * oy
        };
        estimate(w + 1) - samples[w + 1].f * estimate(w)
    }

    #[test]
    fn z_follows_its_definition() {
        let samples = window::<3>(&mut stream(1, 0, Source::Lidar));
        for d in all_differences(&samples, M_B, false).unwrap() {
            let expected = z_by_definition(&samples, d.first);
            assert!(
                (d.z - expected).amax() < 1e-8 * expected.amax().max(1.0),
                "w = {}",
                d.first
            );
        }
    }

    #[test]
    fn z_annihilates_any_state_error() {
        let g = &mut stream(2, 0, Source::Lidar);
        let mut samples = window::<3>(g);
        let mut e = Target::from_fn(|_, _| 100.0 * normal(g));
        for k in 0..samples.len() {
            if k > 0 {
                e = samples[k].f * e;
            }
            samples[k].residual = samples[k].h * e;
        }
        for d in all_differences(&samples, M_B, false).unwrap() {
            assert!(d.z.amax() < 1e-8, "w = {}: {}", d.first, d.z.amax());
        }
    }

    #[test]
    fn a_is_the_answer_to_one_perturbed_measurement() {
        answers_to_measurements::<3>();
        answers_to_measurements::<6>();
    }

    fn answers_to_measurements<const M: usize>() {
        let samples = window::<M>(&mut stream(3, 0, Source::Lidar));
        let all = all_differences(&samples, M_B, false).unwrap();
        for d in &all {
            for l in 0..samples.len() {
                for row in 0..M {
                    let mut perturbed = samples.clone();
                    perturbed[l].residual[row] += 1.0;
                    let answer = z_by_definition(&perturbed, d.first) - z_by_definition(&samples, d.first);
                    let known = l.checked_sub(d.first).and_then(|i| d.a.get(i));
                    let expected = known.map_or_else(Target::zeros, |a| a.column(row).into_owned());
                    assert!(
                        (answer - expected).amax() < 1e-8,
                        "{M} rows, w = {}, sample {l}, row {row}",
                        d.first
                    );
                }
            }
        }
    }

    #[test]
    fn b_is_the_answer_to_one_perturbed_step() {
        answers_to_steps::<3>();
        answers_to_steps::<6>();
    }

    fn answers_to_steps<const M: usize>() {
        let samples = window::<M>(&mut stream(4, 0, Source::Lidar));
        for d in all_differences(&samples, M_B, false).unwrap() {
            for j in 0..2 * M_B {
                for state in 0..N_TARGET {
                    let mut perturbed = samples.clone();
                    let mut e = Target::zeros();
                    e[state] = 1.0;
                    for k in j + 1..samples.len() {
                        if k > j + 1 {
                            e = samples[k].f * e;
                        }
                        perturbed[k].residual += samples[k].h * e;
                    }
                    let answer = z_by_definition(&perturbed, d.first) - z_by_definition(&samples, d.first);
                    let known = j.checked_sub(d.first).and_then(|i| d.b.get(i));
                    let expected = known.map_or_else(Target::zeros, |b| b.column(state).into_owned());
                    assert!(
                        (answer - expected).amax() < 1e-7,
                        "{M} rows, w = {}, step {j}, state {state}",
                        d.first
                    );
                }
            }
        }
    }

    #[test]
    fn open_loop_residuals_undo_the_corrections() {
        // Errors that evolve freely against the same errors seen by a filter that corrects itself by arbitrary amounts.
        let g = &mut stream(5, 0, Source::Lidar);
        let mut samples = window::<3>(g);
        let (mut free, mut filtered) = (Target::from_fn(|_, _| normal(g)), Target::zeros());
        let start = free;
        let mut expected = Vec::new();
        for k in 0..samples.len() {
            if k > 0 {
                free = samples[k].f * free;
                filtered = samples[k].f * (filtered - samples[k - 1].correction);
            } else {
                filtered = start;
            }
            samples[k].residual = samples[k].h * filtered;
            expected.push(samples[k].h * free);
        }
        for (ours, expected) in open_loop_residuals(&samples).zip(&expected) {
            assert!((ours - expected).amax() < 1e-8);
        }
    }

    fn vec(m: &DMatrix<f64>) -> DVector<f64> {
        DVector::from_column_slice(m.as_slice())
    }

    /// The regression with the big matrix formed block by block from Kronecker products, as Eqs. (24) to (28) print it
    /// (vec column-stacked, which the Kronecker identity needs; vech takes one triangle of the first block).
    #[test]
    fn normal_equations_agree_with_the_matrix_that_is_never_formed() {
        let r = Matrix3::new(0.5, 0.1, 0.0, 0.1, 0.8, -0.2, 0.0, -0.2, 0.3);
        agrees_with_the_matrix(&r, &DIAGONAL);
        agrees_with_the_matrix(&r, &FULL);
        let mut six = SMatrix::from_diagonal(&Vector6::new(0.5, 0.8, 0.3, 0.02, 0.1, 0.07));
        six[(1, 4)] = -0.1;
        six[(4, 1)] = -0.1;
        agrees_with_the_matrix(&six, &DIAGONAL);
        agrees_with_the_matrix(&six, &FULL);
    }

    fn agrees_with_the_matrix<const M: usize, const K: usize>(r: &SMatrix<f64, M, M>, entries: &[Entry; K]) {
        let samples = window::<M>(&mut stream(6, 0, Source::Lidar));
        let all = all_differences(&samples, M_B, false).unwrap();
        let newest = &all[M_B];
        let dynamic = |m: &TargetMatrix| DMatrix::from_column_slice(9, 9, m.as_slice());
        let gain = |m: &Gain<M>| DMatrix::from_column_slice(9, M, m.as_slice());
        let (mut d_rows, mut c_rows) = (Vec::new(), Vec::new());
        for p in 0..=M_B {
            let earlier = &all[M_B - p];
            let mut block = DMatrix::zeros(81, K);
            for j in M_B..2 * M_B - p {
                let b = dynamic(&newest.b[j - M_B]);
                let b_earlier = dynamic(&earlier.b[j - earlier.first]);
                let kron = b_earlier.kronecker(&b);
                for (entry, (row, column)) in entries.iter().enumerate() {
                    let mut q = Matrix3::zeros();
                    q[(*row, *column)] = 1.0;
                    q[(*column, *row)] = 1.0;
                    let q_hat = dynamic(&jerk::process_noise_full(&q, samples[j + 1].dt));
                    let mut column = block.column_mut(entry);
                    column += &kron * vec(&q_hat);
                }
            }
            let z = DMatrix::from_column_slice(9, 1, newest.z.as_slice())
                * DMatrix::from_column_slice(9, 1, earlier.z.as_slice()).transpose();
            let mut c = vec(&z);
            for l in M_B..=2 * M_B - p {
                let kron = gain(&earlier.a[l - earlier.first]).kronecker(&gain(&newest.a[l - M_B]));
                c -= kron * DVector::from_column_slice(r.as_slice());
            }
            for entry in 0..81 {
                if p > 0 || entry % 9 >= entry / 9 {
                    d_rows.push(block.row(entry).into_owned());
                    c_rows.push(c[entry]);
                }
            }
        }
        // The paper's count of rows: m_b n^2 + n (n + 1) / 2.
        assert_eq!(d_rows.len(), M_B * 81 + 45);
        let (d, c) = (DMatrix::from_rows(&d_rows), DVector::from_vec(c_rows));
        let (dt_d, dt_c) = (d.transpose() * &d, d.transpose() * c);
        let ours = regression(&samples, M_B, r, false, entries).unwrap();
        for i in 0..K {
            assert!((ours.dt_c[i] - dt_c[i]).abs() < 1e-9 * dt_c.amax());
            for j in 0..K {
                assert!((ours.dt_d[(i, j)] - dt_d[(i, j)]).abs() < 1e-9 * dt_d.amax());
            }
        }
    }

    #[test]
    fn missing_rows_are_left_out_and_blind_windows_refused() {
        let g = &mut stream(7, 0, Source::Lidar);
        let mut samples = window::<3>(g);
        let blind = |s: &mut Sampled<3>| {
            s.h = Observation::zeros();
            s.residual = Vector3::zeros();
        };
        blind(&mut samples[M_B + 1]);
        let r = Matrix3::identity();
        let all = all_differences(&samples, M_B, false).unwrap();
        assert!(
            all.iter()
                .all(|d| d.a.get(M_B + 1 - d.first).is_none_or(|a| a.amax() < 1e-12))
        );
        assert!(regression(&samples, M_B, &r, false, &DIAGONAL).is_some());
        samples.iter_mut().skip(3).take(3).for_each(blind);
        assert_eq!(regression(&samples, M_B, &r, false, &DIAGONAL), None);
        assert_eq!(regression(&samples[1..], M_B, &r, false, &DIAGONAL), None);
    }

    /// A Kalman filter with a wrong Q watches three integrators driven by jerk of a known density.
    ///
    /// * `h`, `sigma`: rows of the measurement and their noise, by which rows and residuals are divided.
    /// * `density`: 3x3.
    /// * returns: `count` samples, a second apart.
    pub(in crate::laws) fn watched<const M: usize>(
        h: &Observation<M>,
        sigma: &SVector<f64, M>,
        density: &Matrix3<f64>,
        run: u64,
        count: usize,
    ) -> Vec<Sampled<M>> {
        let dt = 1.0;
        let mut a = TargetMatrix::zeros();
        for i in 0..6 {
            a[(i, i + 3)] = 1.0;
        }
        let f = expm(&(a * dt));
        let h = SMatrix::<f64, M, M>::from_diagonal(&sigma.map(|s| 1.0 / s)) * h;
        let r = SMatrix::<f64, M, M>::identity();
        let q_filter = jerk::process_noise_full(&(density * 9.0), dt);
        let draw = jerk::process_noise_full(density, dt).cholesky().unwrap().l();
        let g = &mut stream(8, run, Source::Lidar);
        let (mut e, mut p) = (Target::zeros(), TargetMatrix::identity());
        let mut step = || {
            e = f * e + draw * Target::from_fn(|_, _| normal(g));
            p = f * p * f.transpose() + q_filter;
            let residual = h * e + SVector::<f64, M>::from_fn(|_, _| normal(g));
            let s = (h * p * h.transpose() + r).cholesky().unwrap();
            let mut gain = p * h.transpose();
            for mut row in gain.row_iter_mut() {
                let solved = s.solve(&row.transpose());
                row.copy_from(&solved.transpose());
            }
            let correction = gain * residual;
            e -= correction;
            p = spd::symmetrised(&(p - gain * h * p));
            Sampled {
                dt,
                f,
                h,
                residual,
                correction,
            }
        };
        (0..count).map(|_| step()).collect()
    }

    /// What the regression finds in the world of [`watched`]. On open-loop residuals it must find the density without
    /// bias; on the filter's own innovations it need not.
    ///
    /// * returns: mean of the estimated entries, and its standard error from independent batches.
    fn recovered_density<const M: usize, const K: usize>(
        h: &Observation<M>,
        sigma: &SVector<f64, M>,
        density: &Matrix3<f64>,
        entries: &[Entry; K],
        open_loop: bool,
    ) -> (SVector<f64, K>, SVector<f64, K>) {
        let m_b = 8;
        let batches: Vec<SVector<f64, K>> = (0..30)
            .map(|batch| {
                let samples = watched(h, sigma, density, batch, 4000);
                let (mut dt_d, mut dt_c) = (SMatrix::<f64, K, K>::zeros(), SVector::<f64, K>::zeros());
                for window in samples.windows(2 * m_b + 1).step_by(m_b + 1) {
                    let found = regression(window, m_b, &SMatrix::identity(), open_loop, entries).unwrap();
                    dt_d += found.dt_d;
                    dt_c += found.dt_c;
                }
                dt_d.cholesky().unwrap().solve(&dt_c)
            })
            .collect();
        let n = batches.len() as f64;
        let mean = batches.iter().sum::<SVector<f64, K>>() / n;
        let square = |b: &SVector<f64, K>| (b - mean).map(|v| v * v);
        let variance = batches.iter().map(square).sum::<SVector<f64, K>>() / (n - 1.0);
        (mean, (variance / n).map(f64::sqrt))
    }

    /// Every entry of `density` within 3.5 standard errors, and these below `resolution` of its largest entry.
    fn assert_recovered<const M: usize, const K: usize>(
        h: &Observation<M>,
        sigma: &SVector<f64, M>,
        density: &Matrix3<f64>,
        entries: &[Entry; K],
        resolution: f64,
    ) {
        let (mean, error) = recovered_density(h, sigma, density, entries, true);
        for (i, entry) in entries.iter().enumerate() {
            let (mean, error, truth) = (mean[i], error[i], density[*entry]);
            assert!(
                (mean - truth).abs() < 3.5 * error,
                "{M} rows, {entry:?}: {mean} +- {error} for {truth}"
            );
            assert!(
                error < resolution * density.amax(),
                "{M} rows, {entry:?}: too few samples to tell, {error}"
            );
        }
    }

    /// Three rows of the position that are not orthogonal.
    pub(in crate::laws) fn oblique() -> Observation<3> {
        let mut h = Observation::zeros();
        h.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&Matrix3::new(1.0, 0.2, 0.0, -0.1, 0.8, 0.3, 0.0, 0.1, 1.2));
        h
    }

    #[test]
    fn open_loop_residuals_recover_the_density_and_innovations_do_not() {
        let density = Matrix3::from_diagonal(&Vector3::new(0.4, 1.0, 2.5));
        let (h, sigma) = (oblique(), Vector3::repeat(0.3));
        assert_recovered(&h, &sigma, &density, &DIAGONAL, 0.1);
        let (mean, error) = recovered_density(&h, &sigma, &density, &DIAGONAL, false);
        assert!(
            (0..3).all(|i| (mean[i] - density[(i, i)]).abs() > 5.0 * error[i]),
            "innovations: {mean} +- {error}"
        );
    }

    /// Position and velocity measured in full, one a hundred times more precise than the other in numbers.
    #[test]
    fn a_state_measured_in_full_recovers_the_density() {
        let density = Matrix3::from_diagonal(&Vector3::new(0.4, 1.0, 2.5));
        let sigma = Vector6::new(1.0, 1.0, 1.0, 1e-2, 1e-2, 1e-2);
        assert_recovered(&Observation::<6>::identity(), &sigma, &density, &DIAGONAL, 0.1);
    }

    #[test]
    fn entries_off_the_diagonal_are_recovered() {
        let density = Matrix3::new(2.0, -0.9, 0.3, -0.9, 1.0, 0.2, 0.3, 0.2, 0.4);
        assert_recovered(&oblique(), &Vector3::repeat(0.3), &density, &FULL, 0.1);
        let sigma = Vector6::new(1.0, 1.0, 1.0, 1e-2, 1e-2, 1e-2);
        assert_recovered(&Observation::<6>::identity(), &sigma, &density, &FULL, 0.1);
    }
}
