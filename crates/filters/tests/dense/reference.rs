//! The filter of fixed process noise written with whole matrices, as one would write it first: what the fast one is held against,
//! in its results and in its speed.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(missing_docs, reason = "part of test binaries")]
#![allow(dead_code, reason = "each binary uses its own part")]

use filters::dynamics::{Drive, Thrust, TwoVehicles};
use filters::state::{State, StateMatrix, TargetMatrix, idx};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// How exp(A dt) is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponential {
    /// By nalgebra.
    Nalgebra,
    /// I + A dt + (A dt)^2 / 2 + (A dt)^3 / 6.
    ThreeTerms,
}

/// Mean and covariance.
#[derive(Clone, Debug)]
pub struct Dense {
    pub x: State,
    pub p: StateMatrix,
    pub exponential: Exponential,
}

fn part(x: &State, slot: usize) -> Vector3<f64> {
    x.fixed_rows::<3>(slot).into_owned()
}

/// A of Eq. (5), 18x18.
pub fn generator(dynamics: &TwoVehicles, x: &State, thrust: Option<&Thrust>) -> StateMatrix {
    let chaser = dynamics.gravity.partials(&part(x, 9));
    let target = dynamics.gravity.partials(&(part(x, 0) + part(x, 9)));
    let drive = thrust.map_or_else(Matrix3::zeros, |t| -t.dcm_n_bc);
    let mut a = StateMatrix::zeros();
    let mut set = |i: usize, j: usize, block: &Matrix3<f64>| a.fixed_view_mut::<3, 3>(i, j).copy_from(block);
    let identity = Matrix3::identity();
    set(0, 3, &identity);
    set(3, 0, &target.0);
    set(3, 3, &target.1);
    set(3, 6, &identity);
    set(3, 9, &(target.0 - chaser.0));
    set(3, 12, &(target.1 - chaser.1));
    set(3, 15, &-drive);
    set(6, 6, &(identity * -dynamics.acceleration_decay));
    set(9, 12, &identity);
    set(12, 9, &chaser.0);
    set(12, 12, &chaser.1);
    set(12, 15, &drive);
    set(15, 15, &(identity * -dynamics.beta));
    a
}

impl Dense {
    /// Time update: the mean as the fast filter has it, F P F^T + Q in whole matrices.
    pub fn predict(&mut self, dynamics: &TwoVehicles, dt: f64, drive: &Drive, q_target: &TargetMatrix) {
        let a = generator(dynamics, &self.x, drive.thrust.as_ref()) * dt;
        let f = match self.exponential {
            Exponential::Nalgebra => a.exp(),
            Exponential::ThreeTerms => StateMatrix::identity() + a + a * a / 2.0 + a * a * a / 6.0,
        };
        self.x = dynamics.propagate_mean(&self.x, dt, drive);
        let mut q = StateMatrix::zeros();
        dynamics.add_process_noise(&mut q, q_target, dt);
        self.p = f * self.p * f.transpose() + q;
        self.p = (self.p + self.p.transpose()) * 0.5;
    }

    /// Measurement update of Schmidt's filter in Joseph's form, S inverted; the rows by their noise, so that the inverse is not one of
    /// unlike units.
    ///
    /// * `h`: M x 18; `innovation`, `r`: M.
    pub fn update(&mut self, h: &DMatrix<f64>, innovation: &DVector<f64>, r: &DVector<f64>) {
        let p = DMatrix::from_iterator(18, 18, self.p.iter().copied());
        let by_noise = DMatrix::from_diagonal(&r.map(|r| 1.0 / r.sqrt()));
        let (h, innovation) = (&by_noise * h, &by_noise * innovation);
        let r = DMatrix::identity(r.len(), r.len());
        let s = &h * &p * h.transpose() + &r;
        let mut k = &p * h.transpose() * s.try_inverse().unwrap();
        for slot in idx::CONSIDER {
            k.row_mut(slot).fill(0.0);
        }
        let change = &k * innovation;
        self.x += State::from_iterator(change.iter().copied());
        let left = DMatrix::identity(18, 18) - &k * &h;
        let p = &left * p * left.transpose() + &k * r * k.transpose();
        self.p = StateMatrix::from_iterator(p.iter().copied());
        self.p = (self.p + self.p.transpose()) * 0.5;
    }
}
