//! Dropouts, outliers and the greatest range, which the sensors of the target share.

use interface::mission;
use numerics::Generator;
use numerics::streams::{Source, named_stream, stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::overrides::Run;

/// What can go wrong with the samples of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Faults {
    max_range: f64,
    dropout_probability: f64,
    outlier_probability: f64,
    outlier_scale: f64,
    dropout: Generator,
    outlier: Generator,
}

/// What went wrong with a sample.
pub(super) struct Fault {
    /// Nothing was received.
    pub dropped: bool,
    /// By how much the noise is larger.
    pub scale: f64,
}

impl Faults {
    /// * `plain`: whether the sensor has the streams without a name, as the only sensor of the target in the papers' missions
    ///   does; any other has streams of its own, so that no two share their faults.
    pub(super) fn new(of: mission::Faults, run: &Run, name: &str, plain: bool) -> Self {
        let generator = |source| {
            if plain {
                stream(run.study_seed, run.run, source)
            } else {
                named_stream(run.study_seed, run.run, source, name)
            }
        };
        Self {
            max_range: of.max_range_m,
            dropout_probability: of.dropout_probability,
            outlier_probability: of.outlier_probability,
            outlier_scale: of.outlier_scale,
            dropout: generator(Source::Dropout),
            outlier: generator(Source::Outlier),
        }
    }

    /// Draws what goes wrong with the next sample.
    ///
    /// * `range`: distance of the target, m.
    pub(super) fn draw(&mut self, range: f64) -> Fault {
        let dropped = self.dropout.random::<f64>() < self.dropout_probability;
        let outlier = self.outlier.random::<f64>() < self.outlier_probability;
        Fault {
            dropped: dropped || range > self.max_range,
            scale: if outlier { self.outlier_scale } else { 1.0 },
        }
    }
}
