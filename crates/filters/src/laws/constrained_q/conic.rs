//! One call of clarabel, with every status that it may answer.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Why a programme has no answer: the solver's status when it is not a solution; `None` when the problem makes no sense or
/// the answer is not one.
pub(super) type NoAnswer = Option<SolverStatus>;

/// What to make of an answer that the solver calls almost solved: it stuck where gap and residuals are within 5e-5 and 1e-4, and not
/// within the 1e-8 that is asked of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Almost {
    /// It is an answer like any other.
    Taken,
    /// It is none.
    Refused,
}

/// The x that minimises 1/2 x^T P x + q^T x subject to b - A x in the cones, of K unknowns.
///
/// * `cost`: P, of which the upper triangle is read.
/// * `linear`: q.
/// * `rows`, `limits`: A and b, as many as the cones have dimensions.
/// * `almost`: see [`Almost`].
///
/// # Errors
/// See [`NoAnswer`].
pub(super) fn solve<const K: usize>(
    cost: &[[f64; K]; K],
    linear: &[f64; K],
    rows: &[[f64; K]],
    limits: &[f64],
    cones: &[SupportedConeT<f64>],
    almost: Almost,
) -> Result<[f64; K], NoAnswer> {
    judged(
        attempt(DefaultSettings::default(), cost, linear, rows, limits, cones)?,
        almost,
    )
}

fn judged<T>((status, x): (SolverStatus, T), almost: Almost) -> Result<T, NoAnswer> {
    if status == SolverStatus::AlmostSolved && almost == Almost::Refused {
        Err(Some(status))
    } else {
        Ok(x)
    }
}

/// An answer, and whether it is solved or almost solved.
///
/// All that asks for memory here is clarabel's; a function of its own, so that a backtrace shows it where clarabel's are inlined.
#[inline(never)]
fn attempt<const K: usize>(
    settings: DefaultSettings<f64>,
    cost: &[[f64; K]; K],
    linear: &[f64; K],
    rows: &[[f64; K]],
    limits: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Result<(SolverStatus, [f64; K]), NoAnswer> {
    let mut upper = *cost;
    for (i, row) in upper.iter_mut().enumerate() {
        row[..i].fill(0.0);
    }
    let settings = DefaultSettings {
        verbose: false,
        ..settings
    };
    let (cost, rows) = (CscMatrix::from(&upper), CscMatrix::from(rows));
    let mut solver = DefaultSolver::new(&cost, linear, &rows, limits, cones, settings).map_err(|_| None)?;
    solver.solve();
    match solver.solution.status {
        status @ (SolverStatus::Solved | SolverStatus::AlmostSolved) => {
            let mut x = [0.0; K];
            x.copy_from_slice(&solver.solution.x);
            if x.iter().all(|v| v.is_finite()) {
                Ok((status, x))
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

#[cfg(test)]
mod tests {
    use super::*;
    use clarabel::solver::NonnegativeConeT;

    /// The least of (x - 1)^2 + (y - 1)^2 where x + y <= 1, half and half, with so many steps at most.
    fn least(max_iter: u32) -> Result<(SolverStatus, [f64; 2]), NoAnswer> {
        let settings = DefaultSettings {
            max_iter,
            ..DefaultSettings::default()
        };
        let (cost, linear) = ([[2.0, 0.0], [0.0, 2.0]], [-2.0; 2]);
        attempt(settings, &cost, &linear, &[[1.0; 2]], &[1.0], &[NonnegativeConeT(1)])
    }

    #[test]
    fn what_is_almost_solved_is_told_from_what_is_solved() {
        let ends: Vec<_> = (1..20).map(least).collect();
        assert_eq!(ends[0], Err(Some(SolverStatus::MaxIterations)));
        // A gap of 1e-8 or of 5e-5 leaves its square root in the unknowns.
        for (expected, tolerance) in [(SolverStatus::AlmostSolved, 1e-2), (SolverStatus::Solved, 1e-4)] {
            let found = ends.iter().flatten().find(|(status, _)| *status == expected);
            let end @ (_, x) = *found.unwrap_or_else(|| panic!("nothing is {expected:?}: {ends:?}"));
            assert!(x.iter().all(|x| (x - 0.5).abs() < tolerance), "{expected:?}: {x:?}");
            assert_eq!(judged(end, Almost::Taken), Ok(x));
            let refused = (expected == SolverStatus::AlmostSolved).then_some(Some(expected));
            assert_eq!(judged(end, Almost::Refused).err(), refused);
        }
    }
}
