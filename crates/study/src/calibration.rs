//! Statistics tried on a case whose answers are known: a linear system with its exact Kalman filter.
//!
//! On each of three axes a point is pushed by white acceleration, constant over a step of 1 s, and its position is measured. Its
//! filter is linear and knows every covariance, so its errors are Gaussian with the covariance it claims: NEES and NIS are
//! chi-square, shares and quantiles are those of a Gaussian. The records take the way of any other filter's.

use nalgebra::{Matrix2, RowVector2, Vector2, Vector3};
use numerics::{Source, stream};
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;
use statrs::distribution::{ChiSquared, Continuous, ContinuousCDF};

use crate::error::StudyError;
use crate::fold::{FilterResult, RunRow};
use crate::phase_summary::PhaseSummary;
use crate::record::{Quantity, Record};
use crate::run::Ending;
use crate::spec::Layout;
use crate::summary::Summary;

const RUNS: u32 = 300;
/// The covariance has settled long before the first that is scored.
const EPOCHS: usize = 130;
const FIRST_SCORED: usize = 30;
/// Variance of the acceleration and of a measurement. With these a measurement takes away three quarters of an error, so epochs
/// ten apart have nothing to do with one another.
const ACCELERATION: f64 = 1.0;
const MEASUREMENT: f64 = 1.0;
const FORGOTTEN_AFTER: f64 = 10.0;
/// Half width of the bounds, in standard deviations: chance leaves them once in 16 000 times.
const WIDTH: f64 = 4.0;

/// A statistic and where it has to lie.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Column of `summary.csv` or `phases.csv`, over what it is expected to be where that is not 1.
    pub statistic: &'static str,
    /// What came out.
    pub value: Option<f64>,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Check {
    /// Bounds about what is expected.
    ///
    /// * `sigma`: standard deviation of the value.
    fn new(statistic: &'static str, value: Option<f64>, expected: f64, sigma: f64) -> Self {
        Self {
            statistic,
            value,
            low: expected - WIDTH * sigma,
            high: expected + WIDTH * sigma,
        }
    }

    /// Whether it is inside.
    pub fn holds(&self) -> bool {
        self.value.is_some_and(|v| (self.low..=self.high).contains(&v))
    }
}

/// What came out of the matched case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// Runs of it.
    pub runs: u32,
    /// Every statistic.
    pub checks: Vec<Check>,
    /// Whether all are inside their bounds.
    pub holds: bool,
}

/// Tries the statistics on the matched case; the same every time.
///
/// # Errors
/// What the statistics refuse.
pub fn calibrate() -> Result<Calibration, StudyError> {
    tried([1.0, 1.0])
}

/// * `believed`: variances of acceleration and measurement that the filter believes in, over the true ones.
fn tried(believed: [f64; 2]) -> Result<Calibration, StudyError> {
    let layout = Layout {
        epochs: EPOCHS,
        first_scored: FIRST_SCORED,
        sample_period: 1.0,
        seed: 1,
        phases: vec!["scored".to_owned()],
    };
    let gains = Gains::new(believed);
    let mut result = FilterResult::new("linear", &layout);
    for run in 0..RUNS {
        let records = one_run(run, &gains);
        let row = RunRow::new(run, &records, FIRST_SCORED, &Ending::default());
        result.fold(row, &records)?;
    }
    let checks = checks(&result, &gains);
    Ok(Calibration {
        runs: RUNS,
        holds: checks.iter().all(Check::holds),
        checks,
    })
}

/// What the filter knows of an axis before it has seen anything, by epoch.
struct Gains {
    /// Gain, variance of the innovation, covariance after the update.
    steps: Vec<(Vector2<f64>, f64, Matrix2<f64>)>,
}

const PHI: Matrix2<f64> = Matrix2::new(1.0, 1.0, 0.0, 1.0);
/// How an acceleration over a step moves position and velocity.
const PUSH: Vector2<f64> = Vector2::new(0.5, 1.0);
const SEEN: RowVector2<f64> = RowVector2::new(1.0, 0.0);
/// Standard deviation of the initial estimate.
const START: f64 = 10.0;

impl Gains {
    fn new([acceleration, measurement]: [f64; 2]) -> Self {
        let mut p = Matrix2::identity() * (START * START);
        let step = |_| {
            let prior = PHI * p * PHI.transpose() + PUSH * PUSH.transpose() * (acceleration * ACCELERATION);
            let s = prior[(0, 0)] + measurement * MEASUREMENT;
            let gain = prior * SEEN.transpose() / s;
            let rest = Matrix2::identity() - gain * SEEN;
            p = rest * prior * rest.transpose() + gain * gain.transpose() * (measurement * MEASUREMENT);
            (gain, s, p)
        };
        Self {
            steps: (0..EPOCHS).map(step).collect(),
        }
    }
}

fn one_run(run: u32, gains: &Gains) -> Vec<Record> {
    let mut generator = stream(1, run.into(), Source::Calibration);
    let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
    let mut states = [(); 3].map(|()| {
        let truth = Vector2::zeros();
        (truth, truth + Vector2::new(normal(), normal()) * START)
    });
    let mut records = Vec::with_capacity(EPOCHS);
    for (epoch, (gain, s, p)) in gains.steps.iter().enumerate() {
        let mut innovation = Vector3::zeros();
        let mut errors = [Vector3::zeros(); 2];
        let mut nees = 0.0;
        for (axis, (truth, estimate)) in states.iter_mut().enumerate() {
            *truth = PHI * *truth + PUSH * (normal() * ACCELERATION.sqrt());
            *estimate = PHI * *estimate;
            innovation[axis] = truth[0] + normal() * MEASUREMENT.sqrt() - estimate[0];
            *estimate += gain * innovation[axis];
            let error = *estimate - *truth;
            (errors[0][axis], errors[1][axis]) = (error[0], error[1]);
            // e^T P^-1 e of two states.
            let squares = p[(1, 1)] * error[0] * error[0] - 2.0 * p[(0, 1)] * error[0] * error[1]
                + p[(0, 0)] * error[1] * error[1];
            nees += squares / p.determinant();
        }
        let mut record = Record::new(epoch);
        record.phases = u32::from(epoch >= FIRST_SCORED);
        (record.dimension, record.nis_rows) = (6, 3);
        for (quantity, error, state) in [(Quantity::Position, errors[0], 0), (Quantity::Velocity, errors[1], 1)] {
            record.set(quantity, Some(error), Some(Vector3::repeat(p[(state, state)])));
        }
        record.set(Quantity::Residual, Some(innovation), Some(Vector3::repeat(*s)));
        record.set_nees(Some(nees / 6.0), Some(nees / 6.0));
        record.set_nis(Some(innovation.norm_squared() / s / 3.0));
        records.push(record);
    }
    records
}

fn checks(result: &FilterResult, gains: &Gains) -> Vec<Check> {
    let row = Summary::new("calibration", "matched", result);
    let phases = PhaseSummary::of("calibration", "matched", result);
    let phase = phases.first().cloned().unwrap_or_default();
    let scored = (EPOCHS - FIRST_SCORED) as f64;
    let runs = f64::from(RUNS);
    // Innovations are white, so every sample of theirs counts; of the errors one in ten.
    let (white, errors) = (runs * scored, runs * scored / FORGOTTEN_AFTER);
    let epochs = scored / FORGOTTEN_AFTER;
    let share = |p: f64, n: f64| (p * (1.0 - p) / n).sqrt();
    let chi = |freedom: f64, n: f64| (2.0 / freedom / n).sqrt();
    let inside = 0.95;
    let three_sigma = 0.997_300_2;
    // A ratio at one epoch has a relative sigma of 1 / sqrt(2 runs); the median of many, 1.25 of their mean's.
    let ratio = 1.25 / (2.0 * runs * 3.0 * epochs).sqrt();
    let mut found = vec![
        Check::new("nees", row.nees.mean, 1.0, chi(6.0, errors)),
        Check::new("nis", row.nis.mean, 1.0, chi(3.0, white)),
        Check::new("nees_inside", phase.nees.inside, inside, share(inside, epochs)),
        Check::new("nis_inside", phase.nis.inside, inside, share(inside, scored)),
        Check::new(
            "coverage_3s_pos",
            row.position.coverage,
            three_sigma,
            share(three_sigma, 3.0 * errors),
        ),
        Check::new(
            "coverage_3s_vel",
            row.velocity.coverage,
            three_sigma,
            share(three_sigma, 3.0 * errors),
        ),
        Check::new("ratio_pos", row.position.ratio, 1.0, ratio),
        Check::new("ratio_vel", row.velocity.ratio, 1.0, ratio),
        // Root of a mean of so many squares of a standard Gaussian.
        Check::new(
            "mean_err_sigma",
            row.mean_error_sigma,
            1.0,
            (2.0 * 6.0 * epochs).sqrt().recip(),
        ),
    ];
    let sigma = |state: usize| {
        gains
            .steps
            .last()
            .map_or(f64::NAN, |(_, _, p)| p[(state, state)].sqrt())
    };
    let names = [
        ["pos_p50_m", "pos_p95_m", "pos_p997_m"],
        ["vel_p50_m_s", "vel_p95_m_s", "vel_p997_m_s"],
    ];
    // The norm of three equal axes is the root of a chi-square of three degrees.
    if let Ok(squared) = ChiSquared::new(3.0) {
        for (state, names) in names.into_iter().enumerate() {
            for (at, (name, p)) in names.into_iter().zip([0.5, 0.95, 0.997]).enumerate() {
                let square = squared.inverse_cdf(p);
                let norm = square.sqrt();
                let density = squared.pdf(square) * 2.0 * norm;
                let value = phase.errors[state].quantiles[at].map(|q| q / (norm * sigma(state)));
                found.push(Check::new(name, value, 1.0, share(p, errors) / density / norm));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matched_case_is_inside_every_bound() {
        let found = calibrate().unwrap();
        let outside: Vec<&Check> = found.checks.iter().filter(|c| !c.holds()).collect();
        assert!(found.holds && outside.is_empty(), "{outside:#?}");
        assert_eq!(found.checks.len(), 15);
    }

    /// The steady gain of this system from the closed form for white acceleration (Kalata): with index 1,
    /// alpha = 0.75 and beta = 0.5.
    #[test]
    fn the_filter_is_the_steady_one_of_the_textbook() {
        let gains = Gains::new([1.0, 1.0]);
        let (gain, ..) = gains.steps.last().unwrap();
        assert!((gain - Vector2::new(0.75, 0.5)).norm() < 1e-9, "{gain}");
    }

    #[test]
    fn a_filter_that_is_tuned_wrong_is_found_out() {
        for believed in [[4.0, 1.0], [0.25, 1.0], [1.0, 4.0], [1.0, 0.25]] {
            let found = tried(believed).unwrap();
            let outside = |name: &str| found.checks.iter().any(|c| c.statistic == name && !c.holds());
            assert!(
                !found.holds && outside("nees") && outside("nis"),
                "{believed:?}: {:#?}",
                found.checks
            );
            // Its mean error is nothing all the same: that one asks about bias alone.
            assert!(!outside("mean_err_sigma"), "{believed:?}");
        }
    }
}
