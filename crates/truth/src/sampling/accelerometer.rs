//! Accelerometer: the specific force of the instant, or its mean since the last sample.

use interface::mission::{self, AccelerometerOutput};
use nalgebra::Vector3;
use numerics::Generator;
use numerics::streams::{Source, stream};
use sensors::{accelerometer, normal3};
use serde::{Deserialize, Serialize};

use super::Scene;
use crate::overrides::Run;

/// What the accelerometer says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AccelerometerSample {
    /// Whether it sampled at this epoch; if not, the reading stays the last one.
    pub valid: bool,
    /// Whether the reading is the mean since the last sample rather than that just after the epoch.
    pub mean: bool,
    /// Reading, chaser body axes, m/s2.
    pub alpha_c_bc: Vector3<f64>,
}

/// The sensor with its generator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Accelerometer {
    output: AccelerometerOutput,
    sigma: f64,
    noise: Generator,
}

impl Accelerometer {
    pub(super) fn new(sensor: &mission::Accelerometer, run: &Run) -> Self {
        Self {
            output: sensor.output,
            sigma: sensor.sigma_m_s2,
            noise: stream(run.study_seed, run.run, Source::Accelerometer),
        }
    }

    pub(super) fn output(&self) -> AccelerometerOutput {
        self.output
    }

    pub(super) fn sample(&mut self, seen: &mut AccelerometerSample, scene: &Scene) {
        let noise = normal3(&mut self.noise) * self.sigma;
        seen.valid = true;
        (seen.mean, seen.alpha_c_bc) = match scene.mean_force_c_bc {
            Some(force) => (true, force + scene.b_c_bc + noise),
            None => (
                false,
                accelerometer::reading(&scene.force_c_n, &scene.dcm_bc_n, &scene.b_c_bc, &noise),
            ),
        };
    }
}
