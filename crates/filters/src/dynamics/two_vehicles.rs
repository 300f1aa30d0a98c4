//! Both vehicles in axes N under gravity, with an accelerometer in the chaser: 18 states (Mamich and Zanetti).

use super::decay::{self, Answer, Dying, is_slow};
use super::transition::{Flow, Transition};
use crate::disturbance::Disturbance;
use crate::gravity::Gravity;
use crate::state::{State, StateMatrix, TargetMatrix, idx};
use crate::update::kalman::Gaussian;
use interface::mission::InitialSigma;
use nalgebra::{Matrix3, SVector, Vector3};
use numerics::rk4;
use serde::{Deserialize, Serialize};

/// The force model of the filter, internal units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoVehicles {
    /// Gravity of both vehicles.
    pub gravity: Gravity,
    /// Inverse time constant of the target's unmodelled acceleration; zero for a random walk.
    pub acceleration_decay: f64,
    /// Inverse time constant of the accelerometer bias.
    pub beta: f64,
    /// White acceleration density of the chaser.
    pub q_c: f64,
    /// Whether that noise also enters v_tc.
    pub q_coupled: bool,
    /// Variance rate of the bias walk.
    pub q_bias: f64,
}

/// An accelerometer reading that drives the propagation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Thrust {
    /// Reading, chaser body axes.
    pub alpha_c_bc: Vector3<f64>,
    /// Chaser body axes to axes N.
    pub dcm_n_bc: Matrix3<f64>,
}

/// What drives the vehicles over a step beside gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// What the accelerometer feels.
    pub thrust: Option<Thrust>,
    /// Acceleration of the target that the filter is told of, axes N.
    pub told_t_n: Vector3<f64>,
    /// Acceleration of the chaser that the filter is told of and its accelerometer does not feel, axes N.
    pub told_c_n: Vector3<f64>,
}

impl From<Thrust> for Drive {
    fn from(thrust: Thrust) -> Self {
        Self {
            thrust: Some(thrust),
            ..Self::default()
        }
    }
}

fn part(x: &State, slot: std::ops::Range<usize>) -> Vector3<f64> {
    x.fixed_rows::<3>(slot.start).into_owned()
}

impl TwoVehicles {
    /// Mean after `dt`: both vehicles by one Runge-Kutta step of Eq. (4), with g of the chaser in its row 5 and no
    /// "v_c dt" term in the mean.
    pub fn propagate_mean(&self, x: &State, dt: f64, drive: &Drive) -> State {
        if !is_slow(self.acceleration_decay, dt) || !is_slow(self.beta, dt) {
            return self.propagate_dying(x, dt, drive);
        }
        let mut inertial = *x;
        let (r_c, v_c) = (part(x, idx::R_C), part(x, idx::V_C));
        inertial.fixed_rows_mut::<3>(0).copy_from(&(part(x, idx::R_TC) + r_c));
        inertial.fixed_rows_mut::<3>(3).copy_from(&(part(x, idx::V_TC) + v_c));
        let end = rk4::step(0.0, &inertial, dt, |_, y| {
            let (r_t, v_t, a_t) = (part(y, 0..3), part(y, 3..6), part(y, idx::A_T));
            let (r_c, v_c, b) = (part(y, idx::R_C), part(y, idx::V_C), part(y, idx::B_C));
            let felt = drive
                .thrust
                .as_ref()
                .map_or_else(Vector3::zeros, |t| t.dcm_n_bc * (t.alpha_c_bc - b));
            let mut dy = State::zeros();
            dy.fixed_rows_mut::<3>(0).copy_from(&v_t);
            dy.fixed_rows_mut::<3>(3)
                .copy_from(&(self.gravity.acceleration(&r_t, &v_t) + a_t + drive.told_t_n));
            dy.fixed_rows_mut::<3>(6).copy_from(&(a_t * -self.acceleration_decay));
            dy.fixed_rows_mut::<3>(9).copy_from(&v_c);
            dy.fixed_rows_mut::<3>(12)
                .copy_from(&(self.gravity.acceleration(&r_c, &v_c) + felt + drive.told_c_n));
            dy.fixed_rows_mut::<3>(15).copy_from(&(b * -self.beta));
            dy
        });
        let mut out = end;
        out.fixed_rows_mut::<3>(0)
            .copy_from(&(part(&end, 0..3) - part(&end, idx::R_C)));
        out.fixed_rows_mut::<3>(3)
            .copy_from(&(part(&end, 3..6) - part(&end, idx::V_C)));
        out
    }

    /// The same where a_t or b_c die away within a step.
    fn propagate_dying(&self, x: &State, dt: f64, drive: &Drive) -> State {
        let (a_t, b_c) = (part(x, idx::A_T), part(x, idx::B_C));
        let (felt, by_bias) = drive.thrust.as_ref().map_or_else(Default::default, |thrust| {
            (thrust.dcm_n_bc * thrust.alpha_c_bc, thrust.dcm_n_bc * -b_c)
        });
        // Both vehicles: r, v, r, v.
        let dying = [(0, a_t, self.acceleration_decay), (6, by_bias, self.beta)];
        let dying = dying.map(|(row, start, rate)| Dying { row, start, rate });
        let by_forces = [drive.told_t_n, felt + drive.told_c_n];
        let mut start = SVector::<f64, 12>::zeros();
        let chaser = x.fixed_rows::<6>(idx::R_C.start);
        start.fixed_rows_mut::<6>(0).copy_from(&(x.fixed_rows::<6>(0) + chaser));
        start.fixed_rows_mut::<6>(6).copy_from(&chaser);
        let end = decay::step(&start, dt, &dying, |y| {
            let mut dy = SVector::<f64, 12>::zeros();
            for (vehicle, driven) in by_forces.iter().enumerate() {
                let at = |row: usize| y.fixed_rows::<3>(6 * vehicle + row).into_owned();
                let pulled = self.gravity.acceleration(&at(0), &at(3)) + driven;
                dy.fixed_rows_mut::<3>(6 * vehicle).copy_from(&at(3));
                dy.fixed_rows_mut::<3>(6 * vehicle + 3).copy_from(&pulled);
            }
            dy
        });
        let mut out = State::zeros();
        let chaser = end.fixed_rows::<6>(6);
        out.fixed_rows_mut::<6>(0).copy_from(&(end.fixed_rows::<6>(0) - chaser));
        out.fixed_rows_mut::<6>(idx::R_C.start).copy_from(&chaser);
        for (slot, start, rate) in [(idx::A_T, a_t, self.acceleration_decay), (idx::B_C, b_c, self.beta)] {
            let left = Answer::after(dt, rate).left;
            out.fixed_rows_mut::<3>(slot.start).copy_from(&(start * left));
        }
        out
    }

    /// Transition exp(A dt) with A of Eq. (5) at `x`.
    pub fn transition(&self, x: &State, dt: f64, thrust: Option<&Thrust>) -> Transition {
        let r_c = part(x, idx::R_C);
        let flow = |r: &Vector3<f64>, third_decay: f64| {
            let (by_r, by_v) = self.gravity.partials(r);
            Flow::new(&by_r, &by_v, third_decay, dt)
        };
        let target = flow(&(part(x, idx::R_TC) + r_c), self.acceleration_decay);
        let chaser = flow(&r_c, self.beta);
        Transition::new(&target, &chaser, thrust.map(|t| -t.dcm_n_bc).as_ref(), dt)
    }

    /// Adds the process noise of `dt` to a covariance, 18x18: the law's for the target, white acceleration for the chaser (entering
    /// r_tc and v_tc with opposite sign when coupled), a random walk for the bias.
    pub fn add_process_noise(&self, p: &mut StateMatrix, q_target: &TargetMatrix, dt: f64) {
        let mut target = p.fixed_view_mut::<9, 9>(0, 0);
        target += q_target;
        let white = [[dt.powi(3) / 3.0, dt.powi(2) / 2.0], [dt.powi(2) / 2.0, dt]];
        for (i, row) in white.iter().enumerate() {
            for (j, w) in row.iter().enumerate() {
                let w = w * self.q_c;
                for axis in 0..3 {
                    let (ti, tj) = (3 * i + axis, 3 * j + axis);
                    let (ci, cj) = (9 + ti, 9 + tj);
                    p[(ci, cj)] += w;
                    if self.q_coupled {
                        p[(ti, tj)] += w;
                        p[(ti, cj)] -= w;
                        p[(cj, ti)] -= w;
                    }
                }
            }
        }
        for axis in idx::B_C {
            p[(axis, axis)] += self.q_bias * dt;
        }
    }

    /// Time update, Eq. (3): mean by Runge-Kutta, covariance F P F^T + Q.
    ///
    /// * `learnt`: what a law adds to the target's acceleration over the step.
    /// * returns: transition of the target's nine states, 9x9.
    pub fn predict(
        &self,
        est: &mut Gaussian,
        dt: f64,
        drive: &Drive,
        learnt: Option<&Disturbance>,
        q_target: &TargetMatrix,
    ) -> TargetMatrix {
        let mut f = self.transition(&est.x, dt, drive.thrust.as_ref());
        est.x = self.propagate_mean(&est.x, dt, drive);
        if let Some(learnt) = learnt {
            learnt.act(&mut est.x, dt);
            f.add_to_velocity(&learnt.by_x_over(dt));
        }
        f.carry(&mut est.p);
        self.add_process_noise(&mut est.p, q_target, dt);
        f.of_target()
    }
}

/// Initial covariance, 18x18, internal units (Mamich and Zanetti, Eqs. 35 and 37).
///
/// Both vehicles' errors are independent and equally large, so r_tc carries twice the variance and is correlated with r_c;
/// likewise v_tc. The third block is a_t for the target and b_c for the chaser.
///
/// * `sigma`: of one vehicle, internal units.
pub fn initial_covariance(sigma: &InitialSigma) -> StateMatrix {
    let mut p = StateMatrix::zeros();
    for axis in 0..3 {
        for (slot, sigma) in [(0, sigma.position), (3, sigma.velocity)] {
            let (t, c, v) = (slot + axis, 9 + slot + axis, sigma * sigma);
            p[(t, t)] = 2.0 * v;
            p[(c, c)] = v;
            p[(t, c)] = -v;
            p[(c, t)] = -v;
        }
        p[(6 + axis, 6 + axis)] = sigma.acceleration * sigma.acceleration;
        p[(15 + axis, 15 + axis)] = sigma.bias * sigma.bias;
    }
    p
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::state::N;
    use nalgebra::SMatrix;
    fn leo() -> (TwoVehicles, State) {
        let dynamics = TwoVehicles {
            gravity: Gravity::Zonal(astro::earth::FILTER),
            acceleration_decay: 1e-2,
            beta: 1.0 / 3600.0,
            q_c: 1e-12,
            q_coupled: true,
            q_bias: 1e-15,
        };
        let mut x = State::zeros();
        let set = |x: &mut State, slot: usize, v: [f64; 3]| x.fixed_rows_mut::<3>(slot).copy_from_slice(&v);
        set(&mut x, 0, [-1200.0, 800.0, 300.0]);
        set(&mut x, 3, [0.4, -0.7, 0.1]);
        set(&mut x, 6, [2e-5, -1e-5, 3e-5]);
        set(&mut x, 9, [5.0e6, 4.2e6, 2.0e6]);
        set(&mut x, 12, [-4.9e3, 5.2e3, 1.6e3]);
        set(&mut x, 15, [3e-6, -2e-6, 1e-6]);
        (dynamics, x)
    }

    fn thrust() -> Thrust {
        let dcm = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner();
        Thrust {
            alpha_c_bc: Vector3::new(3e-3, -1e-2, 2e-3),
            dcm_n_bc: dcm,
        }
    }

    #[test]
    fn transition_agrees_with_differences_of_the_flow() {
        let (dynamics, x) = leo();
        for drive in [None, Some(thrust())] {
            let f = dynamics.transition(&x, 1.0, drive.as_ref()).dense();
            for j in 0..N {
                // Positions carry a rounding of 1e-9 m, so steps are large; the flow is linear over them to far below the bound.
                let step = [100.0, 10.0, 10.0][(j / 3) % 3];
                let (mut up, mut down) = (x, x);
                up[j] += step;
                down[j] -= step;
                let flow = |x: &State| dynamics.propagate_mean(x, 1.0, &drive.map(Drive::from).unwrap_or_default());
                let column = (flow(&up) - flow(&down)) / (2.0 * step);
                // exp(A dt) holds the gravity gradient over the step, which turns by 1e-3 rad meanwhile: 1e-9 1/s2.
                assert!(
                    (f.column(j) - column).amax() < 1e-8,
                    "column {j}, driven {}",
                    drive.is_some()
                );
            }
        }
    }

    #[test]
    fn what_dies_away_within_a_step_does_what_many_short_steps_of_it_do() {
        let (mut dynamics, mut x) = leo();
        x.fixed_rows_mut::<3>(idx::A_T.start)
            .copy_from_slice(&[2e-3, -1e-3, 3e-3]);
        x.fixed_rows_mut::<3>(idx::B_C.start)
            .copy_from_slice(&[3e-4, -2e-4, 1e-4]);
        let drive = Drive::from(thrust());
        for (of_a, of_b) in [(0.0999, 0.1001), (0.1001, 1e-4), (2.0, 0.0), (0.0, 10.0), (10.0, 50.0)] {
            (dynamics.acceleration_decay, dynamics.beta) = (of_a, of_b);
            let count = 2000;
            let dt = 1.0 / f64::from(count);
            let short = (0..count).fold(x, |x, _| dynamics.propagate_mean(&x, dt, &drive));
            let once = dynamics.propagate_mean(&x, 1.0, &drive);
            for (row, (once, short)) in once.iter().zip(short.iter()).enumerate() {
                // Of positions of 6.7e6 m, 2000 roundings of 1e-9 m are left; velocities of 7 km/s round a thousandth of that.
                let bound = if row / 3 % 3 == 0 { 1e-6 } else { 1e-9 };
                assert!(
                    (once - short).abs() < bound,
                    "rates {of_a} {of_b}, row {row}: {once} {short}"
                );
            }
        }
    }

    #[test]
    fn propagation_conserves_energy_of_both_vehicles() {
        let (dynamics, mut x) = leo();
        x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
        let energies = |x: &State| {
            let (r_c, v_c) = (part(x, idx::R_C), part(x, idx::V_C));
            let (r_t, v_t) = (part(x, idx::R_TC) + r_c, part(x, idx::V_TC) + v_c);
            let of = |r: &Vector3<f64>, v: &Vector3<f64>| 0.5 * v.norm_squared() - astro::earth::FILTER.potential(r);
            [of(&r_t, &v_t), of(&r_c, &v_c)]
        };
        let before = energies(&x);
        for _ in 0..5680 {
            x = dynamics.propagate_mean(&x, 1.0, &Drive::default());
        }
        for (a, b) in before.iter().zip(energies(&x)) {
            assert!(((a - b) / a).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn coupled_noise_of_the_chaser_leaves_the_target_alone() {
        let (mut dynamics, _) = leo();
        let dt = 0.7;
        let mut q = StateMatrix::zeros();
        dynamics.add_process_noise(&mut q, &TargetMatrix::zeros(), dt);
        // r_t = r_tc + r_c and v_t likewise carry no noise when the coupling is right.
        let mut to_target = SMatrix::<f64, 6, N>::zeros();
        to_target.fixed_view_mut::<6, 6>(0, 0).fill_with_identity();
        to_target.fixed_view_mut::<6, 6>(0, 9).fill_with_identity();
        assert!((to_target * q * to_target.transpose()).amax() < 1e-25);
        assert!((q[(12, 12)] - dynamics.q_c * dt).abs() < 1e-25 && q[(3, 3)] == q[(12, 12)]);
        dynamics.q_coupled = false;
        let mut block = StateMatrix::zeros();
        dynamics.add_process_noise(&mut block, &TargetMatrix::zeros(), dt);
        assert_eq!(block.fixed_view::<9, 18>(0, 0).amax(), 0.0);
        assert_eq!(block[(9, 12)], q[(9, 12)]);
    }

    #[test]
    fn initial_covariance_is_that_of_two_independent_vehicles() {
        let p = initial_covariance(&InitialSigma {
            position: 3.0,
            velocity: 0.2,
            acceleration: 1e-9,
            bias: 1e-8,
        });
        let mut to_vehicles = StateMatrix::identity();
        to_vehicles.fixed_view_mut::<6, 6>(0, 9).fill_with_identity();
        let v = to_vehicles * p * to_vehicles.transpose();
        let expected = [9.0, 9.0, 9.0, 0.04, 0.04, 0.04, 1e-18, 1e-18, 1e-18];
        for i in 0..N {
            for j in 0..N {
                let bias = [1e-16; 3];
                let want = if i != j {
                    0.0
                } else if i >= 15 {
                    bias[i - 15]
                } else {
                    expected[i % 9]
                };
                assert!((v[(i, j)] - want).abs() < 1e-15, "{i} {j}");
            }
        }
    }
}
