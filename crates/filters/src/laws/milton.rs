//! MILTON: the process noise follows the correlation of innovations (Mamich and Zanetti, Sec. III.C).
//!
//! [`super::correlation`] turns a window of samples into the regression for the jerk density; here stands what is done with it:
//! the information-form recursion of Eq. (29) for the square root s of the density.
//!
//! Two readings exist of two steps of the paper, each a parameter:
//! * `residuals`: *printed* takes the filter's own innovations, though Eq. (13) describes errors that evolve without
//!   updates; *consistent* restores what the residuals would have been without the filter's corrections.
//! * `linearisation`: *printed* feeds c to D diag(2 s), whose fixed point lies at half of q; *consistent* linearises
//!   about the predicted s, feeding c + D q(s).

use super::adaptation::{Adaptation, Setup, Step};
use super::correlation::{DIAGONAL, Regression};
use super::entry::{FilterEntry, Motion, Search, Update};
use super::window::{M_B, READING, RESIDUALS, WHITEN, Window, regression_variance};
use crate::error::FilterError;
use crate::jerk;
use crate::state::TargetMatrix;
use crate::tunable::{Bound, Kind, Preset, Scales, Start, Tunable};
use nalgebra::{Matrix3, Vector3};
use numerics::{Source, spd, stream};
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

pub(super) const ENTRY: FilterEntry = FilterEntry {
    name: "milton",
    about: "innovation correlation adapts the jerk density (Mamich and Zanetti)",
    motion: Motion::OfFrame,
    update: Update::Kalman,
    ours: false,
    bound: false,
    tunables: &[
        M_B,
        RESIDUALS,
        Tunable {
            name: "linearisation",
            about: "Eq. (28) as printed, or about the predicted s (consistent)",
            kind: READING,
        },
        WHITEN,
        Tunable {
            name: "r_w",
            about: "measurement noise of the adaptation, R_w = r_w I, in the units the law adapts in",
            kind: Kind::Real {
                start: Start::Derived(regression_variance),
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "q_w",
            about: "process noise of the adaptation per update, Q_w = q_w I, in the units the law adapts in",
            kind: Kind::Real {
                start: Start::Derived(|scales| start_variance(scales) / 100.0),
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "psi0",
            about: "initial variance of s, Psi_0 = psi0 I, in the units the law adapts in",
            kind: Kind::Real {
                start: Start::Derived(start_variance),
                unit: "",
                bound: Bound::Positive,
            },
        },
        Tunable {
            name: "s0",
            about: "mean of the random start of s, all axes",
            kind: Kind::Real {
                start: Start::Derived(Scales::root_jerk_density),
                unit: "m/s^2.5",
                bound: Bound::NonNegative,
            },
        },
    ],
    presets: &[
        Preset {
            name: "paper",
            about: "as printed, tuned as in Sec. IV",
            other_reading: false,
            sets: &[],
        },
        Preset {
            name: "consistent",
            about: "open-loop residuals and the linearisation that the derivation implies, tuned as in Sec. IV",
            other_reading: false,
            sets: &[("residuals", "consistent"), ("linearisation", "consistent")],
        },
        Preset {
            name: "whitened",
            about: "as printed, but with the measured rows divided by their standard deviations",
            other_reading: false,
            sets: &[("whiten", "true")],
        },
    ],
    search: &[
        // Of the fourth power of lengths: (1 m)^4 of a LiDAR, (1e-2 m)^4 of a metrology.
        Search {
            tunable: "r_w",
            low: 1e-10,
            high: 1e4,
            only_with: None,
        },
        // Of s squared, where s is 1e-9 to 1e-2 in SI and 1e5 times as much in the units of a halo orbit.
        Search {
            tunable: "q_w",
            low: 1e-18,
            high: 1.0,
            only_with: None,
        },
        Search {
            tunable: "psi0",
            low: 1e-16,
            high: 1e2,
            only_with: None,
        },
        Search {
            tunable: "s0",
            low: 1e-12,
            high: 1e-3,
            only_with: None,
        },
    ],
};

/// Variance of s at the start, internal units: as large as the square of its mean.
fn start_variance(scales: &Scales) -> f64 {
    (scales.root_jerk_density() / scales.units.root_jerk_density()).powi(2)
}

/// The law and its memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Milton {
    window: Window,
    about_prediction: bool,
    r_w: f64,
    q_w: f64,
    s: Vector3<f64>,
    /// Lambda of Eq. (29).
    information: Matrix3<f64>,
    updates: i32,
}

impl Milton {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        let psi0 = t.real("psi0")?;
        let s0 = t.real("s0")? / setup.units.root_jerk_density() * setup.off_nominal.sqrt();
        let mut generator = stream(setup.study_seed, setup.run, Source::AdaptationStart);
        let s = Vector3::from_fn(|_, _| {
            let w: f64 = StandardNormal.sample(&mut generator);
            s0 + psi0.sqrt() * w
        });
        Ok(Self {
            window: Window::new(setup)?,
            about_prediction: t.choice("linearisation")? == 1,
            r_w: t.real("r_w")?,
            q_w: t.real("q_w")?,
            s,
            information: Matrix3::identity() / psi0,
            updates: 0,
        })
    }

    /// Eq. (29) with the regression c = D q, q = s * s.
    fn learn(&mut self, regression: &Regression<3>) -> Result<(), FilterError> {
        let failed = FilterError::InformationNotSpd {
            law: "milton",
            update: self.updates + 1,
        };
        // Lambda- = (I - Lambda (Lambda + Q_w^-1)^-1) Lambda = L (I + q_w L^T L)^-1 L^T with Lambda = L L^T: the same matrix,
        // but as printed it is the difference of two equal numbers once Lambda exceeds 1/q_w by far, which a large s does.
        let Some(root) = self.information.cholesky().map(|factor| factor.l()) else {
            return Err(failed);
        };
        let Some(spread) = (Matrix3::identity() + root.transpose() * root * self.q_w).cholesky() else {
            return Err(failed);
        };
        let mut half = root.transpose();
        spread.l_dirty().solve_lower_triangular_unchecked_mut(&mut half);
        // A random walk leaves s where it is, so d- = Lambda- s.
        let prior = half.transpose() * half;
        // D_hat = D diag(2 s), Eq. (28).
        let slope = Matrix3::from_diagonal(&(self.s * 2.0));
        let fed = if self.about_prediction {
            regression.dt_c + regression.dt_d * self.s.component_mul(&self.s)
        } else {
            regression.dt_c
        };
        let posterior = prior + spd::symmetrised(&(slope * regression.dt_d * slope)) / self.r_w;
        let d = prior * self.s + slope * fed / self.r_w;
        let Some(factor) = posterior.cholesky() else {
            return Err(failed);
        };
        self.s = spd::over(&d.transpose(), factor.l_dirty()).transpose();
        self.information = posterior;
        self.updates += 1;
        Ok(())
    }
}

impl Adaptation for Milton {
    fn process_noise(&self, dt: f64) -> TargetMatrix {
        jerk::process_noise(&self.s.component_mul(&self.s), dt)
    }

    fn observe(&mut self, step: &Step) -> Result<(), FilterError> {
        match self.window.push(step, &DIAGONAL) {
            Some(regression) => self.learn(&regression),
            None => Ok(()),
        }
    }

    fn s(&self) -> Vector3<f64> {
        self.s
    }

    fn learns_without_bound(&self) -> bool {
        true
    }

    fn updates(&self) -> i32 {
        self.updates
    }

    fn skipped(&self) -> i32 {
        self.window.skipped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::correlation::{self, Sampled};
    use crate::layout::{Layout, Measured};
    use crate::state::{RowMatrix, RowVector, Rows, Target};
    use crate::tunable::{Tunables, Value};
    use crate::units::Units;
    use interface::Sensor;
    use nalgebra::{DMatrix, DVector};
    use numerics::{Generator, expm};

    const BUFFER: usize = 4;

    fn normal(g: &mut Generator) -> f64 {
        StandardNormal.sample(g)
    }

    #[derive(Clone, Copy)]
    struct Tuning {
        residuals: usize,
        linearisation: usize,
        whiten: bool,
        r_w: f64,
        q_w: f64,
        psi0: f64,
        s0: f64,
    }

    const TUNING: Tuning = Tuning {
        residuals: 0,
        linearisation: 0,
        whiten: false,
        r_w: 2.0,
        q_w: 0.03,
        psi0: 0.2,
        s0: 0.7,
    };

    /// * `r`: variance of each row of the measurement.
    fn law(tuning: Tuning, r: &[f64], run: u64) -> Milton {
        let values = [
            Value::Integer(BUFFER as i32),
            Value::Choice(tuning.residuals),
            Value::Choice(tuning.linearisation),
            Value::Boolean(tuning.whiten),
            Value::Real(tuning.r_w),
            Value::Real(tuning.q_w),
            Value::Real(tuning.psi0),
            Value::Real(tuning.s0),
        ];
        let told = told();
        Milton::new(&Setup {
            tunables: Tunables {
                law: ENTRY.name,
                declared: ENTRY.tunables,
                values: &values,
                told: &told,
            },
            layout: Layout::new(&[if r.len() == 3 { Sensor::Lidar } else { Sensor::Metrology }]),
            r: RowVector::from_fn(|row, _| r.get(row).copied().unwrap_or(0.0)),
            state_measured: false,
            units: Units::SI,
            off_nominal: 1.0,
            study_seed: 1,
            run,
        })
        .unwrap()
    }

    fn told() -> interface::Navigation {
        let mission = interface::mission::embedded("leo_venting").unwrap();
        mission.mission().unwrap().navigation()
    }

    /// Samples of three integrators seen through rows that turn, corrected by arbitrary amounts.
    fn steps(g: &mut Generator, count: usize) -> Vec<Step> {
        steps_of(3, g, count)
    }

    fn steps_of(rows: usize, g: &mut Generator, count: usize) -> Vec<Step> {
        let mut a = TargetMatrix::zeros();
        (0..6).for_each(|i| a[(i, i + 3)] = 1.0);
        let f = expm(&a);
        (0..count)
            .map(|_| {
                let mut h = Rows::zeros();
                h.view_mut((0, 0), (rows, rows))
                    .iter_mut()
                    .for_each(|entry| *entry = normal(g));
                let mut step = Step::blank(1.0, f);
                step.measured.mark(0..rows);
                step.h = h;
                step.innovation = RowVector::from_fn(|row, _| if row < rows { normal(g) } else { 0.0 });
                step.correction = Target::from_fn(|_, _| 0.1 * normal(g));
                step
            })
            .collect()
    }

    fn fed(mut law: Milton, steps: impl IntoIterator<Item = Step>) -> Milton {
        steps.into_iter().for_each(|step| law.observe(&step).unwrap());
        law
    }

    /// The recursion against least squares with a gain, the form that Eq. (29) rewrites.
    #[test]
    fn information_form_is_recursive_least_squares() {
        for linearisation in [0, 1] {
            let g = &mut stream(21, 0, Source::Lidar);
            let mut ours = law(
                Tuning {
                    linearisation,
                    ..TUNING
                },
                &[1.0; 3],
                0,
            );
            let mut s = DVector::from_column_slice(ours.s.as_slice());
            let mut psi = DMatrix::identity(3, 3) * TUNING.psi0;
            for update in 1..=4 {
                let d = DMatrix::from_fn(20, 3, |_, _| normal(g));
                let c = DVector::from_fn(20, |_, _| normal(g));
                let (dt_d, dt_c) = (d.transpose() * &d, d.transpose() * &c);
                let regression = Regression {
                    dt_d: Matrix3::from_fn(|i, j| dt_d[(i, j)]),
                    dt_c: Vector3::from_fn(|i, _| dt_c[i]),
                };
                ours.learn(&regression).unwrap();

                psi += DMatrix::identity(3, 3) * TUNING.q_w;
                let slope = &d * DMatrix::from_diagonal(&(&s * 2.0));
                let measured = if linearisation == 1 {
                    &c + &d * s.component_mul(&s)
                } else {
                    c
                };
                let spread = &slope * &psi * slope.transpose() + DMatrix::identity(20, 20) * TUNING.r_w;
                let gain = &psi * slope.transpose() * spread.try_inverse().unwrap();
                s += &gain * (measured - &slope * &s);
                psi = (DMatrix::identity(3, 3) - gain * slope) * psi;
                let known = DMatrix::from_fn(3, 3, |i, j| ours.information[(i, j)])
                    .try_inverse()
                    .unwrap();
                for i in 0..3 {
                    assert!(
                        (ours.s[i] - s[i]).abs() < 1e-9,
                        "update {update}: {} and {}",
                        ours.s[i],
                        s[i]
                    );
                }
                assert!((known - &psi).amax() < 1e-10, "update {update}");
            }
        }
    }

    /// However much an update has told, Q_w leaves no more than 1/q_w of it: a difference of large numbers would not.
    #[test]
    fn information_is_forgotten_without_loss_of_digits() {
        let mut ours = law(TUNING, &[1.0; 3], 0);
        let told = Regression {
            dt_d: Matrix3::new(2e30, 3e24, 0.0, 3e24, 1e20, 1e18, 0.0, 1e18, 4e25),
            dt_c: Vector3::repeat(1.0),
        };
        let silent = Regression {
            dt_d: Matrix3::zeros(),
            dt_c: Vector3::zeros(),
        };
        ours.learn(&told).unwrap();
        ours.learn(&silent).unwrap();
        let share = ours.information * TUNING.q_w;
        assert!((share - Matrix3::identity()).amax() < 1e-9, "{share}");
    }

    /// Fed exact correlations of a density q without end, the consistent law finds q and the printed one half of it.
    #[test]
    fn printed_linearisation_settles_at_half_the_density() {
        let q = Vector3::new(0.3, 1.0, 2.0);
        let dt_d = Matrix3::new(2.0, 0.3, 0.1, 0.3, 1.5, 0.2, 0.1, 0.2, 1.0);
        for (linearisation, share) in [(0, 0.5), (1, 1.0)] {
            let mut ours = law(
                Tuning {
                    linearisation,
                    ..TUNING
                },
                &[1.0; 3],
                3,
            );
            for _ in 0..3000 {
                ours.learn(&Regression { dt_d, dt_c: dt_d * q }).unwrap();
            }
            let found = ours.s.component_mul(&ours.s);
            assert!((found - q * share).amax() < 1e-9, "{found}");
        }
    }

    #[test]
    fn updates_wait_for_a_whole_set_of_new_samples() {
        let g = &mut stream(22, 0, Source::Lidar);
        let mut ours = law(TUNING, &[1.0; 3], 0);
        let mut seen = Vec::new();
        for (k, step) in (1..).zip(steps(g, 40)) {
            let before = (ours.s, ours.updates);
            ours.observe(&step).unwrap();
            if ours.updates > before.1 {
                seen.push(k);
            } else {
                assert_eq!(ours.s, before.0);
            }
        }
        // 2 m_b + 1 residuals make the first, m_b + 1 new ones every other.
        assert_eq!(seen, [9, 14, 19, 24, 29, 34, 39]);
        assert_eq!(ours.skipped(), 0);
    }

    #[test]
    fn a_blind_window_is_passed_by_and_counted() {
        let g = &mut stream(23, 0, Source::Lidar);
        let blind = steps(g, 2 * BUFFER + 1).into_iter().map(|step| Step {
            h: Rows::zeros(),
            innovation: RowVector::zeros(),
            measured: Measured::default(),
            ..step
        });
        let start = law(TUNING, &[1.0; 3], 0);
        let ours = fed(start.clone(), blind);
        assert_eq!((ours.updates(), ours.skipped(), ours.s), (0, 1, start.s));
        let later = fed(ours, steps(g, 3 * BUFFER));
        assert!(later.updates() > 0, "it goes on once the target is seen again");
    }

    /// What `residuals` chooses: whether the filter's corrections are undone before the correlation is taken.
    #[test]
    fn consistent_residuals_are_the_innovations_of_a_filter_that_never_corrects() {
        let recorded = steps(&mut stream(24, 0, Source::Lidar), 2 * BUFFER + 1);
        let sampled: Vec<Sampled<3>> = recorded
            .iter()
            .map(|s| Sampled {
                dt: s.dt,
                f: s.f,
                h: s.h.fixed_rows::<3>(0).into_owned(),
                residual: s.innovation.fixed_rows::<3>(0).into_owned(),
                correction: s.correction,
            })
            .collect();
        let restored: Vec<Vector3<f64>> = correlation::open_loop_residuals(&sampled).collect();
        let uncorrected = |innovation: Option<&Vector3<f64>>, step: &Step| Step {
            innovation: innovation.map_or(step.innovation, |z| z.fixed_resize(0.0)),
            correction: Target::zeros(),
            ..step.clone()
        };
        let r = &[0.5; 3];
        let printed = law(TUNING, r, 0);
        let consistent = law(Tuning { residuals: 1, ..TUNING }, r, 0);
        let as_recorded = fed(printed.clone(), recorded.clone()).s;
        let blind_to_corrections = fed(printed.clone(), recorded.iter().map(|s| uncorrected(None, s))).s;
        assert_eq!(as_recorded, blind_to_corrections);
        let undone = fed(consistent, recorded.clone()).s;
        let by_hand = fed(
            printed,
            recorded.iter().zip(&restored).map(|(s, z)| uncorrected(Some(z), s)),
        )
        .s;
        assert!(
            (undone - by_hand).amax() < 1e-9 * by_hand.amax(),
            "{undone} and {by_hand}"
        );
        assert!((undone - as_recorded).amax() > 1e-3);
    }

    /// Whitened, the law does not see in which unit a row was measured; as printed it does.
    #[test]
    fn whitening_takes_out_the_units_of_the_rows() {
        let (r, units) = ([0.5, 0.02, 0.3, 1e-4, 3e-4, 2e-4], [10.0, 0.1, 3.0, 1e3, 0.5, 20.0]);
        let rescale = RowMatrix::from_diagonal(&RowVector::from_fn(|row, _| units.get(row).copied().unwrap_or(1.0)));
        let rescaled_r: Vec<f64> = r.iter().zip(units).map(|(r, unit)| r * unit * unit).collect();
        for (rows, whiten) in [(3, true), (3, false), (6, true), (6, false)] {
            let recorded = steps_of(rows, &mut stream(25, 0, Source::Lidar), 3 * BUFFER);
            let tuning = Tuning { whiten, ..TUNING };
            let plain = fed(law(tuning, &r[..rows], 0), recorded.clone()).s;
            let rescaled = recorded.iter().map(|s| Step {
                h: rescale * s.h,
                innovation: rescale * s.innovation,
                ..s.clone()
            });
            let other = fed(law(tuning, &rescaled_r[..rows], 0), rescaled).s;
            let same = (plain - other).amax() < 1e-8 * plain.amax();
            assert_eq!(same, whiten, "{rows} rows: {plain} and {other}");
        }
    }

    #[test]
    fn s_starts_about_its_mean_with_the_variance_psi0() {
        let runs = 2000;
        let (mut mean, mut square) = (Vector3::zeros(), Vector3::zeros());
        for run in 0..runs {
            let e = law(TUNING, &[1.0; 3], run).s.add_scalar(-TUNING.s0) / TUNING.psi0.sqrt();
            mean += e / runs as f64;
            square += e.component_mul(&e) / runs as f64;
        }
        let n = runs as f64;
        for axis in 0..3 {
            assert!(mean[axis].abs() < 3.5 / n.sqrt(), "{mean}");
            assert!((square[axis] - 1.0).abs() < 3.5 * (2.0 / n).sqrt(), "{square}");
        }
    }
}
