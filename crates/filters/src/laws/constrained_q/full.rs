//! The regression solved for a full symmetric density: a semidefinite programme in six unknowns, by cutting planes.
//!
//! clarabel's own semidefinite cone needs a BLAS and a LAPACK, and each of its features asks for something that not every
//! machine has: CMake and Fortran (netlib), sources downloaded while building (openblas), the MKL, R, or an Apple system.
//! An FMU should build and load anywhere, and for a 3x3 matrix second-order cones do: a symmetric matrix M is positive semidefinite exactly when every 2x2 matrix [v w]^T M [v w] with orthonormal
//! v, w is, and each of those is one second-order cone. The programme with a few of them bounds the semidefinite one from
//! outside; its answer violates others, first of all among the eigenvectors of its own M. Those are added and the programme
//! is solved again, until no eigenvalue violates its bound: then the answer of a programme with fewer constraints
//! satisfies all of them, and is the minimum of the semidefinite one.

use numerics::math;

use super::conic::{self, Almost, NoAnswer};
use crate::laws::correlation::FULL;
use clarabel::solver::{SecondOrderConeT, SupportedConeT};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// By how much an eigenvalue may violate its bound, relative to the largest of the matrix.
const TOLERANCE: f64 = 1e-7;
/// Most programmes solved for one answer.
const ROUNDS: usize = 60;

/// A matrix that must be positive semidefinite: `constant` I + `sign` T U T with T = diag(`scale`), U the unknown.
struct Margin {
    constant: f64,
    sign: f64,
    scale: Vector3<f64>,
}

/// The cuts made so far, in the form of the solver: limits - rows u in one second-order cone of three rows for each. Kept from one
/// answer to the next for its memory alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Cuts {
    rows: Vec<[f64; 6]>,
    limits: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
}

impl Margin {
    /// The matrix itself.
    fn at(&self, u: &Matrix3<f64>) -> Matrix3<f64> {
        let t = Matrix3::from_diagonal(&self.scale);
        Matrix3::identity() * self.constant + t * u * t * self.sign
    }

    /// What positive semidefiniteness asks of those planes between the columns of `axes` (orthonormal) that hold one of
    /// the axes marked in `of`.
    fn cut(&self, axes: &Matrix3<f64>, of: &[bool; 3], cuts: &mut Cuts) {
        // x^T T U T y as a function of the entries of U.
        let form = |x: usize, y: usize| {
            let (x, y) = (
                axes.column(x).component_mul(&self.scale),
                axes.column(y).component_mul(&self.scale),
            );
            Vector6::from_fn(|k, _| {
                let (i, j) = FULL[k];
                if i == j { x[i] * y[i] } else { x[i] * y[j] + x[j] * y[i] }
            }) * self.sign
        };
        for (v, w) in [(0, 1), (0, 2), (1, 2)] {
            if !of[v] && !of[w] {
                continue;
            }
            // [a b; b c] is positive semidefinite when |(a - c, 2 b)| <= a + c.
            let (a, b, c) = (form(v, v), form(v, w), form(w, w));
            for (row, limit) in [(a + c, 2.0 * self.constant), (a - c, 0.0), (b * 2.0, 0.0)] {
                cuts.rows.push((-row).into());
                cuts.limits.push(limit);
            }
            cuts.cones.push(SecondOrderConeT(3));
        }
    }
}

impl Cuts {
    fn clear(&mut self) {
        self.rows.clear();
        self.limits.clear();
        self.cones.clear();
    }
}

/// The symmetric matrix of the six entries.
fn matrix(entries: &Vector6<f64>) -> Matrix3<f64> {
    let mut m = Matrix3::zeros();
    for (value, (i, j)) in entries.iter().zip(FULL) {
        m[(i, j)] = *value;
        m[(j, i)] = *value;
    }
    m
}

/// The six entries of a symmetric matrix.
fn entries(m: &Matrix3<f64>) -> Vector6<f64> {
    Vector6::from_fn(|k, _| m[FULL[k]])
}

/// The symmetric Q with `lower` I <= Q <= `upper` I that minimises 1/2 q^T h q - g^T q, q its six entries.
///
/// * `h`, `g`: 6x6, symmetric, positive definite, and 6, in the order of [`FULL`].
/// * `cuts`: of any earlier answer, or none; they are made anew.
///
/// # Errors
/// See [`NoAnswer`]; `None` also when the last of the rounds still violates a bound.
pub(super) fn minimise(
    h: &Matrix6<f64>,
    g: &Vector6<f64>,
    lower: f64,
    upper: f64,
    cuts: &mut Cuts,
) -> Result<Matrix3<f64>, NoAnswer> {
    // Densities span many decades: Q = lower I + size S U S with a diagonal S that gives the Hessian of U ones where U has
    // its diagonal, and a size that gives the linear term one.
    let side = Vector3::from_fn(|i, _| {
        let k = FULL.iter().position(|entry| *entry == (i, i)).unwrap_or(0);
        math::powf(h[(k, k)], -0.25)
    });
    if !side.iter().all(|s| s.is_finite() && *s > 0.0) || !g.iter().all(|v| v.is_finite()) {
        return Err(None);
    }
    let weight = FULL.map(|(i, j)| side[i] * side[j]);
    let rest = g - h * entries(&(Matrix3::identity() * lower));
    let linear: [f64; 6] = std::array::from_fn(|k| -rest[k] * weight[k]);
    if !linear.iter().all(|v| v.is_finite()) {
        return Err(None);
    }
    let size = linear.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
    let cost = std::array::from_fn(|k| std::array::from_fn(|l| h[(k, l)] * weight[k] * weight[l]));
    let linear = linear.map(|v| v / size);
    let above = Margin {
        constant: 0.0,
        sign: 1.0,
        scale: Vector3::repeat(1.0),
    };
    let below = Margin {
        constant: 1.0,
        sign: -1.0,
        scale: side * (size / (upper - lower)).sqrt(),
    };
    cuts.clear();
    // A bound that the answer keeps clear of is never mentioned to the solver: its tolerances are relative to the limits.
    above.cut(&Matrix3::identity(), &[true; 3], cuts);
    for _ in 0..ROUNDS {
        let u = conic::solve(&cost, &linear, &cuts.rows, &cuts.limits, &cuts.cones, Almost::Taken)?;
        let u = matrix(&Vector6::from(u));
        let mut kept = true;
        for (margin, largest) in [(&above, u.amax().max(1.0)), (&below, 1.0)] {
            let eigen = margin.at(&u).symmetric_eigen();
            let violated: [bool; 3] = std::array::from_fn(|i| eigen.eigenvalues[i] < -TOLERANCE * largest);
            margin.cut(&eigen.eigenvectors, &violated, cuts);
            kept &= !violated.contains(&true);
        }
        if kept {
            let side = Matrix3::from_diagonal(&side);
            let mut eigen = (Matrix3::identity() * lower + side * u * side * size).symmetric_eigen();
            // What the tolerances left.
            eigen.eigenvalues.apply(|v| *v = v.clamp(lower, upper));
            let q = numerics::spd::symmetrised(&eigen.recompose());
            return if q.iter().all(|v| v.is_finite()) {
                Ok(q)
            } else {
                Err(None)
            };
        }
    }
    Err(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use numerics::{Generator, Source, stream};
    use rand_distr::{Distribution, StandardNormal};

    fn minimise(h: &Matrix6<f64>, g: &Vector6<f64>, lower: f64, upper: f64) -> Result<Matrix3<f64>, NoAnswer> {
        super::minimise(h, g, lower, upper, &mut Cuts::default())
    }

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    fn unit(k: usize) -> Matrix3<f64> {
        matrix(&Vector6::from_fn(|l, _| f64::from(k == l)))
    }

    /// The semidefinite minimum by another road: Newton's method inside the bounds on
    /// t (1/2 q^T h q - g^T q) - log det (Q - lower I) - log det (upper I - Q). Its answer costs at most 6 / t too much.
    fn by_barrier(h: &Matrix6<f64>, g: &Vector6<f64>, lower: f64, upper: f64) -> Vector6<f64> {
        let one = Matrix3::identity();
        let factors = |q: &Vector6<f64>| {
            let q = matrix(q);
            Some(((q - one * lower).cholesky()?, (one * upper - q).cholesky()?))
        };
        let free = h.cholesky().unwrap().solve(g);
        let size = free.dot(g);
        let mut q = entries(&(one * (0.5 * (lower + upper)).min(2.0 * lower + free.amax())));
        let mut t = 1e-2 / size;
        while 6.0 / t > 1e-11 * size {
            t *= 5.0;
            let value = |q: &Vector6<f64>| {
                let (above, below) = factors(q)?;
                let log_det = |l: &Matrix3<f64>| 2.0 * l.diagonal().map(f64::ln).sum();
                Some(t * (0.5 * q.dot(&(h * q)) - g.dot(q)) - log_det(&above.l()) - log_det(&below.l()))
            };
            for _ in 0..100 {
                let (above, below) = factors(&q).unwrap();
                let (a, b) = (above.inverse(), below.inverse());
                let slope = (h * q - g) * t + Vector6::from_fn(|k, _| ((b - a) * unit(k)).trace());
                let curvature = |k, l| (a * unit(k) * a * unit(l) + b * unit(k) * b * unit(l)).trace();
                let hessian = h * t + Matrix6::from_fn(curvature);
                let scale = Matrix6::from_diagonal(&hessian.diagonal().map(|d| 1.0 / d.sqrt()));
                let Some(l) = (scale * hessian * scale).cholesky() else {
                    break;
                };
                let step = -(scale * l.solve(&(scale * slope)));
                let (now, decrement) = (value(&q).unwrap(), -step.dot(&slope));
                let mut lengths = (0..40).map(|i| f64::powi(0.5, i));
                let falls = |s: &f64| value(&(q + step * *s)).is_some_and(|v| v <= now - 0.1 * s * decrement);
                let Some(length) = lengths.find(falls) else {
                    break;
                };
                q += step * length;
                if decrement < 1e-16 {
                    break;
                }
            }
        }
        q
    }

    /// Random programmes whose free minimum has the eigenvalues `free`, in axes of unlike units.
    fn agrees_with_the_barrier(free: [f64; 3], lower: f64, upper: f64, unit: f64) {
        for run in 0..40 {
            let g = &mut stream(31, run, Source::Lidar);
            let basis = Matrix6::from_fn(|_, _| normal(g)).qr().q();
            let condition = Matrix6::from_diagonal(&Vector6::from_fn(|i, _| f64::powi(0.25, i as i32)));
            let side = Vector3::from_fn(|_, _| (0.5 * normal(g)).exp());
            let weight = Matrix6::from_diagonal(&Vector6::from(FULL.map(|(i, j)| 1.0 / (side[i] * side[j] * unit))));
            let h = numerics::spd::symmetrised(&(weight * basis * condition * basis.transpose() * weight));
            let axes = Matrix3::from_fn(|_, _| normal(g)).qr().q();
            let q = axes * Matrix3::from_diagonal(&Vector3::from(free)) * axes.transpose() * unit;
            let g = h * entries(&q);

            let (lower, upper) = (lower * unit, upper * unit);
            let ours = minimise(&h, &g, lower, upper).unwrap();
            let eigen = ours.symmetric_eigenvalues();
            let rounding = 1e-14 * ours.amax();
            assert!(
                eigen.min() >= lower - rounding && eigen.max() <= upper + rounding,
                "{eigen}"
            );
            let ours = entries(&ours);
            let expected = by_barrier(&h, &g, lower, upper);
            let cost = |q: &Vector6<f64>| 0.5 * q.dot(&(h * q)) - g.dot(q);
            let excess = (cost(&ours) - cost(&expected)) / entries(&q).dot(&g);
            let off = ours - expected;
            let distance = (off.dot(&(h * off)) / entries(&q).dot(&g)).sqrt();
            // The tolerance on eigenvalues, 1e-7, and its square root in flat directions.
            assert!(
                excess < 1e-6 && distance < 1e-3,
                "free {free:?}, run {run}: costs {excess:e} more, lies {distance:e} away"
            );
        }
    }

    #[test]
    fn minimum_agrees_with_a_barrier_method() {
        // None, one, two or all eigenvalues at the lower bound.
        agrees_with_the_barrier([1.0, 2.0, 0.5], 1e-3, 1e3, 1.0);
        agrees_with_the_barrier([1.0, 0.5, -1.0], 1e-3, 1e3, 1.0);
        agrees_with_the_barrier([1.0, -0.7, -1.0], 1e-3, 1e3, 1e-9);
        agrees_with_the_barrier([-0.3, -0.7, -1.0], 1e-3, 1e3, 1.0);
        // One at the upper bound, alone and with another at the lower.
        agrees_with_the_barrier([20.0, 1.0, 0.5], 1e-3, 5.0, 1.0);
        agrees_with_the_barrier([20.0, 1.0, -0.5], 1e-3, 5.0, 1e6);
        // An upper bound far out of reach.
        agrees_with_the_barrier([1.0, 0.5, -1.0], 1e-3, 1e12, 1e-12);
    }

    /// By hand: with a unit Hessian in the Frobenius sense the minimum is the free one with its eigenvalues clipped.
    #[test]
    fn projection_clips_eigenvalues() {
        let g = &mut stream(32, 0, Source::Lidar);
        let frobenius = Matrix6::from_diagonal(&Vector6::from(FULL.map(|(i, j)| if i == j { 1.0 } else { 2.0 })));
        for _ in 0..20 {
            let axes = Matrix3::from_fn(|_, _| normal(g)).qr().q();
            let with = |e: Vector3<f64>| axes * Matrix3::from_diagonal(&e) * axes.transpose();
            let free = Vector3::from_fn(|_, _| 3.0 * normal(g));
            let ours = minimise(&frobenius, &(frobenius * entries(&with(free))), 0.1, 2.0).unwrap();
            let expected = with(free.map(|v| v.clamp(0.1, 2.0)));
            // The root of the tolerances, times the size of the free minimum.
            assert!((ours - expected).amax() < 1e-3, "{ours} and {expected}");
        }
    }

    #[test]
    fn a_problem_without_sense_is_an_error_and_not_a_panic() {
        let g = Vector6::repeat(1.0);
        assert!(minimise(&Matrix6::zeros(), &g, 0.0, 1.0).is_err());
        assert!(minimise(&(Matrix6::identity() * f64::INFINITY), &g, 0.0, 1.0).is_err());
        assert!(minimise(&Matrix6::identity(), &Vector6::repeat(f64::NAN), 0.0, 1.0).is_err());
        // Not convex: whatever the solver says of it, what is taken for a solution lies within the bounds.
        let mut saddle = Matrix6::identity();
        saddle[(0, 3)] = 5.0;
        saddle[(3, 0)] = 5.0;
        if let Ok(q) = minimise(&saddle, &g, 0.0, 1.0) {
            let eigen = q.symmetric_eigenvalues();
            assert!(eigen.min() > -1e-14 && eigen.max() < 1.0 + 1e-14, "{eigen}");
        }
    }
}
