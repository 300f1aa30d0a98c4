//! The buffer of samples that laws on innovation correlation share: when it is full it yields one regression.

use super::adaptation::{Setup, Step};
use super::correlation::{self, Entry, Regression, Sampled, Work};
use crate::error::FilterError;
use crate::state::MAX_ROWS;
use crate::tunable::{Kind, Scales, Tunable};
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Fewest samples with which a window of three rows each can observe nine states; with six rows two would do.
const SHORTEST: i32 = 3;
const READINGS: &[(&str, &str)] = &[
    ("printed", "as the paper's equations have it"),
    ("consistent", "as their derivation implies"),
];

/// A choice between what the paper prints and what its derivation implies; index 1 is the latter.
pub(super) const READING: Kind = Kind::Choice {
    type_name: "Reading",
    about: "how an equation of MILTON is read",
    items: READINGS,
};

/// Tunable `m_b`.
pub(super) const M_B: Tunable = Tunable {
    name: "m_b",
    about: "samples in the adaptation buffer",
    kind: Kind::Integer {
        start: 30,
        min: SHORTEST,
        max: 200,
    },
};

/// Tunable `residuals`.
pub(super) const RESIDUALS: Tunable = Tunable {
    name: "residuals",
    about: "the filter's own innovations (printed) or open-loop residuals (consistent)",
    kind: READING,
};

/// Tunable `whiten`.
pub(super) const WHITEN: Tunable = Tunable {
    name: "whiten",
    about: "divide the measured rows by their standard deviations before adapting",
    kind: Kind::Boolean { start: false },
};

/// Variance of one entry of the autocorrelation, which is a product of two lengths, in internal units: of the size that noise
/// alone gives it.
pub(super) fn regression_variance(scales: &Scales) -> f64 {
    (scales.length / scales.units.length).powi(4)
}

/// Samples not yet adapted to, of missions with up to three rows, up to six, or more.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) enum Window {
    Three(Samples<3>),
    Six(Samples<6>),
    All(Samples<MAX_ROWS>),
}

impl Window {
    /// An empty buffer, from the tunables [`M_B`], [`RESIDUALS`] and [`WHITEN`] of a law.
    ///
    /// # Errors
    /// When one of them is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        Ok(match setup.layout.rows() {
            ..=3 => Self::Three(Samples::new(setup)?),
            4..=6 => Self::Six(Samples::new(setup)?),
            _ => Self::All(Samples::new(setup)?),
        })
    }

    /// Takes a sample; every m_b + 1 of them, once 2 m_b + 1 have come, returns the regression of the newest 2 m_b + 1.
    ///
    /// C_k,k-p with p = 0..m_b reaches back over 2 m_b + 1 residuals; the next update waits until m_b + 1 are new. A window
    /// that does not observe all states is skipped and counted.
    ///
    /// * `entries`: of the jerk density, those to be solved for.
    pub(super) fn push<const K: usize>(&mut self, step: &Step, entries: &[Entry; K]) -> Option<Regression<K>> {
        match self {
            Self::Three(samples) => samples.push(step, entries),
            Self::Six(samples) => samples.push(step, entries),
            Self::All(samples) => samples.push(step, entries),
        }
    }

    /// How many windows were skipped.
    pub(super) fn skipped(&self) -> i32 {
        match self {
            Self::Three(samples) => samples.skipped,
            Self::Six(samples) => samples.skipped,
            Self::All(samples) => samples.skipped,
        }
    }
}

/// Samples of M rows, and how to look at them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Samples<const M: usize> {
    m_b: usize,
    open_loop: bool,
    /// Noise variances of the scaled rows.
    r: SVector<f64, M>,
    row_scale: SVector<f64, M>,
    /// Oldest first, their rows scaled.
    samples: VecDeque<Sampled<M>>,
    skipped: i32,
    #[serde(skip)]
    work: Work<M>,
}

impl<const M: usize> Samples<M> {
    fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let variances = setup.r.fixed_rows::<M>(0).into_owned();
        let (r, row_scale) = if setup.tunables.boolean(WHITEN.name)? {
            // A row that the world lacks has no variance and is zero at any scale.
            let inverse_sigma = |variance: f64| if variance > 0.0 { 1.0 / variance.sqrt() } else { 1.0 };
            (SVector::repeat(1.0), variances.map(inverse_sigma))
        } else {
            (variances, SVector::repeat(1.0))
        };
        let m_b = setup.tunables.integer(M_B.name)? as usize;
        Ok(Self {
            m_b,
            open_loop: setup.tunables.choice(RESIDUALS.name)? == 1,
            r,
            row_scale,
            samples: VecDeque::with_capacity(2 * m_b + 1),
            skipped: 0,
            work: Work::default(),
        })
    }

    fn push<const K: usize>(&mut self, step: &Step, entries: &[Entry; K]) -> Option<Regression<K>> {
        let rows = SMatrix::<f64, M, M>::from_diagonal(&self.row_scale);
        self.samples.push_back(Sampled {
            dt: step.dt,
            f: step.f,
            h: rows * step.h.fixed_rows::<M>(0),
            residual: rows * step.innovation.fixed_rows::<M>(0),
            correction: step.correction,
        });
        if self.samples.len() < 2 * self.m_b + 1 {
            return None;
        }
        let r = SMatrix::from_diagonal(&self.r);
        let samples = self.samples.make_contiguous();
        let found = correlation::regression(samples, self.m_b, &r, self.open_loop, entries, &mut self.work);
        self.samples.drain(..self.m_b + 1);
        if found.is_none() {
            self.skipped += 1;
        }
        found
    }
}
