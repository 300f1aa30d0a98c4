//! How a law with a network learns (Pesce, Silvestrini and Lavagna, Sec. II.A.2 and Algorithm 1), in any world.

use super::adaptation::{Setup, Step};
use super::network::Network;
use crate::disturbance::Disturbance;
use crate::error::FilterError;
use crate::units::Units;
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// A network, the error it has yet to learn from, and what it says at the newest estimate.
///
/// Algorithm 1 takes the disturbance from the old weights and then learns from the error of the previous step; so the error
/// of one sample changes the weights at the next, with the basis at the estimate that lies between them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Learner {
    network: Network,
    learning_rate: f64,
    /// Most of an error that may turn into acceleration over an interval.
    gain_limit: f64,
    source: ErrorSource,
    units: Units,
    /// Velocity error of the newest sample, m/s.
    error: Vector3<f64>,
    /// Interval over which it arose, s.
    interval: f64,
    /// At the newest estimate, internal units.
    disturbance: Disturbance,
}

/// What stands for e in Eq. (17).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum ErrorSource {
    /// z - H x-, velocity rows.
    Innovation,
    /// z - H x+, velocity rows.
    Residual,
    /// K (z - H x-), where no row measures the velocity.
    Correction,
}

impl Learner {
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        Ok(Self {
            network: Network::new(setup)?,
            learning_rate: t.real("learning_rate")?,
            gain_limit: t.real("gain_limit")?,
            source: match (setup.state_measured, t.choice("error")?) {
                (false, _) => ErrorSource::Correction,
                (true, 0) => ErrorSource::Innovation,
                (true, _) => ErrorSource::Residual,
            },
            units: setup.units,
            error: Vector3::zeros(),
            interval: 0.0,
            disturbance: Disturbance::default(),
        })
    }

    /// Learns from the error of the sample before this one and keeps this one's.
    pub(super) fn observe(&mut self, step: &Step) {
        let seconds = step.dt * self.units.time;
        // An acceleration that is off by a leaves an error of a times the interval, of which this share is learnt at once.
        let share = self.learning_rate * seconds * self.interval * self.network.response();
        let held = if share > self.gain_limit {
            self.gain_limit / share
        } else {
            1.0
        };
        self.network
            .learn(&(self.error * (seconds * self.learning_rate * held)));
        self.interval = seconds;
        if step.measured.is_empty() {
            // Nothing was measured of the target; what the accelerometer corrected is no error of its model.
            self.error = Vector3::zeros();
            return;
        }
        let corrected = step.correction.fixed_rows::<3>(3);
        let innovation = step.innovation.fixed_rows::<3>(3);
        self.error = match self.source {
            ErrorSource::Innovation => innovation.into_owned(),
            ErrorSource::Residual => innovation - corrected,
            ErrorSource::Correction => corrected * self.units.velocity(),
        };
    }

    /// Evaluates the network at the newest estimate.
    ///
    /// * `x`: relative position and velocity, internal units.
    pub(super) fn look_ahead(&mut self, x: &Vector6<f64>) {
        let unit = Vector6::from_fn(|i, _| self.units.of_state(i));
        let Disturbance { d, by_x } = self.network.evaluate(&x.component_mul(&unit));
        let acceleration = self.units.acceleration();
        self.disturbance = Disturbance {
            d: d / acceleration,
            by_x: by_x.map_with_location(|_, j, v| v * unit[j] / acceleration),
        };
    }

    /// What the network says at the newest estimate, internal units.
    pub(super) fn disturbance(&self) -> &Disturbance {
        &self.disturbance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{FILTERS, FilterEntry};
    use crate::layout::{Layout, Measured};
    use crate::state::{RowVector, Target, TargetMatrix};
    use crate::tunable::{Tunables, Value};
    use interface::Sensor;

    fn learner(units: Units, state_measured: bool, error: usize) -> Learner {
        let entry: &FilterEntry = FILTERS.iter().find(|f| f.name == "rbfnn_ekf").unwrap();
        let value = |name: &str, start: Value| match name {
            "learning_rate" => Value::Real(0.3),
            "relaxation" => Value::Real(0.9),
            "scale_position" => Value::Real(100.0),
            "scale_velocity" => Value::Real(0.5),
            "start_weights" => Value::Real(1e-3),
            "error" => Value::Choice(error),
            _ => start,
        };
        let values: Vec<Value> = entry.tunables.iter().map(|t| value(t.name, t.kind.start())).collect();
        let mission = interface::mission::embedded("leo_venting").unwrap();
        let told = mission.mission().unwrap().navigation();
        Learner::new(&Setup {
            tunables: Tunables {
                law: entry.name,
                declared: entry.tunables,
                values: &values,
                told: &told,
            },
            layout: Layout::new(&[if state_measured {
                Sensor::Metrology
            } else {
                Sensor::Lidar
            }]),
            r: RowVector::repeat(1.0),
            state_measured,
            units,
            off_nominal: 1.0,
            study_seed: 1,
            run: 0,
        })
        .unwrap()
    }

    fn step(dt: f64, correction: Target, innovation: Vector6<f64>) -> Step {
        let mut step = Step::blank(dt, TargetMatrix::identity());
        step.measured.mark(0..3);
        step.innovation = innovation.fixed_resize(0.0);
        step.correction = correction;
        step
    }

    /// The same motion in other units must teach the same: only the units of the answer differ.
    #[test]
    fn what_is_learnt_does_not_depend_on_the_units_of_the_filter() {
        let other = Units {
            length: 3.8e8,
            time: 3.7e5,
        };
        let si = Vector6::new(30.0, -50.0, 20.0, 0.1, 0.2, -0.3);
        let correction = Target::from_fn(|i, _| if i < 6 { 1e-2 * (i + 1) as f64 } else { 0.0 });
        let answers: Vec<Disturbance> = [Units::SI, other]
            .into_iter()
            .map(|units| {
                let mut learner = learner(units, false, 0);
                let unit = Vector6::from_fn(|i, _| units.of_state(i));
                let x = si.component_div(&unit);
                let internal = Target::from_fn(|i, _| if i < 6 { correction[i] / unit[i] } else { 0.0 });
                learner.look_ahead(&x);
                for _ in 0..5 {
                    learner.observe(&step(2.0 / units.time, internal, Vector6::zeros()));
                    learner.look_ahead(&x);
                }
                let found = learner.disturbance();
                let acceleration = units.acceleration();
                Disturbance {
                    d: found.d * acceleration,
                    by_x: found.by_x.map_with_location(|_, j, v| v * acceleration / unit[j]),
                }
            })
            .collect();
        assert!(answers[0].d.norm() > 1e-4, "it did learn: {}", answers[0].d);
        assert!((answers[0].d - answers[1].d).amax() < 1e-12 * answers[0].d.amax());
        assert!((answers[0].by_x - answers[1].by_x).amax() < 1e-12 * answers[0].by_x.amax());
    }

    /// By hand, from Algorithm 1: the error of a sample moves the weights at the next one, with the basis between them.
    #[test]
    fn an_error_teaches_one_sample_later() {
        let (innovation, correction) = (Vector6::repeat(0.5), Target::repeat(0.2));
        for (state_measured, error, e) in [(true, 0, 0.5), (true, 1, 0.5 - 0.2), (false, 0, 0.2)] {
            let mut learner = learner(Units::SI, state_measured, error);
            let x = Vector6::zeros();
            learner.look_ahead(&x);
            let start = learner.disturbance().d;
            learner.observe(&step(2.0, correction, innovation));
            learner.look_ahead(&x);
            // Nothing had been measured before: only the relaxation acts.
            assert!((learner.disturbance().d - start * 0.9).amax() < 1e-15);
            let mut without = learner.clone();
            without.error = Vector3::zeros();
            for one in [&mut learner, &mut without] {
                one.observe(&step(2.0, correction, innovation));
                one.look_ahead(&x);
            }
            let moved = learner.disturbance().d - without.disturbance().d;
            // h eta e sum Phi^2; of sixty wide Gaussians the sum is little above 1 / 60.
            let gain = moved / (2.0 * 0.3 * e);
            assert!(
                gain.iter().all(|g| (1.0 / 60.0..1.3 / 60.0).contains(g)),
                "{state_measured}: {gain}"
            );
        }
    }

    #[test]
    fn a_lost_sample_teaches_nothing() {
        let mut learner = learner(Units::SI, false, 0);
        learner.look_ahead(&Vector6::zeros());
        let lost = Step {
            measured: Measured::default(),
            ..step(1.0, Target::repeat(0.2), Vector6::zeros())
        };
        learner.observe(&lost);
        assert_eq!(learner.error, Vector3::zeros());
    }
}
