//! The regression solved for a diagonal density: a quadratic programme in three unknowns.

use super::conic::{self, Almost, NoAnswer};
use arrayvec::ArrayVec;
use clarabel::solver::NonnegativeConeT;
use nalgebra::{Matrix3, Vector3};

/// The q between `lower` and `upper` that minimises 1/2 q^T h q - g^T q.
///
/// * `h`: 3x3, symmetric, positive definite.
///
/// # Errors
/// See [`NoAnswer`].
pub(super) fn minimise(h: &Matrix3<f64>, g: &Vector3<f64>, lower: f64, upper: f64) -> Result<Vector3<f64>, NoAnswer> {
    // Densities span many decades: with q = lower + size u / sqrt(h_ii) the Hessian of u has a unit diagonal and the cost a
    // linear term of size one.
    let scale = h.diagonal().map(f64::sqrt);
    let rest = (g - h * Vector3::repeat(lower)).component_div(&scale);
    let usable = |v: &Vector3<f64>| v.iter().all(|v| v.is_finite());
    if !usable(&scale) || scale.min() <= 0.0 || !usable(&rest) {
        return Err(None);
    }
    let size = rest.amax().max(1e-300);
    let entry = |i: usize, j: usize| if i == j { 1.0 } else { h[(i, j)] / (scale[i] * scale[j]) };
    let cost = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    let linear: [f64; 3] = std::array::from_fn(|i| -rest[i] / size);
    let unit = |i: usize, value: f64| std::array::from_fn(|j| if i == j { value } else { 0.0 });
    // A lower bound each, and an upper one.
    let mut rows: ArrayVec<[f64; 3], 6> = (0..3).map(|i| unit(i, -1.0)).collect();
    let mut limits: ArrayVec<f64, 6> = [0.0; 3].into_iter().collect();
    // An upper bound is stated once an answer exceeds it: the solver's tolerances are relative to the limits, and a bound
    // nine decades away makes it give up.
    let mut stated = [false; 3];
    loop {
        let u = conic::solve(
            &cost,
            &linear,
            &rows,
            &limits,
            &[NonnegativeConeT(rows.len())],
            Almost::Taken,
        )?;
        let before = limits.len();
        for i in 0..3 {
            let limit = (upper - lower) * scale[i] / size;
            if !stated[i] && u[i] > limit {
                rows.push(unit(i, 1.0));
                limits.push(limit);
                stated[i] = true;
            }
        }
        if limits.len() == before {
            return Ok(Vector3::from_fn(|i, _| {
                (lower + u[i] * size / scale[i]).clamp(lower, upper)
            }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum over a box by trying every set of active bounds: slow, and certain in three dimensions.
    fn by_enumeration(h: &Matrix3<f64>, g: &Vector3<f64>, lower: f64, upper: f64) -> Vector3<f64> {
        let cost = |q: &Vector3<f64>| 0.5 * q.dot(&(h * q)) - g.dot(q);
        let mut best: Option<Vector3<f64>> = None;
        for code in 0..27 {
            let choice = [code % 3, code / 3 % 3, code / 9];
            let (mut a, mut b) = (*h, *g);
            for i in 0..3 {
                if choice[i] != 0 {
                    a.set_row(i, &Matrix3::identity().row(i));
                    b[i] = if choice[i] == 1 { lower } else { upper };
                }
            }
            let Some(q) = a.lu().solve(&b) else { continue };
            let slack = 1e-9 * upper;
            let inside = q.iter().all(|v| (lower - slack..=upper + slack).contains(v));
            if inside && best.is_none_or(|old| cost(&q) < cost(&old)) {
                best = Some(q);
            }
        }
        best.unwrap()
    }

    #[test]
    fn minimum_agrees_with_enumeration_of_the_active_bounds() {
        let h = Matrix3::new(4.0, 1.0, -0.5, 1.0, 3.0, 0.8, -0.5, 0.8, 2.0);
        for (unit, upper) in [(1.0, 1.2), (1e-6, 1.2), (1e-12, 1.2), (1.0, 1e4), (1e-12, 1e12)] {
            for g in [[1.0, 2.0, 3.0], [-1.0, 2.0, 0.1], [-3.0, -1.0, -2.0], [40.0, 1.0, -9.0]] {
                let (h, g) = (h / (unit * unit), Vector3::from(g) / unit);
                let (lower, upper) = (0.01 * unit, upper * unit);
                let ours = minimise(&h, &g, lower, upper).unwrap();
                // No answer of these comes near twenty units.
                let expected = by_enumeration(&h, &g, lower, upper.min(20.0 * unit));
                // The solver's gap of 1e-8 leaves an error of its square root in a bounded coordinate at most.
                assert!(
                    (ours - expected).amax() < 1e-4 * unit,
                    "unit {unit}, upper bound {upper}: {ours} and {expected}"
                );
            }
        }
    }

    #[test]
    fn a_problem_without_sense_is_an_error_and_not_a_panic() {
        let g = Vector3::repeat(1.0);
        assert!(minimise(&Matrix3::zeros(), &g, 0.0, 1.0).is_err());
        assert!(minimise(&Matrix3::identity(), &Vector3::repeat(f64::NAN), 0.0, 1.0).is_err());
        // Not convex: whatever the solver says of it, it must not be taken for a solution with a NaN in it.
        let saddle = Matrix3::new(1.0, 5.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        if let Ok(q) = minimise(&saddle, &g, 0.0, 1.0) {
            assert!(q.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}
