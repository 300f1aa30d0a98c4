//! MILTON: the process noise follows the correlation of innovations (Mamich and Zanetti, Sec. III.C).
//!
//! [`correlation`] turns a window of samples into the regression for the jerk density; here stands what is done with it:
//! the information-form recursion of Eq. (29) for the square root s of the density.
//!
//! Two readings exist of two steps of the paper, each a parameter:
//! * `residuals`: *printed* takes the filter's own innovations, though Eq. (13) describes errors that evolve without
//!   updates; *consistent* restores what the residuals would have been without the filter's corrections.
//! * `linearisation`: *printed* feeds c to D diag(2 s), whose fixed point lies at half of q; *consistent* linearises
//!   about the predicted s, feeding c + D q(s).

pub mod correlation;

use super::{Adaptation, FilterEntry, Law, Setup, Step};
use crate::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Tunable};
use correlation::{Regression, Sampled};
use nalgebra::{Matrix3, Vector3};
use numerics::{Source, spd, stream};
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Fewest samples with which a window of three rows each can observe nine states.
const SHORTEST_BUFFER: i32 = 3;
const READINGS: &[&str] = &["printed", "consistent"];
const READING_TYPE: &str = "MiltonReading";

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "milton",
    about: "innovation correlation adapts the jerk density (Mamich and Zanetti)",
    tunables: &[
        Tunable {
            name: "m_b",
            about: "samples in the adaptation buffer",
            kind: Kind::Integer {
                start: 30,
                min: SHORTEST_BUFFER,
                max: 1000,
            },
        },
        Tunable {
            name: "residuals",
            about: "the filter's own innovations (printed) or open-loop residuals (consistent)",
            kind: Kind::Choice {
                type_name: READING_TYPE,
                items: READINGS,
            },
        },
        Tunable {
            name: "linearisation",
            about: "Eq. (28) as printed, or about the predicted s (consistent)",
            kind: Kind::Choice {
                type_name: READING_TYPE,
                items: READINGS,
            },
        },
        Tunable {
            name: "whiten",
            about: "divide the LiDAR rows by their standard deviations before adapting",
            kind: Kind::Boolean { start: false },
        },
        Tunable {
            name: "r_w",
            about: "measurement noise of the adaptation, R_w = r_w I, in the units the law adapts in",
            kind: Kind::Real {
                start: None,
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "q_w",
            about: "process noise of the adaptation per update, Q_w = q_w I, in the units the law adapts in",
            kind: Kind::Real {
                start: None,
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "psi0",
            about: "initial variance of s, Psi_0 = psi0 I, in the units the law adapts in",
            kind: Kind::Real {
                start: None,
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s0",
            about: "mean of the random start of s, all axes",
            kind: Kind::Real {
                start: None,
                unit: "m/s^2.5",
                bound: Bound::NonNegative,
            },
        },
    ],
    presets: &[
        Preset {
            name: "paper",
            about: "as printed, tuned as in Sec. IV",
            sets: &[],
        },
        Preset {
            name: "consistent",
            about: "open-loop residuals and the linearisation that the derivation implies, tuned as in Sec. IV",
            sets: &[("residuals", "consistent"), ("linearisation", "consistent")],
        },
    ],
    build,
};

fn build(setup: &Setup<'_>) -> Result<Law, FilterError> {
    let t = &setup.tunables;
    let psi0 = t.real("psi0")?;
    let s0 = t.real("s0")? / setup.units.root_jerk_density();
    let mut generator = stream(setup.study_seed, setup.run, Source::AdaptationStart);
    let s = Vector3::from_fn(|_, _| {
        let w: f64 = StandardNormal.sample(&mut generator);
        s0 + psi0.sqrt() * w
    });
    let whiten = t.boolean("whiten")?;
    let root = setup.r.diagonal().map(f64::sqrt);
    Ok(Milton {
        m_b: t.integer("m_b")? as usize,
        open_loop: t.choice("residuals")? == 1,
        about_prediction: t.choice("linearisation")? == 1,
        r: if whiten { Matrix3::identity() } else { setup.r },
        row_scale: if whiten {
            root.map(|sigma| 1.0 / sigma)
        } else {
            Vector3::repeat(1.0)
        },
        r_w: t.real("r_w")?,
        q_w: t.real("q_w")?,
        s,
        information: Matrix3::identity() / psi0,
        window: VecDeque::new(),
        updates: 0,
        skipped: 0,
    }
    .into())
}

/// The law and its memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Milton {
    m_b: usize,
    open_loop: bool,
    about_prediction: bool,
    r: Matrix3<f64>,
    row_scale: Vector3<f64>,
    r_w: f64,
    q_w: f64,
    s: Vector3<f64>,
    /// Lambda of Eq. (29).
    information: Matrix3<f64>,
    /// Samples not yet adapted to, oldest first.
    window: VecDeque<Sampled>,
    updates: i32,
    skipped: i32,
}

impl Milton {
    /// Eq. (29) with the regression c = D q, q = s * s.
    fn learn(&mut self, regression: &Regression) -> Result<(), FilterError> {
        let failed = FilterError::InformationNotSpd {
            law: "milton",
            update: self.updates + 1,
        };
        // Lambda- = (I - Lambda (Lambda + Q_w^-1)^-1) Lambda. A random walk leaves s where it is, so d- = Lambda- s.
        let sum = self.information + Matrix3::identity() / self.q_w;
        let Some(l) = spd::cholesky(&sum) else {
            return Err(failed);
        };
        let solved = Matrix3::from_fn(|i, j| spd::cholesky_solve(&l, &self.information.column(j).into_owned())[i]);
        let prior = spd::symmetrised(&(self.information - self.information * solved));
        // D_hat = D diag(2 s), Eq. (28).
        let slope = Matrix3::from_diagonal(&(self.s * 2.0));
        let fed = if self.about_prediction {
            regression.dt_c + regression.dt_d * self.s.component_mul(&self.s)
        } else {
            regression.dt_c
        };
        let posterior = prior + spd::symmetrised(&(slope * regression.dt_d * slope)) / self.r_w;
        let d = prior * self.s + slope * fed / self.r_w;
        let Some(l) = spd::cholesky(&posterior) else {
            return Err(failed);
        };
        self.s = spd::cholesky_solve(&l, &d);
        self.information = posterior;
        self.updates += 1;
        Ok(())
    }
}

impl Adaptation for Milton {
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::process_noise(&self.s.component_mul(&self.s), dt)
    }

    fn observe(&mut self, step: Step) -> Result<(), FilterError> {
        let rows = Matrix3::from_diagonal(&self.row_scale);
        self.window.push_back(Sampled {
            dt: step.dt,
            f: step.f,
            h: rows * step.h,
            residual: rows * step.innovation,
            correction: step.correction,
        });
        // C_k,k-p with p = 0..m_b reaches back over 2 m_b + 1 residuals; the next update waits until m_b + 1 are new.
        if self.window.len() < 2 * self.m_b + 1 {
            return Ok(());
        }
        let result = match correlation::regression(self.window.make_contiguous(), self.m_b, &self.r, self.open_loop) {
            Some(regression) => self.learn(&regression),
            None => {
                self.skipped += 1;
                Ok(())
            }
        };
        self.window.drain(..self.m_b + 1);
        result
    }

    fn s(&self) -> Vector3<f64> {
        self.s
    }

    fn updates(&self) -> i32 {
        self.updates
    }

    fn skipped(&self) -> i32 {
        self.skipped
    }
}
