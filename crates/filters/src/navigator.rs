//! A running filter: takes samples, bridges gaps, and holds the estimate.

use crate::beliefs::Beliefs;
use crate::ekf::{self, Dynamics, Measurement, Thrust};
use crate::error::FilterError;
use crate::laws::{AccelerationModel, Adaptation, FILTERS, FilterEntry, Law, Setup, Step};
use crate::sample::Sample;
use crate::scenarios::{SCENARIOS, ScenarioEntry};
use crate::state::{LidarRows, N, N_TARGET, State, TargetMatrix, idx};
use crate::tunable::{Bound, Tunables, Value};
use crate::units::Units;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};
use numerics::spd;
use serde::{Deserialize, Serialize};

/// Longest step of one propagation, s; a gap between samples is crossed in equal parts no longer than this.
const LONGEST_STEP: f64 = 1.0;
/// Longest gap between samples, s. A tag further ahead is a mistake of the caller, not a gap.
const LONGEST_GAP: f64 = 1e5;

/// Everything that chooses a filter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Index into [`SCENARIOS`].
    pub scenario: usize,
    /// Index into [`FILTERS`].
    pub filter: usize,
    /// Seed of the study.
    pub study_seed: u64,
    /// Run within the study.
    pub run: u64,
    /// What the filter believes of the world.
    pub beliefs: Beliefs,
    /// Values of every tunable of every filter, in the order of [`FILTERS`] and of their declarations.
    pub tunables: Vec<Vec<Value>>,
}

impl Default for Settings {
    /// The first scenario and filter, everything at its start value.
    fn default() -> Self {
        let tunables = FILTERS
            .iter()
            .map(|f| f.tunables.iter().map(|t| t.kind.start()).collect())
            .collect();
        Self {
            scenario: 0,
            filter: 0,
            study_seed: 1,
            run: 0,
            beliefs: Beliefs::default(),
            tunables,
        }
    }
}

impl Settings {
    /// The scenario chosen.
    ///
    /// # Errors
    /// When the index is not registered.
    pub fn scenario(&self) -> Result<&'static ScenarioEntry, FilterError> {
        SCENARIOS
            .get(self.scenario)
            .ok_or_else(|| FilterError::UnknownScenario {
                name: format!("number {}", self.scenario + 1),
                known: SCENARIOS.iter().map(|s| s.name).collect::<Vec<_>>().join(", "),
            })
    }

    /// The filter chosen.
    ///
    /// # Errors
    /// When the index is not registered.
    pub fn filter(&self) -> Result<&'static FilterEntry, FilterError> {
        FILTERS.get(self.filter).ok_or_else(|| FilterError::UnknownFilter {
            name: format!("number {}", self.filter + 1),
            known: FILTERS.iter().map(|f| f.name).collect::<Vec<_>>().join(", "),
        })
    }

    /// The value of one tunable, to be changed.
    pub fn tunable_mut(&mut self, filter: &str, tunable: &str) -> Option<&mut Value> {
        let f = FILTERS.iter().position(|entry| entry.name == filter)?;
        let t = FILTERS[f].tunables.iter().position(|entry| entry.name == tunable)?;
        self.tunables.get_mut(f)?.get_mut(t)
    }
}

/// What a filter is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Waiting for the first sample.
    Initialising,
    /// The newest sample was measured and used.
    Tracking,
    /// The newest sample had no LiDAR measurement.
    Coasting,
    /// Innovations are far larger than the filter expects.
    Diverged,
}

impl Status {
    /// Every status with its name, in the order of the FMU's enumeration.
    pub const ALL: [(Self, &'static str); 4] = [
        (Self::Initialising, "initialising"),
        (Self::Tracking, "tracking"),
        (Self::Coasting, "coasting"),
        (Self::Diverged, "diverged"),
    ];
}

/// The estimate after the newest sample, SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Epoch of the sample last used, s.
    pub time: f64,
    /// Its ordinal; 0 before the first.
    pub count: i32,
    /// The 18 states.
    pub x: State,
    /// Covariance of the target's nine states.
    pub p_target: TargetMatrix,
    /// Standard deviations of the 18 states.
    pub sigma: State,
}

/// The newest LiDAR innovation, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Innovation {
    /// Range (m), azimuth and elevation (rad).
    pub residual: Vector3<f64>,
    /// Their predicted variances.
    pub variance: Vector3<f64>,
    /// Normalised innovation squared of the three rows.
    pub nis: f64,
}

/// A filter at work; all of its state is here and can be saved.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Navigator {
    units: Units,
    dynamics: Dynamics,
    law: Law,
    r_lidar: Vector3<f64>,
    r_accelerometer: f64,
    gate: f64,
    initial_p: ekf::InitialSigma,
    divergence: Divergence,
    /// Mean and covariance, internal units; `None` until the first sample.
    core: Option<ekf::Gaussian>,
    /// The reading held over the step that follows; `None` when below the gate or before the first sample.
    thrust: Option<Thrust>,
    estimate: Estimate,
    innovation: Innovation,
    status: Status,
}

/// Exponential mean of the normalised innovations.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Divergence {
    limit: f64,
    samples: f64,
    mean: f64,
}

/// The LiDAR's three rows among the most that a law can be given.
fn pad(rows: &Vector3<f64>) -> Vector6<f64> {
    rows.fixed_resize(0.0)
}

impl Navigator {
    /// A filter that waits for its first sample.
    ///
    /// * `start_time`: epoch at which the initial estimate will hold, s.
    ///
    /// # Errors
    /// When the scenario or filter is unknown or a parameter is out of range.
    pub fn new(settings: &Settings, start_time: f64) -> Result<Self, FilterError> {
        let (scenario, filter, b) = (settings.scenario()?, settings.filter()?, &settings.beliefs);
        let units = scenario.units;
        let own = |name: &str, value: f64| scenario.resolve(name, value);
        let sigma = |name: &str, value: f64, unit: &'static str| Bound::Positive.check(name, own(name, value)?, unit);
        let r_lidar = sensors::lidar::covariance(
            Bound::Positive.check("r.sigma_range", b.r_sigma_range, "m")? / units.length,
            Bound::Positive.check("r.sigma_angle", b.r_sigma_angle, "rad")?,
        );
        let r_acc =
            Bound::Positive.check("r.sigma_accelerometer", b.r_sigma_accelerometer, "m/s2")? / units.acceleration();
        let bias_walk = Bound::NonNegative.check("accelerometer.bias_sigma", b.accelerometer_bias_sigma, "m/s2")?;
        let q_c = Bound::NonNegative.check("chaser.q_c", own("chaser.q_c", b.chaser_q_c)?, "m2/s3")?;
        let initial_p = ekf::InitialSigma {
            position: sigma("p0.sigma_position", b.p0_sigma_position, "m")? / units.length,
            velocity: sigma("p0.sigma_velocity", b.p0_sigma_velocity, "m/s")? / units.velocity(),
            acceleration: sigma("p0.sigma_acceleration", b.p0_sigma_acceleration, "m/s2")? / units.acceleration(),
            bias: sigma("p0.sigma_bias", b.p0_sigma_bias, "m/s2")? / units.acceleration(),
        };
        let law = (filter.build)(&Setup {
            tunables: Tunables {
                law: filter.name,
                declared: filter.tunables,
                values: settings.tunables.get(settings.filter).map_or(&[], Vec::as_slice),
                scenario: scenario.name,
                defaults: scenario.defaults,
            },
            rows: scenario.measures.rows(),
            r: pad(&r_lidar.diagonal()),
            units,
            study_seed: settings.study_seed,
            run: settings.run,
        })?;
        let dynamics = Dynamics {
            gravity: (scenario.gravity)(b)?,
            acceleration_decay: match law.acceleration() {
                AccelerationModel::GaussMarkov(rate) => rate,
                AccelerationModel::RandomWalk | AccelerationModel::Absent => 0.0,
            },
            beta: Bound::NonNegative.check("accelerometer.beta", b.accelerometer_beta, "1/s")? * units.time,
            q_c: q_c / (units.velocity().powi(2) / units.time),
            q_coupled: b.chaser_q_coupled,
            // A standard deviation per 1 s step, as a variance rate.
            q_bias: (bias_walk / units.acceleration()).powi(2) * units.time,
        };
        Ok(Self {
            units,
            dynamics,
            law,
            r_lidar: r_lidar.diagonal(),
            r_accelerometer: r_acc * r_acc,
            gate: Bound::NonNegative.check("accelerometer.gate", b.accelerometer_gate, "m/s2")? / units.acceleration(),
            initial_p,
            divergence: Divergence {
                limit: Bound::Positive.check("divergence.nis", b.divergence_nis, "")?,
                samples: Bound::Positive.check("divergence.samples", f64::from(b.divergence_samples), "")?,
                mean: 1.0,
            },
            core: None,
            thrust: None,
            estimate: Estimate {
                time: start_time,
                count: 0,
                x: State::zeros(),
                p_target: TargetMatrix::zeros(),
                sigma: State::zeros(),
            },
            innovation: Innovation::default(),
            status: Status::Initialising,
        })
    }

    /// Processes a sample; one whose ordinal is not above the last one used is passed by.
    ///
    /// * `nav_init`: the initial estimate at the start time, 18 states, SI; read with the first sample only.
    ///
    /// # Errors
    /// When the sample makes no sense or the filter breaks down; the filter should then not be used further.
    pub fn process(&mut self, sample: &Sample, nav_init: &State) -> Result<(), FilterError> {
        if sample.count <= self.estimate.count {
            return Ok(());
        }
        let (t_s, last_s) = (sample.time, self.estimate.time);
        let gap_s = t_s - last_s;
        if gap_s.is_nan() || gap_s <= 0.0 {
            return Err(FilterError::TimeNotAdvancing {
                count: sample.count,
                t_s,
                last_s,
            });
        }
        if gap_s > LONGEST_GAP {
            return Err(FilterError::GapTooLong {
                count: sample.count,
                t_s,
                gap_s,
                limit_s: LONGEST_GAP,
            });
        }
        let defect = (sample.dcm_bc_n * sample.dcm_bc_n.transpose() - Matrix3::identity()).amax();
        if defect.is_nan() || defect > 1e-6 {
            return Err(FilterError::NotARotation { t_s, defect });
        }
        let mut core = match self.core.take() {
            Some(core) => core,
            None if nav_init.iter().all(|v| *v == 0.0) => return Err(FilterError::NoInitialEstimate { t_s }),
            None => self.start(nav_init),
        };

        let f = self.propagate(&mut core, gap_s);
        let alpha = sample.alpha_c_bc / self.units.acceleration();
        let drives = alpha.norm() >= self.gate;
        let prior = core.x;
        let (h, innovation) = self.update(&mut core, sample, &alpha, drives)?;
        if !(core.x.iter().all(|v| v.is_finite()) && core.p.iter().all(|v| v.is_finite())) {
            return Err(FilterError::NotFinite { t_s });
        }
        // Zero is legal: a law without an acceleration state has no variance there.
        if let Some(state) = (0..N).find(|i| core.p[(*i, *i)] < 0.0) {
            return Err(FilterError::NegativeVariance { t_s, state: state + 1 });
        }
        self.law.observe(Step {
            dt: gap_s / self.units.time,
            f,
            h: h.fixed_resize(0.0),
            innovation: pad(&innovation),
            correction: (core.x - prior).fixed_rows::<9>(0).into_owned(),
        })?;
        self.thrust = drives.then(|| Thrust {
            alpha_c_bc: alpha,
            dcm_n_bc: sample.dcm_bc_n.transpose(),
        });
        self.report(&core, sample);
        self.core = Some(core);
        Ok(())
    }

    /// The initial estimate as the first sample finds it.
    fn start(&self, nav_init: &State) -> ekf::Gaussian {
        let mut core = ekf::Gaussian {
            x: State::from_fn(|i, _| nav_init[i] / self.units.of_state(i)),
            p: self.initial_p.covariance(),
        };
        if self.law.acceleration() == AccelerationModel::Absent {
            core.x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
            idx::A_T.for_each(|i| core.p[(i, i)] = 0.0);
        }
        core
    }

    /// Time update over a gap, in equal parts.
    ///
    /// * returns: transition of the target's nine states over the whole gap.
    fn propagate(&self, core: &mut ekf::Gaussian, gap_s: f64) -> TargetMatrix {
        let parts = (gap_s / LONGEST_STEP - 1e-9).ceil().max(1.0);
        let dt = gap_s / parts / self.units.time;
        let mut total = TargetMatrix::identity();
        for _ in 0..parts as u32 {
            let f = self
                .dynamics
                .predict(core, dt, self.thrust.as_ref(), &self.law.process_noise(dt));
            total = f.fixed_view::<9, 9>(0, 0) * total;
        }
        total
    }

    /// Measurement update with the rows that this sample offers.
    ///
    /// * returns: LiDAR rows of H and the LiDAR innovation, both zero on a dropout.
    fn update(
        &mut self,
        core: &mut ekf::Gaussian,
        sample: &Sample,
        alpha: &Vector3<f64>,
        drives: bool,
    ) -> Result<(LidarRows, Vector3<f64>), FilterError> {
        let t_s = sample.time;
        let not_spd = |e: ekf::NotSpd| FilterError::InnovationNotSpd {
            t_s,
            min_diagonal: e.min_diagonal,
        };
        let bias_innovation = alpha - core.x.fixed_rows::<3>(idx::B_C.start);
        let bias_rows = |first: usize, h: &mut [f64], rows: usize| {
            // Column-major: an identity under b_c (Eq. 11 prints extra zeros).
            (0..3).for_each(|i| h[(idx::B_C.start + i) * rows + first + i] = 1.0);
        };
        let Some(measured) = sample.lidar else {
            if !drives {
                let mut h = SMatrix::<f64, 3, N>::zeros();
                bias_rows(0, h.as_mut_slice(), 3);
                let r = Vector3::repeat(self.r_accelerometer);
                ekf::update(
                    core,
                    &Measurement {
                        h,
                        innovation: bias_innovation,
                        r,
                    },
                )
                .map_err(not_spd)?;
            }
            self.status = Status::Coasting;
            return Ok((LidarRows::zeros(), Vector3::zeros()));
        };

        let r_tc = core.x.fixed_rows::<3>(0).into_owned();
        let (predicted, rows) = ekf::lidar_rows(&r_tc, &(astro::frames::lidar_from_body() * sample.dcm_bc_n));
        if !rows.iter().all(|v| v.is_finite()) {
            return Err(FilterError::LineOfSightUndefined {
                t_s,
                range_m: r_tc.norm() * self.units.length,
            });
        }
        let innovation = Vector3::new(measured.x / self.units.length, measured.y, measured.z) - predicted;
        let s: Matrix3<f64> = if drives {
            let mut h = SMatrix::<f64, 3, N>::zeros();
            h.fixed_view_mut::<3, 9>(0, 0).copy_from(&rows);
            ekf::update(
                core,
                &Measurement {
                    h,
                    innovation,
                    r: self.r_lidar,
                },
            )
            .map_err(not_spd)?
        } else {
            let mut h = SMatrix::<f64, 6, N>::zeros();
            h.fixed_view_mut::<3, 9>(0, 0).copy_from(&rows);
            bias_rows(3, h.as_mut_slice(), 6);
            let stack = |a: &Vector3<f64>, b: &Vector3<f64>| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
            let m = Measurement {
                h,
                innovation: stack(&innovation, &bias_innovation),
                r: stack(&self.r_lidar, &Vector3::repeat(self.r_accelerometer)),
            };
            ekf::update(core, &m)
                .map_err(not_spd)?
                .fixed_view::<3, 3>(0, 0)
                .into_owned()
        };
        let l = spd::cholesky(&s).ok_or(FilterError::InnovationNotSpd {
            t_s,
            min_diagonal: s.diagonal().min(),
        })?;
        let nis = spd::forward_substitution(&l, &innovation).norm_squared();
        let si = Vector3::new(self.units.length, 1.0, 1.0);
        self.innovation = Innovation {
            residual: innovation.component_mul(&si),
            variance: s.diagonal().component_mul(&si).component_mul(&si),
            nis,
        };
        self.divergence.mean += (nis / 3.0 - self.divergence.mean) / self.divergence.samples;
        self.status = if self.divergence.mean > self.divergence.limit {
            Status::Diverged
        } else {
            Status::Tracking
        };
        Ok((rows, innovation))
    }

    fn report(&mut self, core: &ekf::Gaussian, sample: &Sample) {
        let unit = SVector::<f64, N>::from_fn(|i, _| self.units.of_state(i));
        self.estimate = Estimate {
            time: sample.time,
            count: sample.count,
            x: core.x.component_mul(&unit),
            p_target: TargetMatrix::from_fn(|i, j| core.p[(i, j)] * unit[i] * unit[j]),
            sigma: State::from_fn(|i, _| core.p[(i, i)].sqrt() * unit[i]),
        };
    }

    /// The estimate after the newest sample.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The newest LiDAR innovation.
    pub fn innovation(&self) -> &Innovation {
        &self.innovation
    }

    /// What the filter is doing.
    pub fn status(&self) -> Status {
        self.status
    }

    /// Number of the target's states that have a covariance: nine, or six without an acceleration state.
    pub fn dimension(&self) -> usize {
        if self.law.acceleration() == AccelerationModel::Absent {
            6
        } else {
            N_TARGET
        }
    }

    /// Square root of the jerk density in use, axes N, m/s^2.5; zero for a law without one.
    pub fn s(&self) -> Vector3<f64> {
        self.law.s().map(|s| s.abs() * self.units.root_jerk_density())
    }

    /// How often the law has changed its process noise.
    pub fn updates(&self) -> i32 {
        self.law.updates()
    }

    /// How often the law's solver found no solution.
    pub fn unsolved(&self) -> i32 {
        self.law.unsolved()
    }

    /// How often the law passed an update by because its window was singular.
    pub fn skipped(&self) -> i32 {
        self.law.skipped()
    }
}
