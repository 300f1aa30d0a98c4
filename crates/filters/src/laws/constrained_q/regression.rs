//! The correlation regression solved for the jerk density itself, within bounds, as a small conic programme.
//!
//! MILTON keeps its density positive by estimating the square root, which makes a linear problem quadratic: a gain that
//! vanishes at zero, a sign that does not matter, a linearisation. Here the same normal equations (D^T D, D^T c) are gathered
//! with a forgetting factor, a prior is added, and
//!
//! minimise 1/2 q^T H q - g^T q over s_min^2 I <= Q <= s_max^2 I
//!
//! is solved by clarabel, q being the entries of Q: of a diagonal Q in [`diagonal`], of any symmetric one, in the axes of
//! the filter, in [`full`]. When the solver does not solve, the last Q stays and the case is counted. What is almost solved is taken:
//! cuts that nearly coincide let programmes end so now and then, their answers stay within what the tests of [`full`] allow, and a
//! regression on a few innovations is known by far less than that.

use numerics::math;

use super::full::Cuts;
use super::{diagonal, full};
use crate::error::FilterError;
use crate::jerk;
use crate::laws::adaptation::{Adaptation, Setup, Step};
use crate::laws::correlation::{DIAGONAL, Entry, FULL, Regression};
use crate::laws::window::Window;
use crate::state::TargetMatrix;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Unit of the bounds and of the prior.
pub(super) const ROOT_DENSITY: &str = "m/s^2.5";

/// The law and its memory; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ByRegression {
    window: Window,
    r_w: f64,
    /// Factor on old evidence at each update.
    fade: f64,
    /// Bounds of the eigenvalues of Q.
    lower: f64,
    upper: f64,
    evidence: Evidence,
    #[serde(skip)]
    cuts: Cuts,
    /// Density in use.
    q: Matrix3<f64>,
    updates: i32,
    unsolved: i32,
}

/// What the regressions have told of the density, according to its shape.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Evidence {
    Diagonal(Fit<3>),
    Full(Box<Fit<6>>),
}

/// Evidence for K entries of the density.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Fit<const K: usize> {
    prior_information: SMatrix<f64, K, K>,
    prior_score: SVector<f64, K>,
    /// Gathered D^T D / r_w.
    information: SMatrix<f64, K, K>,
    /// Gathered D^T c / r_w.
    score: SVector<f64, K>,
}

impl<const K: usize> Fit<K> {
    /// Nothing but the prior: Q about `mean` I, the standard deviation of an entry on the diagonal being `spread`.
    ///
    /// An entry off the diagonal deviates by `spread` / sqrt 2, so that the prior is the same in any axes.
    fn new(entries: &[Entry; K], mean: f64, spread: f64) -> Self {
        let weight = |(i, j): Entry| if i == j { 1.0 } else { 2.0 } / (spread * spread);
        let prior_information = SMatrix::from_diagonal(&SVector::from(entries.map(weight)));
        let prior_mean = SVector::from(entries.map(|(i, j)| if i == j { mean } else { 0.0 }));
        Self {
            prior_information,
            prior_score: prior_information * prior_mean,
            information: SMatrix::zeros(),
            score: SVector::zeros(),
        }
    }

    /// Adds a regression to what has been gathered, faded.
    ///
    /// * returns: H and g of the cost 1/2 q^T H q - g^T q.
    fn gather(&mut self, regression: &Regression<K>, fade: f64, r_w: f64) -> (SMatrix<f64, K, K>, SVector<f64, K>) {
        self.information = self.information * fade + regression.dt_d / r_w;
        self.score = self.score * fade + regression.dt_c / r_w;
        (self.information + self.prior_information, self.score + self.prior_score)
    }
}

impl ByRegression {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        let density = |name: &str| Ok::<f64, FilterError>((t.real(name)? / setup.units.root_jerk_density()).powi(2));
        let (lower, upper) = (density("s_min")?, density("s_max")?);
        if lower >= upper {
            let permitted = format!("less than {}.s_max = {}", t.law, t.real("s_max")?);
            return Err(t.refused("s_min", t.real("s_min")?, permitted));
        }
        let (prior, spread) = (density("s_prior")? * setup.off_nominal, density("s_spread")?);
        let full = t.choice("shape")? == 1;
        Ok(Self {
            window: Window::new(setup)?,
            r_w: t.real("r_w")?,
            fade: math::exp(-1.0 / t.real("memory")?),
            lower,
            upper,
            evidence: if full {
                Evidence::Full(Box::new(Fit::new(&FULL, prior, spread)))
            } else {
                Evidence::Diagonal(Fit::new(&DIAGONAL, prior, spread))
            },
            cuts: Cuts::default(),
            q: Matrix3::identity() * prior.clamp(lower, upper),
            updates: 0,
            unsolved: 0,
        })
    }
}

impl Adaptation for ByRegression {
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        match self.evidence {
            Evidence::Diagonal(_) => jerk::process_noise(&self.q.diagonal(), dt),
            Evidence::Full(_) => jerk::process_noise_full(&self.q, dt),
        }
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        let answer = match &mut self.evidence {
            Evidence::Diagonal(fit) => self.window.push(step, &DIAGONAL).map(|regression| {
                let (h, g) = fit.gather(&regression, self.fade, self.r_w);
                diagonal::minimise(&h, &g, self.lower, self.upper).map(|q| Matrix3::from_diagonal(&q))
            }),
            Evidence::Full(fit) => self.window.push(step, &FULL).map(|regression| {
                let (h, g) = fit.gather(&regression, self.fade, self.r_w);
                full::minimise(&h, &g, self.lower, self.upper, &mut self.cuts)
            }),
        };
        match answer {
            Some(Ok(q)) => {
                self.q = q;
                self.updates += 1;
            }
            Some(Err(_)) => self.unsolved += 1,
            None => {}
        }
        Ok(())
    }

    fn s(&self) -> Vector3<f64> {
        self.q.diagonal().map(f64::sqrt)
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

    fn reproduces(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::set_up;
    use super::*;
    use crate::laws::correlation::tests::{oblique, watched};
    use crate::laws::correlation::{Observation, Sampled};
    use crate::tunable::Value;
    use nalgebra::{Rotation3, Vector6};

    fn law(rows: usize, changes: &[(&str, Value)]) -> ByRegression {
        set_up(rows, changes, ByRegression::new).unwrap()
    }

    /// A sample as the filter hands it over: the first `rows` of them, not yet divided by their standard deviation.
    fn step<const M: usize>(sampled: &Sampled<M>, rows: usize, sigma: f64) -> Step {
        let mut step = Step::blank(sampled.dt, sampled.f);
        step.measured.mark(0..rows);
        step.h = (sampled.h.rows(0, rows) * sigma).fixed_resize(0.0);
        step.innovation = (sampled.residual.rows(0, rows) * sigma).fixed_resize(0.0);
        step.correction = sampled.correction;
        step
    }

    /// What a law that never forgets finds in a world of this density, three rows of the position being measured.
    fn found(density: &Matrix3<f64>, changes: &[(&str, Value)], count: usize) -> ByRegression {
        let (rows, sigma) = (oblique(), 0.3);
        let mut ours = law(
            3,
            &[
                &[
                    ("m_b", Value::Integer(8)),
                    ("residuals", Value::Choice(1)),
                    ("whiten", Value::Boolean(true)),
                    ("r_w", Value::Real(1.0)),
                    ("memory", Value::Real(1e9)),
                    ("s_spread", Value::Real(1e3)),
                    ("s_max", Value::Real(10.0)),
                ],
                changes,
            ]
            .concat(),
        );
        for sampled in watched(&rows, &Vector3::repeat(sigma), density, 1, count) {
            ours.observe(&step(&sampled, 3, sigma)).unwrap();
        }
        assert_eq!((ours.unsolved, ours.skipped()), (0, 0));
        ours
    }

    const FULL_SHAPE: (&str, Value) = ("shape", Value::Choice(1));

    /// An anisotropic density whose axes are not those of the filter.
    fn turned() -> Matrix3<f64> {
        Matrix3::new(2.0, -0.9, 0.3, -0.9, 1.0, 0.2, 0.3, 0.2, 0.4)
    }

    #[test]
    fn only_the_full_shape_finds_a_density_whose_axes_are_turned() {
        let truth = turned();
        let full = found(&truth, &[FULL_SHAPE], 40_000);
        assert!((full.q - truth).amax() < 0.15, "{}", full.q);
        let s = truth.diagonal().map(f64::sqrt);
        assert!((full.s() - s).amax() < 0.1, "{}", full.s());
        let diagonal = found(&truth, &[], 40_000);
        assert!(
            (diagonal.q.diagonal() - truth.diagonal()).amax() < 0.15,
            "{}",
            diagonal.q
        );
        // Both say so through the process noise that they hand to the filter: here of v_x and v_y.
        let cross = |law: &ByRegression| law.process_noise(1.0)[(3, 4)] * 3.0;
        assert!((cross(&full) + 0.9).abs() < 0.15, "{}", cross(&full));
        assert!(cross(&diagonal).abs() < 1e-15, "{}", cross(&diagonal));
    }

    #[test]
    fn bounds_hold_in_every_direction() {
        // Its eigenvalues are about 0.1, 0.7 and 2.6.
        let changes = [FULL_SHAPE, ("s_min", Value::Real(0.6)), ("s_max", Value::Real(1.1))];
        let eigen = found(&turned(), &changes, 3000).q.symmetric_eigenvalues();
        assert!((eigen.min() - 0.36).abs() < 1e-9, "{eigen}");
        assert!((eigen.max() - 1.21).abs() < 1e-9, "{eigen}");
    }

    #[test]
    fn the_prior_is_what_is_believed_without_evidence_and_the_same_in_any_axes() {
        let expected = Matrix3::identity() * 0.04;
        let silent = |q: &Matrix3<f64>| (q - expected).amax() < 1e-9;
        let nothing = Regression {
            dt_d: SMatrix::zeros(),
            dt_c: SVector::zeros(),
        };
        let (h, g) = Fit::<3>::new(&DIAGONAL, 0.04, 0.5).gather(&nothing, 0.9, 1.0);
        let q = diagonal::minimise(&h, &g, 1e-4, 10.0).unwrap();
        assert!(silent(&Matrix3::from_diagonal(&q)), "{q}");
        let nothing = Regression {
            dt_d: SMatrix::zeros(),
            dt_c: SVector::zeros(),
        };
        let (h, g) = Fit::<6>::new(&FULL, 0.04, 0.5).gather(&nothing, 0.9, 1.0);
        let q = full::minimise(&h, &g, 1e-4, 10.0, &mut Cuts::default()).unwrap();
        assert!(silent(&q), "{q}");
        let cost = |q: &Matrix3<f64>| {
            let q = Vector6::from(FULL.map(|entry| q[entry]));
            0.5 * q.dot(&(h * q)) - g.dot(&q)
        };
        let turn = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        let other = turn * turned() * turn.transpose();
        assert!((cost(&other) - cost(&turned())).abs() < 1e-12, "{}", cost(&other));
    }

    #[test]
    fn a_programme_without_an_answer_keeps_the_last_density_and_is_counted() {
        for shape in [0, 1] {
            let mut ours = law(
                3,
                &[
                    ("shape", Value::Choice(shape)),
                    ("m_b", Value::Integer(3)),
                    ("r_w", Value::Real(1.0)),
                    ("s_prior", Value::Real(0.2)),
                ],
            );
            for mut sampled in watched(&oblique(), &Vector3::repeat(0.3), &turned(), 2, 7) {
                sampled.residual *= 1e200;
                ours.observe(&step(&sampled, 3, 1.0)).unwrap();
            }
            assert_eq!((ours.updates(), ours.unsolved()), (0, 1), "shape {shape}");
            assert!((ours.q - Matrix3::identity() * 0.04).amax() < 1e-15, "shape {shape}");
        }
    }

    #[test]
    fn a_saved_law_of_either_shape_and_either_number_of_rows_goes_on_bit_for_bit() {
        let whole = Observation::<6>::identity();
        for (rows, shape) in [(3, 0), (3, 1), (6, 0), (6, 1)] {
            let changes = [
                ("shape", Value::Choice(shape)),
                ("m_b", Value::Integer(4)),
                ("r_w", Value::Real(1.0)),
            ];
            let mut ours = law(rows, &changes);
            let steps = watched(&whole, &Vector6::repeat(0.3), &turned(), 3, 60);
            let steps: Vec<Step> = steps.iter().map(|sampled| step(sampled, rows, 0.3)).collect();
            let (early, late) = steps.split_at(31);
            early.iter().for_each(|step| ours.observe(step).unwrap());
            let bytes = postcard::to_allocvec(&ours).unwrap();
            let mut restored: ByRegression = postcard::from_bytes(&bytes).unwrap();
            for step in late {
                ours.observe(step).unwrap();
                restored.observe(step).unwrap();
            }
            assert_eq!(ours.q, restored.q, "{rows} rows, shape {shape}");
            assert!(ours.updates() > 5 && ours.q != Matrix3::identity() * ours.q[(0, 0)]);
        }
    }
}
