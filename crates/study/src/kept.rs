//! What a study keeps of single runs for its figures: thinned errors of the first runs, and the true path of run 0.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::record::{Quantity, Record};
use crate::samples::TruthSample;
use crate::spec::Spec;
use crate::world::Frame;

/// Runs whose errors are kept.
pub const KEPT_RUNS: usize = 50;
/// Stretches of time of equal length in which each axis keeps its least and its greatest error.
const STRETCHES: usize = 100;
/// Most points of the path.
const PATH: usize = 600;

/// Errors that are kept.
const MOTION: [Quantity; 3] = [Quantity::Position, Quantity::Velocity, Quantity::Acceleration];

/// Thinned errors of one run: two rows for each stretch of time that has estimates.
///
/// The rows hold the least and the greatest error of the stretch, axis by axis, in the order in which they came, so that
/// no peak is lost.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptRun {
    /// Number of the run.
    pub run: u32,
    /// In the order of time.
    pub rows: Vec<KeptRow>,
}

/// Errors of position, m, velocity, m/s, and acceleration, m/s2, in the axes of the results; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptRow {
    /// Epoch: the first of the stretch, or one in its middle.
    pub epoch: usize,
    /// By quantity.
    pub errors: [Vector3<f64>; 3],
}

impl KeptRun {
    /// * `records`: the estimates of the run, in order.
    /// * `epochs`: of a whole run.
    pub(crate) fn new(run: u32, records: &[Record], epochs: usize) -> Self {
        let every = epochs.div_ceil(STRETCHES).max(2);
        let mut rows = Vec::new();
        for stretch in records.chunk_by(|a, b| a.epoch as usize / every == b.epoch as usize / every) {
            let first = stretch.first().map_or(0, |r| r.epoch as usize / every * every);
            let pair = MOTION.map(|quantity| extremes(stretch, quantity));
            rows.extend([0, 1].map(|row| KeptRow {
                epoch: first + row * every / 2,
                errors: pair.map(|extremes| extremes[row]),
            }));
        }
        Self { run, rows }
    }
}

/// Least and greatest error of each axis, the earlier one first.
fn extremes(records: &[Record], quantity: Quantity) -> [Vector3<f64>; 2] {
    let of_axis = |axis: usize| {
        let errors = || {
            records
                .iter()
                .filter_map(|r| Some(r.error(quantity)?[axis]))
                .enumerate()
        };
        let least = errors().min_by(|a, b| a.1.total_cmp(&b.1));
        let greatest = errors().max_by(|a, b| a.1.total_cmp(&b.1));
        let pair = least
            .zip(greatest)
            .map(|(l, g)| if l.0 <= g.0 { [l.1, g.1] } else { [g.1, l.1] });
        pair.unwrap_or([f64::NAN; 2])
    };
    let axes = [0, 1, 2].map(of_axis);
    [0, 1].map(|which| Vector3::from(axes.map(|pair| pair[which])))
}

/// Where the vehicles truly are at an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PathPoint {
    /// Place of the epoch on the study's grid, from 0.
    pub epoch: u32,
    /// Chaser relative to target in the axes of the results, m.
    pub relative: Vector3<f64>,
    /// Chaser in axes N, m, where the truth tells it.
    pub chaser: Option<Vector3<f64>>,
}

/// The true path of a run, of which every so many epochs are kept.
#[derive(Debug)]
pub(crate) struct Path {
    every: usize,
    points: Vec<PathPoint>,
}

impl Path {
    pub fn new(spec: &Spec) -> Self {
        Self {
            every: spec.epochs().div_ceil(PATH).max(1),
            points: Vec::new(),
        }
    }

    /// Takes a sample, if it is one of those that are kept and not known yet.
    pub fn push(&mut self, spec: &Spec, truth: &TruthSample) {
        let epoch = u32::try_from(truth.epoch).unwrap_or(u32::MAX);
        if !truth.epoch.is_multiple_of(self.every) || self.points.last().is_some_and(|p| p.epoch >= epoch) {
            return;
        }
        let Some(axes) = spec.world.axes.matrix(truth) else {
            return;
        };
        let sign = match spec.world.frame {
            Frame::Inertial => -1.0,
            Frame::Lvlh => 1.0,
        };
        self.points.push(PathPoint {
            epoch,
            relative: axes * truth.position * sign,
            chaser: truth.chaser.map(|(position, _)| position),
        });
    }

    pub fn into_points(self) -> Vec<PathPoint> {
        self.points
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "values are copied, not computed")]
mod tests {
    use super::*;

    #[test]
    fn peaks_of_every_stretch_survive_in_their_order() {
        let mut records: Vec<Record> = (0..300).map(Record::new).collect();
        for (epoch, record) in records.iter_mut().enumerate() {
            let peak = if epoch == 151 { 9.0 } else { 0.0 };
            let error = Vector3::new(epoch as f64, -(epoch as f64), peak);
            record.set(Quantity::Position, Some(error), None);
        }
        let kept = KeptRun::new(4, &records, 300);
        assert_eq!((kept.run, kept.rows.len()), (4, 200));
        let rows = &kept.rows[100..102];
        assert_eq!([rows[0].epoch, rows[1].epoch], [150, 151]);
        assert_eq!(rows[0].errors[0], Vector3::new(150.0, -150.0, 0.0));
        assert_eq!(rows[1].errors[0], Vector3::new(152.0, -152.0, 9.0));
        assert!(rows[0].errors[1].iter().all(|x| x.is_nan()));
    }
}
