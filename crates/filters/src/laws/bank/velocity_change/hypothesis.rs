//! One past time at which the velocity may have changed.

use super::super::member::Taken;
use super::super::rows::Row;
use super::directions::Axes;
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3};
use serde::{Deserialize, Serialize};

/// Number of sizes.
pub(super) const SIZES: usize = 5;

/// What is expected of a change before the data: a rate, and D ~ N(0, S).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Prior {
    /// Place of its size.
    pub size: usize,
    /// Whether it may point anywhere.
    pub anywhere: bool,
    /// Logarithm of its rate, 1/s.
    pub ln_rate: f64,
    /// S^-1, 3x3, internal units.
    precision: Matrix3<f64>,
    /// ln det S.
    ln_det: f64,
}

impl Prior {
    /// A change of a size in any direction, S = c^2 I.
    pub(super) fn anywhere(size: usize, c: f64, rate: f64) -> Self {
        Self {
            size,
            anywhere: true,
            ln_rate: rate.max(f64::MIN_POSITIVE).ln(),
            precision: Matrix3::from_diagonal_element(1.0 / (c * c)),
            ln_det: 6.0 * c.ln(),
        }
    }

    /// A change along a direction that is known to within `spread`, S = c^2 (u u' + spread^2 (I - u u')).
    pub(super) fn along(size: usize, c: f64, rate: f64, along: &Vector3<f64>, spread: f64) -> Self {
        let axis = along * along.transpose();
        let across = (Matrix3::identity() - axis) / (spread * spread);
        Self {
            size,
            anywhere: false,
            ln_rate: rate.max(f64::MIN_POSITIVE).ln(),
            precision: (axis + across) / (c * c),
            ln_det: 6.0 * c.ln() + 4.0 * spread.ln(),
        }
    }
}

/// A change, given the data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Posterior {
    /// Logarithm of the likelihood against "no change".
    pub ln_likelihood: f64,
    /// V d.
    pub mean: Vector3<f64>,
    /// V, 3x3.
    pub v: Matrix3<f64>,
}

/// A past time with all that may have happened at it; internal units, times in s.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Hypothesis {
    /// E, 6x3.
    pub e: Matrix6x3<f64>,
    /// C, 3x3, and d.
    pub c: Matrix3<f64>,
    /// 3.
    pub d: Vector3<f64>,
    /// s.
    pub age: f64,
    /// Time from the start to its own, in units of the closest spacing.
    pub slot: u64,
    /// Time to the next one opened, s.
    pub span: f64,
    /// By how much longer it counts, since a change was due, s.
    pub due: f64,
    /// What was expected.
    pub priors: Vec<Prior>,
    /// What the data say of each, as [`Hypothesis::given`] has it.
    pub ln_data: Vec<f64>,
    /// Axes at its time.
    pub axes: Axes,
}

impl Hypothesis {
    pub(super) fn new(slot: u64, due: f64, priors: Vec<Prior>, axes: Axes) -> Self {
        let mut e = Matrix6x3::zeros();
        e.fixed_view_mut::<3, 3>(3, 0).fill_with_identity();
        Self {
            e,
            c: Matrix3::zeros(),
            d: Vector3::zeros(),
            age: 0.0,
            slot,
            span: 0.0,
            due,
            ln_data: vec![0.0; priors.len()],
            priors,
            axes,
        }
    }

    /// A step further.
    pub(super) fn predict(&mut self, dt: f64, f: &Matrix6<f64>) {
        self.age += dt;
        self.e = f * self.e;
    }

    /// Takes a row in with what it did to the filter that knows of no change.
    pub(super) fn take(&mut self, row: &Row, taken: &Taken<6>) {
        let g = (row.h * self.e).transpose();
        self.c.ger(1.0 / taken.s, &g, &g, 1.0);
        self.d.axpy(taken.innovation / taken.s, &g, 1.0);
        self.e.ger(-1.0, &taken.gain, &g, 1.0);
    }

    /// A change as this prior has it, given the data.
    pub(super) fn given(&self, prior: &Prior) -> Posterior {
        let precision = self.c + prior.precision;
        // By cofactors, which give inverse and determinant at once; the sum of a covariance and a precision is far from singular.
        let m = |i: usize, j: usize| precision[(i, j)];
        let cofactor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (others(i), others(j));
            m(a, c) * m(b, d) - m(a, d) * m(b, c)
        };
        let cofactors = Matrix3::from_fn(cofactor);
        let det = precision.row(0).dot(&cofactors.row(0));
        let v = cofactors / det;
        let mean = v * self.d;
        // det(I + S C) = det S det(C + S^-1).
        Posterior {
            ln_likelihood: 0.5 * (self.d.dot(&mean) - det.ln() - prior.ln_det),
            mean,
            v,
        }
    }
}

/// The other two of three places, in the order that makes cofactors of them.
fn others(place: usize) -> [usize; 2] {
    [(place + 1) % 3, (place + 2) % 3]
}
