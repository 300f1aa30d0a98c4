//! One run of a mission through its FMU, without noise, seen from outside.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use cosim::{RunOptions, StepContext, System};
use interface::Sensor;
use nalgebra::Vector3;
use study::{Assignment, Models, Plan, StudyError, World};

use crate::HarnessError;

/// Parameters of fmu-truth that are set to zero, so that nothing but the mission's events is left to chance.
fn quiet() -> impl Iterator<Item = String> {
    let of_sensor = |sensor: Sensor| {
        let sigmas = sensor.sigmas().iter().map(|sigma| sigma.name());
        sigmas
            .chain(["dropout_probability", "outlier_probability"])
            .map(move |name| format!("{}.{name}", sensor.name()))
    };
    Sensor::ALL
        .into_iter()
        .flat_map(of_sensor)
        .chain(["accelerometer.sigma".to_owned()])
}

/// Where both vehicles were at one time, axes N, m and m/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub t: f64,
    pub r_tc: Vector3<f64>,
    pub v_tc: Vector3<f64>,
    pub r_c: Vector3<f64>,
    pub v_c: Vector3<f64>,
}

/// What a sensor saw.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    /// Times it sampled.
    pub due: u32,
    /// Times it saw the target.
    pub valid: u32,
    /// First and last of those, s.
    pub span: Option<(f64, f64)>,
    /// Least and greatest distance of the target then, m.
    pub range: Option<(f64, f64)>,
}

/// A run without noise.
#[derive(Debug, Default)]
pub(super) struct QuietRun {
    /// At the communication points, which are the epochs at which samples can lie.
    pub points: Vec<Point>,
    /// By sensor; those that are not on board are missing.
    pub seen: BTreeMap<Sensor, Seen>,
}

/// Runs a world.
///
/// * `plan`: seeds and what else is said of all studies.
/// * `run`: whose events happen.
///
/// # Errors
/// Whatever the FMU refuses.
pub(super) fn run_quietly(models: &Models, plan: &Plan, world: &World, run: u32) -> Result<QuietRun, HarnessError> {
    let quiet = quiet().filter_map(|name| format!("fmu-truth.{name}=0").parse().ok());
    let assignments: Vec<Assignment> = plan.in_fmus().cloned().chain(quiet).collect();
    let participant = models.truth_alone(world, &assignments)?;
    let mut system = System::new();
    let truth = study::seat(&mut system, &participant, plan.seed, run)?;
    let failed = |source| HarnessError::from(StudyError::from(source));
    let mut probe = system.probe(truth).map_err(failed)?;
    let mut vector = |name: &str| probe.vec3(name).map_err(failed);
    let state = [
        vector("truth.r_tc_n")?,
        vector("truth.v_tc_n")?,
        vector("truth.r_c_n")?,
        vector("truth.v_c_n")?,
    ];
    let count = probe.integer("sample_count").map_err(failed)?;
    let mut flags = Vec::new();
    for sensor in Sensor::ALL {
        let due = probe.boolean(&format!("{}.due", sensor.name())).map_err(failed)?;
        let valid = probe.boolean(&format!("{}.valid", sensor.name())).map_err(failed)?;
        flags.push((sensor, due, valid));
    }
    let mut sample = probe.sample();
    let options = RunOptions {
        stop: world.duration_s,
        step: world.sample_period_s,
        ..RunOptions::default()
    };
    let mut quiet = QuietRun::default();
    let mut last = 0;
    let report = system
        .run(&options, |context: &mut StepContext<'_>| {
            let t = context.time();
            if context.read(&mut sample).is_err() {
                return ControlFlow::Break(());
            }
            let [r_tc, v_tc, r_c, v_c] = state.map(|handle| Vector3::from(sample.get(handle)));
            quiet.points.push(Point {
                t,
                r_tc,
                v_tc,
                r_c,
                v_c,
            });
            if sample.get(count) > last {
                last = sample.get(count);
                for (sensor, due, valid) in &flags {
                    if sample.get(*due) {
                        quiet
                            .seen
                            .entry(*sensor)
                            .or_default()
                            .note(t, r_tc.norm(), sample.get(*valid));
                    }
                }
            }
            ControlFlow::Continue(())
        })
        .map_err(failed)?;
    if let Some(refused) = report.isolated.into_iter().next() {
        return Err(failed(refused.error));
    }
    if let Some(lost) = quiet.points.iter().find(|p| !p.r_tc.norm().is_finite()) {
        return Err(StudyError::Lost { time: lost.t }.into());
    }
    Ok(quiet)
}

impl Seen {
    fn note(&mut self, t: f64, range: f64, valid: bool) {
        self.due += 1;
        if !valid {
            return;
        }
        self.valid += 1;
        let (first, _) = self.span.unwrap_or((t, t));
        self.span = Some((first, t));
        let (low, high) = self.range.unwrap_or((range, range));
        self.range = Some((low.min(range), high.max(range)));
    }
}

impl QuietRun {
    /// The point at which the vehicles were closest.
    pub(super) fn closest(&self) -> Option<&Point> {
        self.points
            .iter()
            .min_by(|a, b| a.r_tc.norm().total_cmp(&b.r_tc.norm()))
    }

    /// The largest difference of relative positions at the same times, m.
    pub(super) fn apart_from(&self, other: &Self) -> f64 {
        let pairs = self.points.iter().zip(&other.points);
        pairs.map(|(a, b)| (a.r_tc - b.r_tc).norm()).fold(0.0, f64::max)
    }
}
