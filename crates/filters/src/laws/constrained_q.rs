//! The correlation regression solved for the diagonal jerk density itself, q >= 0, as a small conic programme.
//!
//! MILTON keeps its density positive by estimating the square root, which makes a linear problem quadratic: a gain that
//! vanishes at zero, a sign that does not matter, a linearisation. Here the same normal equations (D^T D, D^T c) are gathered
//! with a forgetting factor, a prior is added, and
//!
//! minimise 1/2 q^T H q - g^T q over s_min^2 <= q <= s_max^2
//!
//! is solved by clarabel. When the solver does not solve, the last q stays and the case is counted.

use super::correlation::{DIAGONAL, Regression};
use super::window::{M_B, RESIDUALS, WHITEN, Window};
use super::{Adaptation, FilterEntry, Law, Setup, Step};
use crate::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Tunable};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

const ROOT_DENSITY: &str = "m/s^2.5";

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "constrained_q",
    about: "the correlation regression solved for a bounded diagonal jerk density by a conic programme",
    tunables: &[
        M_B,
        RESIDUALS,
        WHITEN,
        Tunable {
            name: "r_w",
            about: "weight of the regression: variance of one entry of the autocorrelation, in the units the law adapts in",
            kind: Kind::Real {
                start: None,
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "memory",
            about: "updates after which old evidence has faded to 1/e",
            kind: Kind::Real {
                start: Some(10.0),
                unit: "1",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s_min",
            about: "lower bound of s",
            kind: Kind::Real {
                start: Some(1e-7),
                unit: ROOT_DENSITY,
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "s_max",
            about: "upper bound of s",
            kind: Kind::Real {
                start: Some(1.0),
                unit: ROOT_DENSITY,
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s_prior",
            about: "s before any evidence: the square is the prior's mean of q",
            kind: Kind::Real {
                start: Some(1e-6),
                unit: ROOT_DENSITY,
                bound: Bound::NonNegative,
            },
        },
        Tunable {
            name: "s_spread",
            about: "the square is the prior's standard deviation of q",
            kind: Kind::Real {
                start: Some(1e-2),
                unit: ROOT_DENSITY,
                bound: Bound::Positive,
            },
        },
    ],
    presets: &[
        Preset {
            name: "paper",
            about: "the paper's regression on innovations, and its buffer",
            sets: &[],
        },
        Preset {
            name: "consistent",
            about: "open-loop residuals, rows divided by their standard deviations",
            sets: &[("residuals", "consistent"), ("whiten", "true")],
        },
    ],
    search: &[],
    only: None,
    build,
};

fn build(setup: &Setup<'_>) -> Result<Law, FilterError> {
    let t = &setup.tunables;
    let density = |name: &str| Ok::<f64, FilterError>((t.real(name)? / setup.units.root_jerk_density()).powi(2));
    let (lower, upper) = (density("s_min")?, density("s_max")?);
    if lower >= upper {
        return Err(FilterError::OutOfRange {
            name: "constrained_q.s_min".into(),
            value: t.real("s_min")?,
            unit: ROOT_DENSITY,
            permitted: format!("less than constrained_q.s_max = {}", t.real("s_max")?),
        });
    }
    let (prior, spread) = (density("s_prior")?, density("s_spread")?);
    let prior_information = Matrix3::identity() / (spread * spread);
    Ok(ConstrainedQ {
        window: Window::new(setup)?,
        r_w: t.real("r_w")?,
        fade: (-1.0 / t.real("memory")?).exp(),
        lower,
        upper,
        prior_information,
        prior_score: prior_information * Vector3::repeat(prior),
        information: Matrix3::zeros(),
        score: Vector3::zeros(),
        q: Vector3::repeat(prior.clamp(lower, upper)),
        updates: 0,
        unsolved: 0,
    }
    .into())
}

/// The law and its memory; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ConstrainedQ {
    window: Window,
    r_w: f64,
    /// Factor on old evidence at each update.
    fade: f64,
    /// Bounds of q.
    lower: f64,
    upper: f64,
    prior_information: Matrix3<f64>,
    prior_score: Vector3<f64>,
    /// Gathered D^T D / r_w.
    information: Matrix3<f64>,
    /// Gathered D^T c / r_w.
    score: Vector3<f64>,
    /// Density in use, the diagonal of Q.
    q: Vector3<f64>,
    updates: i32,
    unsolved: i32,
}

impl ConstrainedQ {
    fn learn(&mut self, regression: &Regression<3>) {
        self.information = self.information * self.fade + regression.dt_d / self.r_w;
        self.score = self.score * self.fade + regression.dt_c / self.r_w;
        let h = self.information + self.prior_information;
        let g = self.score + self.prior_score;
        match minimise(&h, &g, self.lower, self.upper) {
            Ok(q) => {
                self.q = q;
                self.updates += 1;
            }
            Err(_) => self.unsolved += 1,
        }
    }
}

/// The q between `lower` and `upper` that minimises 1/2 q^T h q - g^T q.
///
/// * `h`: 3x3, symmetric, positive definite.
///
/// # Errors
/// The solver's status when it is not a solution, `None` when it refused the problem.
fn minimise(h: &Matrix3<f64>, g: &Vector3<f64>, lower: f64, upper: f64) -> Result<Vector3<f64>, Option<SolverStatus>> {
    // Densities span many decades: in u = q sqrt(h_ii) the Hessian has a unit diagonal.
    let scale = h.diagonal().map(f64::sqrt);
    if !scale.iter().all(|s| s.is_finite() && *s > 0.0) || !g.iter().all(|v| v.is_finite()) {
        return Err(None);
    }
    // And the cost is divided by the size of its linear term, which the solver's tolerances are relative to.
    let linear: Vec<f64> = (0..3).map(|i| -g[i] / scale[i]).collect();
    let size = linear.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
    let entry = |i: usize, j: usize| h[(i, j)] / (scale[i] * scale[j]);
    let cost = CscMatrix::from(&[
        [1.0, entry(0, 1), entry(0, 2)],
        [0.0, 1.0, entry(1, 2)],
        [0.0, 0.0, 1.0],
    ]);
    let rows = CscMatrix::from(&[
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ]);
    let linear: Vec<f64> = linear.iter().map(|v| v / size).collect();
    let bound = |value: f64| (0..3).map(move |i| value * scale[i] / size);
    let limits: Vec<f64> = bound(-lower).chain(bound(upper)).collect();
    let settings = DefaultSettings {
        verbose: false,
        ..DefaultSettings::default()
    };
    let mut solver =
        DefaultSolver::new(&cost, &linear, &rows, &limits, &[NonnegativeConeT(6)], settings).map_err(|_| None)?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            let q = Vector3::from_fn(|i, _| (solver.solution.x[i] * size / scale[i]).clamp(lower, upper));
            if q.iter().all(|v| v.is_finite()) {
                Ok(q)
            } else {
                Err(Some(solver.solution.status))
            }
        }
        status @ (SolverStatus::Unsolved
        | SolverStatus::PrimalInfeasible
        | SolverStatus::DualInfeasible
        | SolverStatus::AlmostPrimalInfeasible
        | SolverStatus::AlmostDualInfeasible
        | SolverStatus::MaxIterations
        | SolverStatus::MaxTime
        | SolverStatus::NumericalError
        | SolverStatus::InsufficientProgress
        | SolverStatus::CallbackTerminated) => Err(Some(status)),
    }
}

impl Adaptation for ConstrainedQ {
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::process_noise(&self.q, dt)
    }

    fn observe(&mut self, step: Step) -> Result<(), FilterError> {
        if let Some(regression) = self.window.push(&step, &DIAGONAL) {
            self.learn(&regression);
        }
        Ok(())
    }

    fn s(&self) -> Vector3<f64> {
        self.q.map(f64::sqrt)
    }

    fn updates(&self) -> i32 {
        self.updates
    }

    fn skipped(&self) -> i32 {
        self.window.skipped()
    }

    fn unsolved(&self) -> i32 {
        self.unsolved
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
        for unit in [1.0, 1e-6, 1e-12] {
            for g in [[1.0, 2.0, 3.0], [-1.0, 2.0, 0.1], [-3.0, -1.0, -2.0], [40.0, 1.0, -9.0]] {
                let (h, g) = (h / (unit * unit), Vector3::from(g) / unit);
                let (lower, upper) = (0.01 * unit, 1.2 * unit);
                let ours = minimise(&h, &g, lower, upper).unwrap();
                let expected = by_enumeration(&h, &g, lower, upper);
                // The solver's gap of 1e-8 leaves an error of its square root in a bounded coordinate at most.
                assert!(
                    (ours - expected).amax() < 1e-4 * unit,
                    "unit {unit}: {ours} and {expected}"
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
