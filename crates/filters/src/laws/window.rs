//! The buffer of samples that laws on innovation correlation share: when it is full it yields one regression.

use super::correlation::{self, Regression, Sampled};
use super::{Setup, Step};
use crate::FilterError;
use crate::tunable::{Kind, Tunable};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Fewest samples with which a window of three rows each can observe nine states.
const SHORTEST: i32 = 3;
const READINGS: &[&str] = &["printed", "consistent"];

/// A choice between what the paper prints and what its derivation implies; index 1 is the latter.
pub(super) const READING: Kind = Kind::Choice {
    type_name: "Reading",
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
    about: "divide the LiDAR rows by their standard deviations before adapting",
    kind: Kind::Boolean { start: false },
};

/// Samples not yet adapted to, and how to look at them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Window {
    m_b: usize,
    open_loop: bool,
    r: Matrix3<f64>,
    row_scale: Vector3<f64>,
    /// Oldest first.
    samples: VecDeque<Sampled>,
    skipped: i32,
}

impl Window {
    /// An empty buffer, from the tunables [`M_B`], [`RESIDUALS`] and [`WHITEN`] of a law.
    ///
    /// # Errors
    /// When one of them is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let whiten = setup.tunables.boolean(WHITEN.name)?;
        let variances = setup.r.fixed_rows::<3>(0).into_owned();
        let inverse_sigma = variances.map(|variance| 1.0 / variance.sqrt());
        Ok(Self {
            m_b: setup.tunables.integer(M_B.name)? as usize,
            open_loop: setup.tunables.choice(RESIDUALS.name)? == 1,
            r: if whiten {
                Matrix3::identity()
            } else {
                Matrix3::from_diagonal(&variances)
            },
            row_scale: if whiten { inverse_sigma } else { Vector3::repeat(1.0) },
            samples: VecDeque::new(),
            skipped: 0,
        })
    }

    /// Takes a sample; every m_b + 1 of them, once 2 m_b + 1 have come, returns the regression of the newest 2 m_b + 1.
    ///
    /// C_k,k-p with p = 0..m_b reaches back over 2 m_b + 1 residuals; the next update waits until m_b + 1 are new. A window
    /// that does not observe all states is skipped and counted.
    pub(super) fn push(&mut self, step: Step) -> Option<Regression> {
        let rows = Matrix3::from_diagonal(&self.row_scale);
        self.samples.push_back(Sampled {
            dt: step.dt,
            f: step.f,
            h: rows * step.h.fixed_rows::<3>(0),
            residual: rows * step.innovation.fixed_rows::<3>(0),
            correction: step.correction,
        });
        if self.samples.len() < 2 * self.m_b + 1 {
            return None;
        }
        let found = correlation::regression(self.samples.make_contiguous(), self.m_b, &self.r, self.open_loop);
        self.samples.drain(..self.m_b + 1);
        if found.is_none() {
            self.skipped += 1;
        }
        found
    }

    /// How many windows were skipped.
    pub(super) fn skipped(&self) -> i32 {
        self.skipped
    }
}
