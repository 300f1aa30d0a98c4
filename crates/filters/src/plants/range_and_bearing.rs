//! A target seen by range and angles from a chaser that knows itself roughly: 18 states, axes N (Mamich and Zanetti).

use super::{Estimator, Reported, Updated, defect, sigma};
use crate::beliefs::Beliefs;
use crate::ekf::{self, Dynamics, Measurement, Thrust};
use crate::error::FilterError;
use crate::laws::{AccelerationModel, Adaptation, Law};
use crate::navigator::Innovation;
use crate::sample::Sample;
use crate::scenarios::ScenarioEntry;
use crate::state::{LidarRows, N, Rows, State, TargetMatrix, idx};
use crate::tunable::Bound;
use crate::units::Units;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// The filter's knowledge of both vehicles, internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct RangeAndBearing {
    units: Units,
    dynamics: Dynamics,
    r_lidar: Vector3<f64>,
    r_accelerometer: f64,
    gate: f64,
    initial_p: ekf::InitialSigma,
    /// Mean and covariance; `None` until the first sample.
    core: Option<ekf::Gaussian>,
    /// The reading held over the step that follows; `None` when below the gate or before the first sample.
    thrust: Option<Thrust>,
}

/// LiDAR variances, internal units.
pub(super) fn noise(scenario: &ScenarioEntry, b: &Beliefs) -> Result<Vector6<f64>, FilterError> {
    let r = sensors::lidar::covariance(
        Bound::Positive.check("r.sigma_range", b.r_sigma_range, "m")? / scenario.units.length,
        Bound::Positive.check("r.sigma_angle", b.r_sigma_angle, "rad")?,
    );
    Ok(r.diagonal().fixed_resize(0.0))
}

impl RangeAndBearing {
    pub(super) fn new(
        scenario: &ScenarioEntry,
        b: &Beliefs,
        acceleration: AccelerationModel,
    ) -> Result<Self, FilterError> {
        let units = scenario.units;
        let sigma = |name: &str, value: f64, unit: &'static str| sigma(scenario, name, value, unit);
        let r_acc =
            Bound::Positive.check("r.sigma_accelerometer", b.r_sigma_accelerometer, "m/s2")? / units.acceleration();
        let bias_walk = Bound::NonNegative.check("accelerometer.bias_sigma", b.accelerometer_bias_sigma, "m/s2")?;
        let q_c = Bound::NonNegative.check("chaser.q_c", scenario.resolve("chaser.q_c", b.chaser_q_c)?, "m2/s3")?;
        Ok(Self {
            units,
            dynamics: Dynamics {
                gravity: (scenario.gravity)(b)?,
                acceleration_decay: acceleration.decay(),
                beta: Bound::NonNegative.check("accelerometer.beta", b.accelerometer_beta, "1/s")? * units.time,
                q_c: q_c / (units.velocity().powi(2) / units.time),
                q_coupled: b.chaser_q_coupled,
                // A standard deviation per 1 s step, as a variance rate.
                q_bias: (bias_walk / units.acceleration()).powi(2) * units.time,
            },
            r_lidar: noise(scenario, b)?.fixed_rows::<3>(0).into_owned(),
            r_accelerometer: r_acc * r_acc,
            gate: Bound::NonNegative.check("accelerometer.gate", b.accelerometer_gate, "m/s2")? / units.acceleration(),
            initial_p: ekf::InitialSigma {
                position: sigma("p0.sigma_position", b.p0_sigma_position, "m")? / units.length,
                velocity: sigma("p0.sigma_velocity", b.p0_sigma_velocity, "m/s")? / units.velocity(),
                acceleration: sigma("p0.sigma_acceleration", b.p0_sigma_acceleration, "m/s2")? / units.acceleration(),
                bias: sigma("p0.sigma_bias", b.p0_sigma_bias, "m/s2")? / units.acceleration(),
            },
            core: None,
            thrust: None,
        })
    }

    /// The reading of a sample, and whether it drives the propagation rather than observe the bias.
    fn reading(&self, sample: &Sample) -> (Vector3<f64>, bool) {
        let alpha = sample.alpha_c_bc / self.units.acceleration();
        (alpha, alpha.norm() >= self.gate)
    }
}

/// An identity under b_c from row `first` on (Eq. 11 prints extra zeros).
fn bias_rows<const M: usize>(first: usize, h: &mut SMatrix<f64, M, N>) {
    (0..3).for_each(|i| h[(first + i, idx::B_C.start + i)] = 1.0);
}

impl Estimator for RangeAndBearing {
    fn check(&self, sample: &Sample) -> Result<(), FilterError> {
        let defect = (sample.dcm_bc_n * sample.dcm_bc_n.transpose() - Matrix3::identity()).amax();
        if defect.is_nan() || defect > 1e-6 {
            let t_s = sample.time;
            return Err(FilterError::NotARotation { t_s, defect });
        }
        Ok(())
    }

    fn start(&mut self, nav_init: &State, law: &Law, t_s: f64) -> Result<(), FilterError> {
        if nav_init.fixed_rows::<3>(idx::R_C.start).iter().all(|v| *v == 0.0) {
            return Err(FilterError::NoChaserPosition { t_s });
        }
        let mut core = ekf::Gaussian {
            x: State::from_fn(|i, _| nav_init[i] / self.units.of_state(i)),
            p: self.initial_p.covariance(),
        };
        if law.acceleration() == AccelerationModel::Absent {
            core.x.fixed_rows_mut::<3>(idx::A_T.start).fill(0.0);
            idx::A_T.for_each(|i| core.p[(i, i)] = 0.0);
        }
        self.core = Some(core);
        Ok(())
    }

    fn started(&self) -> bool {
        self.core.is_some()
    }

    fn propagate(&mut self, gap_s: f64, parts: u32, _sample: &Sample, law: &Law) -> TargetMatrix {
        let dt = gap_s / f64::from(parts) / self.units.time;
        let mut total = TargetMatrix::identity();
        let Some(core) = &mut self.core else { return total };
        for _ in 0..parts {
            let (thrust, q) = (self.thrust.as_ref(), law.process_noise(dt));
            let f = self.dynamics.predict(core, dt, thrust, law.disturbance(), &q);
            total = f.fixed_view::<9, 9>(0, 0) * total;
        }
        total
    }

    fn update(&mut self, sample: &Sample, _dt: f64, _law: &Law) -> Result<Updated, FilterError> {
        let t_s = sample.time;
        let (alpha, drives) = self.reading(sample);
        self.thrust = drives.then(|| Thrust {
            alpha_c_bc: alpha,
            dcm_n_bc: sample.dcm_bc_n.transpose(),
        });
        let mut updated = Updated {
            h: Rows::zeros(),
            innovation: Vector6::zeros(),
            correction: SVector::zeros(),
            seen: None,
        };
        let Some(core) = &mut self.core else { return Ok(updated) };
        let prior = core.x;
        let bias_innovation = alpha - core.x.fixed_rows::<3>(idx::B_C.start);
        let Some(measured) = sample.lidar else {
            if !drives {
                let mut h = SMatrix::<f64, 3, N>::zeros();
                bias_rows(0, &mut h);
                let (innovation, r) = (bias_innovation, Vector3::repeat(self.r_accelerometer));
                ekf::update(core, &Measurement { h, innovation, r }, idx::CONSIDER).map_err(|e| e.at(t_s))?;
            }
            updated.correction = (core.x - prior).fixed_rows::<9>(0).into_owned();
            return Ok(updated);
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
        let (variance, nis) = if drives {
            let mut h = SMatrix::<f64, 3, N>::zeros();
            h.fixed_view_mut::<3, 9>(0, 0).copy_from(&rows);
            let r = self.r_lidar;
            let found = ekf::update(core, &Measurement { h, innovation, r }, idx::CONSIDER).map_err(|e| e.at(t_s))?;
            (found.s.diagonal(), found.normalised(&innovation))
        } else {
            let mut h = SMatrix::<f64, 6, N>::zeros();
            h.fixed_view_mut::<3, 9>(0, 0).copy_from(&rows);
            bias_rows(3, &mut h);
            let stack = |a: &Vector3<f64>, b: &Vector3<f64>| Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
            let m = Measurement {
                h,
                innovation: stack(&innovation, &bias_innovation),
                r: stack(&self.r_lidar, &Vector3::repeat(self.r_accelerometer)),
            };
            let found = ekf::update(core, &m, idx::CONSIDER).map_err(|e| e.at(t_s))?;
            let variance = found.s.diagonal().fixed_rows::<3>(0).into_owned();
            (variance, found.normalised(&innovation))
        };
        let si = Vector3::new(self.units.length, 1.0, 1.0);
        updated.h = rows_of(&rows);
        updated.innovation = innovation.fixed_resize(0.0);
        updated.correction = (core.x - prior).fixed_rows::<9>(0).into_owned();
        updated.seen = Some(Innovation {
            residual: innovation.component_mul(&si).fixed_resize(0.0),
            variance: variance.component_mul(&si).component_mul(&si).fixed_resize(0.0),
            nis,
        });
        Ok(updated)
    }

    fn relative(&self) -> Vector6<f64> {
        let of = |core: &ekf::Gaussian| core.x.fixed_rows::<6>(0).into_owned();
        self.core.as_ref().map(of).unwrap_or_default()
    }

    fn report(&self, _sample: &Sample, law: &Law) -> Reported {
        let unit = SVector::<f64, N>::from_fn(|i, _| self.units.of_state(i));
        let Some(core) = &self.core else {
            return Reported {
                x: State::zeros(),
                p_target: TargetMatrix::zeros(),
                sigma: State::zeros(),
            };
        };
        let mut x = core.x;
        if let Some(learnt) = law.disturbance() {
            x.fixed_rows_mut::<3>(idx::A_T.start).copy_from(&learnt.d);
        }
        Reported {
            x: x.component_mul(&unit),
            p_target: TargetMatrix::from_fn(|i, j| core.p[(i, j)] * unit[i] * unit[j]),
            sigma: State::from_fn(|i, _| core.p[(i, i)].sqrt() * unit[i]),
        }
    }

    fn defect(&self, t_s: f64) -> Option<FilterError> {
        let core = self.core.as_ref()?;
        defect(core.x.iter(), core.p.iter(), core.p.diagonal().iter().copied(), t_s)
    }
}

fn rows_of(lidar: &LidarRows) -> Rows {
    lidar.fixed_resize(0.0)
}
