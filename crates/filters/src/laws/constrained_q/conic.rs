//! One call of clarabel, with every status that it may answer.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Why a programme has no answer: the solver's status when it is not a solution; `None` when the problem makes no sense or
/// the answer is not one.
pub(super) type NoAnswer = Option<SolverStatus>;

/// The x that minimises 1/2 x^T P x + q^T x subject to b - A x in the cones, of K unknowns.
///
/// * `cost`: P, of which the upper triangle is read.
/// * `linear`: q.
/// * `rows`, `limits`: A and b, as many as the cones have dimensions.
///
/// # Errors
/// See [`NoAnswer`].
pub(super) fn solve<const K: usize>(
    cost: &[[f64; K]; K],
    linear: &[f64; K],
    rows: &[[f64; K]],
    limits: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Result<[f64; K], NoAnswer> {
    let mut upper = *cost;
    for (i, row) in upper.iter_mut().enumerate() {
        row[..i].fill(0.0);
    }
    let settings = DefaultSettings {
        verbose: false,
        ..DefaultSettings::default()
    };
    let (cost, rows) = (CscMatrix::from(&upper), CscMatrix::from(rows));
    let mut solver = DefaultSolver::new(&cost, linear, &rows, limits, cones, settings).map_err(|_| None)?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            let mut x = [0.0; K];
            x.copy_from_slice(&solver.solution.x);
            if x.iter().all(|v| v.is_finite()) {
                Ok(x)
            } else {
                Err(None)
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
